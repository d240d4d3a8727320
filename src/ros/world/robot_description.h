/* SPDX-License-Identifier: BSD-3-Clause */
/** The robot that the server's parameters name. */
#ifndef CURVE_PROXIMITY_ROS_ROBOT_DESCRIPTION_H
#define CURVE_PROXIMITY_ROS_ROBOT_DESCRIPTION_H

#include <ros/node_handle.h>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <map>
#include <memory>
#include <string>

#include "parameters/parameters.h"

namespace curve_proximity {

/** Finds files of packages by rospack. */
ResourceOptions resourceOptions(const std::string &base_dir, const Parameters &parameters);

/** The URDF in the parameter that ~robot_description names, and the parameter's full name; "" where nobody has set it.
 */
std::string robotText(const ros::NodeHandle &handle, const Parameters &parameters, std::string &name);

/** The robot whose URDF stands in the parameter that ~robot_description names, searched upwards from the handle's
 *  namespace; null, with a line in the log, where nobody has set one.
 *  Throws ParameterError where a name was given but no URDF stands there, Error where the URDF is unusable. */
std::shared_ptr<const Robot> loadRobot(const ros::NodeHandle &handle, const Parameters &parameters);

/** A robot that requests name (RobotTrajectory.msg), and a scene of it alone. */
struct FurtherRobot {
  std::shared_ptr<const Robot> robot;
  Srdf srdf;
  SnapshotPtr alone;
  std::vector<std::string> assumed; /**< joints that are at 0 where nobody says where they are */
};

/** The robots of ~robots by name; that of the name '' is the server's own one, if it has one. A URDF stands in the
 *  parameter that ~robots gives, the SRDF in that of the same name with _semantic at its end; it may be missing. Throws
 *  as loadRobot(). */
std::map<std::string, FurtherRobot> loadFurtherRobots(const ros::NodeHandle &handle, const Parameters &parameters,
                                                      const std::shared_ptr<const Robot> &own, const Srdf &own_srdf);

/** The SRDF that ~robot_description_semantic names; an empty one where nobody has set it. Throws likewise. */
Srdf loadSrdf(const ros::NodeHandle &handle, const Parameters &parameters);

} // namespace curve_proximity
#endif
