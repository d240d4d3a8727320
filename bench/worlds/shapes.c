/* SPDX-License-Identifier: BSD-3-Clause */
/* What is asked about: a bumpy ball of triangles, a room of points, the cells of its octree. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "worlds/worlds.h"

static vec3 bumpy(vec3 v) {
  const vec3 u = vec_scale(1.0 / vec_norm(v), v);
  return vec_scale(1.0 + 0.1 * sin(5.0 * u.x) * sin(6.0 * u.y) * cos(7.0 * u.z), u);
}

worlds_mesh worlds_mesh_make(uint32_t k) {
  static const double corner[6][3] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  worlds_mesh made = {.vertices = worlds_get(8 * (k + 1) * (k + 1) * sizeof(vec3)),
                      .triangles = worlds_get(8 * k * k * 3 * sizeof(uint32_t))};
  for (int f = 0; f < 8; f++) {
    const double *a = corner[f % 4], *b = corner[(f + 1) % 4], *c = corner[f < 4 ? 4 : 5];
    const uint32_t first = (uint32_t)made.n;
    for (uint32_t i = 0; i <= k; i++) {
      for (uint32_t j = 0; i + j <= k; j++) {
        const double u = (double)i / k, v = (double)j / k, w = 1.0 - u - v;
        made.vertices[made.n++] =
            bumpy(vec(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]));
      }
    }
    /* row i begins behind the rows before it, of k + 1, k … points */
    for (uint32_t i = 0; i < k; i++) {
      const uint32_t row = first + i * (k + 1) - i * (i - 1) / 2 * (i > 0), next = row + k + 1 - i;
      for (uint32_t j = 0; i + j < k; j++) {
        const uint32_t one[3] = {row + j, next + j, row + j + 1}, two[3] = {row + j + 1, next + j, next + j + 1};
        memcpy(made.triangles[made.m++], one, sizeof one);
        if (i + j + 1 < k) memcpy(made.triangles[made.m++], two, sizeof two);
      }
    }
  }
  return made;
}

vec3 worlds_in_room(rng *r) {
  const size_t where = rng_index(r, 10);
  const double noise = rng_uniform(r, -1e-3, 1e-3);
  if (where < 4) return vec(rng_uniform(r, -5, 5), rng_uniform(r, -5, 5), noise);
  if (where < 5) return vec(-5.0 + noise, rng_uniform(r, -5, 5), rng_uniform(r, 0, 3));
  if (where < 6) return vec(rng_uniform(r, -5, 5), 5.0 + noise, rng_uniform(r, 0, 3));
  const size_t block = rng_index(r, 40);
  const double x = -4.5 + 1.2 * (double)(block % 8), y = -4.0 + 1.8 * (double)(block % 5),
               h = 0.5 + 0.05 * (double)block;
  const double a = rng_uniform(r, -0.25, 0.25), b = rng_uniform(r, -0.25, 0.25), z = rng_uniform(r, 0, h);
  switch (rng_index(r, 5)) {
    case 0: return vec(x - 0.25 + noise, y + b, z);
    case 1: return vec(x + 0.25 + noise, y + b, z);
    case 2: return vec(x + a, y - 0.25 + noise, z);
    case 3: return vec(x + a, y + 0.25 + noise, z);
    default: return vec(x + a, y + b, h + noise);
  }
}

static int by_place(const void *a, const void *b) {
  const vec3 *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  if (p->y != q->y) return p->y < q->y ? -1 : 1;
  return (p->z > q->z) - (p->z < q->z);
}

size_t worlds_cells_make(rng *r, size_t n, double width, vec3 *centres) {
  size_t count = 0;
  for (int round = 0; round < 8 && count < n; round++) {
    for (size_t i = count; i < n; i++) {
      const vec3 p = worlds_in_room(r);
      centres[i] = vec((floor(p.x / width) + 0.5) * width, (floor(p.y / width) + 0.5) * width,
                       (floor(p.z / width) + 0.5) * width);
    }
    qsort(centres, n, sizeof *centres, by_place);
    count = 1;
    for (size_t i = 1; i < n; i++)
      if (by_place(&centres[i], &centres[count - 1]) != 0) centres[count++] = centres[i];
  }
  return count;
}
