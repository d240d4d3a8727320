/* SPDX-License-Identifier: BSD-3-Clause */
/** Threads that help a request with its rows. */
#ifndef CURVE_PROXIMITY_ROS_CREW_H
#define CURVE_PROXIMITY_ROS_CREW_H

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace curve_proximity {

/** Threads that are started when they are first wanted, and sleep while there is nothing to do: to wake one costs a
 *  tenth of what it costs to start one. */
class Crew {
 public:
  /** most: threads. */
  explicit Crew(std::size_t most) : most_(most) {}

  /** Joins the threads. Jobs that none of them has begun are dropped. */
  ~Crew() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread &thread : threads_) thread.join();
  }

  Crew(const Crew &) = delete;
  Crew &operator=(const Crew &) = delete;

  std::size_t most() const {
    return most_;
  }

  /** Gives a job to a thread that is idle. False: there is none. The job throws nothing, and may run late. */
  bool offer(std::function<void()> job) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const bool idle = idle_ > jobs_.size();
      if (!idle && threads_.size() == most_) return false;
      jobs_.push_back(std::move(job));
      if (!idle) threads_.emplace_back([this] { run(); });
    }
    wake_.notify_one();
    return true;
  }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      ++idle_;
      wake_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
      --idle_;
      if (ending_) return;
      std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      lock.unlock();
      job();
      job = nullptr; // what it holds is given back before the lock is taken
      lock.lock();
    }
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool ending_ = false;
};

} // namespace curve_proximity
#endif
