/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts that stand together make clusters. */
#include <math.h>
#include <stdlib.h>

#include "batch/obstacle_batch.h"

static int by(double a, double b) {
  return (a > b) - (a < b);
}

static int by_x(const void *a, const void *b) {
  return by(((const batch_place *)a)->at.x, ((const batch_place *)b)->at.x);
}

static int by_y(const void *a, const void *b) {
  return by(((const batch_place *)a)->at.y, ((const batch_place *)b)->at.y);
}

static int by_z(const void *a, const void *b) {
  return by(((const batch_place *)a)->at.z, ((const batch_place *)b)->at.z);
}

/* Halves, by whole clusters, along the axis on which the places differ most. */
void batch_clusters_gather(batch_place *places, size_t n) {
  if (n <= CLUSTER) return;
  vec3 low = places[0].at, high = low;
  for (size_t i = 1; i < n; i++) {
    const vec3 p = places[i].at;
    low = vec(lesser(low.x, p.x), lesser(low.y, p.y), lesser(low.z, p.z));
    high = vec(greater(high.x, p.x), greater(high.y, p.y), greater(high.z, p.z));
  }
  const vec3 run = vec_sub(high, low);
  const bool along_x = run.x >= run.y && run.x >= run.z;
  qsort(places, n, sizeof *places, along_x ? by_x : run.y >= run.z ? by_y : by_z);
  const size_t half = (n / 2 + CLUSTER - 1) / CLUSTER * CLUSTER;
  batch_clusters_gather(places, half);
  batch_clusters_gather(places + half, n - half);
}

void batch_clusters_surround(obstacle_batch *batch) {
  const packet_balls *balls = &batch->balls;
  packet_clusters *clusters = &batch->clusters;
  const double *centre[3] = {balls->x, balls->y, balls->z};
  for (size_t b = 0; b < clusters->n; b++) {
    const size_t first = b * CLUSTER, end = first + CLUSTER < balls->n ? first + CLUSTER : balls->n;
    for (int axis = 0; axis < 3; axis++) clusters->low[axis][b] = INFINITY, clusters->high[axis][b] = -INFINITY;
    for (size_t k = first; k < end; k++) {
      for (int axis = 0; axis < 3; axis++) {
        clusters->low[axis][b] = lesser(centre[axis][k] - balls->reach[k], clusters->low[axis][b]);
        clusters->high[axis][b] = greater(centre[axis][k] + balls->reach[k], clusters->high[axis][b]);
      }
      clusters->sizes[b] = greater(balls->sizes[k], clusters->sizes[b]);
    }
  }
}
