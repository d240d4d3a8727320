/* SPDX-License-Identifier: BSD-3-Clause */
/** The one pool of threads of a server or gate, and the callback queues of roscpp that it serves. */
#ifndef CURVE_PROXIMITY_ROS_THREAD_POOL_H
#define CURVE_PROXIMITY_ROS_THREAD_POOL_H

#include <ros/callback_queue.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace curve_proximity {

class PooledQueue;

/** As many threads as there are callbacks to run at once. A thread that waits, for a turn or for tf2, costs next to
 * nothing: so each callback has one. Threads that a burst has left over end after half a second. The thread that became
 * idle last is the first to work again. */
class ThreadPool {
 public:
  ThreadPool() = default;

  /** Joins the threads. Its queues must have ended. */
  ~ThreadPool();

  ThreadPool(const ThreadPool &) = delete;
  ThreadPool &operator=(const ThreadPool &) = delete;

  /** Threads that there are. */
  std::size_t count();

 private:
  friend class PooledQueue;

  struct Worker {
    std::thread thread;
    std::condition_variable woken;
    bool is_woken = false;
  };
  using Lock = std::unique_lock<std::mutex>;
  using Workers = std::list<std::shared_ptr<Worker>>;

  static bool makeReady(PooledQueue &queue);
  void wake(Lock &lock);
  void add();
  void run(Workers::iterator own);
  void callNext(Lock &lock);
  bool waitForWork(Lock &lock, const std::shared_ptr<Worker> &self);

  std::mutex mutex_; /* of all that follows, and of the counts of all queues */
  std::condition_variable ended_;
  std::deque<PooledQueue *> ready_; /* one entry for each callback that may begin */
  std::vector<std::shared_ptr<Worker>> idle_;
  bool ending_ = false;
  std::size_t n_threads_ = 0;
  Workers workers_;
  Workers left_over_; /* that do no more: to be joined */
};

/** A callback queue of roscpp that the pool serves, from start() to end(). */
class PooledQueue : public ros::CallbackQueue {
 public:
  /** pool: outlives the queue. at_once: so many of its callbacks may run at once; 1: one after the other.
   *  afterwards: if set, called by the thread that has run a callback, when the next callback may begin already. */
  explicit PooledQueue(ThreadPool &pool, std::size_t at_once = 1, std::function<void()> afterwards = nullptr);
  ~PooledQueue() override;

  /** Once. What has waited in the queue runs at once. */
  void start();

  /** No callback runs, nor will one begin. Not to be called by a callback. */
  void end();

  void addCallback(const ros::CallbackInterfacePtr &callback, std::uint64_t removal_id = 0) override;

  /** Runs `work`, which throws nothing, as a callback. */
  void post(std::function<void()> work);

  /** Threads that run its callbacks now. */
  std::size_t running();

  /** Do as many run as may? */
  bool isFull();

 private:
  friend class ThreadPool;

  ThreadPool &pool_;
  const std::size_t at_once_;
  const std::function<void()> afterwards_;
  bool started_ = false;
  std::size_t waiting_ = 0; /* callbacks that came and are not ready to begin */
  std::size_t begun_ = 0;   /* callbacks that are ready to begin, or run */
  std::size_t running_ = 0; /* threads in callbacks or in afterwards_ */
};

} // namespace curve_proximity
#endif
