/* SPDX-License-Identifier: BSD-3-Clause */
/* The least clearance of a robot's motion and its derivatives, by one search. */
#ifndef CPROX_SOLVE_MOTION_GRADIENT_H
#define CPROX_SOLVE_MOTION_GRADIENT_H

#include "curve_proximity/cprox/gradient.h"
#include "problem/problem.h"

/* As cprox_robot_distance_gradient() has it; the query must have begun. */
cprox_status motion_gradient_answer(const query *q, cprox_result *result, cprox_motion_gradient *gradient);

#endif
