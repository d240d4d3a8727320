/* SPDX-License-Identifier: BSD-3-Clause */
/* A ball about the origin: a point with a margin. size: radius. */
#include "base/rounding.h"
#include "convex/feature.h"

static void sphere_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double radius = shape->size[0];
  *near = (convex_near){0};
  near->distance = feature_unit(y, &near->normal) - radius;
  /* at the centre every direction leads out as well as another */
  if (vec_norm2(near->normal) == 0.0) near->normal = vec(0, 0, 1);
  near->point = vec_scale(radius, near->normal);
  feature_vertex(near, vec(0, 0, 0), radius);
}

static double sphere_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)shape, (void)d, (void)hint;
  if (at) *at = vec(0, 0, 0);
  return 0.0;
}

static bool sphere_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  (void)near;
  *cover = (convex_cover){.radius = shape->size[0]};
  return true;
}

static void sphere_project(const convex *shape, vec3 y, convex_foot *foot) {
  (void)shape, (void)y;
  foot->tangents = 0;
  foot->point = vec(0, 0, 0);
}

/* near_rounding: a norm, 3u of |y|, and a difference, u of at most |y| + radius. */
const convex_ops convex_sphere = {.kind = CPROX_BODY_SPHERE,
                                  .near_rounding = 4.0,
                                  .closed_form = true,
                                  .round_core = CONVEX_ALWAYS_ROUND,
                                  .nearest = sphere_nearest,
                                  .support = sphere_support,
                                  .project = sphere_project,
                                  .cover = sphere_cover};
