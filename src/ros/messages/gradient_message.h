/* SPDX-License-Identifier: BSD-3-Clause */
/** Gradients as messages. */
#ifndef CURVE_PROXIMITY_ROS_GRADIENT_MESSAGE_H
#define CURVE_PROXIMITY_ROS_GRADIENT_MESSAGE_H

#include <curve_proximity/Gradient.h>
#include <geometry_msgs/Twist.h>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/query.hpp>
#include <vector>

namespace curve_proximity {

/** By a shift and a turn. */
geometry_msgs::Twist toTwistMessage(const Eigen::Vector3d &linear, const Eigen::Vector3d &angular);

/** A matrix row by row. */
std::vector<double> toList(const Eigen::MatrixXd &matrix);

/** Of a curve. */
Gradient toMessage(const CurveGradient &gradient);

/** Of a motion along these points, of these joints. */
Gradient toMessage(const ClearanceGradient &gradient, const TrajectoryDescription &trajectory);

} // namespace curve_proximity
#endif
