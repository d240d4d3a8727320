/* SPDX-License-Identifier: BSD-3-Clause */
/* What a batch knows of its obstacles. */
#ifndef CPROX_BATCH_OBSTACLE_BATCH_H
#define CPROX_BATCH_OBSTACLE_BATCH_H

#include "curve/packets.h"
#include "curve_proximity/cprox/query.h"
#include "problem/candidates.h"

/* A point in an obstacle or near it, in the world, and balls about it: one inside the obstacle, one round it. Margin is
 * left out. */
typedef struct batch_core {
  vec3 centre;
  double inner; /* rounding included; < 0: there is no such ball */
  double outer;
  bool flat;     /* the inner ball is a disc in the plane of constant z: it tells of curves in that plane only */
  double plane;  /* this */
  double margin; /* of the obstacle, which the radii leave out */

  /* a box round the part, in the frame of its shape */
  bool has_obb, is_obb; /* there is one; the part is that box */
  packet_obb obb;
  double obb_sizes;                 /* the sum of the lengths that entered, for rounding: this times obb_turned u, */
  double obb_turned, obb_misplaced; /* and this [m] are what placing it may be off */
} batch_core;

typedef struct obstacle_batch {
  const cprox_obstacle *obstacles; /* not owned */
  size_t n;
  bool synchronized; /* some of them are: where they are depends on the mover */
  /* one for each obstacle that is a curve, one for each convex part of a body */
  candidate *parts;
  batch_core *cores;
  packet_balls balls;
  packet_clusters clusters; /* of CLUSTER parts each, that stand together */
} obstacle_batch;

/* Makes n obstacles ready, which were checked and must outlive it. */
cprox_status obstacle_batch_create(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace,
                                   obstacle_batch **batch);
void obstacle_batch_free(obstacle_batch *batch);

/* Where a part stands, as far as its place in a cluster is concerned. */
typedef struct batch_place {
  candidate part;
  vec3 at;
} batch_place;

/* Puts n places in the order of clusters; and boxes round the clusters of the batch's balls. */
void batch_clusters_gather(batch_place *places, size_t n);
void batch_clusters_surround(obstacle_batch *batch);

#endif
