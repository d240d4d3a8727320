/* SPDX-License-Identifier: BSD-3-Clause */
/* The only file of the command line that knows ROS. */
#include <curve_proximity/ApplyScene.h>
#include <ros/ros.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "../ros/conversions.h"
#include "failure.h"
#include "frames.h"
#include "robot_file.h"
#include "scene_yaml.h"
#include "verbs.h"

namespace curve_proximity::cli {
namespace {

/* How long a node that is just starting is waited for. */
constexpr std::chrono::seconds kPatience(5);

/* Frames that only the node's tf2 knows stay as they are; those that the file itself explains are resolved. */
void resolveFrame(ObjectDescription &object, const Frames &frames) {
  if (!frames.knows(object.frame)) return;
  object.pose = frames.find(object.frame) * object.pose;
  object.frame.clear();
}

/* The node does not know the folder that paths in the file are relative to. */
void makeResourcesAbsolute(ObjectDescription &object, const std::string &folder) {
  for (ShapeDescription &shape : object.shapes) {
    const bool relative = !shape.resource.empty() && shape.resource.find("://") == std::string::npos &&
                          std::filesystem::path(shape.resource).is_relative();
    if (relative) shape.resource = (std::filesystem::path(folder) / shape.resource).string();
  }
}

SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings) {
  const Frames frames({}, file.transforms, {}, warnings);
  SceneChange change;
  change.operations = file.operations;
  for (const AttachedObject &attached : file.attached) {
    warnings.add("object '" + attached.object.id + "' is attached to '" + attached.link +
                 "'; in the node it stands still where the link is now");
    change.operations.push_back({Operation::Kind::ADD, attached.object});
  }
  for (Operation &operation : change.operations) {
    try {
      resolveFrame(operation.object, frames);
    } catch (const BadInput &e) {
      throw BadUsage(path + ": object '" + operation.object.id + "': " + e.what());
    }
    makeResourcesAbsolute(operation.object, folderOf(path));
  }
  change.link_padding = file.link_padding;
  change.allowed = file.allowed;
  return change;
}

/* As ros::service::waitForService(), which would tell standard output that it waits. */
bool waitForService(const std::string &service) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (ros::ok() && !ros::service::exists(service, false)) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return ros::ok();
}

} // namespace

int sendScene(const Arguments &arguments, Console &console) {
  /* the file first: what is wrong with it needs no node */
  Warnings warnings;
  const SceneChange change = toChange(readScene(arguments.scene, warnings), arguments.scene, warnings);
  console.warn(warnings);

  ros::init(ros::M_string(), "cprox_send", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  if (!ros::master::check()) throw BadUsage("send: no ROS master at " + ros::master::getURI());
  ros::NodeHandle handle;
  const std::string service = arguments.node + "/apply_scene";
  if (!waitForService(service)) {
    throw BadUsage("send: there is no service " + service + " (is the node called otherwise? --node NAME)");
  }

  /* one call, all or nothing */
  ApplyScene call;
  call.request = toMessage(change);
  if (!ros::service::call(service, call)) throw BadUsage("send: the call of " + service + " failed");
  if (!call.response.success) throw BadUsage("send: " + service + ": " + call.response.message);
  console.say("sent: " + std::to_string(change.operations.size()) + " objects to " + arguments.node);
  return kAllAnswered;
}

} // namespace curve_proximity::cli
