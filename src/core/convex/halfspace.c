/* SPDX-License-Identifier: BSD-3-Clause */
/* The halfspace n·x + offset <= 0. size: the unit normal n, the offset. */
#include "convex/feature.h"

static vec3 halfspace_normal(const convex *shape) {
  return vec(shape->size[0], shape->size[1], shape->size[2]);
}

static void halfspace_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  vec3 e, f;
  *near = (convex_near){0};
  near->normal = halfspace_normal(shape);
  near->distance = vec_dot(near->normal, y) + shape->size[3];
  near->point = vec_axpy(y, -near->distance, near->normal);
  feature_tangents(near->normal, &e, &f);
  feature_face(near, e, f);
}

/* Finite along the stored normal only, bit by bit: along any other direction the halfspace has no end. */
static double halfspace_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const vec3 n = halfspace_normal(shape);
  if (at) *at = vec_scale(-shape->size[3], n);
  return vec_equal(d, n) ? -shape->size[3] : INFINITY;
}

/* near_rounding: the stored normal (3u of it), a dot product (3u), the offset (3u), a sum (u). */
const convex_ops convex_halfspace = {.kind = CPROX_BODY_HALFSPACE,
                                     .near_rounding = 8.0,
                                     .closed_form = true,
                                     .nearest = halfspace_nearest,
                                     .support = halfspace_support};
