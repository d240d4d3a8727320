/* SPDX-License-Identifier: BSD-3-Clause */
/* The threads that take requests from a callback queue: none before the server is whole, none after its end. */
#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <thread>

#include "transport/request_threads.h"

namespace curve_proximity {
namespace {

/** A request that asks how many are at work, as a service's callback does. */
class Request : public ros::CallbackInterface {
 public:
  Request(RequestThreads &threads, std::atomic<int> &answered) : threads_(threads), answered_(answered) {}

  CallResult call() override {
    const RequestThreads::AtWork at_work(threads_);
    ++answered_;
    return Success;
  }

 private:
  RequestThreads &threads_;
  std::atomic<int> &answered_;
};

void waitFor(const std::atomic<int> &answered, int count) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (answered < count && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(RequestThreads, requests_wait_until_the_server_has_started) {
  ros::CallbackQueue queue;
  std::atomic<int> answered{0};
  RequestThreads threads(queue, 4);
  for (int i = 0; i < 3; ++i) queue.addCallback(boost::make_shared<Request>(threads, answered));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(answered, 0);
  threads.start();
  waitFor(answered, 3);
  EXPECT_EQ(answered, 3);
}

TEST(RequestThreads, threads_that_a_burst_has_left_over_end) {
  ros::CallbackQueue queue;
  RequestThreads threads(queue, 16);
  std::atomic<int> begun{0};
  std::atomic<bool> ending{false};
  class Slow : public ros::CallbackInterface {
   public:
    Slow(RequestThreads &threads, std::atomic<int> &begun, std::atomic<bool> &ending)
        : threads_(threads), begun_(begun), ending_(ending) {}
    CallResult call() override {
      const RequestThreads::AtWork at_work(threads_);
      ++begun_;
      while (!ending_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return Success;
    }

   private:
    RequestThreads &threads_;
    std::atomic<int> &begun_;
    std::atomic<bool> &ending_;
  };
  threads.start();
  for (int i = 0; i < 12; ++i) queue.addCallback(boost::make_shared<Slow>(threads, begun, ending));
  waitFor(begun, 12);
  ASSERT_EQ(begun, 12);
  EXPECT_GE(threads.count(), 12u);
  ending = true;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (threads.count() > 1 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(threads.count(), 1u);
  std::atomic<int> answered{0};
  queue.addCallback(boost::make_shared<Request>(threads, answered));
  waitFor(answered, 1);
  EXPECT_EQ(answered, 1);
}

TEST(RequestThreads, none_is_taken_after_the_end) {
  ros::CallbackQueue queue;
  std::atomic<int> answered{0};
  RequestThreads threads(queue, 4);
  threads.start();
  queue.addCallback(boost::make_shared<Request>(threads, answered));
  waitFor(answered, 1);
  threads.stop();
  queue.addCallback(boost::make_shared<Request>(threads, answered));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(answered, 1);
  EXPECT_EQ(threads.atWork(), 0u);
}

} // namespace
} // namespace curve_proximity
