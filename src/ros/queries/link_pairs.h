/* SPDX-License-Identifier: BSD-3-Clause */
/** ~collision_matrix: which links of the robot can touch each other. */
#ifndef CURVE_PROXIMITY_ROS_LINK_PAIRS_H
#define CURVE_PROXIMITY_ROS_LINK_PAIRS_H

#include <curve_proximity/ListLinkPairs.h>

#include <curve_proximity/query.hpp>

#include "queries/time_budget.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** options: of each pair. most_pairs: ~max_results. Throws Error where nothing can be answered at all; what is wrong
 *  with one pair becomes its row, and pairs that the budget does not reach are undecided. */
void answerLinkPairs(const ListLinkPairs::Request &request, ListLinkPairs::Response &response, const LiveScene &live,
                     cprox_options options, int most_pairs, TimeBudget &budget);

} // namespace curve_proximity
#endif
