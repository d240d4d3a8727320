/* SPDX-License-Identifier: BSD-3-Clause */
#include "certify_path.h"

#include <cmath>

#include "violation_message.h"

namespace curve_proximity {
namespace {

moveit::core::RobotState startOf(const CertifyPath::Request &req, const planning_scene::PlanningScene &scene) {
  const sensor_msgs::JointState &given = req.start_state;
  if (given.name.size() != given.position.size())
    throw Error("start_state has " + std::to_string(given.name.size()) + " names and " +
                std::to_string(given.position.size()) + " positions");
  moveit::core::RobotState out = scene.getCurrentState();
  out.dropDynamics(); // velocities that the trajectory does not have
  for (std::size_t i = 0; i < given.name.size(); ++i) out.setVariablePosition(given.name[i], given.position[i]);
  out.update();
  return out;
}

/* Of the whole robot: no group needs to have just these joints. */
robot_trajectory::RobotTrajectory toTrajectory(const CertifyPath::Request &req, const moveit::core::RobotState &start) {
  moveit_msgs::RobotTrajectory message;
  message.joint_trajectory = req.joint_trajectory;
  message.multi_dof_joint_trajectory = req.multi_dof_joint_trajectory;
  const moveit::core::RobotModel &model = *start.getRobotModel();
  for (const std::vector<std::string> &names :
       {message.joint_trajectory.joint_names, message.multi_dof_joint_trajectory.joint_names})
    for (const std::string &name : names)
      if (!model.hasJointModel(name)) throw Error("robot '" + model.getName() + "' has no joint '" + name + "'");
  for (const trajectory_msgs::JointTrajectoryPoint &point : message.joint_trajectory.points)
    if (point.positions.size() != message.joint_trajectory.joint_names.size())
      throw Error("a point has " + std::to_string(point.positions.size()) + " positions of " +
                  std::to_string(message.joint_trajectory.joint_names.size()) + " joints");
  robot_trajectory::RobotTrajectory out(start.getRobotModel(), nullptr);
  out.setRobotTrajectoryMsg(start, message);
  return out;
}

} // namespace

void certifyPath(const CertifyPath::Request &req, const planning_scene::PlanningScene &scene,
                 const Certifier &certifier, CertifyPath::Response &res) {
  res.scene = scene.getName();
  res.frame_id = scene.getPlanningFrame();
  try {
    if (!std::isfinite(req.clearance) || req.clearance < 0.0)
      throw Error("the clearance is " + std::to_string(req.clearance) + ": it must be finite and >= 0");
    CertifySettings settings;
    settings.clearance = req.clearance;
    const Finding finding = certifier.certify(scene, toTrajectory(req, startOf(req, scene)), settings);
    res.message = finding.why;
    res.warnings = finding.warnings;
    res.clear_until = finding.clear_until;
    for (const Doubt &doubt : finding.doubts) res.violations.push_back(toMessage(doubt));
    res.certified = finding.why.empty();
  } catch (const std::exception &error) {
    res.message = error.what();
  }
}

} // namespace curve_proximity
