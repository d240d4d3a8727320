/* SPDX-License-Identifier: BSD-3-Clause */
/** The latest value of each joint, from ~joint_states, and how old it is. */
#ifndef CURVE_PROXIMITY_ROS_JOINT_BOARD_H
#define CURVE_PROXIMITY_ROS_JOINT_BOARD_H

#include <sensor_msgs/JointState.h>

#include <chrono>
#include <curve_proximity/robot.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "world/age.h"

namespace curve_proximity {

/** Any number of threads. */
class JointBoard {
 public:
  struct Joint {
    double position = 0.0;
    Age age;
  };

  /** Takes in a message. Joints that the robot does not have are ignored, and so are values that are not finite. */
  void take(const sensor_msgs::JointState &state, const Robot *robot) {
    const Age age(state.header.stamp);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < state.name.size() && i < state.position.size(); ++i) {
      const bool known = robot && robot->hasJoint(state.name[i]);
      if (!known || !std::isfinite(state.position[i])) continue;
      joints_[state.name[i]] = {state.position[i], age};
      told_.insert(state.name[i]);
    }
  }

  /** The same, only for joints that no message of take() has told. */
  void suggest(const sensor_msgs::JointState &state, const Robot *robot) {
    const Age age(state.header.stamp);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < state.name.size() && i < state.position.size(); ++i) {
      const bool known = robot && robot->hasJoint(state.name[i]) && std::isfinite(state.position[i]);
      if (known && told_.count(state.name[i]) == 0) joints_[state.name[i]] = {state.position[i], age};
    }
  }

  std::map<std::string, Joint> joints() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return joints_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Joint> joints_;
  std::set<std::string> told_; /* by take() */
};

} // namespace curve_proximity
#endif
