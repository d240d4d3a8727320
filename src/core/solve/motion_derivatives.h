/* SPDX-License-Identifier: BSD-3-Clause */
/* From what one place of a motion says of a pair to the derivatives by all that the motion was made of. */
#ifndef CPROX_SOLVE_MOTION_DERIVATIVES_H
#define CPROX_SOLVE_MOTION_DERIVATIVES_H

#include "curve_proximity/cprox/gradient.h"
#include "solve/motion_spot.h"

/* Places whose derivatives are added up, each times its part; NULL: 1. */
typedef struct spots {
  const motion_spot *spot;
  const double *part;
  int n;
} spots;

/* All derivatives, at the minimiser `at`. Of a spot the gap's normal counts, of any length, and its two points. */
void motion_derivatives_fill(spot_pair *p, const motion_spot *at, const spots *by, cprox_motion_gradient *to);

/* Without a minimiser: all numbers are 0. */
void motion_derivatives_fill_nothing(const cprox_motion *motion, cprox_motion_gradient *to);

#endif
