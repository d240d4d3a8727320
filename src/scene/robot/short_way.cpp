/* SPDX-License-Identifier: BSD-3-Clause */
#include "short_way.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "joint_parts.h"

namespace curve_proximity {
namespace {

/* More than this [rad] is the long way: half a turn, and what printing it with a few digits costs. */
constexpr double HALF_TURN = M_PI + 1e-6;

double step(const TrajectoryDescription &trajectory, std::size_t point, std::size_t column) {
  return trajectory.points[point].positions[column] - trajectory.points[point - 1].positions[column];
}

bool goesLong(const TrajectoryDescription &trajectory, std::size_t column) {
  for (std::size_t i = 1; i < trajectory.points.size(); ++i)
    if (std::abs(step(trajectory, i, column)) > HALF_TURN) return true;
  return false;
}

bool isContinuous(const Robot::Joint &joint) {
  return joint.type == Robot::JointType::REVOLUTE && joint.leader.empty() && std::isinf(joint.lower) &&
         std::isinf(joint.upper);
}

/* What a value after a whole turn is the same as before: a continuous joint, the angle of a planar one. */
bool turnsFreely(const std::string &name, const Robot &robot, const TrajectoryDescription &trajectory) {
  for (const VirtualJoint &base : trajectory.base) {
    if (base.type != "planar") continue;
    if (name == (trajectory.base_joints.empty() ? base.name + PLANAR_PARTS[2] : trajectory.base_joints[2])) return true;
  }
  return std::any_of(robot.joints().begin(), robot.joints().end(), [&](const Robot::Joint &joint) {
    if (joint.type == Robot::JointType::PLANAR) return name == joint.name + PLANAR_PARTS[2];
    return name == joint.name && isContinuous(joint);
  });
}

/* The columns that go the long way at least once; none where a point lacks a value, which checkTrajectory() refuses. */
std::vector<std::size_t> longColumns(const Robot &robot, const TrajectoryDescription &trajectory) {
  std::vector<std::size_t> out;
  for (const TrajectoryPoint &point : trajectory.points)
    if (point.positions.size() != trajectory.joints.size()) return out;
  for (std::size_t k = 0; k < trajectory.joints.size(); ++k)
    if (goesLong(trajectory, k) && turnsFreely(trajectory.joints[k], robot, trajectory)) out.push_back(k);
  return out;
}

} // namespace

std::vector<std::string> longWays(const Robot &robot, const TrajectoryDescription &trajectory) {
  std::vector<std::string> out;
  if (trajectory.degree > 0 || trajectory.shortest_way) return out;
  for (const std::size_t column : longColumns(robot, trajectory)) {
    std::size_t first = 0, times = 0;
    for (std::size_t i = 1; i < trajectory.points.size(); ++i)
      if (std::abs(step(trajectory, i, column)) > HALF_TURN && times++ == 0) first = i;
    const double turn = step(trajectory, first, column);
    char text[160];
    std::snprintf(text, sizeof text, "turns by %.4g rad from point %zu to point %zu; the short way is %.4g rad", turn,
                  first - 1, first, std::remainder(turn, 2.0 * M_PI));
    out.push_back("continuous joint '" + trajectory.joints[column] + "' " + text +
                  (times > 1 ? " (" + std::to_string(times) + " times in all)" : ""));
  }
  return out;
}

void takeShortWays(const Robot &robot, TrajectoryDescription &trajectory) {
  if (trajectory.degree > 0) throw Error("the shortest way is between waypoints: a spline of joint values has none");
  for (const std::size_t column : longColumns(robot, trajectory)) {
    const std::string &name = trajectory.joints[column];
    for (const Robot::Joint &joint : robot.joints()) {
      const bool whole = joint.type == Robot::JointType::REVOLUTE && joint.multiplier == std::floor(joint.multiplier);
      if (joint.leader == name && !whole)
        throw Error("the shortest way: joint '" + joint.name + "' follows joint '" + name +
                    "', and after a whole turn of that it is not where it was");
    }
    for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
      const double turn = step(trajectory, i, column);
      if (std::abs(turn) > HALF_TURN)
        trajectory.points[i].positions[column] -= 2.0 * M_PI * std::round(turn / (2.0 * M_PI));
    }
  }
}

} // namespace curve_proximity
