/* SPDX-License-Identifier: BSD-3-Clause */
/* The four kernels of a mover's curve against one obstacle: a convex shape, the elements of a BVH, another curve, a set
 * known by its distance. Each knows a radius that changes along the curve. Searches for distances, for verdicts and for
 * the time of contact are the same for all of them; what differs between the kernels is one row of operations each. */
#ifndef CPROX_CURVE_QUERY_SEARCH_KERNEL_H
#define CPROX_CURVE_QUERY_SEARCH_KERNEL_H

#include "curve_query/contact_bvh.h"
#include "curve_query/contact_convex.h"
#include "curve_query/contact_curve.h"
#include "curve_query/curve_distance.h"
#include "problem/placed_pair.h"

typedef struct curve_search curve_search;

/* The place where a search found the two nearest, in the world. An obstacle on the mover's clock stands as if its curve
 * were at the origin. */
typedef struct curve_finding {
  bool found;                   /* false: nothing was measured, and only `bound` and `distance_queries` are set */
  bool is_contact;              /* the mover's witness point is proven to lie on the obstacle, too */
  bool at_end;                  /* at the end of a piece of the mover's curve */
  double t, t_obstacle;         /* the parameters of both curves; t_obstacle: NAN but for the kernel of two curves */
  double t_contact;             /* time of contact: contact is proven here, at t or a little later */
  vec3 centre, surface;         /* the point of the mover's curve, and that of the obstacle */
  vec3 normal;                  /* unit, from the obstacle to the mover; (0,0,0) where there is none */
  double distance;              /* between the two points, without margins */
  bool parts_known;             /* a Minkowski difference: the points of both bodies, in the frame of what stands, */
  vec3 on_standing, on_carried; /* else the point of what stands, and the curve's or the carried ball's centre */
  search_best bound;
  uint32_t distance_queries;
} curve_finding;

/* What the engine begins with. */
typedef struct curve_start {
  search_goal goal; /* the caller's; a kernel may change the order */
  search_oracle oracle;
  search_node root;
  double upper; /* an upper bound that is known before the search; infinity: none */
} curve_start;

/* Each operation returns CPROX_OK or a negative status. */
typedef struct curve_kernel {
  bool knows_depth; /* measures how deep both overlap */

  /* Makes the state ready. */
  cprox_status (*begin_state)(curve_search *s);

  /* Fills in oracle, root and upper of a search for the distance or a verdict, or for the time of contact. */
  cprox_status (*start_distance)(curve_search *s, curve_start *start);
  cprox_status (*start_contact)(curve_search *s, curve_start *start);

  /* After a search for the distance: so near that only a proof of contact is better. Whether there is one; NULL: the
   * search itself looks for one. */
  bool (*prove_crossing)(curve_search *s);

  /* After a search for the time of contact: where contact is proven; bound.at is infinity where it is nowhere. */
  cprox_status (*prove_contact)(curve_search *s, curve_finding *proven);

  /* The best that a search found. */
  void (*best_found)(const curve_search *s, curve_finding *seen);
} curve_kernel;

/* One search: the pair, its kernel, and what the kernel knows. A search for distances uses `base` of its state alone.
 */
struct curve_search {
  const query *q;
  const placed_pair *pair;
  const curve_kernel *kernel;
  union {
    contact_convex convex;
    contact_tree tree;
    contact_curve curve;
    curve_distance distance;
  } state;
};

/* The one place that says which kernel answers a pair. */
const curve_kernel *curve_kernel_of(const placed_pair *p);

/* CPROX_PRECISION by its true name: CPROX_INEXACT where the error of a field takes more of `slack` than rounding. */
cprox_status curve_kernel_shortfall(const placed_pair *p, double slack);

/* Picks the kernel and makes its state ready. */
cprox_status curve_search_begin(curve_search *s, const query *q, const placed_pair *p);

/* ---- single kernels, for callers that measure without a search ---- */

/* False where memory is out. */
bool curve_convex_begin_pair(curve_convex *o, const query *q, const placed_pair *p);
bool curve_tree_begin_pair(curve_tree *o, const query *q, const placed_pair *p);

void curve_convex_finding(const curve_convex *o, curve_finding *seen);
void curve_tree_finding(const curve_tree *o, curve_finding *seen);

#endif
