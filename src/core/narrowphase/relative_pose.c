/* SPDX-License-Identifier: BSD-3-Clause */
#include "narrowphase/relative_pose.h"

#include "base/rounding.h"

pair_side relative_pose_of_model(const cprox_obstacle *obstacle, size_t part, cprox_lod finest) {
  cprox_pose inner, pose = obstacle->pose;
  bool moved;
  const model m = lod_model_of_part(obstacle->body, part, finest, &inner, &moved);
  pair_side side = {.body = m.body, .shape = &m.body->shape, .lod = m.lod};
  if (moved) {
    pose = frame_compose(&obstacle->pose, &inner);
    const double turned = vec_norm(inner.position) + vec_norm(m.body->centre) + m.body->shape.scale;
    side.error = ROUND_U * (ROUND_ROTATION * turned + 3.0 * vec_norm(pose.position));
  }
  side.f = frame_create(&pose, m.body->centre);
  side.margin = obstacle->margin + m.excess + m.body->shape.margin;
  return side;
}

pair_side relative_pose_of_side(const cprox_obstacle *obstacle, size_t part) {
  return relative_pose_of_model(obstacle, part, CPROX_LOD_MESH);
}

pair_placement relative_pose_make(const pair_side *a, const pair_side *b) {
  pair_placement place = {.error = a->error + b->error};
  for (int i = 0; i < 3; i++) {
    const vec3 column = frame_turn_to_local(&a->f, vec(b->f.r[i], b->f.r[3 + i], b->f.r[6 + i]));
    place.r[i] = column.x;
    place.r[3 + i] = column.y;
    place.r[6 + i] = column.z;
  }
  const vec3 apart = vec_sub(b->f.position, a->f.position), centre = frame_turn_to_world(&b->f, b->f.centre);
  const vec3 world = vec_add(apart, centre), local = frame_turn_to_local(&a->f, world);
  place.t = vec_sub(local, a->f.centre);

  const bool turned = a->f.rotated || b->f.rotated;
  place.error += ROUND_UP * ROUND_U *
                 (vec_norm(apart) + vec_norm(world) + vec_norm(place.t) +
                  (turned ? ROUND_ROTATION * (vec_norm(centre) + vec_norm(local) + 2.0 * b->shape->scale) : 0.0));
  return place;
}
