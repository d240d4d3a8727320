/* SPDX-License-Identifier: BSD-3-Clause */
/** A queue that never holds more than so many: what is oldest makes way for what is new, and is counted. */
#ifndef CURVE_PROXIMITY_ROS_BOUNDED_QUEUE_H
#define CURVE_PROXIMITY_ROS_BOUNDED_QUEUE_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>

namespace curve_proximity {

/** Any number of threads put jobs in; one at a time takes them out. A thread that puts a job in and finds nobody at
 * work becomes the one that works: so a job that need not wait costs no change of threads. */
template <class Job>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t most) : most_(most) {}

  /** Puts a job in. True: the caller now works, and calls next() until it says false. */
  bool push(Job job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (jobs_.size() == most_) {
      jobs_.pop_front();
      ++dropped_;
    }
    jobs_.push_back(std::move(job));
    if (working_) return false;
    working_ = true;
    return true;
  }

  /** Takes the oldest job out. False where there is none left: then the caller's work is over. */
  bool next(Job &job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    working_ = !jobs_.empty();
    if (!working_) return false;
    job = std::move(jobs_.front());
    jobs_.pop_front();
    return true;
  }

  std::uint64_t dropped() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t most_;
  mutable std::mutex mutex_;
  std::deque<Job> jobs_;
  std::uint64_t dropped_ = 0;
  bool working_ = false;
};

} // namespace curve_proximity
#endif
