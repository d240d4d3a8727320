/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/minkowski.h"

#include "base/rotation.h"
#include "base/rounding.h"
#include "convex/depth.h"
#include "convex/feature.h"
#include "convex/pair.h"

enum { MOST_STEPS = 256 };

/* A nearest point is wanted as exactly as the arithmetic allows: what it costs beyond 1e-6 is a Newton step or two. */
static const double RELATIVE_WIDTH = 1e-13;

/* ---- support ---- */

static double difference_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  vec3 b, k;
  const double standing = shape->standing->ops->support(shape->standing, d, NULL, &b);
  const double carried = shape->carried->ops->support(shape->carried, vec_neg(rotate_back(shape->r, d)), NULL, &k);
  if (at) *at = vec_sub(b, rotate(shape->r, k));
  return standing + carried;
}

/* ---- nearest points ---- */

static bool has_closed_form(const convex *shape) {
  return shape->ops->kind != CPROX_BODY_POLYTOPE && shape->ops->kind != CPROX_BODY_SUPPORT;
}

/* r H r^T */
static void turn_hessian(const double *r, const double h[6], double turned[6]) {
  const vec3 row[3] = {vec(h[0], h[1], h[2]), vec(h[1], h[3], h[4]), vec(h[2], h[4], h[5])};
  vec3 half[3]; /* the columns of r H */
  for (int j = 0; j < 3; j++) half[j] = rotate(r, row[j]);
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++) {
      const double hx[3] = {half[0].x, half[0].y, half[0].z}, hy[3] = {half[1].x, half[1].y, half[1].z},
                   hz[3] = {half[2].x, half[2].y, half[2].z};
      turned[k++] = hx[i] * r[3 * j] + hy[i] * r[3 * j + 1] + hz[i] * r[3 * j + 2];
    }
}

/* A ball that stands sees the carried shape from where the curve would be if that stood and the ball moved. */
static void nearest_of_ball(const convex *shape, vec3 y, convex_near *near) {
  const double *r = shape->r, radius = shape->standing->margin;
  convex_near seen;
  shape->carried->ops->nearest(shape->carried, vec_neg(rotate_back(r, y)), NULL, &seen);
  *near = seen;
  near->distance = seen.distance - radius;
  near->normal = vec_neg(rotate(r, seen.normal));
  near->point = vec_axpy(y, -near->distance, near->normal);
  near->origin = vec_neg(rotate(r, seen.origin));
  near->offset = seen.offset + radius;
  for (int i = 0; i < 2; i++) near->e[i] = rotate(r, seen.e[i]);
  if (!seen.flat) turn_hessian(r, seen.hessian, near->hessian);
}

/* Whether x is a point of both but for rounding: of the carried one put at y, too. */
static bool both_hold(const convex *shape, vec3 y, vec3 x) {
  const convex *body[2] = {shape->standing, shape->carried};
  const vec3 at[2] = {x, rotate_back(shape->r, vec_sub(x, y))};
  for (int k = 0; k < 2; k++) {
    convex_hint hint = {0};
    convex_near near;
    body[k]->ops->nearest(body[k], at[k], &hint, &near);
    if (!(near.distance <= 64.0 * ROUND_U * (vec_norm(x) + vec_norm(y) + body[k]->scale))) return false;
  }
  return true;
}

static void difference_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  const convex *standing = shape->standing, *carried = shape->carried;
  const bool ball = standing->ops->kind == CPROX_BODY_POINT || standing->ops->kind == CPROX_BODY_SPHERE;
  if (ball && has_closed_form(carried)) {
    nearest_of_ball(shape, y, near);
    return;
  }
  pair_placement place = {.t = y};
  for (int i = 0; i < 9; i++) place.r[i] = shape->r[i];
  const bool rough = hint && hint->fraction > 0.0;
  pair_goal goal = {.relative_epsilon = RELATIVE_WIDTH, .max_steps = MOST_STEPS, .wants_feature = !rough};
  if (rough) goal.fraction = hint->fraction, goal.floor = hint->floor;
  if (hint) goal.start = vec_neg(hint->towards);
  pair_answer answer;
  pair_separate(standing, standing->margin, carried, carried->margin, &place, &goal, &answer);
  *near = (convex_near){0};
  if (answer.support_failed) {
    near->distance = NAN;
    return;
  }
  near->normal = vec_neg(answer.normal);
  near->distance = answer.overlap ? -(answer.depth + shape->margin) : answer.upper - answer.above;
  near->point = vec_axpy(y, -near->distance, near->normal);
  near->parts_known = answer.upper > 0.0 || both_hold(shape, y, answer.common);
  near->on_standing = answer.upper > 0.0 ? answer.on_a : answer.common;
  near->on_carried = answer.upper > 0.0 ? answer.on_b : answer.common;
  if (!answer.overlap && !rough) depth_describe(&answer.feature, shape->margin, y, near);
}

/* near_rounding: that of pair_separate, 32, and the steps to and from it; no closed form of a carried shape needs more.
 */
const convex_ops convex_difference = {.kind = CPROX_BODY_SUPPORT,
                                      .near_rounding = 72.0,
                                      .proves_depth = true,
                                      .nearest = difference_nearest,
                                      .support = difference_support};

/* ---- making ---- */

/* A halfspace reaches as much farther as the carried shape reaches into it. */
static bool make_halfspace(const convex *standing, const convex *carried, const double r[9], double turning,
                           convex *difference) {
  const vec3 n = vec(standing->size[0], standing->size[1], standing->size[2]);
  const double reach = carried->ops->support(carried, vec_neg(rotate_back(r, n)), NULL, NULL) + carried->margin;
  *difference = *standing;
  difference->size[3] -= reach;
  difference->scale = fabs(difference->size[3]);
  difference->slack = ROUND_UP * (turning * carried->scale + carried->slack +
                                  ROUND_U * (12.0 * carried->scale + fabs(standing->size[3]) + difference->scale));
  difference->outside = difference->slack;
  return isfinite(reach);
}

/* Boxes with the same axes make a box. */
static void make_box(const convex *standing, const convex *carried, convex *difference) {
  *difference = *standing;
  for (int i = 0; i < 3; i++) difference->size[i] = standing->size[i] + carried->size[i];
  difference->scale = (standing->scale + carried->scale) * (1.0 + 4.0 * ROUND_U);
  difference->slack = difference->outside = ROUND_UP * ROUND_U * difference->scale;
}

bool minkowski_make(const convex *standing, const convex *carried, const double r[9], bool turned, convex *difference) {
  /* r, computed from two poses, and its product with a point or a direction; doc/rounding.md, T3 */
  const double turning = turned ? 2.0 * ROUND_ROTATION * ROUND_U : 0.0;
  if (standing->ops->kind == CPROX_BODY_HALFSPACE) return make_halfspace(standing, carried, r, turning, difference);
  if (standing->ops->kind == CPROX_BODY_BOX && carried->ops->kind == CPROX_BODY_BOX && !turned) {
    make_box(standing, carried, difference);
    return true;
  }
  const double rounding = turning * carried->scale + 4.0 * ROUND_U * (standing->scale + carried->scale);
  *difference = (convex){.ops = &convex_difference,
                         .margin = standing->margin + carried->margin,
                         .scale = ROUND_UP * (standing->scale + carried->scale),
                         .slack = ROUND_UP * (2.0 * (standing->slack + carried->slack) + rounding),
                         .outside = ROUND_UP * (2.0 * (standing->outside + carried->outside) + rounding),
                         .standing = standing,
                         .carried = carried};
  for (int i = 0; i < 9; i++) difference->r[i] = r[i];
  return true;
}
