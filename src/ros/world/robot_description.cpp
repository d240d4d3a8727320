/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/robot_description.h"

#include <ros/console.h>
#include <ros/names.h>
#include <ros/package.h>
#include <ros/param.h>

namespace curve_proximity {
namespace {

/** A text in the parameter of that name, searched upwards. The search begins above the server's own namespace, where
 * the private parameter of the same name is that name and no text. Empty where there is none; a name that is not the
 * default must exist. */
std::string findText(const ros::NodeHandle &handle, const std::string &wanted, const std::string &by_default,
                     const char *parameter, const char *what, std::string &name) {
  const std::string above = ros::names::parentNamespace(handle.getNamespace());
  std::string text;
  if (!wanted.empty() && ros::param::search(above, wanted, name) && handle.getParam(name, text)) return text;
  if (!wanted.empty() && wanted != by_default)
    throw ParameterError(std::string("parameter ~") + parameter + ": there is no " + what + " in the parameter '" +
                         wanted + "'");
  return "";
}

std::shared_ptr<const Robot> parseRobot(const std::string &xml, const std::string &name, const Parameters &parameters) {
  // Geometry that is left out must never read as free space without a word.
  RobotOptions options;
  options.resources = resourceOptions(parameters.urdf_dir, parameters);
  options.allow_missing_geometry = parameters.allow_missing_geometry;
  std::shared_ptr<const Robot> robot;
  try {
    robot = Robot::fromUrdf(xml, options);
  } catch (const Error &error) {
    const std::string what = error.what();
    const bool relative = parameters.urdf_dir.empty() && what.find("the path is relative") != std::string::npos;
    throw Error("the URDF in '" + name + "': " + what +
                    (relative ? ": the parameter ~urdf_dir names the folder of such mesh files" : ""),
                error.status());
  }
  for (const std::string &warning : robot->warnings()) ROS_WARN("%s", warning.c_str());
  ROS_INFO("robot '%s' with %zu links from '%s'", robot->name().c_str(), robot->links().size(), name.c_str());
  return robot;
}

} // namespace

ResourceOptions resourceOptions(const std::string &base_dir, const Parameters &parameters) {
  ResourceOptions options;
  options.memory_limit = static_cast<std::size_t>(parameters.max_shape_mb) << 20;
  options.mesh_tolerance = parameters.mesh_tolerance;
  options.base_dir = base_dir;
  options.find_package = [](const std::string &package) { return ros::package::getPath(package); };
  return options;
}

Srdf loadSrdf(const ros::NodeHandle &handle, const Parameters &parameters) {
  std::string name;
  const std::string xml = findText(handle, parameters.robot_description_semantic,
                                   Parameters().robot_description_semantic, "robot_description_semantic", "SRDF", name);
  if (xml.empty()) {
    ROS_INFO("there is no %s: pairs of links that the SRDF would disable are checked",
             parameters.robot_description_semantic.c_str());
    return {};
  }
  try {
    return parseSrdf(xml);
  } catch (const Error &error) {
    throw Error("the SRDF in '" + name + "': " + error.what(), error.status());
  }
}

std::string robotText(const ros::NodeHandle &handle, const Parameters &parameters, std::string &name) {
  return findText(handle, parameters.robot_description, Parameters().robot_description, "robot_description", "URDF",
                  name);
}

std::shared_ptr<const Robot> loadRobot(const ros::NodeHandle &handle, const Parameters &parameters) {
  std::string name;
  const std::string xml = robotText(handle, parameters, name);
  if (xml.empty()) {
    ROS_INFO("there is no robot_description: this server knows objects only");
    return nullptr;
  }
  return parseRobot(xml, name, parameters);
}

std::map<std::string, FurtherRobot> loadFurtherRobots(const ros::NodeHandle &handle, const Parameters &parameters,
                                                      const std::shared_ptr<const Robot> &own, const Srdf &own_srdf) {
  std::map<std::string, FurtherRobot> out;
  const auto add = [&](const std::string &name, std::shared_ptr<const Robot> robot, const Srdf &srdf) {
    const Scene alone(robot, {}, allowedPairs(srdf));
    out[name] = {std::move(robot), srdf, alone.snapshot(), parameters.assumed_joints};
  };
  if (own) add("", own, own_srdf);
  for (const auto &[name, parameter] : parameters.robots) {
    if (name.empty()) throw ParameterError("parameter ~robots: a robot has no name");
    std::string where;
    const std::string urdf = findText(handle, parameter, "", "robots", "URDF", where);
    const std::string semantic = where + "_semantic";
    std::string srdf;
    handle.getParam(semantic, srdf);
    try {
      add(name, parseRobot(urdf, where, parameters), srdf.empty() ? Srdf() : parseSrdf(srdf));
    } catch (const Error &error) {
      throw Error("robot '" + name + "' of ~robots: " + error.what(), error.status());
    }
  }
  return out;
}

} // namespace curve_proximity
