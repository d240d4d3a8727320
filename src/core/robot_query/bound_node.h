/* SPDX-License-Identifier: BSD-3-Clause */
/* Lower bounds of a node of a robot's search: of each pair on its list, by planes that turn with the motion and by
 * distances in its middle (doc/robot-motion-bounds.md). */
#ifndef CPROX_ROBOT_QUERY_BOUND_NODE_H
#define CPROX_ROBOT_QUERY_BOUND_NODE_H

#include "robot_query/oracle.h"

/* Bounds all pairs of a node; those that still matter become its own list. */
cprox_status robot_bound_node(robot_search *o, search_node *node);

/* Measures the pairs whose sides stand still against each other, at the beginning of the root: that is their distance
 * at all times. No node has them on its list. */
cprox_status robot_settle_standing(robot_search *o, const search_node *root);

#endif
