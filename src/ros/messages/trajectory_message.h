/* SPDX-License-Identifier: BSD-3-Clause */
/** Joint values, joint trajectories and the ways of objects. */
#ifndef CURVE_PROXIMITY_ROS_TRAJECTORY_MESSAGE_H
#define CURVE_PROXIMITY_ROS_TRAJECTORY_MESSAGE_H

#include <curve_proximity/PoseTrajectory.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <curve_proximity/scene.hpp>
#include <curve_proximity/trajectory.hpp>
#include <string>

namespace curve_proximity {

/** Throws Error where names and positions are not as many, or a joint is named twice. */
JointPositions toJointPositions(const sensor_msgs::JointState &state);

/** A joint trajectory. Where its first point comes after 0 and `now` has all of its joints, it begins at 0 with the way
 *  from there: at rest if that point has velocities, without acceleration if it has accelerations. Times that are all 0
 *  become 0, 1, 2 …, and `remark` says so. A point that repeats the one before it, time included, is left out. */
TrajectoryDescription toDescription(const trajectory_msgs::JointTrajectory &trajectory, const JointPositions &now,
                                    std::string &remark);

/** The way of an object that moves. Throws Error, which names the waypoint: a time that is not finite, a pose that is
 *  none; an unknown turning, a tolerance below 0. */
ObjectTrajectory toTrajectory(const PoseTrajectory &message);
PoseTrajectory toMessage(const ObjectTrajectory &trajectory);

/** [s] of a start; infinity: any time. Throws Error for a tolerance below 0. */
double toStartTolerance(double tolerance, bool any_time);

} // namespace curve_proximity
#endif
