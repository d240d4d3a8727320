/* SPDX-License-Identifier: BSD-3-Clause */
/* Which parts may matter, as far as balls and blocks of them can tell. */
#include "batch/prefilter.h"

#include <math.h>

/* The balls of one block, as if there were no others. */
static packet_balls balls_of(const obstacle_batch *batch, size_t block) {
  const packet_balls *all = &batch->balls;
  const size_t at = block * BLOCK;
  return (packet_balls){BLOCK, BLOCK, all->x + at, all->y + at, all->z + at, all->reach + at, all->sizes + at};
}

void batch_open_begin(batch_run *run) {
  enum { PAYS_FROM = 8 }; /* of fewer parts the curve's capsule rules out enough */
  const obstacle_batch *batch = run->batch;
  run->n_boxes = 0;
  if (!run->short_enough || batch->balls.n < PAYS_FROM || !batch_points_ready(run)) {
    for (size_t b = 0; b < batch->blocks.n; b++) run->block_lower[b] = -INFINITY;
    return;
  }
  batch_points_join(run);
  for (size_t i = 0; i < run->q.mover.curve->n_pieces; i++) {
    packet_boxes(&run->chords[i], run->boxes + run->n_boxes);
    run->n_boxes += PACKET_INTERVALS;
  }
  const double radius = run->q.mover.radius + run->beside;
  packet_block_bounds(&batch->blocks, run->boxes, run->n_boxes, radius, run->slack, run->block_lower);
}

/* Bounds each part of a block. */
static void open_block(batch_run *run, size_t block) {
  const packet_balls balls = balls_of(run->batch, block);
  double *lower = run->lower + block * BLOCK;
  const double radius = run->q.mover.radius;
  if (run->n_boxes == 0) {
    const curve_capsule whole = curve_whole(run->q.mover.curve);
    packet_ball_bounds(&balls, &whole, radius, lower);
    return;
  }
  for (size_t k = 0; k < BLOCK; k++) lower[k] = run->block_lower[block];
  packet_box_bounds(&balls, run->boxes, run->n_boxes, radius + run->beside, run->slack, lower);
}

static size_t end_of(const obstacle_batch *batch, size_t block) {
  const size_t end = (block + 1) * BLOCK;
  return end < batch->balls.n ? end : batch->balls.n;
}

size_t batch_open_nearest(batch_run *run) {
  const obstacle_batch *batch = run->batch;
  if (batch->balls.n == 0) return SIZE_MAX;
  size_t block = 0;
  for (size_t b = 1; b < batch->blocks.n; b++)
    if (run->block_lower[b] < run->block_lower[block]) block = b;
  open_block(run, block);
  size_t nearest = block * BLOCK;
  for (size_t k = nearest; k < end_of(batch, block); k++)
    if (run->lower[k] < run->lower[nearest]) nearest = k;
  return nearest;
}

double batch_open_list(batch_run *run, double most) {
  const obstacle_batch *batch = run->batch;
  double beyond = INFINITY;
  size_t n = 0;
  for (size_t b = 0; b < batch->blocks.n; b++) {
    if (run->block_lower[b] > most) {
      beyond = lesser(beyond, run->block_lower[b]);
      continue;
    }
    open_block(run, b);
    for (size_t k = b * BLOCK; k < end_of(batch, b); k++) {
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
