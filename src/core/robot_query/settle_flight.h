/* SPDX-License-Identifier: BSD-3-Clause */
/* The search of one pair by control poses: doc/robot-poses.md, Control poses. */
#ifndef CPROX_ROBOT_QUERY_SETTLE_FLIGHT_H
#define CPROX_ROBOT_QUERY_SETTLE_FLIGHT_H

#include "robot_query/oracle.h"

/* A node over one segment, in a search of one pair in all whose sides are at one time: measures and bounds the pair
 * until it is settled, or many intervals inside the node were looked at. In a search from left to right the node's
 * beginning moves on to where the distance may be as small as the limit. *served is false where control poses cannot
 * bound the pair: then nothing was done. CPROX_OK, or a negative status. */
cprox_status robot_bound_flight(robot_search *o, search_node *node, bool *served);

#endif
