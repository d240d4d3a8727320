/* SPDX-License-Identifier: BSD-3-Clause */
/** How old a message is: by the steady clock since it came, and by its stamp before that. */
#ifndef CURVE_PROXIMITY_ROS_AGE_H
#define CURVE_PROXIMITY_ROS_AGE_H

#include <ros/time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace curve_proximity {

class Age {
 public:
  Age() = default;

  /** Of a message that came now. stamp 0: nothing is known of the time before. */
  explicit Age(const ros::Time &stamp) {
    if (stamp.isZero() || !ros::Time::isValid()) return;
    const ros::Time now = ros::Time::now();
    if (!now.isZero()) before_ = std::max(0.0, (now - stamp).toSec());
  }

  /** [s] */
  double seconds() const {
    return before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - came_).count();
  }

 private:
  std::chrono::steady_clock::time_point came_ = std::chrono::steady_clock::now();
  double before_ = 0.0;
};

} // namespace curve_proximity
#endif
