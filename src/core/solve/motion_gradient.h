/* SPDX-License-Identifier: BSD-3-Clause */
/* The least clearance of a robot's motion and its derivatives, by one search. */
#ifndef CPROX_SOLVE_MOTION_GRADIENT_H
#define CPROX_SOLVE_MOTION_GRADIENT_H

#include "curve_proximity/cprox/gradient.h"
#include "problem/problem.h"

/* As cprox_robot_distance_gradient() has it, of obstacles first … last - 1 over [q->t0, q->t1]; the query must have
 * begun.
 */
cprox_status motion_gradient_of(const query *q, size_t first, size_t last, cprox_result *result,
                                cprox_motion_gradient *gradient);

/* Of slerp and of screws there are no rows by points: CPROX_INVALID, with an error message, where they are wanted. */
cprox_status motion_gradient_check(const query *q, const cprox_motion_gradient *gradient);

#endif
