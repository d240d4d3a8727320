/* SPDX-License-Identifier: BSD-3-Clause */
/** The latest value of each joint, from ~joint_states, and how old it is. */
#ifndef CURVE_PROXIMITY_ROS_JOINT_BOARD_H
#define CURVE_PROXIMITY_ROS_JOINT_BOARD_H

#include <sensor_msgs/JointState.h>

#include <curve_proximity/robot.hpp>
#include <map>
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

  /** Takes in a message. Joints that the robot does not have are ignored, and so are values that are not finite. told:
   *  false: of somebody else than the robot; then joints that it has told of stay as they are. */
  void take(const sensor_msgs::JointState &state, const Robot *robot, bool told = true) {
    const Age age(state.header.stamp);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < state.name.size() && i < state.position.size(); ++i) {
      const std::string &name = state.name[i];
      const bool known = robot && robot->hasJoint(name) && std::isfinite(state.position[i]);
      if (!known || (!told && told_.count(name) > 0)) continue;
      joints_[name] = {state.position[i], age};
      if (told) told_.insert(name);
    }
  }

  std::map<std::string, Joint> joints() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return joints_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Joint> joints_;
  std::set<std::string> told_; /* by the robot */
};

} // namespace curve_proximity
#endif
