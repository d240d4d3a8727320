/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/threaded_queue.h"

#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdint>
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

void ThreadedQueue::start() {
  const Lock lock(mutex_);
  started_ = true;
  for (std::size_t i = 0; i < waiting_; ++i) findThread();
}

void ThreadedQueue::end() {
  {
    const Lock lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  for (Threads *threads : {&threads_, &left_over_})
    for (std::thread &thread : *threads) thread.join();
  threads_.clear();
  left_over_.clear();
  disable();
  clear();
}

void ThreadedQueue::addCallback(const ros::CallbackInterfacePtr &callback, std::uint64_t removal_id) {
  CallbackQueue::addCallback(callback, removal_id);
  const Lock lock(mutex_);
  ++waiting_;
  if (started_ && !ended_) findThread();
}

/** For one more callback. The lock is held. */
void ThreadedQueue::findThread() {
  if (waiting_ <= idle_) return wake_.notify_one();
  if (threads_.size() == at_once_) return; // the first that is ready takes it
  for (std::thread &thread : left_over_) thread.join();
  left_over_.clear();
  const auto own = threads_.emplace(threads_.end());
  try {
    *own = std::thread([this, own] { run(own); });
  } catch (const std::system_error &) { // the system has no more: the others will come to it
    threads_.erase(own);
    if (threads_.empty()) throw;
  }
}

void ThreadedQueue::run(Threads::iterator own) {
  Lock lock(mutex_);
  while (true) {
    ++idle_;
    const bool any = wake_.wait_for(lock, PATIENCE, [this] { return ended_ || waiting_ > 0; });
    --idle_;
    if (ended_) return;
    if (!any && idle_ > 0) return left_over_.splice(left_over_.end(), threads_, own);
    if (!any) continue;
    --waiting_;
    ++running_;
    lock.unlock();
    const bool again = callOne() == TryAgain;
    if (again) std::this_thread::sleep_for(TRY_AGAIN);
    afterwards();
    lock.lock();
    waiting_ += again;
    --running_;
  }
}

void ThreadedQueue::post(std::function<void()> work) {
  addCallback(boost::make_shared<Posted>(std::move(work)));
}

std::size_t ThreadedQueue::running() {
  const Lock lock(mutex_);
  return running_;
}

std::size_t ThreadedQueue::threads() {
  const Lock lock(mutex_);
  return threads_.size();
}

} // namespace curve_proximity
