/* SPDX-License-Identifier: BSD-3-Clause */
#include "free_joints.h"

#include <algorithm>
#include <cmath>

#include "joint_parts.h"

namespace curve_proximity {
namespace {

std::string bare(const std::string &frame) {
  return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame;
}

bool isIdentity(const cprox_pose &pose) {
  const cprox_quat &q = pose.orientation;
  const cprox_vec3 &p = pose.position;
  return p.x == 0.0 && p.y == 0.0 && p.z == 0.0 && q.w != 0.0 && q.x == 0.0 && q.y == 0.0 && q.z == 0.0;
}

} // namespace

std::optional<FreeJoint> findFreeJoint(const std::string &name, const Robot &robot,
                                       const std::vector<VirtualJoint> &virtual_joints) {
  for (const VirtualJoint &joint : virtual_joints)
    if (joint.name == name && joint.type != "fixed")
      return FreeJoint{name, joint.type == "planar", joint.parent_frame, true};
  for (const Robot::Joint &joint : robot.joints()) {
    if (joint.name != name) continue;
    if (joint.type == Robot::JointType::FLOATING) return FreeJoint{name, false, joint.parent, false};
    if (joint.type == Robot::JointType::PLANAR)
      return FreeJoint{name, true, joint.parent, false, joint.axis == Eigen::Vector3d::UnitZ()};
  }
  return std::nullopt;
}

std::vector<std::string> variablesOf(const FreeJoint &joint) {
  std::vector<std::string> out;
  if (joint.planar)
    for (const char *part : PLANAR_PARTS) out.push_back(joint.name + part);
  else
    for (const char *part : FLOATING_PARTS) out.push_back(joint.name + part);
  return out;
}

Eigen::Quaterniond rotationOf(const cprox_pose &pose, const std::string &where, const Eigen::Quaterniond &before) {
  Eigen::Quaterniond q(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  const double norm = q.coeffs().stableNorm();
  if (!(norm > 0.0 && std::isfinite(norm))) throw Error(where + ": the quaternion's norm is " + std::to_string(norm));
  q.coeffs() /= norm;
  if (q.coeffs().dot(before.coeffs()) < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

std::vector<std::vector<double>> valuesAt(const std::vector<cprox_pose> &poses, const FreeJoint &joint) {
  constexpr double FLAT = 1e-6; /* a rotation out of the plane by more than twice this [rad] is no planar joint's */
  std::vector<std::vector<double>> out;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  double theta = 0.0;
  for (const cprox_pose &pose : poses) {
    const std::string where = "point " + std::to_string(out.size()) + ", joint '" + joint.name + "'";
    const Eigen::Vector3d p = toEigen(pose.position);
    if (!p.allFinite()) throw Error(where + ": the translation is not finite");
    if (!joint.flat && !isIdentity(pose))
      throw Error(where + ": the joint's plane is not that of x and y: give the values of its variables");
    q = rotationOf(pose, where, q);
    if (!joint.planar) {
      out.push_back({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
      continue;
    }
    if (std::hypot(q.x(), q.y()) > FLAT || std::abs(p.z()) > FLAT)
      throw Error(where + ": the transform leaves the joint's plane");
    const double turn = 2.0 * std::atan2(q.z(), q.w());
    theta += std::remainder(turn - theta, 2.0 * M_PI);
    out.push_back({p.x(), p.y(), theta});
  }
  return out;
}

std::optional<FreeJoint> resolveFreeJoint(const FreeJointPoses &given, const Robot &robot,
                                          const std::vector<VirtualJoint> &virtual_joints) {
  const bool moved = !std::all_of(given.poses.begin(), given.poses.end(), isIdentity);
  std::optional<FreeJoint> joint = findFreeJoint(given.joint, robot, virtual_joints);
  if (!joint) {
    if (!moved) return std::nullopt;
    throw Error("joint '" + given.joint + "' is not at the identity, and it is neither a planar or floating joint of " +
                "robot '" + robot.name() + "' nor a virtual joint of that kind in its SRDF" +
                (virtual_joints.empty() ? ": is the SRDF given?" : ""));
  }
  const std::string frame = bare(given.frame);
  if (moved && !frame.empty() && !joint->parent.empty() && frame != bare(joint->parent))
    throw Error("joint '" + given.joint + "': its poses are in frame '" + frame + "', it moves in '" + joint->parent +
                "'");
  return joint;
}

} // namespace curve_proximity
