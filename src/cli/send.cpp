/* SPDX-License-Identifier: BSD-3-Clause */
/* The only file of the command line that knows ROS. */
#include <curve_proximity/ApplyScene.h>
#include <ros/ros.h>

#include <chrono>
#include <thread>

#include "../ros/messages/scene_message.h"
#include "../scene/yaml/scene_change.h"
#include "commands.h"
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

/* How long a node that is just starting is waited for. */
constexpr std::chrono::seconds kPatience(5);

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
  SceneChange change = toChange(readScene(arguments.scene, warnings), arguments.scene, warnings);
  if (arguments.replace) change.clear = *arguments.replace;
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
  console.say("sent: " + std::to_string(change.operations.size() + change.attachments.size()) + " objects to " +
              arguments.node + (change.clear ? ", in the place of its scene" : ", in addition to its scene"));
  return kAllAnswered;
}

} // namespace curve_proximity::cli
