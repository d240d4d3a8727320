/* SPDX-License-Identifier: BSD-3-Clause */
/** Parameters that change while the server runs, by dynamic_reconfigure's protocol: rqt_reconfigure, dynparam. */
#ifndef CURVE_PROXIMITY_ROS_RECONFIGURE_H
#define CURVE_PROXIMITY_ROS_RECONFIGURE_H

#include <curve_proximity/ProximityServerConfig.h>
#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <functional>

#include "tuning.h"

namespace curve_proximity {

/** Serves ~set_parameters. handle: private, on the queue whose thread carries changes out. threads: is told a new number of them. */
class Reconfigure {
 public:
  Reconfigure(const ros::NodeHandle &handle, Tuning &tuning, std::function<void(int)> threads)
      : tuning_(tuning), threads_(std::move(threads)), server_(handle) {
    server_.setCallback([this](ProximityServerConfig &config, std::uint32_t level) { change(config, level); });
  }

 private:
  void change(const ProximityServerConfig &config, std::uint32_t level) {
    // The first call, on all levels at once, tells what was read at start, within the sliders' ranges: that is known, and exactly.
    constexpr std::uint32_t ALL_LEVELS = 0xffffffffu;
    if (level == ALL_LEVELS) return;
    tuning_.epsilon = config.epsilon;
    tuning_.delta = config.delta;
    tuning_.budget_ms = config.budget_ms;
    tuning_.max_nodes = config.max_nodes;
    threads_(config.threads);
  }

  Tuning &tuning_;
  const std::function<void(int)> threads_;
  dynamic_reconfigure::Server<ProximityServerConfig> server_;
};

} // namespace curve_proximity
#endif
