/* SPDX-License-Identifier: BSD-3-Clause */
#include "frames.h"

#include <algorithm>
#include <curve_proximity/core.hpp>
#include <sstream>
#include <thread>

namespace curve_proximity {
namespace {

/** tf2 knows no leading slash; users of tf still write it. */
std::string withoutSlash(const std::string &frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Eigen::Isometry3d toIsometry(const geometry_msgs::Transform &transform) {
  const geometry_msgs::Vector3 &p = transform.translation;
  const geometry_msgs::Quaternion &q = transform.rotation;
  return curve_proximity::toIsometry(cprox_pose{{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}});
}

} // namespace

Frames::Frames(const std::string &fixed_frame, double timeout, const std::atomic<bool> &stop)
    : fixed_frame_(withoutSlash(fixed_frame)), timeout_(timeout), stop_(stop), listener_(buffer_, true) {
  buffer_.setUsingDedicatedThread(true);
}

std::chrono::steady_clock::time_point Frames::deadline() const {
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(timeout_);
}

Eigen::Isometry3d Frames::toFixed(const std::string &given, const ros::Time &stamp,
                                  std::chrono::steady_clock::time_point deadline) const {
  const std::string frame = withoutSlash(given);
  if (frame.empty() || frame == fixed_frame_) return Eigen::Isometry3d::Identity();

  // tf2's own timeout counts in ROS time, which stands still without a clock: so ask without one, again and again.
  while (true) {
    std::string reason;
    try {
      if (buffer_.canTransform(fixed_frame_, frame, stamp, &reason))
        return toIsometry(buffer_.lookupTransform(fixed_frame_, frame, stamp).transform);
    } catch (const tf2::TransformException &error) {
      reason = error.what(); // what was there a moment ago has left the buffer
    }
    if (stop_ || std::chrono::steady_clock::now() >= deadline) {
      std::ostringstream what;
      what << "no transform from frame '" << frame << "' to frame '" << fixed_frame_ << "' ";
      if (stamp.isZero()) {
        what << "at any time";
      } else {
        what << "at time " << stamp;
      }
      what << " within " << timeout_.count() << " s: " << reason;
      throw Error(what.str());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::optional<double> Frames::age(const std::string &given) const {
  const std::string frame = withoutSlash(given);
  if (frame == fixed_frame_) return 0.0;
  try {
    const ros::Time stamp = buffer_.lookupTransform(fixed_frame_, frame, ros::Time()).header.stamp;
    return stamp.isZero() ? 0.0 : std::max(0.0, (ros::Time::now() - stamp).toSec());
  } catch (const tf2::TransformException &) {
    return std::nullopt;
  }
}

const Eigen::Isometry3d &FrameLookup::toFixed(const std::string &frame, const ros::Time &stamp) {
  const auto inserted = found_.emplace(std::make_pair(frame, stamp), Found());
  Found &found = inserted.first->second;
  if (inserted.second) {
    try {
      found.pose = frames_.toFixed(frame, stamp, deadline_);
    } catch (const std::exception &error) {
      found.error = error.what();
    }
  }
  if (!found.error.empty()) throw Error(found.error);
  return found.pose;
}

} // namespace curve_proximity
