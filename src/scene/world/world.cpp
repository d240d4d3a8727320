/* SPDX-License-Identifier: BSD-3-Clause */
#include "world.h"

#include <memory>
#include <vector>

#include "geometry/placing.h"
#include "moving_body.h"

namespace curve_proximity {

World::World(const std::map<std::string, std::shared_ptr<const SceneObject>> &objects, const World *before)
    : trees_(std::make_shared<const Trees>()) {
  items_.reserve(objects.size());
  for (const auto &[id, object] : objects) {
    for (std::size_t i = 0; i < object->shapes.size(); ++i) {
      const PlacedShape &shape = object->shapes[i].placed;
      if (object->shapes[i].geometry.is_open) open_.push_back(id);
      if (object->shapes[i].geometry.isEmpty()) continue;
      const auto index = static_cast<std::uint32_t>(items_.size());
      items_.push_back({&shape, &object->description.id, false, static_cast<int>(i)});
      (curve_proximity::unbounded(shape) ? unbounded_ : bounded_).push_back(index);
    }
  }
  if (before) takeOver(*before);
}

/* Both worlds are in the order of ids, and an object that did not change is the same one. */
void World::takeOver(const World &before) {
  std::vector<std::uint32_t> now(before.items_.size(), NO_BOX);
  std::size_t was = 0;
  for (std::uint32_t i = 0; i < items_.size() && was < now.size(); ++i) {
    const Item &item = items_[i];
    while (was < now.size() && before.items_[was].shape != item.shape && *before.items_[was].owner < *item.owner) ++was;
    if (was < now.size() && before.items_[was].shape == item.shape) now[was++] = i;
  }
  // of one's own: queries in other threads may put others in their place meanwhile
  const std::shared_ptr<const Trees> of_before = std::atomic_load(&before.trees_);
  Trees trees;
  for (const Tree &old : *of_before) {
    Tree tree{old.boxes, old.items, 0};
    for (std::uint32_t &item : tree.items) {
      if (item != NO_BOX) item = now[item];
      if (item != NO_BOX) ++tree.here;
    }
    if (2 * tree.here > tree.items.size()) trees.push_back(std::move(tree));
  }
  trees_ = std::make_shared<const Trees>(std::move(trees));
}

/* One more tree for what is in none; a tree joins it that is not twice as large. So there are few trees, and a box is
 * put into a tree about as often as there are trees. */
const World::Trees &World::trees() const {
  std::call_once(trees_made_, [this] {
    Trees trees = *trees_;
    std::vector<bool> is_in_tree(items_.size());
    for (const Tree &tree : trees)
      for (const std::uint32_t item : tree.items)
        if (item != NO_BOX) is_in_tree[item] = true;
    Tree added;
    for (const std::uint32_t item : bounded_)
      if (!is_in_tree[item]) added.items.push_back(item);
    if (added.items.empty()) return;
    while (!trees.empty() && trees.back().here < 2 * added.items.size()) {
      for (const std::uint32_t item : trees.back().items)
        if (item != NO_BOX) added.items.push_back(item);
      trees.pop_back();
    }
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(added.items.size());
    for (const std::uint32_t item : added.items) boxes.push_back(items_[item].shape->box);
    added.boxes = std::make_shared<const Broadphase>(boxes);
    added.here = indexed_ = boxes.size();
    trees.push_back(std::move(added));
    std::atomic_store(&trees_, std::make_shared<const Trees>(std::move(trees)));
  });
  return *trees_;
}

NearestBox World::nearest(const std::vector<Eigen::AlignedBox3d> &to) const {
  NearestBox best;
  for (const Tree &tree : trees()) {
    const NearestBox found = tree.boxes->nearest(to, tree.items);
    if (found.gap < best.gap) best = found;
  }
  return best;
}

void World::within(const std::vector<Eigen::AlignedBox3d> &of, double reach,
                   std::vector<std::uint32_t> &indices) const {
  for (const Tree &tree : trees()) tree.boxes->within(of, reach, tree.items, indices);
}

void requireBody(const Item &item) {
  if (!item.shape->obstacle.body)
    throw Error("object '" + *item.owner + "' is a curve: it is asked about curves, not about robots");
}

Coverage coverageOf(const Snapshot &snapshot) {
  Coverage out = snapshot.coverage();
  const auto note = [&](const char *what, const std::string &id) {
    out.add(Gap::PARTIAL, what + (" '" + id) + "' is to be solid, but its mesh is not closed: it has no inside",
            Missing::GEOMETRY);
  };
  for (const std::string &id : snapshot.world().open()) note("object", id);
  for (const auto &[id, object] : snapshot.moving())
    for (const Geometry &geometry : object->geometries)
      if (geometry.is_open) note("object", id);
  for (const auto &[id, object] : snapshot.attached())
    for (const LinkGeometry &shape : object->shapes)
      if (shape.geometry.is_open) note("attached object", id);
  return out;
}

} // namespace curve_proximity
