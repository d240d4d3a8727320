/* SPDX-License-Identifier: BSD-3-Clause */
/* The shapes that a query is about. */
#ifndef CURVE_PROXIMITY_SCENE_OBSTACLES_H
#define CURVE_PROXIMITY_SCENE_OBSTACLES_H

#include <deque>
#include <vector>

#include <curve_proximity/query.hpp>

#include "world/world.h"

namespace curve_proximity {

/* Up to so many shapes the core alone is faster than asking the tree first. */
constexpr std::size_t FEW_SHAPES = 8;

struct SceneObstacles::Data {
  SnapshotPtr snapshot;

  /* Objects' shapes first, then the links', then those of what links carry: each owner's stand together. */
  std::vector<Item> items;

  /* The first items[] are the snapshot's world, all of it, in its order: its tree may be asked. Else 0. */
  std::size_t in_tree = 0;

  std::deque<PlacedShape> links; /* where the items of links and of what they carry point to */

  Coverage coverage; /* of the scene, and of the robot where it takes part */

  ObstaclesHandle few; /* all items, where they are so few that each curve is held against all of them; else null */
};

} // namespace curve_proximity
#endif
