/* SPDX-License-Identifier: BSD-3-Clause */
/** The server's state on /diagnostics, once a second. */
#ifndef CURVE_PROXIMITY_ROS_DIAGNOSTICS_H
#define CURVE_PROXIMITY_ROS_DIAGNOSTICS_H

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <cstdint>

#include "moveit/planning_scene_topic.h"
#include "pipeline/pipeline.h"
#include "transport/statistics.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** Three statuses: `queries` (rate, mean and longest time of a request, undecided and failed rows, messages dropped),
 * `sensors` (how old the object of each is, and whether anything is known of it), `planning_scene` (what came of
 * move_group's scene, and whether this one differs). */
class Diagnostics {
 public:
  /** handle: private; its callback queue runs the timer. The others are kept by reference. */
  Diagnostics(const ros::NodeHandle &handle, Statistics &statistics, Turns &turns, const Pipeline &pipeline,
              const PlanningSceneTopic &planning_scene, const LiveScene &live);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void queries(Status &status);
  void sensors(Status &status);
  void planningScene(Status &status);

  Statistics &statistics_;
  Turns &turns_;
  const Pipeline &pipeline_;
  const PlanningSceneTopic &planning_scene_;
  const LiveScene &live_;
  std::uint64_t dropped_ = 0; /* when last reported */
  ros::NodeHandle handle_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

} // namespace curve_proximity
#endif
