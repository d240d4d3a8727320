/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_description.h"

#include <ros/console.h>
#include <ros/names.h>
#include <ros/package.h>
#include <ros/param.h>

namespace curve_proximity {

ResourceOptions resourceOptions(const std::string &base_dir) {
  ResourceOptions options;
  options.base_dir = base_dir;
  options.find_package = [](const std::string &package) { return ros::package::getPath(package); };
  return options;
}

std::shared_ptr<const Robot> loadRobot(const ros::NodeHandle &handle, const Parameters &parameters) {
  // Where the URDF is; the default name may be missing, one that was given may not.
  // The search begins above the server's own namespace, where ~robot_description is that name and no URDF.
  const std::string above = ros::names::parentNamespace(handle.getNamespace());
  std::string name, xml;
  const bool found = !parameters.robot_description.empty() &&
                     ros::param::search(above, parameters.robot_description, name) && handle.getParam(name, xml);
  if (!found) {
    const bool by_default =
        parameters.robot_description.empty() || parameters.robot_description == Parameters().robot_description;
    if (!by_default)
      throw ParameterError("parameter ~robot_description: there is no URDF in the parameter '" +
                           parameters.robot_description + "'");
    ROS_INFO("there is no robot_description: this server knows objects only");
    return nullptr;
  }

  // Geometry that is left out must never read as free space without a word.
  RobotOptions options;
  options.resources = resourceOptions(parameters.urdf_dir);
  options.allow_missing_geometry = parameters.allow_missing_geometry;
  std::shared_ptr<const Robot> robot;
  try {
    robot = Robot::fromUrdf(xml, options);
  } catch (const Error &error) {
    throw Error("the URDF in '" + name + "': " + error.what(), error.status());
  }
  for (const std::string &warning : robot->warnings()) ROS_WARN("%s", warning.c_str());
  ROS_INFO("robot '%s' with %zu links from '%s'", robot->name().c_str(), robot->links().size(), name.c_str());
  return robot;
}

} // namespace curve_proximity
