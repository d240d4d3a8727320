/* SPDX-License-Identifier: BSD-3-Clause */
/* What a handle of many obstacles holds: the list, and the one index that was asked for. */
#ifndef CPROX_PROBLEM_OBSTACLES_H
#define CPROX_PROBLEM_OBSTACLES_H

#include "base/rounding.h"
#include "curve_proximity/cprox/obstacles.h"
#include "shape/body.h"

struct obstacle_bvh;
struct obstacle_batch;

struct cprox_obstacles {
  cprox_obstacle *obstacles; /* checked when the handle was made */
  size_t n;
  struct obstacle_bvh *bvh;     /* CPROX_INDEX_BVH, else NULL */
  struct obstacle_batch *batch; /* CPROX_INDEX_BATCH, else NULL */
};

/* NULL stands for no obstacles. */
static inline const cprox_obstacle *obstacles_list(const cprox_obstacles *obstacles) {
  return obstacles ? obstacles->obstacles : NULL;
}

static inline size_t obstacles_count(const cprox_obstacles *obstacles) {
  return obstacles ? obstacles->n : 0;
}

/* The largest distance of a point of an obstacle, which is a body, from its pose's position; infinity where it has no
 * end. */
static inline double obstacle_reach(const cprox_obstacle *obstacle) {
  const cprox_body *body = obstacle->body;
  return ROUND_UP * (vec_norm(body->ball_centre) + body->ball_radius + obstacle->margin);
}

#endif
