/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/level_of_detail.h"

#include "base/rounding.h"
#include "problem/carried_shape.h"
#include "shape/kinds.h"

static bool has_ball(const cprox_body *body) {
  return !body_kind_of(body->kind)->is_own_sphere && isfinite(body->ball_radius);
}

model lod_model_of(const cprox_body *body, cprox_lod finest) {
  if (finest == CPROX_LOD_SPHERE && has_ball(body)) {
    /* the point that stands for the ball is placed by one more composition of poses */
    const double moved = ROUND_UP * ROUND_U * 2.0 * ROUND_ROTATION * (vec_norm(body->ball_centre) + body->ball_radius);
    return (model){.body = &carried_point,
                   .excess = body->ball_radius + moved,
                   .shift = body->ball_centre,
                   .lod = CPROX_LOD_SPHERE};
  }
  model m = {.body = body};
  if (body->kind == CPROX_BODY_LOD) {
    const bool by_hull = finest == CPROX_LOD_SPHERE || finest == CPROX_LOD_HULL;
    m.body = by_hull ? body->hull : body->mesh;
    m.excess = by_hull ? body->excess : 0.0;
  }
  m.lod = m.body->tree || m.body->field ? CPROX_LOD_MESH : CPROX_LOD_HULL;
  return m;
}

bool lod_has_tree(const cprox_body *body, cprox_lod finest) {
  if (!body) return false;
  for (size_t i = 0; i < body_n_parts(body); i++)
    if (lod_model_of(body_part_at(body, i), finest).body->tree) return true;
  return false;
}

model lod_model_of_part(const cprox_body *body, size_t part, cprox_lod finest, cprox_pose *inner, bool *moved) {
  const bool compound = body->kind == CPROX_BODY_COMPOUND;
  const model m = lod_model_of(body_part_at(body, part), finest);
  const bool shifted = vec_norm2(m.shift) > 0.0;
  *inner = compound ? body->parts[part].pose : CPROX_POSE_IDENTITY;
  *moved = compound || shifted;
  if (shifted) {
    const frame f = frame_create(inner, vec(0, 0, 0));
    inner->position = frame_to_world(&f, m.shift);
  }
  return m;
}
