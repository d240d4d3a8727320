/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/pair_place.h"

#include "base/rounding.h"

pair_side pair_place_side(const cprox_target *target, size_t part) {
  const cprox_body *body = target->body;
  pair_side side = {.margin = target->padding};
  cprox_pose pose = target->pose;
  if (body->kind == CPROX_COMPOUND) {
    const body_part *p = &body->parts[part];
    pose = frame_compose(&target->pose, &p->pose);
    body = p->body;
    side.error = ROUND_U * (ROUND_ROTATION * (vec_norm(p->pose.position) + vec_norm(body->centre) + body->shape.scale) +
                            3.0 * vec_norm(pose.position));
  }
  side.body = body;
  side.shape = &body->shape;
  side.f = frame_create(&pose, body->centre);
  side.margin += body->shape.margin;
  return side;
}

pair_placement pair_place(const pair_side *a, const pair_side *b) {
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
