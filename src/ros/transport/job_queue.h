/* SPDX-License-Identifier: BSD-3-Clause */
/** A callback queue whose messages are taken in at once, and answered one after the other. */
#ifndef CURVE_PROXIMITY_ROS_JOB_QUEUE_H
#define CURVE_PROXIMITY_ROS_JOB_QUEUE_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

#include "transport/threaded_queue.h"

namespace curve_proximity {

/** Callbacks leave jobs here. The thread that has taken a message in does its job, and all that wait; another one takes
 *  in what comes meanwhile. Of more jobs than may wait the oldest is dropped. roscpp's own queues drop what is oldest,
 *  too, but tell nobody. */
class JobQueue : public ThreadedQueue {
 public:
  using Job = std::function<void()>;

  /** most: so many jobs may wait. */
  explicit JobQueue(std::size_t most) : ThreadedQueue(2), most_(most) {}
  ~JobQueue() override {
    end();
  }

  /** By a callback. The job throws nothing. */
  void add(Job job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (jobs_.size() == most_) jobs_.pop_front(), ++dropped_;
    jobs_.push_back(std::move(job));
  }

  /** What waits is not done. */
  void end() override {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      jobs_.clear();
    }
    ThreadedQueue::end();
  }

  std::uint64_t dropped() const {
    return dropped_;
  }

 private:
  void afterwards() override {
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

  const std::size_t most_;
  std::mutex mutex_;
  std::deque<Job> jobs_;
  bool working_ = false;
  std::atomic<std::uint64_t> dropped_{0};
};

} // namespace curve_proximity
#endif
