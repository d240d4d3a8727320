/* SPDX-License-Identifier: BSD-3-Clause */
/** The action control_msgs/FollowJointTrajectory: generated of the definitions in src/ros/foreign. */
#ifndef CURVE_PROXIMITY_ROS_FOLLOW_JOINT_TRAJECTORY_H
#define CURVE_PROXIMITY_ROS_FOLLOW_JOINT_TRAJECTORY_H

#include <foreign/control_msgs/FollowJointTrajectoryAction.h>

namespace curve_proximity {

namespace control = control_msgs;

} // namespace curve_proximity
#endif
