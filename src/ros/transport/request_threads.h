/* SPDX-License-Identifier: BSD-3-Clause */
/** Threads that take requests from a callback queue: always one more than are at work, up to a limit. Threads that a
 *  burst has left over end after half a second. */
#ifndef CURVE_PROXIMITY_ROS_REQUEST_THREADS_H
#define CURVE_PROXIMITY_ROS_REQUEST_THREADS_H

#include <ros/callback_queue.h>

#include <atomic>
#include <cstddef>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

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
    for (std::list<std::thread> *threads : {&threads_, &left_over_}) {
      for (std::thread &thread : *threads) thread.join();
      threads->clear();
    }
    n_threads_ = 0;
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

  /** Threads that take requests. */
  std::size_t count() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return n_threads_;
  }

  /** Requests at work. */
  std::size_t atWork() const {
    return at_work_;
  }

 private:
  bool begin() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++at_work_;
    if (at_work_ == n_threads_ && n_threads_ <= most_) add();
    return at_work_ == n_threads_;
  }

  void end() {
    --at_work_;
  }

  /* The lock is held. */
  void add() {
    if (ending_) return;
    for (std::list<std::thread> done = std::move(left_over_); !done.empty(); done.pop_front()) done.front().join();
    left_over_.clear();
    ++n_threads_;
    const auto own = threads_.emplace(threads_.end());
    *own = std::thread([this, own] { run(own); });
  }

  void run(std::list<std::thread>::iterator own) {
    while (!ending_) {
      if (queue_.callOne(ros::WallDuration(PATIENCE)) == ros::CallbackQueue::Called) continue;
      const std::lock_guard<std::mutex> lock(mutex_);
      if (ending_ || n_threads_ <= at_work_ + 1) continue;
      --n_threads_;
      left_over_.splice(left_over_.end(), threads_, own); // it ends as soon as the lock is given back
      return;
    }
  }

  static constexpr double PATIENCE = 0.5; /* [s] that a thread waits for a request */

  ros::CallbackQueue &queue_;
  const std::size_t most_;
  std::atomic<bool> ending_{false};
  std::atomic<std::size_t> at_work_{0};
  std::mutex mutex_;
  std::size_t n_threads_ = 0;
  std::list<std::thread> threads_;   /* that take requests */
  std::list<std::thread> left_over_; /* that do no more: to be joined */
};

} // namespace curve_proximity
#endif
