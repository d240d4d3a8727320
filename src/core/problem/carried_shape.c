/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/carried_shape.h"

#include "base/rounding.h"
#include "convex/minkowski.h"

const cprox_body carried_point = {.kind = CPROX_BODY_POINT, .shape = {.ops = &convex_point, .scale = 1e-100}};

static bool is_ball(const cprox_body *body) {
  return body->kind == CPROX_BODY_POINT || body->kind == CPROX_BODY_SPHERE;
}

bool carried_shape_join(const cprox_body *standing, const cprox_pose *pose, const cprox_body *carried,
                        const cprox_pose *carried_pose, carried_shape *joined) {
  /* the carried shape's own origin, seen from the curve's point along the standing body's axes */
  const frame own = frame_create(carried_pose, carried->centre);
  frame placed = frame_create(pose, standing->centre);
  const vec3 ahead = frame_to_world(&own, vec(0, 0, 0)), shift = frame_turn_to_local(&placed, ahead);
  placed.centre = vec_sub(placed.centre, shift);
  const bool turned = placed.rotated || own.rotated;
  const double moved = (turned ? ROUND_ROTATION * (vec_norm(carried->centre) + vec_norm(shift)) : 0.0) +
                       (vec_norm2(shift) > 0.0 ? vec_norm(ahead) + vec_norm(placed.centre) : 0.0);

  joined->placed = placed;
  joined->offset = 0.0;
  if (is_ball(carried)) {
    joined->shape = standing->shape;
    joined->offset = carried->shape.margin;
  } else {
    double r[9];
    for (int i = 0; i < 3; i++) {
      const vec3 column = frame_turn_to_local(&placed, vec(own.r[i], own.r[3 + i], own.r[6 + i]));
      r[i] = column.x, r[3 + i] = column.y, r[6 + i] = column.z;
    }
    if (!minkowski_make(&standing->shape, &carried->shape, r, turned, &joined->shape)) return false;
  }
  joined->shape.slack += ROUND_UP * ROUND_U * moved, joined->shape.outside += ROUND_UP * ROUND_U * moved;
  return true;
}
