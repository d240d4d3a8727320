/* SPDX-License-Identifier: BSD-3-Clause */
/* Claims about robots along motions. NULL, or why they are not proven. */
#ifndef CHECK_ROBOT_CHECK_H
#define CHECK_ROBOT_CHECK_H

#include "bytes.h"
#include "robot.h"

/* A place of the motion: u counts from 0 to 1 over the segment. */
typedef struct motion_place {
  size_t segment;
  double u;
} motion_place;

/* From one place to another, the bodies of every pair are farther apart than delta. *tries counts the directions that
 * were tried. */
const char *robot_apart(robot *r, reader *in, uint32_t width, double delta, const motion_place *from,
                        const motion_place *until, size_t *tries);

/* Somewhere the bodies of one pair are no farther apart than delta. */
const char *robot_near(const robot *r, reader *in, double delta);

#endif
