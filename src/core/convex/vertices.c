/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/vertices.h"

#include "convex/feature.h"
#include "simd/dispatch.h"

/* Four lanes, selected by masks and never by branches, which a processor would guess wrong: loops over arrays are made
 * into branches by some compilers. */
typedef double lanes __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t choice __attribute__((vector_size(32)));

enum { WIDTH = 4, LANES = 8 }; /* the arrays are padded to a multiple of LANES */

SIMD_CLONES
int32_t vertices_extreme(const convex *shape, vec3 d, double *most) {
  const lanes dx = {d.x, d.x, d.x, d.x}, dy = {d.y, d.y, d.y, d.y}, dz = {d.z, d.z, d.z, d.z};
  const double *x = shape->x, *y = shape->y, *z = shape->z;

  /* the best of each lane, and its index */
  lanes best[2];
  choice where[2], index[2] = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  for (int k = 0; k < 2; k++) {
    best[k] = (lanes){-INFINITY, -INFINITY, -INFINITY, -INFINITY};
    where[k] = index[k];
  }
  for (int32_t i = 0; i < shape->padded; i += LANES) {
    for (int k = 0; k < 2; k++) {
      const int32_t j = i + WIDTH * k;
      const lanes h = dx * *(const lanes *)(x + j) + dy * *(const lanes *)(y + j) + dz * *(const lanes *)(z + j);
      const choice more = h > best[k];
      best[k] = (lanes)((more & (choice)h) | (~more & (choice)best[k]));
      where[k] = (more & index[k]) | (~more & where[k]);
      index[k] += LANES;
    }
  }

  /* the first of the best, which is never the margin: that repeats the last vertex */
  const double half[2] = {greater(greater(best[0][0], best[0][1]), greater(best[0][2], best[0][3])),
                          greater(greater(best[1][0], best[1][1]), greater(best[1][2], best[1][3]))};
  const double farthest = greater(half[0], half[1]);
  int64_t first = shape->n - 1;
  for (int k = 0; k < 2; k++) {
    const choice is_best = best[k] == (lanes){farthest, farthest, farthest, farthest};
    const choice at = (is_best & where[k]) | (~is_best & INT32_MAX);
    for (int l = 0; l < WIDTH; l++) first = at[l] < first ? at[l] : first;
  }
  if (most) *most = farthest;
  return (int32_t)first;
}

/* How far the vertices reach, without asking which one does. */
SIMD_CLONES
static double reach_of(const convex *shape, vec3 d) {
  const double *x = shape->x, *y = shape->y, *z = shape->z;
  double most = -INFINITY;
#pragma omp simd reduction(max : most)
  for (int32_t i = 0; i < shape->padded; i++) {
    const double h = d.x * x[i] + d.y * y[i] + d.z * z[i];
    most = h > most ? h : most;
  }
  return most;
}

double vertices_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  if (!at) return reach_of(shape, d);
  double h;
  *at = vertices_at(shape, vertices_extreme(shape, d, &h));
  return h;
}

bool vertices_cover(const convex *shape, const convex_near *near, convex_cover *cover) {
  return feature_cover(near, shape->n, shape->x, shape->y, shape->z, shape->scale, cover);
}
