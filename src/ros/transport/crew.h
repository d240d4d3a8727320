/* SPDX-License-Identifier: BSD-3-Clause */
/** Threads that help a request with its rows. */
#ifndef CURVE_PROXIMITY_ROS_CREW_H
#define CURVE_PROXIMITY_ROS_CREW_H

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace curve_proximity {

/** Threads that are started when they are first wanted, and sleep while there is nothing to do: to wake one costs a
 *  tenth of what it costs to start one, and still some 50 us. rouse() hides that behind what comes before the job. */
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
      n_jobs_ = jobs_.size();
      if (!idle) threads_.emplace_back([this] { run(); });
    }
    wake_.notify_one();
    return true;
  }

  /** A job is likely to be offered in a moment: a thread that sleeps wakes now, and looks out for it. */
  void rouse() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (idle_ <= jobs_.size() || looks_out_) return;
      looks_out_ = roused_ = true;
    }
    wake_.notify_one();
  }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      ++idle_;
      while (!ending_ && jobs_.empty()) {
        if (roused_) {
          lookOut(lock);
        } else {
          wake_.wait(lock);
        }
      }
      --idle_;
      if (ending_) return;
      std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      n_jobs_ = jobs_.size();
      lock.unlock();
      job();
      job = nullptr; // what it holds is given back before the lock is taken
      lock.lock();
    }
  }

  /** Without sleep, for the time that it takes to read a few hundred curves. */
  void lookOut(std::unique_lock<std::mutex> &lock) {
    roused_ = false;
    lock.unlock();
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(200);
    while (n_jobs_ == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    lock.lock();
    looks_out_ = false;
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::vector<std::thread> threads_;
  std::atomic<std::size_t> n_jobs_{0};
  std::size_t idle_ = 0;
  bool ending_ = false, roused_ = false, looks_out_ = false;
};

} // namespace curve_proximity
#endif
