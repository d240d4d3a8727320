/* SPDX-License-Identifier: BSD-3-Clause */
/* What errors of an execution may cost the distances of lanes. doc/robust.md */
#ifndef CPROX_EDGES_EDGE_LOSSES_H
#define CPROX_EDGES_EDGE_LOSSES_H

#include "edges/edge_bound.h"
#include "problem/problem.h"

/* Of a query that has errors. The arrays stand in its workspace. */
typedef struct edge_losses {
  float *standing_room, *pairs; /* as edge_motion has them */
  double *standing, *most;      /* of each part against what stands [m]; room for the most of many intervals */
  axis_state *axes;
  struct axis_deviations *off; /* of each axis */
  double *rows;
  int32_t *axis_of;                /* of each frame; -1: the base */
  double object_reach, object_far; /* obstacles that end reach so far from their poses' positions; the others have these
                                      so far from the base */
} edge_losses;

/* False where memory is out. */
bool edge_losses_begin(const query *q, const cprox_edge_checker *c, size_t first, size_t last, edge_losses *losses);

/* Those of all parts and pairs over a part of one segment of the motion, in losses->standing and losses->pairs. */
void edge_losses_over(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_losses *losses);

/* The same, added to the room of the motion, which is of that part. */
void edge_losses_add(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_losses *losses,
                     edge_motion *motion);

#endif
