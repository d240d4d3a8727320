/* SPDX-License-Identifier: BSD-3-Clause */
/** Keeps the log short: the same warning once in a while, and never many at a time. */
#ifndef CURVE_PROXIMITY_ROS_LOG_LIMIT_H
#define CURVE_PROXIMITY_ROS_LOG_LIMIT_H

#include <chrono>
#include <iterator>
#include <map>
#include <mutex>
#include <string>

namespace curve_proximity {

/** Any number of threads. */
class LogLimit {
 public:
  /** every: in this time the same warning is made once. */
  explicit LogLimit(std::chrono::seconds every) : every_(every) {}

  /** Is it to be made now? */
  bool isDue(const std::string &what) {
    const auto now = std::chrono::steady_clock::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto it = made_.begin(); it != made_.end();) it = now - it->second >= every_ ? made_.erase(it) : std::next(it);
    return made_.size() < MOST && made_.emplace(what, now).second;
  }

 private:
  static constexpr std::size_t MOST = 20; /* different ones in that time */

  const std::chrono::seconds every_;
  std::mutex mutex_;
  std::map<std::string, std::chrono::steady_clock::time_point> made_;
};

} // namespace curve_proximity
#endif
