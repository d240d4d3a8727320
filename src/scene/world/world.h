/* SPDX-License-Identifier: BSD-3-Clause */
/* All shapes of a snapshot's objects in one row, and trees over those that have a finite box. A tree is made when it is
 * first asked for: curves need it, robots do not, and a scene may change often in between. The next snapshot takes over
 * the trees, and adds one of what is new. */
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
  /* before: the world whose trees are taken over; it is not kept. */
  explicit World(const std::map<std::string, std::shared_ptr<const SceneObject>> &objects,
                 const World *before = nullptr);

  /* By object, in the order of their ids; the shapes of one object stand together. */
  const std::vector<Item> &items() const {
    return items_;
  }

  /* The item with a finite box that is nearest to any of the boxes: NearestBox::id is its index. */
  NearestBox nearest(const std::vector<Eigen::AlignedBox3d> &to) const;

  /* Appends the indices of at least all items with a finite box within `reach` of any of the boxes, see Broadphase. */
  void within(const std::vector<Eigen::AlignedBox3d> &of, double reach, std::vector<std::uint32_t> &indices) const;

  /* The items with a finite box. */
  const std::vector<std::uint32_t> &bounded() const {
    return bounded_;
  }

  /* The items without one. */
  const std::vector<std::uint32_t> &unbounded() const {
    return unbounded_;
  }

  /* The objects with a mesh that is to be solid and is not closed, a name for each such mesh. */
  const std::vector<std::string> &open() const {
    return open_;
  }

  /* How many boxes were put into a tree for this world so far. */
  std::size_t indexed() const {
    return indexed_;
  }

 private:
  /* A tree of this world or of one before: items[id of the tree] is the item's index; NO_BOX: it is gone. */
  struct Tree {
    std::shared_ptr<const Broadphase> boxes;
    std::vector<std::uint32_t> items;
    std::size_t here = 0; /* of the items */
  };
  using Trees = std::vector<Tree>; /* from large to small */

  const Trees &trees() const;
  void takeOver(const World &before);

  std::vector<Item> items_;
  std::vector<std::uint32_t> bounded_, unbounded_;
  std::vector<std::string> open_;
  mutable std::once_flag trees_made_;
  mutable std::size_t indexed_ = 0;
  mutable std::shared_ptr<const Trees> trees_; /* until they are made, what was taken over; set and read atomically */
};

} // namespace curve_proximity
#endif
