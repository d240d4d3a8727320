/* SPDX-License-Identifier: BSD-3-Clause */
/** What readers of trajectories share, from files and from messages. */
#ifndef CURVE_PROXIMITY_SCENE_TRAJECTORY_POINTS_H
#define CURVE_PROXIMITY_SCENE_TRAJECTORY_POINTS_H

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/trajectory.hpp>

namespace curve_proximity {

/** linear, cubic or quintic. */
inline std::optional<Interpolation> interpolationFromName(const std::string &name) {
  if (name == "linear") return Interpolation::LINEAR;
  if (name == "cubic") return Interpolation::CUBIC;
  if (name == "quintic") return Interpolation::QUINTIC;
  return std::nullopt;
}

/** For points of which the first comes after the time 0: the way from where the robot stands at 0, which `known` tells.
 *  False: it does not tell of each joint, and nothing is added. points: TrajectoryPoint or
 *  trajectory_msgs/JointTrajectoryPoint, at least one. */
template <class Points>
bool beginAt(const JointPositions &known, const std::vector<std::string> &joints, Points &points) {
  typename Points::value_type begin;
  for (const std::string &joint : joints) {
    const auto it = known.find(joint);
    if (it == known.end()) return false;
    begin.positions.push_back(it->second);
  }
  begin.velocities.resize(points.front().velocities.size());
  begin.accelerations.resize(points.front().accelerations.size());
  points.insert(points.begin(), std::move(begin));
  return true;
}

} // namespace curve_proximity
#endif
