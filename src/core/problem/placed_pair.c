/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/placed_pair.h"

#include "base/rounding.h"
#include "problem/carried_shape.h"
#include "problem/level_of_detail.h"
#include "problem/radius.h"
#include "shape/body.h"

/* Most bodies are their own model. */
static inline placed_model model_at(const cprox_body *body, int32_t part, cprox_lod finest) {
  placed_model m = {.body = body, .lod = body && (body->tree || body->field) ? CPROX_LOD_MESH : CPROX_LOD_HULL};
  if (!body || lod_is_body(body, finest)) return m;
  const model is = lod_model_of_part(body, (size_t)part, finest, &m.inner, &m.moved);
  m.body = is.body, m.excess = is.excess, m.lod = is.lod;
  return m;
}

/* The pose of the obstacle, with its curve at the origin where it is on the mover's clock. */
static cprox_pose obstacle_pose(const cprox_obstacle *obstacle) {
  cprox_pose pose = obstacle->pose;
  if (obstacle->synchronized) pose.position = vec(0, 0, 0);
  return pose;
}

placed_model placed_model_of_obstacle(const query *q, const candidate *c) {
  const cprox_obstacle *obstacle = &q->obstacles[c->obstacle];
  const cprox_body *body = obstacle->synchronized && !obstacle->body ? &carried_point : obstacle->body;
  const cprox_pose pose = obstacle_pose(obstacle);
  placed_model m = model_at(body, c->part, c->lod != CPROX_LOD_NONE ? c->lod : q->options.max_lod);
  m.pose = m.moved ? frame_compose(&pose, &m.inner) : pose;
  return m;
}

placed_models placed_models_resolve(const query *q, const candidate *c) {
  placed_models both = {.obstacle = placed_model_of_obstacle(q, c)};
  both.carried = model_at(q->mover.body, c->mover_part, both.obstacle.lod);
  both.carried.pose = both.carried.moved ? both.carried.inner : CPROX_POSE_IDENTITY;
  return both;
}

/* ---- the ball ---- */

/* Round a whole curve, in its frame. */
static candidate_ball ball_of_curve(const cprox_curve *curve) {
  const curve_capsule whole = curve_whole(curve), *capsule = &whole;
  const double length = vec_norm(vec_sub(capsule->b, capsule->a));
  return (candidate_ball){.centre = vec_lerp(capsule->a, capsule->b, 0.5), .radius = 0.5 * length + capsule->radius};
}

candidate_ball placed_model_ball(const cprox_obstacle *obstacle, int32_t part, const placed_model *m, double *sizes) {
  const candidate_ball run = obstacle->curve ? ball_of_curve(obstacle->curve) : (candidate_ball){0};
  candidate_ball round = {0};
  *sizes = 0.0;
  if (m->body) {
    const frame f = frame_create(&m->pose, vec(0, 0, 0));
    round.centre = frame_to_world(&f, m->body->ball_centre);
    round.radius = m->body->ball_radius;
    *sizes += placed_size(m->body->ball_centre) + placed_size(m->pose.position);
    /* a compound's part: what the two positions lose may be more than their sum, which is small where they cancel */
    if (obstacle->body && obstacle->body->kind == CPROX_BODY_COMPOUND)
      *sizes += placed_size(obstacle->body->parts[part].pose.position);
  }
  if (obstacle->curve) {
    const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
    round.centre = vec_add(round.centre, frame_to_world(&f, run.centre));
    round.radius += run.radius;
    *sizes += placed_size(run.centre) + placed_size(f.position) + round.radius;
  }
  return round;
}

/* ---- the pair ---- */

/* What composing the poses costs: a turn of both shapes, and the sum of the positions. */
static double position_error_of(const placed_model *m, const cprox_body *carried) {
  if (!m->moved || !m->body) return 0.0;
  const double own = carried ? carried->shape.scale : 0.0;
  const double turned = vec_norm(m->inner.position) + vec_norm(m->body->centre) + m->body->shape.scale + own;
  return ROUND_UP * ROUND_U * (2.0 * ROUND_ROTATION * turned + 3.0 * vec_norm(m->pose.position));
}

placed_pair placed_pair_resolve(const query *q, const candidate *c) {
  const placed_models both = placed_models_resolve(q, c);
  const placed_model *m = &both.obstacle;
  placed_pair p = {.which = *c,
                   .obstacle = &q->obstacles[c->obstacle],
                   .lod = m->lod,
                   .shape = m->body,
                   .pose = m->pose,
                   .carried = both.carried.body,
                   .carried_pose = both.carried.pose};
  p.margin = p.obstacle->margin + m->excess;
  p.offset = q->mover.radius + both.carried.excess + p.margin;
  p.radius_changes = radius_changes(&q->mover, p.obstacle);
  p.position_error = position_error_of(m, p.carried);
  if (!p.shape) return p;
  const cprox_pose outer = obstacle_pose(p.obstacle);
  p.frame = !m->moved ? frame_create(&outer, p.shape->centre) : frame_create_within(&outer, &m->inner, p.shape->centre);
  return p;
}
