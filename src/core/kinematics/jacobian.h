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

/* Whether the variable follows its waypoints by slerp or by screws: then it is no sum of them. */
bool motion_is_on_arc(const cprox_motion *motion, int32_t variable);

/* What every variable is made of at one time: the sum of these multiples of what was given at points first …
 * first + n - 1, waypoints or control points. */
typedef struct motion_weights {
  size_t first, n;
  double position[MOTION_MAX_DEGREE + 1];
  double velocity[2], acceleration[2]; /* of waypoints */
} motion_weights;

/* Those at u of a segment of the track; n is 0 where nothing was given. */
motion_weights motion_weights_at(const motion_given *given, const motion_track *track, size_t own, double u);

/* How fast a variable of the track, its k-th that moves, grows with the logarithm of the duration: at the same fraction
 * of the way, the points' own values being kept. */
double motion_stretch_rate(const motion_given *given, const motion_track *track, size_t k, size_t own, double u);

#endif
