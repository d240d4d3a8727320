/* SPDX-License-Identifier: BSD-3-Clause */
/* A box about the origin. size: half extents. */
#include "convex/feature.h"

static const vec3 AXES[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* Inside the face with the least depth is nearest. */
static void box_nearest_inside(const convex *shape, vec3 y, convex_near *near) {
  const double p[3] = {y.x, y.y, y.z};
  int face = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(p[i]) - shape->size[i] > fabs(p[face]) - shape->size[face]) face = i;
  const double side = p[face] < 0.0 ? -1.0 : 1.0;
  double q[3] = {y.x, y.y, y.z};
  q[face] = side * shape->size[face];
  near->distance = fabs(p[face]) - shape->size[face];
  near->point = vec(q[0], q[1], q[2]);
  near->normal = vec_scale(side, AXES[face]);
  feature_face(near, AXES[(face + 1) % 3], AXES[(face + 2) % 3]);
}

static void box_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const double *h = shape->size;
  const vec3 q = vec(fmin(fmax(y.x, -h[0]), h[0]), fmin(fmax(y.y, -h[1]), h[1]), fmin(fmax(y.z, -h[2]), h[2]));
  const vec3 w = vec_sub(y, q);
  *near = (convex_near){0};
  if (w.x == 0.0 && w.y == 0.0 && w.z == 0.0) {
    box_nearest_inside(shape, y, near);
    return;
  }
  near->distance = feature_unit(w, &near->normal);
  near->point = q;

  /* the coordinates that were not cut off are free along the feature */
  const double gap[3] = {w.x, w.y, w.z};
  vec3 e[3];
  int tangents = 0;
  for (int i = 0; i < 3; i++)
    if (gap[i] == 0.0) e[tangents++] = AXES[i];
  if (tangents == 0) feature_vertex(near, q, 0.0);
  if (tangents == 1) feature_edge(near, q, e[0], 0.0);
  if (tangents == 2) feature_face(near, e[0], e[1]);
}

static double box_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const double *h = shape->size;
  if (at) *at = vec(copysign(h[0], d.x), copysign(h[1], d.y), copysign(h[2], d.z));
  return fabs(d.x) * h[0] + fabs(d.y) * h[1] + fabs(d.z) * h[2];
}

static bool box_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  const double *h = shape->size;
  double x[8], y[8], z[8];
  for (int i = 0; i < 8; i++) {
    x[i] = i & 1 ? h[0] : -h[0];
    y[i] = i & 2 ? h[1] : -h[1];
    z[i] = i & 4 ? h[2] : -h[2];
  }
  return feature_cover(near, 8, x, y, z, shape->scale, cover);
}

/* Free along the axes on which y is not cut off. */
static void box_project(const convex *shape, vec3 y, convex_foot *foot) {
  const double *h = shape->size;
  const bool free[3] = {fabs(y.x) < h[0], fabs(y.y) < h[1], fabs(y.z) < h[2]};
  foot->point = vec(free[0] ? y.x : copysign(h[0], y.x), free[1] ? y.y : copysign(h[1], y.y),
                    free[2] ? y.z : copysign(h[2], y.z));
  foot->tangents = 0;
  for (int i = 0; i < 3; i++) {
    if (!free[i]) continue;
    if (foot->tangents < 2) foot->e[foot->tangents] = AXES[i];
    foot->tangents++;
  }
  foot->along[0] = foot->along[1] = 1.0;
}

/* near_rounding: three differences (u of each) under a norm (3u). */
const convex_ops convex_box = {.kind = CPROX_BODY_BOX,
                               .near_rounding = 4.0,
                               .closed_form = true,
                               .nearest = box_nearest,
                               .support = box_support,
                               .project = box_project,
                               .cover = box_cover};
