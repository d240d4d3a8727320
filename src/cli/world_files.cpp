/* SPDX-License-Identifier: BSD-3-Clause */
#include "world_files.h"

#include <chrono>
#include <cstdio>
#include <filesystem>

#include <curve_proximity/mesh_remarks.hpp>

#include "../scene/yaml/cloud_file.h"
#include "../scene/yaml/path_yaml.h"
#include "../scene/yaml/scene_change.h"
#include "../scene/yaml/scene_frames.h"
#include "../scene/yaml/scene_yaml.h"
#include "exit_code.h"
#include "packages.h"
#include "robot_file.h"
#include "run.h"

namespace curve_proximity::cli {
namespace {

/* The robot, and where its links are at the scene's robot_state (which frames speak of) and at the state asked for. */
struct PlacedRobot {
  std::shared_ptr<const Robot> robot; /* null: there is none */
  RobotPlace of_scene;
  LinkPoses links_now;
  JointPositions state;
  Srdf srdf;
};

PlacedRobot readPlaced(const Arguments &arguments, const SceneFile &file, const RobotSource &robots,
                       Warnings &warnings) {
  PlacedRobot out;
  if (arguments.robot.empty()) return out;
  out.robot = robots ? robots(arguments.robot)
                     : readRobot(arguments.robot, arguments.mesh_tolerance, arguments.allow_missing_geometry);
  for (const std::string &message : out.robot->warnings()) warnings.add(arguments.robot + ": " + message);
  if (!arguments.srdf.empty()) out.srdf = readSrdf(arguments.srdf);
  try {
    out.of_scene = placeRobot(file, *out.robot, out.srdf.virtual_joints, warnings);
  } catch (const Error &e) {
    throw BadUsage(arguments.scene + ": " + e.what());
  }
  out.state = readState(arguments.state, *out.robot);
  JointPositions joints = out.of_scene.joints;
  for (const auto &[joint, value] : out.state) joints[joint] = value;
  try {
    out.links_now = out.robot->linkPoses(joints, out.of_scene.base);
  } catch (const Error &e) {
    throw BadUsage(arguments.robot + ": " + e.what());
  }
  return out;
}

void apply(Scene &scene, const SceneChange &change) {
  const std::vector<std::string> faults = scene.apply(change);
  if (faults.empty()) return;
  const std::string more = faults.size() > 1 ? " (and " + std::to_string(faults.size() - 1) + " more)" : "";
  throw BadUsage(faults.front() + more);
}

/* Meshes that were to be solid and are not closed, and what was done to read a mesh file. */
void warnOfMeshes(const Snapshot &snapshot, const ResourceOptions &resources, Warnings &warnings) {
  for (const auto &[id, object] : snapshot.objects()) {
    for (const ObjectShape &shape : object->shapes) {
      if (shape.geometry.is_open)
        warnings.add("object '" + id + "': a mesh that is to be solid is not closed: its surface alone counts");
    }
    for (const std::string &remark : meshRemarks(object->description, resources))
      warnings.add("object '" + id + "': " + remark);
  }
}

/* What takes no part: links that nothing can come close to. */
std::vector<std::string> skippedOf(const PlacedRobot &robot) {
  std::vector<std::string> out;
  if (!robot.robot) return out;
  for (const auto &[link, geometry] : robot.robot->links()) {
    if (geometry.empty()) out.push_back("link '" + link + "': it has no collision geometry");
  }
  return out;
}

/* A ball that has the name of the path. */
ObjectDescription ballOf(const Arguments &arguments) {
  ObjectDescription out;
  out.id = std::filesystem::path(arguments.path).stem().string();
  out.shapes.emplace_back().type = ShapeType::POINT;
  out.padding = arguments.radius;
  return out;
}

/* What rides along --path, in the words of a scene file. */
ObjectDescription readBody(const Arguments &arguments, Warnings &warnings) {
  SceneChange one;
  try {
    one.operations.push_back({Operation::Kind::ADD, readRider(loadYaml(arguments.body), warnings)});
    readClouds(one.operations.front().object, folderOf(arguments.body));
  } catch (const BadInput &e) {
    throw BadUsage(arguments.body + ": " + e.what());
  }
  makeResourcesAbsolute(one, folderOf(arguments.body));
  return one.operations.front().object;
}

Ride readRide(const Arguments &arguments, const Frames &frames, const PlacedRobot &robot, Warnings &warnings) {
  const bool turns = !arguments.body.empty();
  PathFile path = readPath(arguments.path, turns, warnings);
  if (!path.remark.empty()) warnings.add(arguments.path + ": " + path.remark);
  Ride out{turns ? readBody(arguments, warnings) : ballOf(arguments), std::move(path.poses), path.origin};
  if (out.body.shapes.empty() && !robot.robot)
    throw BadUsage(arguments.body + ": '" + out.body.id +
                   "' has no shape; an object that a link carries needs --robot");
  if (!out.body.shapes.empty() && robot.robot)
    throw BadUsage("--path takes no --robot: a body along a path is not measured against robots that stand");
  try {
    const Eigen::Isometry3d frame = frames.find(path.frame);
    for (TimedPose &pose : out.poses) pose.pose = frame * pose.pose * out.body.pose;
  } catch (const BadInput &e) {
    throw BadUsage(arguments.path + ": " + e.what());
  }
  out.body.pose = Eigen::Isometry3d::Identity();
  return out;
}

std::string milliseconds(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f ms", 1e3 * seconds);
  return text;
}

const char *sourceName(MeshTiming::Source from) {
  switch (from) {
    case MeshTiming::CACHE_DIR: return "the cache directory";
    case MeshTiming::MEMORY: return "memory";
    case MeshTiming::FILE: break;
  }
  return "the file";
}

/* One message a mesh, and one for all. */
std::vector<std::string> timingsOf(const PlacedRobot &robot, double robot_seconds, double all_seconds) {
  std::vector<std::string> out;
  if (robot.robot) {
    for (const MeshTiming &t : robot.robot->meshTimings())
      out.push_back("mesh '" + t.file + "': " + milliseconds(t.read) + " to read it from " + sourceName(t.from) + ", " +
                    milliseconds(t.hull) + " for the hull, " + milliseconds(t.tree) + " for " +
                    std::to_string(t.triangles) + " triangles");
    out.push_back("robot: " + milliseconds(robot_seconds));
  }
  out.push_back("robot and scene: " + milliseconds(all_seconds));
  return out;
}

} // namespace

World readWorld(const Arguments &arguments, Warnings &warnings, const RobotSource &robots) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Clock::time_point start = Clock::now();
  const SceneFile file = arguments.scene.empty() ? SceneFile() : readScene(arguments.scene, warnings);
  const Clock::time_point robot_start = Clock::now();
  const PlacedRobot robot = readPlaced(arguments, file, robots, warnings);
  const double robot_seconds = since(robot_start);
  const Frames frames(robot.of_scene.fixed, file.transforms, robot.of_scene.links, warnings);

  /* mesh files of the scene are relative to its folder */
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.scene);
  resources.find_package = packageFinder(resources.base_dir);
  resources.mesh_tolerance = arguments.mesh_tolerance;
  Scene scene(robot.robot, resources, allowedPairs(robot.srdf));
  try {
    apply(scene, toFixedChange(file, frames, robot.robot.get(), robot.of_scene.links, warnings));
  } catch (const BadUsage &e) {
    throw BadUsage(arguments.scene + ": " + e.what());
  }
  warnOfMeshes(*scene.snapshot(), resources, warnings);
  std::optional<Ride> ride;
  if (!arguments.path.empty()) ride = readRide(arguments, frames, robot, warnings);
  if (ride && !warnings.coverage().complete()) { /* what was said of --path and --body, too */
    SceneChange told;
    told.coverage = warnings.coverage();
    apply(scene, told);
  }
  return {scene.snapshot(),   robot.links_now, robot.of_scene.joints, robot.of_scene.base,
          robot.state,        robot.srdf,      skippedOf(robot),      timingsOf(robot, robot_seconds, since(start)),
          file.moving_robots, resources,       std::move(ride)};
}

std::shared_ptr<const SecondOpinions> secondOpinions(const Arguments &arguments, const ResourceOptions &resources) {
  if (!arguments.second_opinion) return nullptr;
  return std::make_shared<const SecondOpinions>(*arguments.second_opinion, resources);
}

Query queryOf(const Arguments &arguments, const World &world, const Warnings &warnings) {
  Query query = arguments.query;
  query.options.stop = interrupted;
  query.coverage = warnings.coverage();
  query.second_opinion = secondOpinions(arguments, world.resources);
  return query;
}

World readStandingWorld(const Arguments &arguments, const std::string &what, Warnings &warnings,
                        const RobotSource &robots) {
  World world = readWorld(arguments, warnings, robots);
  if (!world.moves()) return world;
  const std::string who = world.snapshot->moving().empty() ? "robot '" + world.moving_robots.front().name + "'"
                                                           : "object '" + world.snapshot->moving().begin()->first + "'";
  throw BadUsage(arguments.scene + ": " + who + " moves along a trajectory, and " + what +
                 " takes scenes in which nothing moves");
}

} // namespace curve_proximity::cli
