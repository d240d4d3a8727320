/* SPDX-License-Identifier: BSD-3-Clause */
/** moveit_msgs/RobotTrajectory and DisplayTrajectory as what the queries take. Needs no node and no master. */
#ifndef CURVE_PROXIMITY_ROS_ROBOT_TRAJECTORY_H
#define CURVE_PROXIMITY_ROS_ROBOT_TRAJECTORY_H

#include <curve_proximity/Proximity.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <optional>
#include <string>
#include <vector>

#include "moveit/moveit_messages.h"

namespace curve_proximity {

/** Motions of the robot, one after the other. */
struct RobotMotions {
  std::vector<trajectory_msgs::JointTrajectory> trajectories;
  sensor_msgs::JointState start;    /**< joints that no trajectory names */
  std::vector<std::string> remarks; /**< what is not used, or is not as the message says */
  Coverage coverage;                /**< those of them that can make an answer wrong */
};

/** Both parts as one trajectory of joints: a planar or floating joint by its variables. Joints that the robot does not
 *  have are left out, with a remark. Where both parts move joints, their points must be as many and at the same times,
 *  and all joints go straight from point to point, as those of the multi-DOF part do; velocities that are not used are
 *  missing in the coverage. Throws Error: a scene without a
 *  robot, no joint of the robot, parts that do not fit, and what toJointTrajectory() refuses. */
RobotMotions toMotions(const moveit::RobotTrajectory &message, const Snapshot &snapshot, const Srdf &srdf);

/** Each trajectory begins with the joints where the one before has left them; before the first they stand as
 *  trajectory_start says. What that state carries and the scene does not is missing in the coverage. */
RobotMotions toMotions(const moveit::DisplayTrajectory &message, const Snapshot &snapshot, const Srdf &srdf);

/** Nothing for a row that is clear, or, where it has no verdict, farther than `epsilon` [m]. A row that is violated, or
 *  without a verdict at most `epsilon` away, is a contact in the middle of the witness points. Its depth is minus the
 *  distance: below 0 for what is apart, but within the limit of a tolerance query. Of any other row nothing is proven:
 *  its second body is '<' + the status + '>', such as "<stale>", or "<undecided>", and all numbers are 0. */
std::optional<moveit::ContactInformation> toContact(const Proximity &row, double epsilon, const Snapshot &snapshot);

} // namespace curve_proximity
#endif
