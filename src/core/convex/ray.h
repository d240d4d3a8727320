/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a ray from inside the Minkowski difference leaves it: the growth distance, its multipliers and its derivatives
 * (doc/implicit.md, Growth distance). */
#ifndef CPROX_CONVEX_RAY_H
#define CPROX_CONVEX_RAY_H

#include "convex/pair.h"

typedef struct ray_answer {
  bool found;          /* both bounds are finite and what follows is set; false also where a callback misbehaved */
  bool solved;         /* the conditions of the optimum hold but for rounding; else the bounds alone are known */
  double lower, upper; /* of the least g >= 0 for which a grown by g and b grown by g meet, rounding included */
  vec3 slope;          /* a's frame: the derivative of g by the place of b's origin: an outward normal of a */
  vec3 on_a;           /* a's frame: the point of a that, scaled by g, is where both touch */
  bool bends;          /* hessian is known */
  double hessian[6];   /* the derivative of slope by that place (xx, xy, xz, yy, yz, zz) */
  bool slope_alone;    /* no other normal is as good: tilted by RAY_TILT the bound falls */
  bool point_alone;    /* no other point is: not both are flat, within RAY_FLAT of their sizes, along a direction */
  uint32_t supports;
} ray_answer;

/* How far directions are tilted to tell whether the optimum is one alone [rad], */
#define RAY_TILT 1e-5

/* how far, in sizes, extreme points move then where a body counts as flat. */
#define RAY_FLAT 1e-3

/* a and b grown by their margins, each scaled about the origin of its own frame, which a ball of the radius inner_a or
 * inner_b, > 0, about it proves to be inside. The origins differ. Without wants_derivatives the bounds and the slope
 * alone are wanted. */
void ray_leave(const convex *a, double margin_a, double inner_a, const convex *b, double margin_b, double inner_b,
               const pair_placement *place, bool wants_derivatives, ray_answer *answer);

#endif
