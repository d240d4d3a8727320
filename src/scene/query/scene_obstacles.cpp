/* SPDX-License-Identifier: BSD-3-Clause */
#include "scene_obstacles.h"

#include <set>
#include <utility>

#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "geometry/placing.h"
#include "proving.h"
#include "world/attaching.h"

namespace curve_proximity {
namespace {

using Names = std::set<std::string>;

void checkObjects(const Names &names, const Snapshot &snapshot) {
  for (const std::string &name : names) {
    if (snapshot.objects().count(name) == 0 && snapshot.attached().count(name) == 0)
      throw Error("there is no object '" + name + "' in the scene" + didYouMean(name, namesOf(snapshot.objects())));
  }
}

void checkLinks(const Names &names, const LinkPoses &poses, const Robot *robot) {
  for (const std::string &name : names) {
    checkLink(name, robot);
    if (robot->links().at(name).empty()) throw Error("link '" + name + "' has no collision geometry");
  }
  if (!robot && !poses.empty()) throw Error("poses of links were given, but the scene has no robot");
  for (const auto &[name, pose] : poses) {
    if (robot->links().count(name) == 0) throw Error("robot '" + robot->name() + "' has no link '" + name + "'");
    checkPose(pose, "the pose of link '" + name + "'");
  }
}

/* All of the world, or the objects that are named. */
void addObjects(bool everything, const Names &names, SceneObstacles::Data &data) {
  const std::vector<Item> &all = data.snapshot->world().items();
  if (everything) {
    data.items = all;
    data.in_tree = all.size();
    return;
  }
  for (const Item &item : all) {
    if (names.count(*item.owner) > 0) data.items.push_back(item);
  }
}

/* The links with geometry, each where its pose says. */
void addLinks(bool everything, const Names &names, const LinkPoses &poses, SceneObstacles::Data &data) {
  for (const auto &[name, of_robot] : data.snapshot->robot()->links()) {
    if (of_robot.empty() || (!everything && names.count(name) == 0)) continue;
    const std::vector<LinkGeometry> &geometries = data.snapshot->linkGeometry(name);
    const auto pose = poses.find(name);
    if (pose == poses.end()) throw Error("link '" + name + "' has collision geometry, but its pose is not known");
    const double padding = data.snapshot->linkPadding(name);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      data.links.push_back(place(geometries[i].geometry, pose->second, geometries[i].pose, padding));
      data.items.push_back({&data.links.back(), &name, true, static_cast<int>(i)});
    }
  }
}

/* What links carry, each where its link is. */
void addAttached(bool everything, const Names &names, const LinkPoses &poses, SceneObstacles::Data &data) {
  for (const auto &[id, object] : data.snapshot->attached()) {
    if (!everything && names.count(id) == 0) continue;
    const auto pose = poses.find(object->link);
    if (pose == poses.end())
      throw Error("object '" + id + "' is carried by link '" + object->link + "', whose pose is not known");
    for (std::size_t i = 0; i < object->shapes.size(); ++i) {
      const LinkGeometry &shape = object->shapes[i];
      data.links.push_back(place(shape.geometry, pose->second, shape.pose, data.snapshot->attachedPadding(*object)));
      data.items.push_back({&data.links.back(), &id, false, static_cast<int>(i)});
    }
  }
}

} // namespace

SceneObstacles::SceneObstacles(SnapshotPtr snapshot, const LinkPoses &links, const Query &query) {
  const Names objects(query.objects.begin(), query.objects.end());
  const Names named_links(query.links.begin(), query.links.end());
  const std::string fault = objects.empty() && !named_links.empty() ? "" : faultOfMoving(*snapshot, query.objects);
  if (!fault.empty()) throw Error(fault);
  if (query.moving_only)
    throw Error("moving_only does not apply to curves: it is about the links of a robot in motion");
  checkObjects(objects, *snapshot);
  checkLinks(named_links, links, snapshot->robot().get());

  auto data = std::make_unique<Data>();
  data->snapshot = std::move(snapshot);
  const bool everything = objects.empty() && named_links.empty();
  addObjects(everything, objects, *data);
  if (!links.empty() || !named_links.empty()) addLinks(everything, named_links, links, *data);
  if (!links.empty() || !everything) addAttached(everything, objects, links, *data);
  data->coverage = coverageOf(*data->snapshot);
  if (!links.empty() || !named_links.empty()) data->coverage.add(data->snapshot->robot()->coverage());
  if (data->items.size() <= FEW_SHAPES) {
    std::vector<cprox_obstacle> all;
    for (const Item &item : data->items) all.push_back(item.shape->obstacle);
    Workspace workspace;
    if (makeObstacles(all, CPROX_INDEX_NONE, workspace, data->few) < 0) data->few.reset(); // ask() finds out why
  }
  data_ = std::move(data);
}

CurveBoxes SceneObstacles::boxes() const {
  return data_->items.size() <= FEW_SHAPES ? CurveBoxes::NONE : CurveBoxes::MANY;
}

SceneObstacles::~SceneObstacles() = default;
SceneObstacles::SceneObstacles(SceneObstacles &&) noexcept = default;
SceneObstacles &SceneObstacles::operator=(SceneObstacles &&) noexcept = default;

std::vector<cprox_obstacle> coreObstacles(const SceneObstacles &obstacles) {
  std::vector<cprox_obstacle> all;
  for (const Item &item : obstacles.data().items) all.push_back(item.shape->obstacle);
  return all;
}

std::string describeObstacles(const SceneObstacles &obstacles) {
  std::vector<std::string> names;
  for (const Item &item : obstacles.data().items) names.push_back(*item.owner);
  return obstacleLines(coreObstacles(obstacles), names);
}

std::vector<std::string> unprovable(const SceneObstacles &obstacles) {
  std::vector<std::string> messages;
  for (const Item &item : obstacles.data().items) {
    const std::string who = (item.is_link ? "link '" : "object '") + *item.owner + "'";
    const std::string message = unprovable(who, item.shape->obstacle);
    if (!message.empty()) messages.push_back(message);
  }
  return messages;
}

std::int32_t coreObstacleOf(const SceneObstacles &obstacles, const Answer &answer) {
  if (answer.result.obstacle_index < 0) return -1;
  const std::vector<Item> &items = obstacles.data().items;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item &item = items[i];
    if (item.is_link == answer.b_is_link && item.part == answer.result.obstacle_index && *item.owner == answer.b)
      return static_cast<std::int32_t>(i);
  }
  return -1;
}

} // namespace curve_proximity
