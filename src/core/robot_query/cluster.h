/* SPDX-License-Identifier: BSD-3-Clause */
/* The obstacles of a set as the parts of a robot come near them, by the tree of their boxes: a part and all that is
 * under a node of the tree are one entry of a list until the part comes near, and only then pairs. doc/robot-search.md,
 * Many obstacles */
#ifndef CPROX_ROBOT_QUERY_CLUSTER_H
#define CPROX_ROBOT_QUERY_CLUSTER_H

#include "bvh/bvh.h"
#include "robot_query/robot_scene.h"

/* A part in the middle of the node at hand, as the tree's boxes see it. */
typedef struct cluster_view {
  int32_t part;
  const tree *boxes;
  vec3 centre;                    /* the shape's origin, seen from the tree's */
  double r[9];                    /* the shape's axes are the columns */
  vec3 middle, half;              /* the box round the core, along these axes */
  double radius, displacement;    /* of the part; over the node */
  double beyond_ball, beyond_box; /* what a distance from the centre or from the box has too much, rounding included */
} cluster_view;

/* moves: over the node; else it is seen in the middle alone. */
cluster_view cluster_see(robot_scene *scene, int32_t part, bool moves);

/* What the lanes of a node of the tree, or of a pack (TREE_LEAF), are away from a part. Unused lanes repeat others. */
typedef struct cluster_lanes {
  uint32_t live;            /* a bit for each lane that is below the bar */
  double dropped;           /* the least bound of the others, infinity for none */
  double lower[TREE_LANES]; /* anywhere in the node at hand, rounding included */
  double apart[TREE_LANES]; /* in its middle */
  const uint32_t *under;    /* of a node: what the lane leads to; of a pack: the number of a box */
} cluster_lanes;

/* By the ball round the part: from `bar` on lanes are of no interest. */
void cluster_measure(const cluster_view *view, uint32_t at, double bar, cluster_lanes *lanes);

/* The same lanes by the box round the part, too. */
void cluster_measure_boxes(const cluster_view *view, uint32_t at, double bar, cluster_lanes *lanes);

/* The pairs of a part and the obstacle in a box, one for each part of that: the first one's number, -1 where memory is
 * out. They may move all pairs and obstacles in memory. */
int32_t cluster_pairs(robot_scene *scene, int32_t part, uint32_t box, size_t *count);

#endif
