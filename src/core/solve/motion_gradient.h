/* SPDX-License-Identifier: BSD-3-Clause */
/* The least clearance of a robot's motion and its derivatives, by one search. */
#ifndef CPROX_SOLVE_MOTION_GRADIENT_H
#define CPROX_SOLVE_MOTION_GRADIENT_H

#include "curve_proximity/cprox/gradient.h"
#include "problem/problem.h"

/* As cprox_robot_distance_gradient() has it, of targets first … last - 1 over [q->t0, q->t1]; the query must have
 * begun.
 */
cprox_status motion_gradient_of(const query *q, size_t first, size_t last, cprox_result *result,
                                cprox_motion_gradient *gradient);

static inline cprox_status motion_gradient_answer(const query *q, cprox_result *result,
                                                  cprox_motion_gradient *gradient) {
  return motion_gradient_of(q, 0, q->n, result, gradient);
}

#endif
