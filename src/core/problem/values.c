/* SPDX-License-Identifier: BSD-3-Clause */
/* Movers, obstacles and options as values, and the names of enumerators. */
#include "curve_proximity/cprox/robot.h"

cprox_obstacle cprox_obstacle_at(const cprox_body *body, cprox_pose pose) {
  return (cprox_obstacle){.body = body, .pose = pose, .margin = 0.0};
}

cprox_obstacle cprox_with_margin(cprox_obstacle obstacle, double margin) {
  obstacle.margin = margin;
  return obstacle;
}

cprox_obstacle cprox_obstacle_curve(const cprox_curve *curve, double radius) {
  return (cprox_obstacle){.curve = curve, .pose = CPROX_POSE_IDENTITY, .margin = radius};
}

const char *cprox_verdict_name(cprox_verdict verdict) {
  switch (verdict) {
    case CPROX_VERDICT_CLEAR: return "clear";
    case CPROX_VERDICT_VIOLATED: return "violated";
    case CPROX_VERDICT_UNDECIDED: return "undecided";
  }
  return "unknown";
}

const char *cprox_lod_name(cprox_lod lod) {
  switch (lod) {
    case CPROX_LOD_NONE: return "none";
    case CPROX_LOD_SPHERE: return "sphere";
    case CPROX_LOD_HULL: return "hull";
    case CPROX_LOD_MESH: return "mesh";
  }
  return "unknown";
}

cprox_mover cprox_point_along(const cprox_curve *curve) {
  return (cprox_mover){.kind = CPROX_MOVER_BALL, .curve = curve, .radius = 0.0};
}

cprox_mover cprox_tube_along(const cprox_curve *curve, double radius) {
  return (cprox_mover){.kind = CPROX_MOVER_BALL, .curve = curve, .radius = radius};
}

cprox_obstacle cprox_synchronized(cprox_mover other) {
  return (cprox_obstacle){.body = other.body,
                          .pose = CPROX_POSE_IDENTITY,
                          .margin = other.radius,
                          .curve = other.curve,
                          .synchronized = true,
                          .radius_curve = other.radius_curve};
}

cprox_mover cprox_body_along(const cprox_body *body, const cprox_curve *curve) {
  return (cprox_mover){.kind = CPROX_MOVER_BODY, .curve = curve, .body = body};
}

cprox_mover cprox_robot_along(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs) {
  return (cprox_mover){.kind = CPROX_MOVER_ROBOT, .motion = motion, .pairs = pairs, .n_pairs = n_pairs};
}

cprox_mover cprox_robot_self(const cprox_motion *motion, const cprox_robot_pair *pairs, size_t n_pairs) {
  return (cprox_mover){.kind = CPROX_MOVER_ROBOT_SELF, .motion = motion, .pairs = pairs, .n_pairs = n_pairs};
}

cprox_mover cprox_robot_whole(cprox_mover along, const cprox_robot_pair *self_pairs, size_t n_self_pairs) {
  along.kind = CPROX_MOVER_ROBOT_WHOLE;
  along.self_pairs = self_pairs;
  along.n_self_pairs = n_self_pairs;
  return along;
}
