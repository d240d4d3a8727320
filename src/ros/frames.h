/* SPDX-License-Identifier: BSD-3-Clause */
/** Brings frames to the fixed frame by tf2, without ever waiting on ROS time. */
#ifndef CURVE_PROXIMITY_ROS_FRAMES_H
#define CURVE_PROXIMITY_ROS_FRAMES_H

#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <chrono>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace curve_proximity {

/** One tf2 buffer, fed by a thread of its own. Any number of threads may look up. */
class Frames {
 public:
  /** timeout: how long a lookup may wait for a transform, on the steady clock [s]. stop: ends every wait. */
  Frames(const std::string &fixed_frame, double timeout, const std::atomic<bool> &stop);

  const std::string &fixedFrame() const {
    return fixed_frame_;
  }

  std::chrono::steady_clock::time_point deadline() const;

  /** The pose of `frame` in the fixed frame. '' and the fixed frame itself: the identity. stamp 0: the latest known.
   *  Waits until the deadline at most, then throws Error, which names both frames. */
  Eigen::Isometry3d toFixed(const std::string &frame, const ros::Time &stamp,
                            std::chrono::steady_clock::time_point deadline) const;

  /** [s] How old the latest pose of `frame` in the fixed frame is, by ROS time; 0 where nothing between them moves. Does not wait:
   *  nothing where there is no transform. */
  std::optional<double> age(const std::string &frame) const;

 private:
  const std::string fixed_frame_;
  const std::chrono::duration<double> timeout_;
  const std::atomic<bool> &stop_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

/** The lookups of one request: each frame and stamp is looked up once, and all of them share one deadline, so that
 *  many curves in a frame that is missing cost one timeout. For one thread. */
class FrameLookup {
 public:
  explicit FrameLookup(const Frames &frames) : frames_(frames), deadline_(frames.deadline()) {}

  /** As Frames::toFixed(). */
  const Eigen::Isometry3d &toFixed(const std::string &frame, const ros::Time &stamp);

 private:
  struct Found {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    std::string error; /* empty where there is a pose */
  };

  const Frames &frames_;
  const std::chrono::steady_clock::time_point deadline_;
  std::map<std::pair<std::string, ros::Time>, Found> found_;
};

} // namespace curve_proximity
#endif
