/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/link_model.h"

#include "base/rounding.h"

static const convex POINT = {.ops = &convex_point};

/* Of a ball about `centre` that contains the body. */
static double reach_from(const cprox_body *body, vec3 centre) {
  return ROUND_UP * (vec_norm(vec_sub(body->ball_centre, centre)) + body->ball_radius);
}

part_model part_model_of(const cprox_body *body) {
  const cprox_body *hull = body->mesh ? body->hull : body, *mesh = body->mesh ? body->mesh : body;
  part_model m = {.shape = &hull->shape, .centre = hull->centre, .margin = hull->shape.margin};
  m.radius = reach_from(hull, hull->centre);
  if (body->mesh) {
    m.margin += body->excess;
    m.radius += body->excess;
  }
  if (!mesh->tree) return m;
  m.tree = mesh->tree, m.clusters = body->clusters, m.winding = mesh->winding;
  m.tree_margin = mesh->shape.margin;
  if (!body->mesh) {
    m.centre = body->ball_centre;
    m.radius = reach_from(body, m.centre);
    m = part_model_ball(&m);
  }
  m.tree_at = vec_sub(mesh->centre, m.centre);
  return m;
}

void part_model_find_box(part_model *model) {
  const convex *shape = model->shape;
  double low[3], high[3];
  for (int i = 0; i < 3; i++) {
    const vec3 axis = vec(i == 0, i == 1, i == 2);
    high[i] = shape->ops->support(shape, axis, NULL, NULL);
    low[i] = -shape->ops->support(shape, vec_neg(axis), NULL, NULL);
  }
  const double grow = ROUND_SUPPORT * ROUND_U * shape->scale + shape->slack;
  model->middle = vec(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2]));
  model->half = vec(0.5 * (high[0] - low[0]) + grow, 0.5 * (high[1] - low[1]) + grow, 0.5 * (high[2] - low[2]) + grow);
}

part_model part_model_ball(const part_model *model) {
  part_model ball = *model;
  ball.shape = &POINT;
  ball.middle = ball.half = vec(0, 0, 0);
  ball.margin = model->radius;
  ball.by_ball = true;
  return ball;
}

bool part_model_is_solid(const cprox_body *body) {
  bool solid = body->winding || (body->mesh && body->mesh->winding);
  for (size_t i = 0; i < body->n_parts; i++) solid = solid || part_model_is_solid(body->parts[i].body);
  return solid;
}
