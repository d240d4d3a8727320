/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast a variable of a motion changes by time: for errors that grow with the speed. */
#ifndef CPROX_KINEMATICS_MOTION_RATES_H
#define CPROX_KINEMATICS_MOTION_RATES_H

#include "kinematics/motion.h"

/* |q'| and |q''| of a variable that moves, at u of a segment. The motion has one track. */
void motion_rates_at(const cprox_motion *motion, int32_t variable, size_t segment, double u, double rates[2]);

/* Upper bounds of both over an interval, rounding included. */
void motion_rates_over(const cprox_motion *motion, int32_t variable, const motion_interval *over, double rates[2]);

#endif
