/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "robot/free_joints.h"

namespace curve_proximity {
namespace {

/* One of a point's three lists: all joints, or none where it may be missing. */
void checkList(const TrajectoryDescription &trajectory, std::size_t i, const char *what,
               const std::vector<double> &values, bool needed) {
  const std::string place = "point " + std::to_string(i) + ": ";
  if (values.empty() && !needed) return;
  if (values.size() != trajectory.joints.size()) {
    throw Error(place + "has " + std::to_string(values.size()) + " " + what + " for " +
                std::to_string(trajectory.joints.size()) + " joints");
  }
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) {
      throw Error(place + "the entry of '" + trajectory.joints[k] + "' in " + what + " is not finite");
    }
  }
}

/* Degree, knots and control points of a B-spline. */
void checkSpline(const TrajectoryDescription &trajectory) {
  const std::size_t n = trajectory.points.size(), degree = trajectory.degree;
  for (std::size_t i = 0; i < n; ++i) checkList(trajectory, i, "positions", trajectory.points[i].positions, true);
  if (n <= degree)
    throw Error("a spline of degree " + std::to_string(degree) + " needs at least " + std::to_string(degree + 1) +
                " control points, got " + std::to_string(n));
  if (trajectory.knots.size() != n + degree + 1)
    throw Error(std::to_string(n) + " control points of degree " + std::to_string(degree) + " need " +
                std::to_string(n + degree + 1) + " knots, got " + std::to_string(trajectory.knots.size()));
}

/* The virtual joint of that name becomes the base; the names of its variables. */
std::vector<std::string> baseVariables(const FreeJoint &joint, const std::vector<VirtualJoint> &joints,
                                       TrajectoryDescription &trajectory) {
  if (!joint.is_virtual) return variablesOf(joint);
  if (trajectory.base.empty())
    for (const VirtualJoint &candidate : joints)
      if (candidate.name == joint.name && trajectory.base.empty()) trajectory.base.push_back(candidate);
  if (trajectory.base.front().name != joint.name)
    throw Error("the trajectory moves two bases: '" + trajectory.base.front().name + "' and '" + joint.name + "'");
  return trajectory.base_joints.empty() ? variablesOf(joint) : trajectory.base_joints;
}

/* Columns for the values of further joints, straight from point to point. */
void addColumns(const std::vector<std::string> &names, const std::vector<std::vector<double>> &values,
                TrajectoryDescription &trajectory) {
  if (trajectory.degree > 0) throw Error("a spline of joint values does not go with poses of joints at points");
  if (values.size() != trajectory.points.size())
    throw Error("joint_trajectory has " + std::to_string(trajectory.points.size()) +
                " points, multi_dof_joint_trajectory has " + std::to_string(values.size()));
  bool smooth = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    TrajectoryPoint &point = trajectory.points[i];
    checkList(trajectory, i, "positions", point.positions, true);
    smooth = smooth || !point.velocities.empty() || !point.accelerations.empty();
    point.velocities.clear();
    point.accelerations.clear();
    point.positions.insert(point.positions.end(), values[i].begin(), values[i].end());
  }
  trajectory.joints.insert(trajectory.joints.end(), names.begin(), names.end());
  if (smooth && trajectory.interpolation != Interpolation::LINEAR)
    trajectory.coverage.add(Gap::PARTIAL,
                            "where a base moves by poses, all joints go straight from point to point: velocities are "
                            "not used (interpolation: linear says that this is meant)");
  trajectory.interpolation = Interpolation::LINEAR;
}

void takeFree(const FreeJointPoses &given, const std::vector<VirtualJoint> &joints, const Robot &robot,
              TrajectoryDescription &trajectory) {
  const std::vector<VirtualJoint> &all = trajectory.base.empty() ? joints : trajectory.base;
  const std::optional<FreeJoint> joint = resolveFreeJoint(given, robot, all);
  if (!joint) return;
  const std::vector<std::vector<double>> values = valuesAt(given.poses, *joint);
  const std::vector<std::string> names = baseVariables(*joint, joints, trajectory);
  const bool stands =
      std::all_of(values.begin(), values.end(), [&](const std::vector<double> &row) { return row == values.front(); });
  const bool counts = given.poses.size() == trajectory.points.size() || given.poses.size() == 1;
  if (!(stands && counts && !trajectory.joints.empty())) return addColumns(names, values, trajectory);
  for (std::size_t k = 0; k < names.size(); ++k) trajectory.fixed_joints.emplace(names[k], values.front()[k]);
}

} // namespace

void adoptBase(const std::vector<VirtualJoint> &joints, const Robot &robot, TrajectoryDescription &trajectory) {
  for (const FreeJointPoses &given : trajectory.free_joints) takeFree(given, joints, robot, trajectory);
  trajectory.free_joints.clear();
  for (const VirtualJoint &joint : joints) {
    for (const std::string &name : trajectory.joints) {
      if (trajectory.base.empty() && name.rfind(joint.name + "/", 0) == 0) trajectory.base.push_back(joint);
    }
  }
}

Eigen::Isometry3d placeOf(const TrajectoryDescription &trajectory, const Eigen::Isometry3d &base,
                          JointPositions &rest) {
  if (trajectory.base.empty() || trajectory.base.front().type == "fixed") return base;
  const VirtualJoint &joint = trajectory.base.front();
  const FreeJoint free{joint.name, joint.type == "planar", joint.parent_frame, true};
  const std::vector<std::string> names = trajectory.base_joints.empty() ? variablesOf(free) : trajectory.base_joints;
  const std::vector<double> values = valuesAt({toPose(base)}, free).front();
  for (std::size_t k = 0; k < names.size(); ++k) rest.emplace(names[k], values[k]);
  return Eigen::Isometry3d::Identity();
}

void checkTrajectory(const TrajectoryDescription &trajectory) {
  if (trajectory.joints.empty() && trajectory.free_joints.empty()) throw Error("the trajectory names no joints");
  if (trajectory.points.empty()) throw Error("the trajectory has no points");
  std::set<std::string> names;
  for (const std::string &joint : trajectory.joints) {
    if (!names.insert(joint).second) throw Error("joint '" + joint + "' is named twice");
  }

  if (trajectory.degree > 0) return checkSpline(trajectory);
  if (!trajectory.knots.empty()) throw Error("a trajectory through waypoints has no knots");
  const Interpolation kind = trajectory.interpolation;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const TrajectoryPoint &point = trajectory.points[i];
    checkList(trajectory, i, "positions", point.positions, true);
    checkList(trajectory, i, "velocities", point.velocities,
              kind == Interpolation::CUBIC || kind == Interpolation::QUINTIC);
    checkList(trajectory, i, "accelerations", point.accelerations, kind == Interpolation::QUINTIC);
    if (!std::isfinite(point.time)) throw Error("point " + std::to_string(i) + ": its time is not finite");
    if (i > 0 && !(point.time > trajectory.points[i - 1].time)) {
      throw Error("point " + std::to_string(i) + ": its time " + std::to_string(point.time) + " s is not after point " +
                  std::to_string(i - 1) + " at " + std::to_string(trajectory.points[i - 1].time) + " s");
    }
  }
}

} // namespace curve_proximity
