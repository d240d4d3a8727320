/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions as they were given, before any conversion: what a certificate is about. */
#ifndef CPROX_KINEMATICS_GIVEN_H
#define CPROX_KINEMATICS_GIVEN_H

#include <stdbool.h>
#include <stdint.h>

#include "curve_proximity/cprox/robot.h"

typedef struct motion_given {
  size_t degree; /* of a B-spline; 0: waypoints */
  cprox_interpolation interpolation;
  cprox_turning turning;
  double start;                /* [s] on the clock of a joined motion */
  size_t n, n_points, n_times; /* variables; waypoints or control points; times or knots */
  int32_t *variables;
  double *times;
  uint8_t *orders; /* waypoints: 1 positions, 2 velocities too, 3 accelerations too */
  double *values;  /* waypoints: [point][order][variable], room for three orders; B-splines: [point][variable] */
} motion_given;

/* Keep a copy; false where memory is out, then nothing is kept. motion_keep_points(): which points there are, with the
 * knots of splines, and not where they are; the variables are those from first_variable on of a joined robot. */
bool motion_keep_waypoints(motion_given *given, const cprox_motion_description *description);
bool motion_keep_spline(motion_given *given, const cprox_motion_description *description);
bool motion_keep_points(motion_given *given, const motion_given *from, int32_t first_variable);

/* All of it, as part of a joined motion that starts it at this time. */
bool motion_keep_joined(motion_given *given, const motion_given *from, int32_t first_variable, double start);

void motion_given_free(motion_given *given);

#endif
