/* SPDX-License-Identifier: BSD-3-Clause */
/* How the bodies of a robot move over an interval of a segment of its motion. doc/robot-motion-bounds.md proves what is
 * computed here; u in [0, 1] is the interval's own parameter, and all derivatives are by it. */
#ifndef CHECK_KINEMATICS_H
#define CHECK_KINEMATICS_H

#include "robot.h"

/* An axis: where it is and how it moves in the middle, in world axes, and bounds over the interval. */
typedef struct axis_state {
  place frame; /* moved */
  vec z;       /* not of a quaternion's */
  vec velocity, acceleration;
  double w, a, g; /* the first, second and third derivative of the angle or the shift are at most */
  double shift;   /* it is never farther than this from where it is in the middle */
} axis_state;

/* points: of an interval of the segment, laid out as those of a segment. Radii are infinite where nothing can be said.
 */
void kinematics_axes(const robot *r, size_t segment, const num *points, axis_state *states);

/* The world place of a body in the middle. */
place kinematics_place(const body *b, const axis_state *states);

/* The places of all bodies at u of a segment. points: room for those of a segment, states: for all axes. */
void kinematics_hold(const robot *r, size_t segment, double u, num *points, axis_state *states, place *places);

/* A body's motion as seen from another one. */
typedef struct body_motion {
  vec v, omega, a, alpha; /* of its centre, in the middle */
  double travel, second,
      third; /* of any of its points: how far from where it is in the middle; derivatives are at most */
} body_motion;

/* chain, levers: room for all axes, used here. at: the place of `moving` in the middle. */
void kinematics_motion(const robot *r, const axis_state *states, const body *moving, const place *at, double radius,
                       const body *standing, int *chain, double *levers, body_motion *m);

#endif
