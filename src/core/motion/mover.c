/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_proximity/cprox/robot.h"

cprox_mover cprox_point_along(const cprox_curve *curve) {
  return (cprox_mover){.curve = curve, .radius = 0.0};
}

cprox_mover cprox_tube_along(const cprox_curve *curve, double radius) {
  return (cprox_mover){.curve = curve, .radius = radius};
}

cprox_target cprox_on_clock(cprox_mover other) {
  return (cprox_target){.body = other.body,
                        .pose = cprox_pose_identity(),
                        .padding = other.radius,
                        .curve = other.curve,
                        .on_clock = true};
}

cprox_mover cprox_body_along(const cprox_body *body, const cprox_curve *curve) {
  return (cprox_mover){.curve = curve, .body = body};
}

cprox_mover cprox_robot_along(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs) {
  return (cprox_mover){.motion = motion, .pairs = pairs, .n_pairs = n_pairs};
}

cprox_mover cprox_robot_self(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs) {
  return (cprox_mover){.motion = motion, .pairs = pairs, .n_pairs = n_pairs, .self = true};
}
