/* SPDX-License-Identifier: BSD-3-Clause */
/** The action control_msgs/FollowJointTrajectory by its published definition: control_msgs itself need not be
 * installed. */
#ifndef CURVE_PROXIMITY_ROS_FOLLOW_JOINT_TRAJECTORY_H
#define CURVE_PROXIMITY_ROS_FOLLOW_JOINT_TRAJECTORY_H

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatus.h>
#include <ros/duration.h>
#include <std_msgs/Header.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/foreign_message.h"

namespace curve_proximity::control {

struct JointTolerance {
  std::string name;
  double position = 0.0, velocity = 0.0, acceleration = 0.0;
};

struct FollowJointTrajectoryGoal {
  trajectory_msgs::JointTrajectory trajectory;
  std::vector<JointTolerance> path_tolerance, goal_tolerance;
  ros::Duration goal_time_tolerance;
};

struct FollowJointTrajectoryResult {
  static constexpr std::int32_t INVALID_GOAL = -1, PATH_TOLERANCE_VIOLATED = -4;
  std::int32_t error_code = 0;
  std::string error_string;
};

struct FollowJointTrajectoryFeedback {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  trajectory_msgs::JointTrajectoryPoint desired, actual, error;
};

struct FollowJointTrajectoryActionGoal {
  using _goal_type = FollowJointTrajectoryGoal;
  std_msgs::Header header;
  actionlib_msgs::GoalID goal_id;
  _goal_type goal;
};

struct FollowJointTrajectoryActionResult {
  using _result_type = FollowJointTrajectoryResult;
  std_msgs::Header header;
  actionlib_msgs::GoalStatus status;
  _result_type result;
};

struct FollowJointTrajectoryActionFeedback {
  using _feedback_type = FollowJointTrajectoryFeedback;
  std_msgs::Header header;
  actionlib_msgs::GoalStatus status;
  _feedback_type feedback;
};

struct FollowJointTrajectoryAction {
  using _action_goal_type = FollowJointTrajectoryActionGoal;
  using _action_result_type = FollowJointTrajectoryActionResult;
  using _action_feedback_type = FollowJointTrajectoryActionFeedback;
  _action_goal_type action_goal;
  _action_result_type action_result;
  _action_feedback_type action_feedback;
};

} // namespace curve_proximity::control

/* Definitions are left out: tools look them up by name. */
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::JointTolerance, name, position, velocity, acceleration)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryGoal, trajectory, path_tolerance,
                                   goal_tolerance, goal_time_tolerance)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryResult, error_code, error_string)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryFeedback, header, joint_names,
                                   desired, actual, error)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryActionGoal, header, goal_id, goal)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryActionResult, header, status, result)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::control::FollowJointTrajectoryActionFeedback, header, status,
                                   feedback)

CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryGoal,
                               "control_msgs/FollowJointTrajectoryGoal", "69636787b6ecbde4d61d711979bc7ecb", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryResult,
                               "control_msgs/FollowJointTrajectoryResult", "493383b18409bfb604b4e26c676401d2", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryFeedback,
                               "control_msgs/FollowJointTrajectoryFeedback", "10817c60c2486ef6b33e97dcd87f4474", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryActionGoal,
                               "control_msgs/FollowJointTrajectoryActionGoal", "cff5c1d533bf2f82dd0138d57f4304bb", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryActionResult,
                               "control_msgs/FollowJointTrajectoryActionResult", "c4fb3b000dc9da4fd99699380efcc5d9", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryActionFeedback,
                               "control_msgs/FollowJointTrajectoryActionFeedback", "d8920dc4eae9fc107e00999cce4be641",
                               "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::control::FollowJointTrajectoryAction,
                               "control_msgs/FollowJointTrajectoryAction", "bc4f9b743838566551c0390c65f1a248", "")
#endif
