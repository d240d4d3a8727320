/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/thread_pool.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <system_error>
#include <utility>

namespace curve_proximity {
namespace {

/** How long a thread waits for work before it ends, if another one waits, too. */
constexpr std::chrono::milliseconds PATIENCE{500};

/** Before a callback is tried again that roscpp could not run: another one of its subscriber is at work. */
constexpr std::chrono::milliseconds TRY_AGAIN{1};

class Posted : public ros::CallbackInterface {
 public:
  explicit Posted(std::function<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  const std::function<void()> work_;
};

} // namespace

ThreadPool::~ThreadPool() {
  {
    const Lock lock(mutex_);
    ending_ = true;
    for (const auto &worker : idle_) worker->woken.notify_one();
  }
  for (Workers *workers : {&workers_, &left_over_})
    for (const auto &worker : *workers) worker->thread.join();
}

std::size_t ThreadPool::count() {
  const Lock lock(mutex_);
  return n_threads_;
}

/** The next callback of a queue, if one more may run. The lock is held. */
bool ThreadPool::makeReady(PooledQueue &queue) {
  if (!queue.started_ || queue.waiting_ == 0 || queue.begun_ == queue.at_once_) return false;
  --queue.waiting_;
  ++queue.begun_;
  queue.pool_.ready_.push_back(&queue);
  return true;
}

/** Finds a thread for a callback that is ready. Gives the lock back: a thread that is woken wants it. */
void ThreadPool::wake(Lock &lock) {
  if (idle_.empty()) {
    add();
    return lock.unlock();
  }
  const std::shared_ptr<Worker> worker = std::move(idle_.back());
  idle_.pop_back();
  worker->is_woken = true;
  lock.unlock();
  worker->woken.notify_one();
}

/** The lock is held. */
void ThreadPool::add() {
  for (const auto &worker : left_over_) worker->thread.join();
  left_over_.clear();
  const auto own = workers_.insert(workers_.end(), std::make_shared<Worker>());
  try {
    (*own)->thread = std::thread([this, own] { run(own); });
    ++n_threads_;
  } catch (const std::system_error &) { // the system has no more: the others will come to it
    workers_.erase(own);
    if (n_threads_ == 0) throw;
  }
}

void ThreadPool::run(Workers::iterator own) {
  Lock lock(mutex_);
  while (true) {
    while (!ready_.empty()) callNext(lock);
    if (ending_) return;
    if (waitForWork(lock, *own)) continue;
    --n_threads_;
    left_over_.splice(left_over_.end(), workers_, own); // it ends as soon as the lock is given back
    return;
  }
}

/** False: the thread is to end. */
bool ThreadPool::waitForWork(Lock &lock, const std::shared_ptr<Worker> &self) {
  self->is_woken = false;
  idle_.push_back(self);
  while (!self->is_woken && !ending_) {
    if (self->woken.wait_for(lock, PATIENCE) == std::cv_status::no_timeout) continue;
    if (self->is_woken || ending_ || idle_.size() == 1) continue;
    idle_.erase(std::find(idle_.begin(), idle_.end(), self));
    return false;
  }
  return true;
}

/** A callback that follows in the same queue is this thread's, unless it has something to do before. */
void ThreadPool::callNext(Lock &lock) {
  PooledQueue &queue = *ready_.front();
  ready_.pop_front();
  ++queue.running_;
  lock.unlock();
  const bool again = queue.callOne() == ros::CallbackQueue::TryAgain;
  if (again) std::this_thread::sleep_for(TRY_AGAIN);
  lock.lock();
  --queue.begun_;
  queue.waiting_ += again;
  const bool follows = makeReady(queue);
  if (queue.afterwards_) {
    if (follows) wake(lock);
    if (lock.owns_lock()) lock.unlock();
    queue.afterwards_();
    lock.lock();
  }
  if (--queue.running_ == 0) ended_.notify_all();
}

PooledQueue::PooledQueue(ThreadPool &pool, std::size_t at_once, std::function<void()> afterwards)
    : pool_(pool), at_once_(at_once), afterwards_(std::move(afterwards)) {}

PooledQueue::~PooledQueue() {
  end();
}

void PooledQueue::start() {
  ThreadPool::Lock lock(pool_.mutex_);
  started_ = true;
  while (pool_.makeReady(*this)) {
    pool_.wake(lock);
    lock.lock();
  }
}

void PooledQueue::end() {
  ThreadPool::Lock lock(pool_.mutex_);
  started_ = false;
  pool_.ready_.erase(std::remove(pool_.ready_.begin(), pool_.ready_.end(), this), pool_.ready_.end());
  pool_.ended_.wait(lock, [this] { return running_ == 0; });
  lock.unlock();
  disable();
  clear();
}

void PooledQueue::addCallback(const ros::CallbackInterfacePtr &callback, std::uint64_t removal_id) {
  CallbackQueue::addCallback(callback, removal_id);
  ThreadPool::Lock lock(pool_.mutex_);
  ++waiting_;
  if (pool_.makeReady(*this)) pool_.wake(lock);
}

void PooledQueue::post(std::function<void()> work) {
  addCallback(boost::make_shared<Posted>(std::move(work)));
}

std::size_t PooledQueue::running() {
  const ThreadPool::Lock lock(pool_.mutex_);
  return running_;
}

bool PooledQueue::isFull() {
  const ThreadPool::Lock lock(pool_.mutex_);
  return running_ >= at_once_;
}

} // namespace curve_proximity
