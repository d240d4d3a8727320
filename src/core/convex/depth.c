/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/depth.h"

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

void depth_of_point(const convex *shape, vec3 y, double width, convex_near *near) {
  const convex point = {.ops = &convex_point, .scale = 1e-100};
  const bool joined = shape->standing != NULL;
  const convex *a = joined ? shape->standing : shape, *b = joined ? shape->carried : &point;
  pair_placement place = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .t = y};
  for (int i = 0; i < 9 && joined; i++) place.r[i] = shape->r[i];
  const pair_goal goal = {.epsilon = width, .max_steps = MOST_STEPS, .wants_feature = true, .wants_depth = true};
  pair_answer answer;
  pair_separate(a, a->margin, b, b->margin, &place, &goal, &answer);
  *near = (convex_near){.distance = answer.fault ? NAN : answer.upper, .normal = vec_neg(answer.normal)};
  near->point = vec_axpy(y, -near->distance, near->normal);
  if (answer.measured || !answer.overlap) depth_describe(&answer.feature, shape->margin, y, near);
}
