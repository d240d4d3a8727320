/* SPDX-License-Identifier: BSD-3-Clause */
/** Points and poses of geometry_msgs, both ways. */
#ifndef CURVE_PROXIMITY_ROS_GEOMETRY_MESSAGE_H
#define CURVE_PROXIMITY_ROS_GEOMETRY_MESSAGE_H

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

#include <curve_proximity/core.hpp>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace curve_proximity {

/** Throws Error for a quaternion of norm 0 or a number that is not finite. */
Eigen::Isometry3d toIsometry(const geometry_msgs::Pose &pose);
Eigen::Isometry3d toIsometry(const geometry_msgs::Transform &transform);
geometry_msgs::Pose toMessage(const Eigen::Isometry3d &pose);

/** A message that nobody filled in has zeros everywhere. */
bool isUnset(const geometry_msgs::Pose &pose);

geometry_msgs::Point toPointMessage(const Eigen::Vector3d &point);
geometry_msgs::Point toPointMessage(const cprox_vec3 &point);
geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d &vector);

/** tf2 knows no leading slash; users of tf still write it. */
std::string withoutSlash(const std::string &frame);

/** Points are the columns; fillPoints() in the memory of another matrix. */
Eigen::Matrix3Xd toPoints(const std::vector<geometry_msgs::Point> &points);
void fillPoints(const std::vector<geometry_msgs::Point> &points, Eigen::Matrix3Xd &out);
std::vector<geometry_msgs::Point> toPointMessages(const Eigen::Matrix3Xd &points);

} // namespace curve_proximity
#endif
