/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/motion_watch.h"

#include <algorithm>
#include <utility>

#include "transport/guard.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectory;

constexpr std::chrono::seconds AT_LEAST{1};

/** What is left after `elapsed` seconds: from the last point before that on, as a trajectory of its own whose time 0 is
 *  now: objects that move do so on that clock. */
JointTrajectory restOf(const JointTrajectory &whole, double elapsed) {
  std::size_t first = 0;
  while (first + 1 < whole.points.size() && whole.points[first + 1].time_from_start.toSec() <= elapsed) ++first;
  JointTrajectory rest = whole;
  rest.header.stamp = ros::Time();
  rest.points.erase(rest.points.begin(), rest.points.begin() + static_cast<std::ptrdiff_t>(first));
  const bool stands = rest.points.size() == 1 && rest.points.front().time_from_start.toSec() <= elapsed; // at its end
  if (!stands && elapsed <= 0.0) return rest;
  const ros::Duration now = stands ? rest.points.front().time_from_start : ros::Duration(elapsed);
  for (auto &point : rest.points) point.time_from_start -= now;
  return rest;
}

} // namespace

MotionWatch::MotionWatch(ProximityQuery query, const ros::Time &stamp, SceneState scene)
    : query_(std::move(query)), scene_(std::move(scene)), began_(std::max(ros::Time::now(), stamp)) {}

bool MotionWatch::isOver() const {
  const auto &points = trajectory().points;
  return points.empty() || ros::Time::now() > began_ + points.back().time_from_start;
}

bool MotionWatch::isStillClear(ServerCalls &calls, Refusal &refusal) {
  bool clear = false;
  guarded(
      [&] {
        const auto now = std::chrono::steady_clock::now();
        const SceneState scene = calls.scene();
        clear = scene.epoch == scene_.epoch && scene.version == scene_.version && now - asked_ < AT_LEAST;
        if (clear) return;
        asked_ = now;
        ProximityQuery query = query_;
        query.trajectories.front() = restOf(trajectory(), (ros::Time::now() - began_).toSec());
        clear = calls.isClear(query, refusal);
        scene_ = refusal.scene;
      },
      [&](const std::string &why) {
        refusal.header.stamp = ros::Time::now();
        refusal.scene = scene_;
        refusal.message = why;
      });
  return clear;
}

} // namespace curve_proximity
