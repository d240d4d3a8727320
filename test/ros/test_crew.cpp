/* SPDX-License-Identifier: BSD-3-Clause */
/* The threads that help a request: a job runs once, whether its thread sleeps, looks out for it, or is late. */
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "transport/crew.h"

namespace curve_proximity {
namespace {

bool reaches(const std::atomic<int> &count, int wanted) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (count < wanted && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  return count == wanted;
}

/** 400 jobs, offered at once after rouse(), while the thread looks out, and after it has gone to sleep again. */
TEST(Crew, a_roused_thread_runs_each_job_once) {
  for (const std::size_t most : {std::size_t{1}, std::size_t{3}}) {
    std::atomic<int> done{0};
    Crew crew(most);
    int taken = 0;
    for (int i = 0; i < 200; ++i) {
      if (i % 4 != 3) crew.rouse();
      if (i % 4 != 0) std::this_thread::sleep_for(std::chrono::microseconds(i % 4 == 1 ? 30 : 400));
      if (crew.offer([&done] { ++done; })) ++taken;
      ASSERT_TRUE(reaches(done, taken));
    }
    EXPECT_GT(taken, 0);
  }
}

TEST(Crew, a_crew_that_is_busy_takes_no_more_than_it_has_threads) {
  std::atomic<bool> going{true};
  std::atomic<int> done{0};
  {
    Crew crew(1);
    const auto wait = [&] {
      while (going) std::this_thread::yield();
      ++done;
    };
    ASSERT_TRUE(crew.offer(wait));
    crew.rouse();
    EXPECT_FALSE(crew.offer(wait));
    going = false;
    ASSERT_TRUE(reaches(done, 1));
  }
  EXPECT_EQ(done, 1);
}

TEST(Crew, it_ends_while_a_thread_looks_out) {
  for (int i = 0; i < 200; ++i) {
    Crew crew(1);
    std::atomic<int> done{0};
    crew.offer([&done] { ++done; });
    ASSERT_TRUE(reaches(done, 1));
    crew.rouse();
  }
}

} // namespace
} // namespace curve_proximity
