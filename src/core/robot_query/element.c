/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/element.h"

#include <math.h>

#include "base/rounding.h"

double robot_core_radius(const robot_body *body) {
  const double least = body->tree ? lesser(body->side.margin, body->tree_margin) : body->side.margin;
  const double margin = body->side.margin_turns ? 0.0 : least;
  return greater(body->radius - margin, 0.0) + ROUND_UP * 2.0 * ROUND_U * body->radius + body->side.error;
}

static vec3 middle_of(const vec3 v[3], int n) {
  if (n == 1) return v[0];
  if (n == 2) return vec_axpy(vec_scale(0.5, v[0]), 0.5, v[1]);
  return vec_scale(1.0 / 3.0, vec_add(vec_add(v[0], v[1]), v[2]));
}

/* The smallest box round the corners; of a box itself, whose middle may be off by half a rounding, one that contains
 * both. */
static void find_box(robot_element *e, int n) {
  double low[3] = {e->x[0], e->y[0], e->z[0]}, high[3] = {e->x[0], e->y[0], e->z[0]};
  for (int i = 1; i < n; i++) {
    const double at[3] = {e->x[i], e->y[i], e->z[i]};
    for (int k = 0; k < 3; k++) low[k] = lesser(low[k], at[k]), high[k] = greater(high[k], at[k]);
  }
  robot_body *body = &e->body;
  const double grow = ROUND_U * e->shape.scale;
  body->side.middle = vec(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2]));
  body->side.half =
      vec(0.5 * (high[0] - low[0]) + grow, 0.5 * (high[1] - low[1]) + grow, 0.5 * (high[2] - low[2]) + grow);
  if (n != 2) return;
  body->side.middle = vec(0, 0, 0);
  for (int k = 0; k < 3; k++) e->shape.size[k] = greater(fabs(low[k]), fabs(high[k]));
  body->side.half = vec(e->shape.size[0] + grow, e->shape.size[1] + grow, e->shape.size[2] + grow);
}

/* Lengths that enter the place of what is at `at` from the owner's shape and reaches so far round there. */
static double placing_error(const robot_body *owner, double reach, vec3 world) {
  const double sizes = vec_norm(owner->tree_at) + 2.0 * owner->tree->scale + reach;
  return ROUND_UP * ROUND_U * (ROUND_ROTATION * sizes + 3.0 * vec_norm(world));
}

static void make_cluster(const robot_body *owner, int32_t code, robot_element *e) {
  const cluster_hull *hull = robot_cluster_of(owner, code);
  e->body = *owner;
  robot_body *body = &e->body;
  body->side.shape = &hull->shape;
  body->side.margin = owner->tree_margin;
  body->side.at.p = placement_apply(&owner->side.at, vec_add(owner->tree_at, hull->centre));
  body->side.error += placing_error(owner, hull->radius, body->side.at.p);
  body->radius = hull->radius + owner->tree_margin;
  const double grow = ROUND_U * hull->radius;
  body->side.middle = vec(0, 0, 0);
  body->side.half = vec_add(hull->half, vec(grow, grow, grow));
}

static void make_element(const robot_body *owner, int32_t code, robot_element *e) {
  const tree *t = owner->tree;
  vec3 v[3];
  const int n = tree_corners(t, robot_element_place(code), v);
  const vec3 middle = middle_of(v, n);
  double reach = 0.0;
  for (int i = 0; i < 8; i++) {
    const vec3 corner = vec_sub(v[i < n ? i : n - 1], middle);
    e->x[i] = corner.x, e->y[i] = corner.y, e->z[i] = corner.z;
    reach = greater(reach, vec_norm(corner));
  }
  reach *= 1.0 + ROUND_LENGTH * ROUND_U;
  e->shape = (convex){.ops = n == 3 ? &convex_polytope : n == 2 ? &convex_box : &convex_point, .scale = reach};
  if (n == 3) e->shape.n = 3, e->shape.padded = 8, e->shape.x = e->x, e->shape.y = e->y, e->shape.z = e->z;

  /* where it stands: sums of lengths that the owner's tree reaches, turned once */
  e->body = *owner;
  robot_body *body = &e->body;
  const vec3 at = vec_add(owner->tree_at, middle);
  body->tree = NULL, body->clusters = NULL, body->winding = NULL;
  body->side.shape = &e->shape;
  body->side.margin = owner->tree_margin;
  body->side.at.p = placement_apply(&owner->side.at, at);
  body->side.error += placing_error(owner, reach, body->side.at.p);
  body->radius = reach + owner->tree_margin;
  find_box(e, n);
}

const robot_body *robot_element_make(const robot_body *owner, int32_t code, robot_element *e) {
  e->node = 0;
  if (code < ROBOT_WHOLE)
    make_cluster(owner, code, e);
  else
    make_element(owner, code, e);
  e->body.core = robot_core_radius(&e->body);
  return &e->body;
}
