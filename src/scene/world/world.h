/* SPDX-License-Identifier: BSD-3-Clause */
/* All shapes of a snapshot's objects in one row, and a tree over those that have a finite box. The tree is made when it
 * is first asked for: curves need it, robots do not, and a scene may change often in between. */
#ifndef CURVE_PROXIMITY_SCENE_WORLD_H
#define CURVE_PROXIMITY_SCENE_WORLD_H

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <curve_proximity/scene.hpp>

#include "broadphase.h"

namespace curve_proximity {

/* One shape, and whose it is; names and shapes are owned by the snapshot's objects or the robot. */
struct Item {
  const PlacedShape *shape = nullptr;
  const std::string *owner = nullptr;
  bool is_link = false;
  int part = 0; /* number of the shape in its owner */
};

/* Throws Error where the item is a curve, as robots are asked about bodies. */
void requireBody(const Item &item);

/* The gaps of a snapshot: those of its changes, and objects that are to be solid but whose mesh is not closed. */
Coverage coverageOf(const Snapshot &snapshot);

class World {
 public:
  explicit World(const std::map<std::string, std::shared_ptr<const SceneObject>> &objects);

  /* By object, in the order of their ids; the shapes of one object stand together. */
  const std::vector<Item> &items() const {
    return items_;
  }

  /* Over the items with a finite box: bounded()[id of the tree] is the item's index. */
  const Broadphase &tree() const;
  const std::vector<std::uint32_t> &bounded() const {
    return bounded_;
  }

  /* The objects with a mesh that is to be solid and is not closed, a name for each such mesh. */
  const std::vector<std::string> &open() const {
    return open_;
  }

  /* The items without one. */
  const std::vector<std::uint32_t> &unbounded() const {
    return unbounded_;
  }

 private:
  std::vector<Item> items_;
  std::vector<std::uint32_t> bounded_, unbounded_;
  std::vector<std::string> open_;
  mutable std::once_flag tree_made_;
  mutable std::unique_ptr<const Broadphase> tree_;
};

} // namespace curve_proximity
#endif
