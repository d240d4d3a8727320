/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a chain of axes may be off by the bounds of an execution's errors. doc/robust.md derives it. */
#ifndef CPROX_KINEMATICS_ERRORS_H
#define CPROX_KINEMATICS_ERRORS_H

#include "curve_proximity/cprox/robust.h"
#include "kinematics/motion.h"

/* What a query knows of errors. */
typedef struct robot_errors {
  const cprox_error_bounds *bounds;
  double scale;       /* of all of them */
  double loss, left;  /* after the search: what errors take off the distance of its nearest pair, where that was found,
                         and what is left; negative where it is less than what errors take */
  double object_size; /* [m] no obstacle with a box reaches farther from its pose's position */
} robot_errors;

/* How much nearer two sides may be than they are in the middle of a node, by errors; elsewhere in the node by so much
 * more. */
typedef struct deviation {
  double middle, growth;
} deviation;

static inline deviation deviation_sum(deviation a, deviation b) {
  return (deviation){a.middle + b.middle, a.growth + b.growth};
}

/* Of an axis: how far it may be from its value, by the node for which that was found. */
typedef struct axis_deviations {
  uint32_t found;
  deviation of;
} axis_deviations;

/* How far an axis may be from its value, at u of a segment and anywhere in the interval. Balls are never off. */
deviation errors_of_axis(const cprox_motion *motion, const robot_errors *errors, int32_t axis, size_t segment, double u,
                         const motion_interval *over);

/* The same anywhere in the interval: by `still` and by_speed times the axis's own speed, which is |multiplier| times
 * that of its variable; by no more than `most`. */
typedef struct axis_error {
  double still, by_speed, most;
} axis_error;

axis_error errors_of_axis_over(const cprox_motion *motion, const robot_errors *errors, int32_t axis,
                               const motion_interval *over);

/* How far what a ball about a point in the middle of the node contains is off, which the axis `from` carries, by all
 * axes up to, not including, `to` above it. `off` of these axes must be known. *travel: how far it moves over the
 * node. */
deviation errors_along_chain(const cprox_motion *motion, const axis_state *axes, const axis_deviations *off,
                             int32_t from, int32_t to, vec3 centre, double radius, double *travel);

/* The same by the pose of the base, of what moves so far over the node. */
deviation errors_of_base(const robot_errors *errors, vec3 centre, double radius, double travel);

#endif
