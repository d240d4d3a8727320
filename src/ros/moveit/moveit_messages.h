/* SPDX-License-Identifier: BSD-3-Clause */
/** What the server speaks of moveit_msgs: generated of the definitions in src/ros/foreign. */
#ifndef CURVE_PROXIMITY_ROS_MOVEIT_MESSAGES_H
#define CURVE_PROXIMITY_ROS_MOVEIT_MESSAGES_H

#include <foreign/moveit_msgs/ContactInformation.h>
#include <foreign/moveit_msgs/DisplayTrajectory.h>
#include <foreign/moveit_msgs/GetPlanningScene.h>
#include <foreign/moveit_msgs/PlanningScene.h>
#include <foreign/moveit_msgs/RobotTrajectory.h>

namespace curve_proximity {

namespace moveit = moveit_msgs;

} // namespace curve_proximity
#endif
