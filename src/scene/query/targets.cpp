/* SPDX-License-Identifier: BSD-3-Clause */
#include "targets.h"

#include <set>
#include <utility>

#include <curve_proximity/nearest_name.hpp>

#include "answering.h"
#include "geometry/placing.h"
#include "proving.h"

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
  if (!robot && !names.empty()) throw Error("link '" + *names.begin() + "' is unknown: the scene has no robot");
  if (!robot && !poses.empty()) throw Error("poses of links were given, but the scene has no robot");
  for (const std::string &name : names) {
    const auto it = robot->links().find(name);
    if (it == robot->links().end())
      throw Error("robot '" + robot->name() + "' has no link '" + name + "'" +
                  didYouMean(name, namesOf(robot->links())));
    if (it->second.empty()) throw Error("link '" + name + "' has no collision geometry");
  }
  for (const auto &[name, pose] : poses) {
    if (robot->links().count(name) == 0) throw Error("robot '" + robot->name() + "' has no link '" + name + "'");
    checkPose(pose, "the pose of link '" + name + "'");
  }
}

/* All of the world, or the objects that are named. */
void addObjects(bool everything, const Names &names, Targets::Data &data) {
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
void addLinks(bool everything, const Names &names, const LinkPoses &poses, Targets::Data &data) {
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
void addAttached(bool everything, const Names &names, const LinkPoses &poses, Targets::Data &data) {
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

Targets::Targets(SnapshotPtr snapshot, const LinkPoses &links, const Query &query) {
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
    for (const Item &item : data->items) all.push_back(item.shape->target);
    Workspace workspace;
    if (makeObstacles(all, CPROX_INDEX_NONE, workspace, data->few) < 0) data->few.reset(); // ask() finds out why
  }
  data_ = std::move(data);
}

CurveBoxes Targets::boxes() const {
  return data_->items.size() <= FEW_SHAPES ? CurveBoxes::NONE : CurveBoxes::MANY;
}

Targets::~Targets() = default;
Targets::Targets(Targets &&) noexcept = default;
Targets &Targets::operator=(Targets &&) noexcept = default;

std::vector<cprox_obstacle> coreTargets(const Targets &targets) {
  std::vector<cprox_obstacle> all;
  for (const Item &item : targets.data().items) all.push_back(item.shape->target);
  return all;
}

std::string describeTargets(const Targets &targets) {
  std::vector<std::string> names;
  for (const Item &item : targets.data().items) names.push_back(*item.owner);
  return targetLines(coreTargets(targets), names);
}

std::vector<std::string> unprovable(const Targets &targets) {
  std::vector<std::string> sentences;
  for (const Item &item : targets.data().items) {
    const std::string who = (item.is_link ? "link '" : "object '") + *item.owner + "'";
    const std::string sentence = unprovable(who, item.shape->target);
    if (!sentence.empty()) sentences.push_back(sentence);
  }
  return sentences;
}

std::int32_t coreTargetOf(const Targets &targets, const Answer &answer) {
  if (answer.result.obstacle_index < 0) return -1;
  const std::vector<Item> &items = targets.data().items;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item &item = items[i];
    if (item.is_link == answer.b_is_link && item.part == answer.result.obstacle_index && *item.owner == answer.b)
      return static_cast<std::int32_t>(i);
  }
  return -1;
}

} // namespace curve_proximity
