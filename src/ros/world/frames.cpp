/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/frames.h"

#include <algorithm>
#include <cmath>
#include <curve_proximity/core.hpp>
#include <curve_proximity/nearest_name.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "messages/geometry_message.h"
#include "transport/turns.h"

namespace curve_proximity {
namespace {

/** By then what is published regularly, and what is latched, has come. */
constexpr std::chrono::seconds SETTLED{3};

/** A wait looks again this often, as those of tf2_ros do. */
constexpr std::chrono::milliseconds LOOK_AGAIN{10};

} // namespace

Frames::Frames(const std::string &fixed_frame, double timeout, const std::atomic<bool> &stop)
    : fixed_frame_(withoutSlash(fixed_frame)), timeout_(timeout), stop_(stop), listener_(buffer_, true) {
  buffer_.setUsingDedicatedThread(true);
}

Frames::Clock::time_point Frames::deadline() const {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout_);
}

bool Frames::settled() const {
  return Clock::now() - began_ > SETTLED;
}

std::optional<Frames::Place> Frames::now(const std::string &frame, const ros::Time &stamp, std::string &reason) const {
  try {
    if (!buffer_.canTransform(fixed_frame_, frame, stamp, &reason)) return std::nullopt;
    const geometry_msgs::TransformStamped found = buffer_.lookupTransform(fixed_frame_, frame, stamp);
    Place place;
    place.pose = toIsometry(found.transform);
    if (stamp.isZero() && !found.header.stamp.isZero())
      place.age = std::max(0.0, (ros::Time::now() - found.header.stamp).toSec());
    return place;
  } catch (const tf2::TransformException &error) {
    reason = error.what(); // what was there a moment ago has left the buffer
    return std::nullopt;
  }
}

void Frames::refuse(const std::string &frame, const ros::Time &stamp, const std::string &reason) const {
  std::ostringstream what;
  what << "no transform from frame '" << frame << "' to frame '" << fixed_frame_ << "' ";
  if (stamp.isZero()) {
    what << "at any time";
  } else {
    what << "at time " << stamp;
  }
  what << ": " << reason;
  throw Error(what.str());
}

Frames::Place Frames::place(const std::string &given, const ros::Time &stamp, Clock::time_point deadline,
                            Turn *turn) const {
  const std::string frame = withoutSlash(given);
  if (frame.empty() || frame == fixed_frame_) return {};
  std::string reason;
  if (const std::optional<Place> found = now(frame, stamp, reason)) return *found;
  if (settled() && !buffer_._frameExists(frame)) { // it makes no sense to wait for it
    std::vector<std::string> names;
    buffer_._getFrameStrings(names);
    refuse(frame, stamp, "nobody has published that frame" + didYouMean(frame, names));
  }

  // tf2's own timeout counts in ROS time, which stands still without a clock: so ask without one, again and again.
  const Turn::Pause pause(turn);
  while (!stop_ && Clock::now() < deadline) {
    std::this_thread::sleep_until(std::min(deadline, Clock::now() + LOOK_AGAIN));
    if (const std::optional<Place> found = now(frame, stamp, reason)) return *found;
  }
  std::ostringstream waited;
  waited << "none within " << timeout_.count() << " s: " << reason;
  refuse(frame, stamp, waited.str());
}

bool Frames::has(const std::string &given, const ros::Time &stamp) const {
  const std::string frame = withoutSlash(given);
  std::string reason;
  return frame.empty() || frame == fixed_frame_ || now(frame, stamp, reason);
}

const Eigen::Isometry3d &FrameLookup::toFixed(const std::string &frame, const ros::Time &stamp) {
  const std::pair<std::string, ros::Time> key(frame, stamp);
  const auto known = found_.find(key);
  Found &found = known != found_.end() ? known->second : found_[key];
  if (known == found_.end()) {
    try {
      found.place = frames_.place(frame, stamp, deadline_, turn_);
    } catch (const std::exception &error) {
      found.error = error.what();
    }
  }
  if (!found.error.empty()) throw Error(found.error);
  oldest_ = std::fmax(oldest_, found.place.age);
  age_ = std::fmax(age_, found.place.age);
  return found.place.pose;
}

} // namespace curve_proximity
