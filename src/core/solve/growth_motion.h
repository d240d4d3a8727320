/* SPDX-License-Identifier: BSD-3-Clause */
/* The least growth distance of a robot along its motion. */
#ifndef CPROX_SOLVE_GROWTH_MOTION_H
#define CPROX_SOLVE_GROWTH_MOTION_H

#include "curve_proximity/cprox/gradient.h"
#include "problem/problem.h"

/* As cprox_robot_growth() has it; the query must have begun, signed, without a set. */
cprox_status growth_motion_answer(const query *q, cprox_motion_growth *found, cprox_motion_gradient *gradient);

#endif
