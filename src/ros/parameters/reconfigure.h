/* SPDX-License-Identifier: BSD-3-Clause */
/** Parameters that change while the server runs, by dynamic_reconfigure's protocol: rqt_reconfigure, dynparam. */
#ifndef CURVE_PROXIMITY_ROS_RECONFIGURE_H
#define CURVE_PROXIMITY_ROS_RECONFIGURE_H

#include <curve_proximity/ProximityServerConfig.h>
#include <dynamic_reconfigure/server.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>

#include "parameters/tuning.h"

namespace curve_proximity {

/** Serves ~set_parameters. handle: private, on the queue whose thread carries changes out. threads: is told a new
 * number of them. */
class Reconfigure {
 public:
  Reconfigure(const ros::NodeHandle &handle, Tuning &tuning, std::function<void(int)> threads)
      : tuning_(tuning), threads_(std::move(threads)), server_(handle) {
    server_.setCallback([this](ProximityServerConfig &config, std::uint32_t level) { change(config, level); });
  }

 private:
  void change(ProximityServerConfig &config, std::uint32_t level) {
    // The first call, on all levels at once, tells what was read at start, within the sliders' ranges: that is known,
    // and exactly.
    constexpr std::uint32_t ALL_LEVELS = 0xffffffffu;
    if (level == ALL_LEVELS) return;
    take("epsilon", config.epsilon, tuning_.epsilon, Range{0.0, true, 1.0});
    take("delta", config.delta, tuning_.delta, Range{0.0, false, 10.0});
    take("budget_ms", config.budget_ms, tuning_.budget_ms, Range{0.0, true, 3600000.0});
    take("max_nodes", config.max_nodes, tuning_.max_nodes, Range{1.0, false, 1e9});
    take("threads", config.threads, tuning_.threads, Range{1.0, false, 256.0});
    threads_(tuning_.threads);
  }

  /** What is refused stays as it is; the answer of ~set_parameters tells what is in force. */
  template <class Number>
  static void take(const char *name, Number &given, std::atomic<Number> &value, const Range &range) {
    const auto x = static_cast<double>(given);
    if (range.holds(x)) {
      value = given;
      return;
    }
    ROS_WARN("dynamic_reconfigure: %s is not %s %g and at most %g: it stays at %g", name,
             range.open ? "above" : "at least", range.least, range.most, static_cast<double>(value.load()));
    given = value;
  }

  Tuning &tuning_;
  const std::function<void(int)> threads_;
  dynamic_reconfigure::Server<ProximityServerConfig> server_;
};

} // namespace curve_proximity
#endif
