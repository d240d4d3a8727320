/* SPDX-License-Identifier: BSD-3-Clause */
/** What messages ask for, done one after the other. */
#ifndef CURVE_PROXIMITY_ROS_JOB_QUEUE_H
#define CURVE_PROXIMITY_ROS_JOB_QUEUE_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace curve_proximity {

/** While one job is done, a few others wait; of more the oldest is dropped and counted. roscpp's own queue drops what is
 *  oldest too, but counts nothing, and keeps all messages of its topic waiting. Any number of threads. */
class JobQueue {
 public:
  using Job = std::function<void()>;

  /** most: that may wait. */
  explicit JobQueue(std::size_t most) : most_(most) {}

  /** The job throws nothing. */
  void add(Job job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (jobs_.size() == most_) {
      jobs_.pop_front();
      ++dropped_;
    }
    jobs_.push_back(std::move(job));
  }

  /** Does all that wait, unless another thread is at it. */
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (working_) return;
    working_ = true;
    while (!jobs_.empty()) {
      const Job job = std::move(jobs_.front());
      jobs_.pop_front();
      lock.unlock();
      job();
      lock.lock();
    }
    working_ = false;
  }

  /** What waits is not done. */
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.clear();
  }

  std::uint64_t dropped() const {
    return dropped_;
  }

 private:
  const std::size_t most_;
  std::mutex mutex_;
  std::deque<Job> jobs_;
  bool working_ = false;
  std::atomic<std::uint64_t> dropped_{0};
};

} // namespace curve_proximity
#endif
