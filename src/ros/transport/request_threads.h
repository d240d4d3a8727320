/* SPDX-License-Identifier: BSD-3-Clause */
/** Threads that take requests from a callback queue: always one more than are at work, up to a limit. */
#ifndef CURVE_PROXIMITY_ROS_REQUEST_THREADS_H
#define CURVE_PROXIMITY_ROS_REQUEST_THREADS_H

#include <ros/callback_queue.h>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include "transport/time_slice.h"

namespace curve_proximity {

/** A thread that waits, for a turn or for tf2, costs next to nothing; so each request has one, and Turns tells how many
 *  compute. */
class RequestThreads {
 public:
  /** queue: kept by reference. most: threads beside the one that refuses. Nothing runs before start(). */
  RequestThreads(ros::CallbackQueue &queue, std::size_t most) : queue_(queue), most_(most) {}

  ~RequestThreads() {
    stop();
  }

  /** Once. What has waited in the queue runs at once. */
  void start() {
    const std::lock_guard<std::mutex> lock(mutex_);
    add();
  }

  /** Joins the threads: no callback runs, nor will one begin. */
  void stop() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    for (std::thread &thread : threads_) thread.join();
    threads_.clear();
  }

  /** A callback of the queue is at work, for as long as this lives. */
  class AtWork {
   public:
    explicit AtWork(RequestThreads &threads) : threads_(threads), last_(threads.begin()) {}
    ~AtWork() {
      threads_.end();
    }
    AtWork(const AtWork &) = delete;
    AtWork &operator=(const AtWork &) = delete;

    /** No thread is left for further requests: this one must not wait for anything. */
    bool isLast() const {
      return last_;
    }

   private:
    RequestThreads &threads_;
    const bool last_;
  };

  /** Requests at work. */
  std::size_t atWork() const {
    return at_work_;
  }

 private:
  bool begin() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++at_work_;
    if (at_work_ == threads_.size() && threads_.size() <= most_) add();
    return at_work_ == threads_.size();
  }

  void end() {
    --at_work_;
  }

  void add() {
    if (ending_) return;
    threads_.emplace_back([this] {
      setTimeSlice(SHORT_SLICE);
      while (!ending_) queue_.callOne(ros::WallDuration(0.1));
    });
  }

  ros::CallbackQueue &queue_;
  const std::size_t most_;
  std::atomic<bool> ending_{false};
  std::atomic<std::size_t> at_work_{0};
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

} // namespace curve_proximity
#endif
