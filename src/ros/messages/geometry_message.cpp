/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/geometry_message.h"

#include <cmath>

namespace curve_proximity {
namespace {

template <class Message>
Message messageOf(const Eigen::Vector3d &v) {
  Message message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

template <class Position>
Eigen::Isometry3d isometry(const Position &p, const geometry_msgs::Quaternion &q) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) throw Error("the position is not finite");
  return toIsometry(cprox_pose{{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}});
}

} // namespace

Eigen::Isometry3d toIsometry(const geometry_msgs::Pose &pose) {
  return isometry(pose.position, pose.orientation);
}

Eigen::Isometry3d toIsometry(const geometry_msgs::Transform &transform) {
  return isometry(transform.translation, transform.rotation);
}

std::string withoutSlash(const std::string &frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

geometry_msgs::Pose toMessage(const Eigen::Isometry3d &pose) {
  const cprox_pose p = toPose(pose);
  geometry_msgs::Pose message;
  message.position = toPointMessage(p.position);
  message.orientation.w = p.orientation.w;
  message.orientation.x = p.orientation.x;
  message.orientation.y = p.orientation.y;
  message.orientation.z = p.orientation.z;
  return message;
}

bool isUnset(const geometry_msgs::Pose &pose) {
  const geometry_msgs::Point &p = pose.position;
  const geometry_msgs::Quaternion &q = pose.orientation;
  return p.x == 0 && p.y == 0 && p.z == 0 && q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0;
}

geometry_msgs::Point toPointMessage(const Eigen::Vector3d &point) {
  return messageOf<geometry_msgs::Point>(point);
}

geometry_msgs::Point toPointMessage(const cprox_vec3 &point) {
  return toPointMessage(toEigen(point));
}

geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d &vector) {
  return messageOf<geometry_msgs::Vector3>(vector);
}

void fillPoints(const std::vector<geometry_msgs::Point> &points, Eigen::Matrix3Xd &out) {
  out.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y, points[i].z;
}

Eigen::Matrix3Xd toPoints(const std::vector<geometry_msgs::Point> &points) {
  Eigen::Matrix3Xd out;
  fillPoints(points, out);
  return out;
}

std::vector<geometry_msgs::Point> toPointMessages(const Eigen::Matrix3Xd &points) {
  std::vector<geometry_msgs::Point> out;
  out.reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) out.push_back(toPointMessage(Eigen::Vector3d(points.col(i))));
  return out;
}

} // namespace curve_proximity
