/* SPDX-License-Identifier: BSD-3-Clause */
/* A capsule along z: a segment with a margin. size: radius, half height of the segment. */
#include "base/rounding.h"
#include "convex/feature.h"

static void capsule_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double radius = shape->size[0], half = shape->size[1];
  const vec3 q = vec(0, 0, fmin(fmax(y.z, -half), half));
  *near = (convex_near){0};
  near->distance = feature_unit(vec_sub(y, q), &near->normal) - radius;
  /* on the axis every direction across it leads out as well as another */
  if (vec_norm2(near->normal) == 0.0) near->normal = vec(1, 0, 0);
  near->point = vec_axpy(q, radius, near->normal);
  if (fabs(y.z) <= half)
    feature_edge(near, vec(0, 0, 0), vec(0, 0, 1), radius);
  else
    feature_vertex(near, q, radius);
}

static double capsule_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const double half = shape->size[1];
  if (at) *at = vec(0, 0, copysign(half, d.z));
  return fabs(d.z) * half;
}

static bool capsule_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  const double radius = shape->size[0], half = shape->size[1];
  *cover = (convex_cover){.axis = {0, 0, 1}, .cylinder = true, .radius = radius * (1.0 + 2.0 * ROUND_U)};
  if (near->tangents == 1) return true;

  /* at an end: the ball about the segment's two ends that touches at this one, and the margin about it */
  const double x[2] = {0, 0}, y[2] = {0, 0}, z[2] = {half, -half};
  convex_near core = *near;
  core.point = near->origin;
  if (!feature_cover(&core, 2, x, y, z, shape->scale, cover)) return false;
  cover->radius = (cover->radius + radius) * (1.0 + 2.0 * ROUND_U);
  return true;
}

static void capsule_project(const convex *shape, vec3 y, convex_foot *foot) {
  const double half = shape->size[1];
  foot->tangents = fabs(y.z) < half ? 1 : 0;
  foot->point = vec(0, 0, foot->tangents ? y.z : copysign(half, y.z));
  foot->e[0] = vec(0, 0, 1);
  foot->along[0] = 1.0;
}

/* near_rounding: a difference (u), a norm (3u), a difference (u). */
const convex_ops convex_capsule = {.kind = CPROX_BODY_CAPSULE,
                                   .near_rounding = 6.0,
                                   .closed_form = true,
                                   .round_core = CONVEX_ALWAYS_ROUND,
                                   .nearest = capsule_nearest,
                                   .support = capsule_support,
                                   .project = capsule_project,
                                   .cover = capsule_cover};
