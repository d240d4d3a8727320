/* SPDX-License-Identifier: BSD-3-Clause */
/** Asks the master now and then whether it still knows a service of ours: one that was restarted knows nobody. */
#ifndef CURVE_PROXIMITY_ROS_MASTER_WATCH_H
#define CURVE_PROXIMITY_ROS_MASTER_WATCH_H

#include <ros/master.h>
#include <ros/this_node.h>

#include <chrono>
#include <string>
#include <utility>

namespace curve_proximity {

/** For one thread. */
class MasterWatch {
 public:
  enum class State { KNOWN, SILENT, FORGOTTEN };

  /** service: by its full name, and advertised before the first look. The node's own name would not do: a node that
   * subscribes to something new is known again, its services are not. */
  explicit MasterWatch(std::string service) : service_(std::move(service)) {}

  /** FORGOTTEN: a master answers, and twice in a row did not know the service. SILENT: none answers; it may come back
   * and know us. Asks every two seconds at most; in between the last state. */
  State look() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return state_;
    next_ = now + std::chrono::seconds(2);
    state_ = ask();
    return state_;
  }

 private:
  State ask() {
    if (!ros::master::check()) return State::SILENT;
    XmlRpc::XmlRpcValue request, response, payload;
    request[0] = ros::this_node::getName();
    request[1] = service_;
    const bool known = ros::master::execute("lookupService", request, response, payload, false);
    if (!known && !ros::master::check()) return State::SILENT;
    times_ = known ? 0 : times_ + 1;
    return times_ >= 2 ? State::FORGOTTEN : State::KNOWN;
  }

  const std::string service_;
  std::chrono::steady_clock::time_point next_;
  State state_ = State::KNOWN;
  int times_ = 0;
};

} // namespace curve_proximity
#endif
