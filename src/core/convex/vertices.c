/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/vertices.h"

#include "base/lanes.h"
#include "convex/feature.h"

enum { LANES = 8 }; /* the arrays are padded to a multiple of this */

LANES_DISPATCHED
int32_t vertices_extreme(const convex *shape, vec3 d, double *most) {
  /* the best of each lane; indices are kept as doubles so that a lane is as wide as its value */
  double best[LANES], where[LANES];
  for (int l = 0; l < LANES; l++) {
    best[l] = -INFINITY;
    where[l] = 0.0;
  }
  const double *restrict x = shape->x, *restrict y = shape->y, *restrict z = shape->z;
  for (int32_t i = 0; i < shape->padded; i += LANES) {
    const double base = i;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const double h = d.x * x[i + l] + d.y * y[i + l] + d.z * z[i + l];
      const bool more = h > best[l];
      best[l] = more ? h : best[l];
      where[l] = more ? base : where[l];
    }
  }
  /* the first of the best: the padding repeats the last vertex in later lanes and never comes before it */
  int lane = 0;
  double farthest = best[0];
  for (int l = 1; l < LANES; l++) {
    lane = best[l] > farthest ? l : lane;
    farthest = best[l] > farthest ? best[l] : farthest;
  }
  if (most) *most = farthest;
  return (int32_t)where[lane] + lane;
}

double vertices_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  double h;
  const int32_t i = vertices_extreme(shape, d, &h);
  if (at) *at = vertices_at(shape, i);
  return h;
}

bool vertices_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  return feature_cover(near, shape->n, shape->x, shape->y, shape->z, shape->scale, cover);
}
