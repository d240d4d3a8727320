/* SPDX-License-Identifier: BSD-3-Clause */
#include <cmath>

#include <curve_proximity/robot.hpp>

#include "joint_parts.h"

namespace curve_proximity {
namespace {

double valueOr(const JointPositions &positions, const std::string &name, double otherwise) {
  const auto it = positions.find(name);
  return it == positions.end() ? otherwise : it->second;
}

/* A motion in the plane through the origin with that normal. */
Eigen::Isometry3d planarMotion(const std::string &name, const Eigen::Vector3d &normal,
                               const JointPositions &positions) {
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = valueOr(positions, name + PLANAR_PARTS[i], 0.0);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const Eigen::Quaterniond to_plane = rotationBetween(Eigen::Vector3d::UnitZ(), normal);
  motion.linear() = Eigen::AngleAxisd(v[2], normal).toRotationMatrix();
  motion.translation() = to_plane * Eigen::Vector3d(v[0], v[1], 0.0);
  return motion;
}

Eigen::Isometry3d floatingMotion(const std::string &name, const JointPositions &positions) {
  double v[7];
  for (int i = 0; i < 7; ++i) v[i] = valueOr(positions, name + FLOATING_PARTS[i], 0.0);

  // A rotation of which nothing is said is none; of which a part is said, the rest is 0.
  bool rotated = false;
  for (int i = 3; i < 7; ++i) rotated = rotated || positions.count(name + FLOATING_PARTS[i]) > 0;
  if (!rotated) v[6] = 1.0;
  try {
    return toIsometry({{v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}});
  } catch (const Error &error) {
    throw Error("joint '" + name + "': " + error.what());
  }
}

} // namespace

bool Robot::hasJoint(const std::string &name) const {
  return joint_by_name_.count(name) > 0;
}

double Robot::value(const Joint &joint, const JointPositions &positions) const {
  if (joint.leader.empty()) return valueOr(positions, joint.name, joint.rest);
  const Joint &leader = joints_[joint_by_name_.at(joint.leader)];
  const double led = leader.type == JointType::FIXED ? 0.0 : valueOr(positions, leader.name, leader.rest);
  return joint.multiplier * led + joint.offset;
}

Eigen::Isometry3d Robot::motion(const Joint &joint, const JointPositions &positions) const {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  switch (joint.type) {
    case JointType::FIXED: break;
    case JointType::REVOLUTE:
      motion.linear() = Eigen::AngleAxisd(value(joint, positions), joint.axis).toRotationMatrix();
      break;
    case JointType::PRISMATIC: motion.translation() = value(joint, positions) * joint.axis; break;
    case JointType::PLANAR: motion = planarMotion(joint.name, joint.axis, positions); break;
    case JointType::FLOATING: motion = floatingMotion(joint.name, positions); break;
  }
  return motion;
}

void Robot::checkPositions(const JointPositions &positions) const {
  for (const auto &[name, value] : positions) {
    const auto it = joint_by_name_.find(name);
    if (it == joint_by_name_.end()) throw Error("joint '" + name + "' is no joint of robot '" + name_ + "'");
    const Joint &joint = joints_[it->second];
    if (!std::isfinite(value)) throw Error("the value of joint '" + name + "' is not finite");
    if (joint.name == name && joint.type == JointType::PLANAR) {
      throw Error("joint '" + name + "' is planar: give " + name + "/x, " + name + "/y and " + name + "/theta");
    }
    if (joint.name == name && joint.type == JointType::FLOATING) {
      throw Error("joint '" + name + "' is floating: give " + name + "/trans_x … " + name + "/rot_w");
    }
    if (!joint.leader.empty() && joint.type != JointType::FIXED && positions.count(joint.leader) == 0) {
      throw Error("joint '" + name + "' follows joint '" + joint.leader + "', of which no value is given");
    }
  }
}

LinkPoses Robot::linkPoses(const JointPositions &positions, const Eigen::Isometry3d &base) const {
  checkPositions(positions);
  LinkPoses poses;
  poses.emplace(root_link_, base);
  for (const Joint &joint : joints_) {
    poses.emplace(joint.child, poses.at(joint.parent) * joint.origin * motion(joint, positions));
  }
  return poses;
}

} // namespace curve_proximity
