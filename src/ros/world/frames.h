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
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace curve_proximity {

class Turn;

/** One tf2 buffer, fed by a thread of its own. Any number of threads may look up. */
class Frames {
 public:
  using Clock = std::chrono::steady_clock;

  /** timeout: how long a lookup may wait for a transform, on the steady clock [s]. stop: ends every wait. */
  Frames(const std::string &fixed_frame, double timeout, const std::atomic<bool> &stop);

  const std::string &fixedFrame() const {
    return fixed_frame_;
  }

  Clock::time_point deadline() const;

  /** A frame in the fixed frame. */
  struct Place {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    double age = std::numeric_limits<double>::quiet_NaN(); /**< [s] of the latest transform; NaN: asked for a time, or
                                                               nothing between the two moves */
  };

  /** The pose of `frame` in the fixed frame. '' and the fixed frame itself: the identity. stamp 0: the latest known.
   *  Waits until the deadline at most, then throws Error, which names both frames. A frame that nobody has ever
   *  published is refused at once, with the nearest name there is, once the server has listened for a moment.
   *  turn: given back while this waits; may be null. */
  Place place(const std::string &frame, const ros::Time &stamp, Clock::time_point deadline, Turn *turn) const;

  /** Is there a transform now? Does not wait, but in the first moments of the server. */
  bool has(const std::string &frame, const ros::Time &stamp) const;

  /** Has the server listened long enough to have heard of static and regular transforms? */
  bool settled() const;

 private:
  std::optional<Place> now(const std::string &frame, const ros::Time &stamp, std::string &reason) const;
  [[noreturn]] void refuse(const std::string &frame, const ros::Time &stamp, const std::string &reason) const;

  const std::string fixed_frame_;
  const std::chrono::duration<double> timeout_;
  const std::atomic<bool> &stop_;
  const Clock::time_point began_ = Clock::now();
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

/** The lookups of one request: each frame and stamp is looked up once, and all of them share one deadline, so that
 *  many curves in a frame that is missing cost one timeout. For one thread. */
class FrameLookup {
 public:
  /** turn: given back during waits; may be null. */
  explicit FrameLookup(const Frames &frames, Turn *turn = nullptr)
      : frames_(frames), turn_(turn), deadline_(frames.deadline()) {}

  /** As Frames::place(). */
  const Eigen::Isometry3d &toFixed(const std::string &frame, const ros::Time &stamp);

  const Frames &frames() const {
    return frames_;
  }

  /** [s] The greatest age so far; NaN: none has one. */
  double oldest() const {
    return oldest_;
  }

  /** The same since begin(). */
  double age() const {
    return age_;
  }
  void begin() {
    age_ = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  struct Found {
    Frames::Place place;
    std::string error; /* empty where there is a pose */
  };

  const Frames &frames_;
  Turn *const turn_;
  const Frames::Clock::time_point deadline_;
  std::map<std::pair<std::string, ros::Time>, Found> found_;
  double oldest_ = std::numeric_limits<double>::quiet_NaN();
  double age_ = std::numeric_limits<double>::quiet_NaN();
};

} // namespace curve_proximity
#endif
