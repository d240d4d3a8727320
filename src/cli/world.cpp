/* SPDX-License-Identifier: BSD-3-Clause */
#include "world.h"

#include <set>

#include "failure.h"
#include "frames.h"
#include "packages.h"
#include "robot_file.h"
#include "scene_yaml.h"

namespace curve_proximity::cli {
namespace {

/* The scene's robot_state, without the joints that this robot does not have. */
JointPositions stateOfScene(const SceneFile &file, const Robot &robot, Warnings &warnings) {
  JointPositions out;
  for (const auto &[joint, value] : file.joints) {
    if (robot.hasJoint(joint)) {
      out.emplace(joint, value);
    } else {
      warnings.add("robot_state: '" + joint + "' is no joint of the robot; it is ignored");
    }
  }
  return out;
}

/* An object's pose, from the frame that it names to the fixed frame. Shapes that are appended without a pose belong to
 * an object that stands there already. */
Operation toFixed(Operation operation, const Frames &frames) {
  ObjectDescription &object = operation.object;
  const bool relative = operation.kind == Operation::Kind::APPEND && object.pose.matrix().isIdentity(0.0);
  if (operation.kind == Operation::Kind::REMOVE || relative) return operation;
  try {
    object.pose = frames.find(object.frame) * object.pose;
    object.frame.clear();
  } catch (const BadInput &e) {
    throw BadUsage("object '" + object.id + "': " + e.what());
  }
  return operation;
}

/* An object that the robot carries moves with its link, from where the scene's robot_state has the link to where it is
 * now. */
Operation toFixed(const AttachedObject &attached, const Frames &frames, const LinkPoses &links_of_scene,
                  const LinkPoses &links_now) {
  Operation operation = toFixed(Operation{Operation::Kind::ADD, attached.object}, frames);
  if (links_now.empty()) return operation;
  const auto before = links_of_scene.find(attached.link), now = links_now.find(attached.link);
  if (before == links_of_scene.end() || now == links_now.end()) {
    throw BadUsage("object '" + attached.object.id + "' is attached to '" + attached.link +
                   "', which is no link of the robot");
  }
  operation.object.pose = now->second * before->second.inverse() * operation.object.pose;
  return operation;
}

/* An id that comes twice: the later object takes the earlier one's place, which is hardly what was meant. */
void warnOfReplaced(const std::vector<Operation> &operations, Warnings &warnings) {
  std::set<std::string> there;
  for (const Operation &operation : operations) {
    const std::string &id = operation.object.id;
    if (operation.kind == Operation::Kind::REMOVE) {
      there.erase(id);
    } else if (operation.kind == Operation::Kind::ADD && !there.insert(id).second) {
      warnings.add("object '" + id + "' comes twice; the later one replaces the earlier");
    }
  }
}

SceneFile readSceneOf(const Arguments &arguments, Warnings &warnings) {
  return arguments.scene.empty() ? SceneFile() : readScene(arguments.scene, warnings);
}

/* All that the file says, in the fixed frame. */
SceneChange changeOf(const SceneFile &file, const Frames &frames, const LinkPoses &links_of_scene,
                     const LinkPoses &links_now, Warnings &warnings) {
  SceneChange change;
  for (const Operation &operation : file.operations) change.operations.push_back(toFixed(operation, frames));
  for (const AttachedObject &attached : file.attached) {
    change.operations.push_back(toFixed(attached, frames, links_of_scene, links_now));
  }
  warnOfReplaced(change.operations, warnings);

  /* without a robot there are no links to be padded */
  if (!links_now.empty()) change.link_padding = file.link_padding;
  change.allowed = file.allowed;
  return change;
}

void apply(Scene &scene, const SceneChange &change, const std::string &path) {
  const std::vector<std::string> faults = scene.apply(change);
  if (faults.empty()) return;
  const std::string more = faults.size() > 1 ? " (and " + std::to_string(faults.size() - 1) + " more)" : "";
  throw BadUsage(path + ": " + faults.front() + more);
}

std::vector<std::string> linksWithoutGeometry(const Robot &robot) {
  std::vector<std::string> out;
  for (const auto &[link, geometry] : robot.links()) {
    if (geometry.empty()) out.push_back("link '" + link + "': it has no collision geometry");
  }
  return out;
}

} // namespace

World readWorld(const Arguments &arguments, Warnings &warnings) {
  World world;
  const SceneFile file = readSceneOf(arguments, warnings);
  world.skipped = file.skipped;

  /* the robot, at the scene's state (which frames speak of) and at the state asked for */
  std::shared_ptr<const Robot> robot;
  std::set<std::string> fixed;
  LinkPoses links_of_scene;
  if (!arguments.robot.empty()) {
    robot = readRobot(arguments.robot);
    fixed.insert(robot->rootLink());
    if (!arguments.srdf.empty()) fixed.insert(readParentFrame(arguments.srdf));
    JointPositions joints = stateOfScene(file, *robot, warnings);
    const JointPositions asked = readState(arguments.state, *robot);
    try {
      links_of_scene = robot->linkPoses(joints);
      for (const auto &[joint, value] : asked) joints[joint] = value;
      world.links = robot->linkPoses(joints);
    } catch (const Error &e) {
      throw BadUsage(arguments.robot + ": " + e.what());
    }
    const std::vector<std::string> bare = linksWithoutGeometry(*robot);
    world.skipped.insert(world.skipped.end(), bare.begin(), bare.end());
  }

  const Frames frames(fixed, file.transforms, links_of_scene, warnings);
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.scene);
  resources.find_package = packageFinder(resources.base_dir);
  Scene scene(robot, resources);
  try {
    apply(scene, changeOf(file, frames, links_of_scene, world.links, warnings), arguments.scene);
  } catch (const BadUsage &e) {
    const std::string what = e.what();
    throw BadUsage(what.rfind(arguments.scene, 0) == 0 ? what : arguments.scene + ": " + what);
  }
  world.snapshot = scene.snapshot();
  return world;
}

} // namespace curve_proximity::cli
