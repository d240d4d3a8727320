/* SPDX-License-Identifier: BSD-3-Clause */
/* One point: the origin of its own frame. */
#include "convex/feature.h"

static void point_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)shape, (void)hint;
  *near = (convex_near){0};
  near->distance = feature_unit(y, &near->normal);
  feature_vertex(near, vec(0, 0, 0), 0.0);
}

static double point_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)shape, (void)d, (void)hint;
  if (at) *at = vec(0, 0, 0);
  return 0.0;
}

static bool point_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  (void)shape, (void)near;
  *cover = (convex_cover){0};
  return true;
}

static void point_project(const convex *shape, vec3 y, convex_foot *foot) {
  (void)shape, (void)y;
  foot->tangents = 0;
  foot->point = vec(0, 0, 0);
}

/* near_rounding: a norm, 3u of |y|. */
const convex_ops convex_point = {.kind = CPROX_BODY_POINT,
                                 .near_rounding = 4.0,
                                 .closed_form = true,
                                 .round_core = CONVEX_ALWAYS_ROUND,
                                 .nearest = point_nearest,
                                 .support = point_support,
                                 .project = point_project,
                                 .cover = point_cover};
