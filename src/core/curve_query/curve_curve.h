/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball or a convex body that rides one curve against a ball that rides another, each at its own
 * parameter. A node is a pair of intervals. doc/curve-bound.md derives it. */
#ifndef CPROX_CURVE_QUERY_CURVE_CURVE_H
#define CPROX_CURVE_QUERY_CURVE_CURVE_H

#include "branch_and_bound/search.h"
#include "curve/curve_side.h"
#include "shape/body.h"

/* The payload of a node, and how to get at it. */
typedef struct curve_curve_node {
  curve_interval side[2];
  uint32_t seen; /* the incumbent that its bound knows already */
} curve_curve_node;

static inline const curve_curve_node *curve_curve_known(const search_node *node) {
  _Static_assert(sizeof(curve_curve_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const curve_curve_node *)node->payload.bytes;
}

static inline curve_curve_node *curve_curve_own(search_node *node) {
  return (curve_curve_node *)node->payload.bytes;
}

/* A point of either curve, how far apart they are, and the direction from the second to the first. */
typedef struct curve_meeting {
  vec3 point[2];
  size_t piece[2];
  double s[2];
  double distance;  /* between the points, or of the carried body and the second point */
  vec3 normal;      /* unit within 4 u; (0,0,0) where there is none */
  convex_near near; /* where a body is carried */
} curve_meeting;

typedef struct curve_curve {
  /* the problem */
  cprox_curve own[2]; /* the curve and the radius of the first side where they were made for this search */
  curve_side side[2];
  double offset; /* the sum of the two radii */
  bool carries;  /* a body rides the first curve: the points' difference, moved by `shift`, against `joined` */
  convex joined;
  vec3 shift;
  search_effort effort;

  /* what is known */
  curve_meeting best;
  search_best best_bound;
  uint32_t incumbent;  /* counts the best meetings; 0: none */
  vec3 last_normal;    /* of the last pair of chords, or of the last probe of a carried body */
  bool support_failed; /* a support callback misbehaved */
  double goal;         /* what settles a node, as of the last one that was looked at */
  uint32_t distance_queries, nodes;

  /* memory */
  cprox_workspace *workspace;
  points_pool pool;
} curve_curve;

/* Makes the oracle ready; false where memory is out. Both curves are seen from the frame of the second, which `placed`
 * puts into the world of the first, about the second's first control point. */
bool curve_curve_begin(curve_curve *o, const cprox_curve *first, const cprox_curve *second, const cprox_pose *placed,
                       double offset, cprox_workspace *workspace);

/* Lets the first curve carry a body, its pose that at the curve's origin; false where its support callback misbehaved.
 */
bool curve_curve_carry(curve_curve *o, const cprox_pose *placed, const cprox_body *carried, const cprox_pose *pose);

/* The least n·x of what the first curve carries, seen from the curve's point; n is a unit vector. 0: nothing. */
double curve_curve_carried(const curve_curve *o, vec3 n);

/* The node that is all that is asked about: side[0].part and side[1].part. */
search_node curve_curve_root(const curve_curve *o);

/* The functions of the contract in branch_and_bound/search.h, self being the curve_curve. */
search_oracle curve_curve_oracle(curve_curve *o);

/* ---- what an oracle with another place to measure and to cut is made of: curve_query/contact_curve.c ---- */

/* Raises node->lower along n, unit or (0,0,0). The node's pieces must be the loaded ones. */
void curve_curve_bound(const curve_curve *o, search_node *node, vec3 n);

/* Gives single pieces points of their own, and loads them; *pieces: both sides are single pieces. */
cprox_status curve_curve_materialise(curve_curve *o, search_node *node, bool *pieces);

/* What the chords of the node suggest: a normal, and where on both they are nearest. */
vec3 curve_curve_suggest(curve_curve *o, const search_node *node, double fraction[2]);

/* Points of both curves near those fractions of the chords; their errors add up to *error. */
curve_meeting curve_curve_meeting_near(curve_curve *o, const search_node *node, const double fraction[2],
                                       double *error);

/* Fills in distance and normal of a meeting whose points are within `error` of the exact ones in all. */
void curve_curve_measure(curve_curve *o, curve_meeting *m, double error, search_best *bound);
void curve_curve_adopt(curve_curve *o, const curve_meeting *m, search_best bound);

/* Which sides of a node to cut, at which fraction s of the interval, and at which parameter of the piece. Ranges of
 * pieces fall in two halves wherever that is. */
typedef struct curve_curve_cuts {
  bool wanted[2];
  double s[2], at[2];
} curve_curve_cuts;

void curve_curve_cut_middle(curve_curve_cuts *cuts, const search_node *node, int k);
int curve_curve_longer_side(const curve_curve *o, const search_node *node);

/* The children, all bounded by the last and the best normal; as search_oracle.split. */
int curve_curve_cut(curve_curve *o, search_node *node, const curve_curve_cuts *cuts, search_node *child);

#endif
