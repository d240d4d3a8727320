/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of a robot's variables, read from text: Hermite polynomials between waypoints, or B-splines, as Bézier
 * polynomials. */
#ifndef CHECK_TRAJECTORY_H
#define CHECK_TRAJECTORY_H

#include "robot.h"
#include "words.h"

/* False, with a message in the problem's fault. */
bool trajectory_read(problem *p, words *w, robot *r);

/* The right half of a polynomial takes its place, the left half goes to `left`, where it ends in the middle. */
void trajectory_halve(num *points, size_t degree, num *left);

#endif
