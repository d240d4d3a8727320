/* SPDX-License-Identifier: BSD-3-Clause */
/* Which parts may matter, as far as balls and clusters of them can tell. */
#include "batch/prefilter.h"

#include <math.h>

/* The balls of one cluster, as if there were no others. */
static packet_balls balls_of(const obstacle_batch *batch, size_t cluster) {
  const packet_balls *all = &batch->balls;
  const size_t at = cluster * CLUSTER;
  return (packet_balls){CLUSTER, CLUSTER, all->x + at, all->y + at, all->z + at, all->reach + at, all->sizes + at};
}

void batch_cull_begin(batch_run *run) {
  enum { PAYS_FROM = 8 }; /* of fewer parts the curve's capsule rules out enough */
  const obstacle_batch *batch = run->batch;
  run->n_boxes = 0;
  if (!run->short_enough || batch->balls.n < PAYS_FROM || !batch_points_ready(run)) {
    for (size_t b = 0; b < batch->clusters.n; b++) run->cluster_lower[b] = -INFINITY;
    return;
  }
  batch_points_join(run);
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    packet_boxes(&run->chords[i], run->boxes + run->n_boxes);
    run->n_boxes += PACKET_INTERVALS;
  }
  const double radius = run->q.mover.radius + run->beside;
  packet_cluster_bounds(&batch->clusters, run->boxes, run->n_boxes, radius, run->slack, run->cluster_lower);
}

/* Bounds each part of a cluster. */
static void open_cluster(batch_run *run, size_t cluster) {
  const packet_balls balls = balls_of(run->batch, cluster);
  double *lower = run->lower + cluster * CLUSTER;
  const double radius = run->q.mover.radius;
  if (run->n_boxes == 0) {
    const curve_capsule whole = curve_whole(run->q.mover.curve);
    packet_ball_bounds(&balls, &whole, radius, lower);
    return;
  }
  for (size_t k = 0; k < CLUSTER; k++) lower[k] = run->cluster_lower[cluster];
  packet_box_bounds(&balls, run->boxes, run->n_boxes, radius + run->beside, run->slack, lower);
}

static size_t end_of(const obstacle_batch *batch, size_t cluster) {
  const size_t end = (cluster + 1) * CLUSTER;
  return end < batch->balls.n ? end : batch->balls.n;
}

size_t batch_cull_nearest(batch_run *run) {
  const obstacle_batch *batch = run->batch;
  if (batch->balls.n == 0) return SIZE_MAX;
  size_t cluster = 0;
  for (size_t b = 1; b < batch->clusters.n; b++)
    if (run->cluster_lower[b] < run->cluster_lower[cluster]) cluster = b;
  open_cluster(run, cluster);
  size_t nearest = cluster * CLUSTER;
  for (size_t k = nearest; k < end_of(batch, cluster); k++)
    if (run->lower[k] < run->lower[nearest]) nearest = k;
  return nearest;
}

double batch_cull_list(batch_run *run, double most) {
  const obstacle_batch *batch = run->batch;
  double beyond = INFINITY;
  size_t n = 0;
  for (size_t b = 0; b < batch->clusters.n; b++) {
    if (run->cluster_lower[b] > most) {
      beyond = lesser(beyond, run->cluster_lower[b]);
      continue;
    }
    open_cluster(run, b);
    for (size_t k = b * CLUSTER; k < end_of(batch, b); k++) {
      const double lower = run->lower[k];
      const bool is_open = !(lower > most);
      run->open[n] = (uint32_t)k;
      n += is_open;
      beyond = lesser(beyond, is_open ? INFINITY : lower);
    }
  }
  run->n_open = n;
  return beyond;
}
