/* SPDX-License-Identifier: BSD-3-Clause */
/** A callback queue of roscpp with threads of its own. */
#ifndef CURVE_PROXIMITY_ROS_THREADED_QUEUE_H
#define CURVE_PROXIMITY_ROS_THREADED_QUEUE_H

#include <ros/callback_queue.h>

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace curve_proximity {

/** It has as many threads as callbacks run at once: one that waits, for a turn or for tf2, keeps none waiting. Threads
 * that a burst has left over end after half a second; the last one stays. */
class ThreadedQueue : public ros::CallbackQueue {
 public:
  /** at_once: so many callbacks may run at once; 1: one after the other. */
  explicit ThreadedQueue(std::size_t at_once = 1) : at_once_(at_once) {}
  ~ThreadedQueue() override {
    ThreadedQueue::end();
  }

  /** Once. What has waited in the queue runs at once. */
  void start();

  /** No callback runs, nor will one begin. Not to be called by a callback. */
  virtual void end();

  void addCallback(const ros::CallbackInterfacePtr &callback, std::uint64_t removal_id = 0) override;

  /** Runs `work`, which throws nothing, as a callback. */
  void post(std::function<void()> work);

  /** Threads that run callbacks now. */
  std::size_t running();

  /** Do as many run as may? */
  bool isFull() {
    return running() >= at_once_;
  }

  /** Threads that there are. */
  std::size_t threads();

 protected:
  /** Called by the thread that has run a callback. */
  virtual void afterwards() {}

 private:
  using Lock = std::unique_lock<std::mutex>;
  using Threads = std::list<std::thread>;
  void findThread();
  void run(Threads::iterator own);

  const std::size_t at_once_;
  std::mutex mutex_; /* of what follows */
  std::condition_variable wake_;
  bool started_ = false, ended_ = false;
  std::size_t waiting_ = 0; /* callbacks that came and that no thread has taken */
  std::size_t idle_ = 0;    /* threads that wait for one */
  std::size_t running_ = 0; /* threads in callbacks or in afterwards() */
  Threads threads_;
  Threads left_over_; /* that do no more: to be joined */
};

} // namespace curve_proximity
#endif
