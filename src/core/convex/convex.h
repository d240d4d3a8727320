/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex shapes in their own frame, one file a kind: a core (what the support function describes) and a margin (a ball
 * added to it). A sphere is a point with a margin, a capsule a segment with a margin, an ellipsoid a core with the
 * largest ball that can be split off; the rest have margin 0. */
#ifndef CPROX_CONVEX_CONVEX_H
#define CPROX_CONVEX_CONVEX_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec.h"
#include "curve_proximity/cprox/body.h"

typedef struct convex convex;
struct implicit;

/* Where a search for a nearest or extreme point may start: vertices of the last answer. Zero-initialised: from scratch.
 * A bad hint costs time, never truth. */
typedef struct convex_hint {
  int32_t n;
  int32_t vertex[4];
  double near_enough; /* a point of the core that is as near as this will do, though another is nearer */
  vec3 towards;       /* of a difference, unit: near the normal of the answer; (0,0,0): nothing is known */
  double fraction;    /* likewise: the width that the distance may have, as a fraction of what it is above `floor`; */
  double floor;       /* 0: it is as exact as can be */
} convex_hint;

/* The answer of a nearest-point query for a point y: the surface point, and how the distance behaves near y.
 *
 * Where `flat` is set, near y  distance = |w| - offset, w = the part of (y - origin) orthogonal to the `tangents`
 * vectors e[]: a vertex has none, an edge one, a face two; a sphere's origin is its centre, a cylinder's side has its
 * axis as tangent. Where it is not, `hessian` is the second derivative of the distance at y (xx, xy, xz, yy, yz, zz).
 */
typedef struct convex_near {
  double distance; /* to the shape, margin included; negative inside where the kind can tell, else 0. NaN: the callback
                      of a support body misbehaved */
  vec3 point;      /* the nearest point of the shape, margin included */
  vec3 normal;     /* unit, the direction in which the distance grows; (0,0,0) where there is none */
  bool flat;
  int tangents;
  vec3 e[2];
  vec3 origin;
  double offset;
  double hessian[6];
  bool height_known; /* height is the core's support function at `normal`, from above: no need to ask again */
  double height;
  bool parts_known; /* Minkowski differences: the points of both that make `point`, in the frame of what stands; twice
                       the same, a point of both, where they overlap */
  vec3 on_standing, on_carried;
} convex_near;

/* A ball about `centre`, or a cylinder of infinite length about the line through `centre` along the unit `axis`, that
 * contains the whole shape, margin included, rounding included. */
typedef struct convex_cover {
  vec3 centre;
  vec3 axis;
  bool cylinder;
  double radius;
} convex_cover;

/* Where a point of the space is carried by the projection onto a core, and how that place moves with it. */
typedef struct convex_foot {
  vec3 point;      /* of the core: the nearest to y; y itself inside */
  int tangents;    /* the dimension of the piece of the surface that the point lies on; 3 inside */
  vec3 e[2];       /* orthonormal, tangent to it */
  double along[2]; /* in (0, 1]: how far the point moves along e for each unit that y does; 1: the piece is straight */
} convex_foot;

typedef enum convex_round_core {
  CONVEX_NEVER_ROUND,
  CONVEX_ALWAYS_ROUND,
  CONVEX_ROUND_IF_EQUAL /* where size[0] == size[1] */
} convex_round_core;

/* What a kind can do. Queries get shapes that their constructor has checked. */
typedef struct convex_ops {
  cprox_body_kind kind;

  /* |computed - true distance| <= near_rounding * u * (|y| + scale) + slack: the constant of the kind. Inside a
   * polytope or a support body the distance is minus a proven depth, which may be less than the true one. */
  double near_rounding;

  void (*nearest)(const convex *shape, vec3 y, convex_hint *hint, convex_near *near);

  /* h(d) = max over the core of d·x, for d of any length but 0, and the maximiser (at may be NULL).
   * Within ROUND_SUPPORT * u * |d| * scale of the truth (plus |d| slack), never below a point of the core. */
  double (*support)(const convex *shape, vec3 d, convex_hint *hint, vec3 *at);

  /* The derivative of the maximiser by d, at unit d with maximiser x of the core (xx, xy, xz, yy, yz, zz); NULL for
   * polyhedra. */
  void (*curvature)(const convex *shape, vec3 d, vec3 x, double hessian[6]);

  /* nearest() tells the distance and the depth of any point by a formula. */
  bool closed_form;

  /* Inside, nearest() proves a depth that may be less than the true one: convex/depth.h completes it. */
  bool proves_depth;

  /* Whether turning the core about the z axis leaves it as it is. */
  convex_round_core round_core;

  /* The maximiser is a smooth function of the direction: the core's surface is one piece. */
  bool smooth;

  /* The extreme point in direction d of the smooth piece of the core that x lies on (a rim, the whole ellipsoid),
   * whether or not another piece reaches farther: always a point of the core. NULL for polyhedra: x itself. */
  vec3 (*follow)(const convex *shape, vec3 d, vec3 x);

  /* The point of the core nearest to y: a point of the core but for 5 u of its scale, however far y is. NULL: there is
   * no quick closed form. */
  void (*project)(const convex *shape, vec3 y, convex_foot *foot);

  /* A tight cover that touches the shape at near->point; false where there is none (a face, a flat side). NULL: never.
   */
  bool (*cover)(const convex *shape, const convex_near *near, convex_cover *cover);
} convex_ops;

struct convex {
  const convex_ops *ops;
  double size[4]; /* what the kind needs: half extents; radius and half height; semi-axes; unit normal and offset */
  double margin;
  double scale;   /* bound on |x| over the shape, about the origin of this frame; a halfspace's distance from it */
  double slack;   /* how far support values and distances may be off: support callbacks and implicit bodies; else 0 */
  double outside; /* how far nearest points may be off the core: as slack, but 0 of implicit bodies */
  double drawn; /* implicit bodies: what was computed lies in the body once it is drawn to 0 by this part of its way */
  /* polytopes and polygons: vertices about the origin, one array a coordinate, padded to a multiple of 8 with the last
   * one */
  int32_t n, padded;
  double *x, *y, *z;
  double *edge; /* polygons: of each edge from vertex i on, its unit direction's x and y, its length, its other end's x
                   and y; five arrays, padded likewise */
  /* support callbacks */
  cprox_support_fn callback;
  const void *user;
  vec3 user_centre;
  /* Minkowski differences: all b - r k, b of `standing`, k of `carried` */
  const convex *standing, *carried;
  double r[9];               /* row-major */
  struct implicit *implicit; /* superquadrics and implicit bodies: the constraints, about the shape's origin */
};

/* Whether turning the core about its z axis leaves it as it is. */
static inline bool convex_is_round(const convex *shape) {
  const convex_round_core round = shape->ops->round_core;
  return round == CONVEX_ALWAYS_ROUND || (round == CONVEX_ROUND_IF_EQUAL && shape->size[0] == shape->size[1]);
}

/* A point that a search ended at, drawn into the body. Searches themselves go on with the points as they are: what they
 * may be off counts at both ends of their intervals, and drawn points would leave a gap between these. */
static inline vec3 convex_drawn(const convex *shape, vec3 x) {
  return vec_axpy(x, -shape->drawn, x);
}

/* What an upper bound need not have of the slack where nearest() has told a distance. */
static inline double convex_sure(const convex *shape, double distance) {
  return distance > 0.0 ? shape->slack - shape->outside : 0.0;
}

/* The error where a support function answered NaN: a callback, or an implicit body whose solver failed. */
#define CONVEX_NO_SUPPORT \
  "a support callback or an implicit body's solver answered with a point that is not finite or outside its radius"

extern const convex_ops convex_point, convex_sphere, convex_box, convex_capsule, convex_cylinder, convex_cone,
    convex_ellipsoid, convex_halfspace, convex_polytope, convex_polygon, convex_support_callback, convex_difference;

/* Makes a polygon's edges, whose vertices are known; false where memory is out. */
bool convex_polygon_measure_edges(convex *shape);

/* Signed distance inside the plane z = 0 of a polygon to a point of that plane: negative inside. Same accuracy as
 * nearest. */
void convex_polygon_nearest_in_plane(const convex *shape, vec3 y, convex_near *near);

#endif
