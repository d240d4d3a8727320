/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/trajectory_message.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../scene/motion/trajectory_points.h"
#include "messages/geometry_message.h"

namespace curve_proximity {

JointPositions toJointPositions(const sensor_msgs::JointState &state) {
  if (state.name.size() != state.position.size())
    throw Error("joint_state has " + std::to_string(state.name.size()) + " names and " +
                std::to_string(state.position.size()) + " positions");
  JointPositions positions;
  for (std::size_t i = 0; i < state.name.size(); ++i) {
    if (!positions.emplace(state.name[i], state.position[i]).second)
      throw Error("joint_state names '" + state.name[i] + "' twice");
  }
  return positions;
}

TrajectoryDescription toDescription(const trajectory_msgs::JointTrajectory &trajectory, const JointPositions &now,
                                    std::string &remark) {
  TrajectoryDescription out;
  out.joints = trajectory.joint_names;
  const auto timeless = [](const trajectory_msgs::JointTrajectoryPoint &point) {
    return point.time_from_start.isZero() && point.velocities.empty() && point.accelerations.empty();
  };
  const bool untimed =
      trajectory.points.size() > 1 && std::all_of(trajectory.points.begin(), trajectory.points.end(), timeless);
  if (untimed) remark = "its times are all 0: t counts its points";
  for (const trajectory_msgs::JointTrajectoryPoint &point : trajectory.points) {
    TrajectoryPoint next{point.positions, point.velocities, point.accelerations, point.time_from_start.toSec()};
    if (untimed) next.time = static_cast<double>(out.points.size());
    if (!out.points.empty()) {
      const TrajectoryPoint &last = out.points.back();
      const bool repeated = next.time == last.time && next.positions == last.positions &&
                            next.velocities == last.velocities && next.accelerations == last.accelerations;
      if (repeated) continue;
    }
    out.points.push_back(std::move(next));
  }
  if (!out.points.empty() && out.points.front().time > 0.0) beginAt(now, out.joints, out.points);
  return out;
}

double toStartTolerance(double tolerance, bool any_time) {
  if (!(tolerance >= 0.0 && std::isfinite(tolerance)))
    throw Error("start_tolerance is " + std::to_string(tolerance) + " s: it must be at least 0 and finite");
  return any_time ? std::numeric_limits<double>::infinity() : tolerance;
}

ObjectTrajectory toTrajectory(const PoseTrajectory &message) {
  const std::optional<Turning> turning = turningFromName(message.turning);
  if (!turning) throw Error("the turning '" + message.turning + "' is none of slerp, screw");
  ObjectTrajectory out;
  out.turning = *turning;
  out.start = static_cast<std::int64_t>(message.start.toNSec());
  out.tolerance = toStartTolerance(message.start_tolerance, message.any_time != 0);
  for (const Waypoint &waypoint : message.waypoints) {
    try {
      if (!std::isfinite(waypoint.time)) throw Error("the time is not finite");
      out.poses.push_back({waypoint.time, toIsometry(waypoint.pose)});
    } catch (const Error &error) {
      throw Error("waypoint " + std::to_string(out.poses.size()) + ": " + error.what());
    }
  }
  return out;
}

PoseTrajectory toMessage(const ObjectTrajectory &trajectory) {
  constexpr std::int64_t SECOND = 1000000000;
  if (trajectory.start < 0 || trajectory.start / SECOND > std::numeric_limits<std::uint32_t>::max())
    throw Error("a trajectory starts at a time that no stamp has: " + std::to_string(trajectory.start / SECOND) + " s");
  PoseTrajectory message;
  message.start.fromNSec(static_cast<std::uint64_t>(trajectory.start));
  message.any_time = std::isinf(trajectory.tolerance);
  message.start_tolerance = message.any_time ? 0.0 : trajectory.tolerance;
  message.turning = turningName(trajectory.turning);
  for (const TimedPose &pose : trajectory.poses) {
    message.waypoints.emplace_back();
    message.waypoints.back().time = pose.time;
    message.waypoints.back().pose = toMessage(pose.pose);
  }
  return message;
}

} // namespace curve_proximity
