/* SPDX-License-Identifier: BSD-3-Clause */
/* What errors of an execution may cost the distances of lanes. doc/robust.md */
#ifndef CPROX_EDGES_EDGE_LOSSES_H
#define CPROX_EDGES_EDGE_LOSSES_H

#include "edges/edge_bound.h"
#include "problem/problem.h"

/* Of a query that has errors, over one edge. The arrays stand in its workspace. */
typedef struct edge_losses {
  float *still, *by_rate, *most; /* of each frame: it is off by still + by_rate times its rate by the edge's parameter,
                                    and by no more than `most` */
  float *slack;                  /* of each part: lever arms of its points are off by this, however lanes round [m] */
  float *standing, *pairs;       /* what a part may lose against what stands, and each pair, anywhere on the edge [m] */
  int32_t *axis_of;              /* of each frame; -1: the base */
  float base_origin[3];          /* seen from the base, as all coordinates */
  float base_rotation, object_rotation, places, flex; /* places: base, object and sensor together [m] */
  float object_reach, object_far; /* obstacles that end reach so far from their poses' positions; the others have these
                                     so far from the base */
} edge_losses;

/* False where memory is out. */
bool edge_losses_begin(const query *q, const cprox_edge_checker *c, size_t first, size_t last, edge_losses *losses);

/* Those of a part of one segment of the motion; `edge` is filled from it. */
void edge_losses_over(const query *q, const cprox_edge_checker *c, const motion_interval *over, const edge_motion *edge,
                      edge_losses *losses);

#endif
