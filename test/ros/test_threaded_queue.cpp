/* SPDX-License-Identifier: BSD-3-Clause */
/* A queue's threads: none runs a callback before the start, none after the end, and no more than may. */
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "transport/job_queue.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {
namespace {

constexpr std::chrono::milliseconds A_WHILE{50};

void sleep() {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

bool comes(const std::function<bool()> &happens) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!happens() && std::chrono::steady_clock::now() < deadline) sleep();
  return happens();
}

/** A callback that runs until it is let go. */
struct Slow {
  std::atomic<int> begun{0};
  std::atomic<bool> ending{false};

  std::function<void()> work() {
    return [this] {
      ++begun;
      while (!ending) sleep();
    };
  }
};

TEST(ThreadedQueue, callbacks_wait_until_their_queue_has_started) {
  ThreadedQueue queue(4);
  std::atomic<int> done{0};
  for (int i = 0; i < 3; ++i) queue.post([&] { ++done; });
  std::this_thread::sleep_for(A_WHILE);
  EXPECT_EQ(done, 0);
  queue.start();
  EXPECT_TRUE(comes([&] { return done == 3; }));
}

TEST(ThreadedQueue, threads_that_a_burst_has_left_over_end) {
  ThreadedQueue queue(16);
  Slow slow;
  queue.start();
  for (int i = 0; i < 12; ++i) queue.post(slow.work());
  ASSERT_TRUE(comes([&] { return slow.begun == 12; }));
  EXPECT_EQ(queue.threads(), 12u);
  slow.ending = true;
  EXPECT_TRUE(comes([&] { return queue.threads() == 1; }));
  std::atomic<int> done{0};
  queue.post([&] { ++done; });
  EXPECT_TRUE(comes([&] { return done == 1; }));
}

TEST(ThreadedQueue, no_more_run_at_once_than_may) {
  ThreadedQueue queue(2);
  Slow slow;
  queue.start();
  for (int i = 0; i < 5; ++i) queue.post(slow.work());
  ASSERT_TRUE(comes([&] { return queue.isFull(); }));
  std::this_thread::sleep_for(A_WHILE);
  EXPECT_EQ(slow.begun, 2);
  slow.ending = true;
  EXPECT_TRUE(comes([&] { return slow.begun == 5; }));
}

TEST(ThreadedQueue, callbacks_of_one_at_once_keep_their_order) {
  ThreadedQueue queue;
  queue.start();
  std::vector<int> order; // no lock: one callback at a time
  std::atomic<bool> done{false};
  for (int i = 0; i < 1000; ++i) queue.post([&, i] { order.push_back(i); });
  queue.post([&] { done = true; });
  ASSERT_TRUE(comes([&] { return done.load(); }));
  ASSERT_EQ(order.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST(JobQueue, callbacks_are_taken_while_a_job_is_done_and_the_oldest_jobs_are_dropped) {
  JobQueue queue(3);
  Slow slow;
  std::atomic<int> taken{0}, done{0};
  queue.start();
  const auto leave = [&](const std::function<void()> &job) {
    queue.post([&, job] {
      queue.add(job);
      ++taken;
    });
  };
  leave(slow.work());
  ASSERT_TRUE(comes([&] { return slow.begun == 1; }));
  for (int i = 0; i < 10; ++i) leave([&] { ++done; });
  ASSERT_TRUE(comes([&] { return taken == 11; }));
  EXPECT_EQ(queue.dropped(), 7u);
  EXPECT_EQ(done, 0);
  slow.ending = true;
  EXPECT_TRUE(comes([&] { return done == 3; }));
}

TEST(JobQueue, the_end_waits_for_a_job_and_begins_no_other) {
  JobQueue queue(3);
  Slow slow;
  std::atomic<bool> ended{false}, done{false};
  queue.start();
  queue.post([&] { queue.add(slow.work()); });
  ASSERT_TRUE(comes([&] { return slow.begun == 1; }));
  queue.add([&] { done = true; });
  std::thread ending([&] {
    queue.end();
    ended = true;
  });
  std::this_thread::sleep_for(A_WHILE);
  EXPECT_FALSE(ended);
  slow.ending = true;
  ending.join();
  EXPECT_FALSE(done);
}

TEST(ThreadedQueue, none_runs_after_the_end) {
  ThreadedQueue queue(4);
  std::atomic<int> done{0};
  queue.start();
  queue.post([&] { ++done; });
  EXPECT_TRUE(comes([&] { return done == 1; }));
  queue.end();
  queue.post([&] { ++done; });
  std::this_thread::sleep_for(A_WHILE);
  EXPECT_EQ(done, 1);
  EXPECT_EQ(queue.running(), 0u);
}

} // namespace
} // namespace curve_proximity
