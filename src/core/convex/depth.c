/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/depth.h"

#include "base/rounding.h"
#include "convex/feature.h"

enum { MOST_STEPS = 400 };

void depth_describe(const pair_feature *feature, double margin, vec3 y, convex_near *near) {
  near->flat = feature->flat;
  for (int i = 0; i < 6; i++) near->hessian[i] = feature->hessian[i];
  if (!feature->flat) return;
  const vec3 vertex = vec_add(feature->w[0], y);
  vec3 e, f;
  if (feature->n == 1) feature_vertex(near, vertex, margin);
  if (feature->n == 2) {
    feature_unit(vec_sub(feature->w[1], feature->w[0]), &e);
    feature_edge(near, vertex, e, margin);
  }
  if (feature->n == 3) {
    feature_tangents(near->normal, &e, &f);
    feature_face(near, e, f);
  }
}

/* The shape and the point as a pair. */
static void separate_point(const convex *shape, vec3 y, const pair_goal *goal, pair_answer *answer) {
  const convex point = {.ops = &convex_point, .scale = 1e-100};
  const bool joined = shape->standing != NULL;
  const convex *a = joined ? shape->standing : shape, *b = joined ? shape->carried : &point;
  pair_placement place = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .t = y};
  for (int i = 0; i < 9 && joined; i++) place.r[i] = shape->r[i];
  pair_separate(a, a->margin, b, b->margin, &place, goal, answer);
}

void depth_of_point(const convex *shape, vec3 y, double width, convex_near *near) {
  const pair_goal goal = {.epsilon = width, .max_steps = MOST_STEPS, .wants_feature = true, .wants_depth = true};
  pair_answer answer;
  separate_point(shape, y, &goal, &answer);
  *near = (convex_near){.distance = answer.support_failed ? NAN : answer.upper, .normal = vec_neg(answer.normal)};
  near->point = vec_axpy(y, -near->distance, near->normal);
  if (answer.measured || !answer.overlap) depth_describe(&answer.feature, shape->margin, y, near);
}

double depth_proven(const convex *shape, vec3 y) {
  const pair_goal goal = {.max_steps = MOST_STEPS};
  pair_answer answer;
  separate_point(shape, y, &goal, &answer);
  return answer.overlap && !answer.support_failed ? greater(answer.depth - answer.rounding, 0.0) : 0.0;
}

void depth_complete(const convex *shape, vec3 y, convex_near *near) {
  const double rounding = shape->ops->near_rounding * ROUND_U * (vec_norm(y) + shape->scale);
  if (!shape->ops->proves_depth || !(near->distance <= rounding)) return;
  const int32_t vertices = shape->n + MOST_STEPS;
  const pair_goal goal = {.max_steps = (uint32_t)vertices, .wants_depth = true, .plain = true, .room = vertices};
  pair_answer answer;
  separate_point(shape, y, &goal, &answer);
  if (answer.support_failed) return;
  double distance = fmin(0.5 * (answer.upper + answer.lower), 0.0);
  if (!answer.measured) { /* beside a sharp vertex: between what near() has proven and the best plane, where the two are
                             close */
    const double most = -(answer.lower + answer.rounding), least = -near->distance;
    if (!(least > 0.0 && most <= 8.0 * least) || vec_norm2(answer.normal) == 0.0) return;
    distance = -0.5 * (least + most);
  }
  near->distance = distance;
  near->normal = vec_neg(answer.normal);
  near->point = vec_axpy(y, -near->distance, near->normal);
}
