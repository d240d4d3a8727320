/* SPDX-License-Identifier: BSD-3-Clause */
/* The targets of a set as the parts of a robot come near them, by the tree of their boxes: a part and all that is under
 * a node of the tree are one entry of a list until the part comes near, and only then pairs. doc/robot-bounds.md, Many
 * obstacles */
#ifndef CPROX_ROBOT_QUERY_CULL_H
#define CPROX_ROBOT_QUERY_CULL_H

#include "bvh/bvh.h"
#include "robot_query/pair_state.h"

/* What the lanes of a node of the tree, or of a pack (TREE_LEAF), are away from a part. */
typedef struct cluster_lanes {
  uint32_t live;              /* a bit for each lane in use */
  double lower[TREE_LANES];   /* anywhere in the node at hand, rounding included */
  double apart[TREE_LANES];   /* in its middle, as robot_pair_ball_distance() has it */
  uint32_t under[TREE_LANES]; /* of a node: what the lane leads to; of a pack: the number of a box */
} cluster_lanes;

/* displacement: of the part over the node at hand. */
void cluster_measure(robot_scene *scene, int32_t part, uint32_t at, double displacement, cluster_lanes *lanes);

/* The pairs of a part and the target in a box, one for each part of that: the first one's number, -1 where memory is
 * out. They may move all pairs and obstacles in memory. */
int32_t cluster_pairs(robot_scene *scene, int32_t part, uint32_t box, size_t *count);

#endif
