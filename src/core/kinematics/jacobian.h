/* SPDX-License-Identifier: BSD-3-Clause */
/* How points of a robot follow its variables, and how its variables follow what a motion was made of. */
#ifndef CPROX_KINEMATICS_JACOBIAN_H
#define CPROX_KINEMATICS_JACOBIAN_H

#include "kinematics/motion.h"

/* Adds to by_variable[v] how fast n·x grows with variable v, x a point that the axis carries: by the joints from that
 * axis up to `above`, which does not count (-1: all). frames: of robot_place_axes() for these values. */
void motion_add_gradient(const cprox_robot *robot, const double *values, const placement *frames, int32_t axis,
                         int32_t above, vec3 n, vec3 x, double *by_variable);

/* The derivatives of all variables by time at u of a segment; 0 for those at rest. */
void motion_rates(const cprox_motion *motion, size_t segment, double u, double *rates);

#endif
