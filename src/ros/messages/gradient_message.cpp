/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/gradient_message.h"

#include "messages/geometry_message.h"

namespace curve_proximity {

geometry_msgs::Twist toTwistMessage(const Eigen::Vector3d &linear, const Eigen::Vector3d &angular) {
  geometry_msgs::Twist message;
  message.linear = toVectorMessage(linear);
  message.angular = toVectorMessage(angular);
  return message;
}

std::vector<double> toList(const Eigen::MatrixXd &matrix) {
  std::vector<double> list;
  list.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) list.push_back(matrix(i, k));
  return list;
}

Gradient toMessage(const CurveGradient &gradient) {
  Gradient message;
  message.valid = gradient.valid;
  message.message = gradient.reason;
  for (Eigen::Index i = 0; i < gradient.points.cols(); ++i)
    message.points.push_back(toVectorMessage(gradient.points.col(i)));
  message.parameters.assign(gradient.parameters.data(), gradient.parameters.data() + gradient.parameters.size());
  message.range = {gradient.range_start, gradient.range_end};
  message.radius = gradient.radius;
  message.moving = toTwistMessage(gradient.linear, gradient.angular);
  message.obstacle = toTwistMessage(gradient.object_linear, gradient.object_angular);
  return message;
}

Gradient toMessage(const ClearanceGradient &gradient, const TrajectoryDescription &trajectory) {
  Gradient message;
  message.valid = gradient.valid;
  message.message = gradient.reason;
  message.joints = trajectory.joints;
  for (const TrajectoryPoint &point : trajectory.points) message.times.push_back(point.time);
  message.positions = toList(gradient.positions);
  message.velocities = toList(gradient.velocities);
  message.accelerations = toList(gradient.accelerations);
  message.duration = gradient.duration;
  message.start = gradient.start;
  message.moving = toTwistMessage(gradient.base_linear, gradient.base_angular);
  message.obstacle = toTwistMessage(gradient.object_linear, gradient.object_angular);
  return message;
}

} // namespace curve_proximity
