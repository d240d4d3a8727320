/* SPDX-License-Identifier: BSD-3-Clause */
#include "world.h"

#include <memory>
#include <vector>

#include "geometry/placing.h"
#include "moving_body.h"

namespace curve_proximity {

World::World(const std::map<std::string, std::shared_ptr<const SceneObject>> &objects) {
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
}

const Broadphase &World::tree() const {
  std::call_once(tree_made_, [this] {
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(bounded_.size());
    for (const std::uint32_t index : bounded_) boxes.push_back(items_[index].shape->box);
    tree_ = std::make_unique<const Broadphase>(boxes);
  });
  return *tree_;
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
