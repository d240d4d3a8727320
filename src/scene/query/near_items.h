/* SPDX-License-Identifier: BSD-3-Clause */
/* Which of many objects a verdict about a robot in motion can depend on. */
#ifndef CURVE_PROXIMITY_SCENE_NEAR_ITEMS_H
#define CURVE_PROXIMITY_SCENE_NEAR_ITEMS_H

#include <vector>

#include "answering.h"
#include "motion/motion_data.h"

namespace curve_proximity {

struct NearItems {
  std::vector<std::size_t> items; /* not empty where items were given */
  double left_out = INFINITE;     /* [m] the robot stays farther than this from all other items */
};

/* Of a query that asks for a verdict, the items that the robot comes near, by boxes; all where they are few, and where
 * the query asks for more than a verdict. */
NearItems nearItems(const RobotMotion::Data &data, std::vector<std::size_t> items, const Query &query,
                    Workspace &workspace);

} // namespace curve_proximity
#endif
