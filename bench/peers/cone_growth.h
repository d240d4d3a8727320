/* SPDX-License-Identifier: BSD-3-Clause */
/* The growth distance by a cone program, as Tracy, Howell and Manchester state it (Differentiable collision detection
 * for a set of convex primitives, 2023): the least s for which a point x lies in both bodies scaled by s. Solved by a
 * primal-dual method with Nesterov and Todd's scaling and Mehrotra's corrector; written from the papers. */
#ifndef CPROX_BENCH_CONE_GROWTH_H
#define CPROX_BENCH_CONE_GROWTH_H

#include <stdbool.h>

#include "curve_proximity/cprox/base.h"

typedef struct cone_body {
  enum { CONE_BOX, CONE_ELLIPSOID, CONE_CYLINDER } kind;
  double size[3]; /* half extents; semi-axes; radius and half height */
} cone_body;

typedef struct cone_answer {
  bool solved; /* to 1e-6 */
  double value;
  cprox_vec3 by_b;  /* by b's position; minus that by a's */
  cprox_vec3 touch; /* where the scaled bodies touch */
  int steps;
} cone_answer;

cone_answer cone_growth(const cone_body *a, const cprox_pose *pose_a, const cone_body *b, const cprox_pose *pose_b);

#endif
