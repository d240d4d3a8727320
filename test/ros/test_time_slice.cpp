/* SPDX-License-Identifier: BSD-3-Clause */
/* Time slices of threads, as the kernel tells them. */
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <sched.h>
#include <sys/utsname.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdio>
#include <future>
#include <thread>
#include <utility>

#include "transport/request_threads.h"
#include "transport/time_slice.h"

namespace curve_proximity {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/** Linux 6.12 and later. Older ones have one slice for all threads. */
bool kernelHasSlices() {
  utsname system;
  int major = 0, minor = 0;
  if (uname(&system) != 0 || std::sscanf(system.release, "%d.%d", &major, &minor) != 2) return false;
  return major > 6 || (major == 6 && minor >= 12);
}

/** A request that looks at the slice of the thread which takes it. */
class Request : public ros::CallbackInterface {
 public:
  CallResult call() override {
    slice.set_value(timeSlice());
    return Success;
  }

  std::promise<microseconds> slice;
};

/** Work of a thread of its own, so that no slice is left behind. */
template <class Work>
void onThread(Work &&work) {
  std::thread(std::forward<Work>(work)).join();
}

TEST(TimeSlice, what_is_set_is_what_the_kernel_says) {
  onThread([] {
    const microseconds own = timeSlice();
    ASSERT_TRUE(setTimeSlice(milliseconds(7)));
    EXPECT_EQ(timeSlice(), kernelHasSlices() ? milliseconds(7) : own);
    ASSERT_TRUE(setTimeSlice(microseconds(0)));
    EXPECT_EQ(timeSlice(), own);
  });
}

TEST(TimeSlice, nothing_else_of_the_thread_changes) {
  onThread([] {
    sched_param parameters = {};
    ASSERT_EQ(sched_setscheduler(0, SCHED_BATCH, &parameters), 0);
    ASSERT_TRUE(setTimeSlice(SHORT_SLICE));
    EXPECT_EQ(sched_getscheduler(0), SCHED_BATCH);
    ASSERT_EQ(sched_setscheduler(0, SCHED_IDLE, &parameters), 0);
    EXPECT_FALSE(setTimeSlice(SHORT_SLICE));
    EXPECT_EQ(sched_getscheduler(0), SCHED_IDLE);
  });
}

TEST(TimeSlice, each_thread_has_its_own) {
  onThread([] {
    const microseconds own = timeSlice();
    onThread([] { EXPECT_TRUE(setTimeSlice(SHORT_SLICE)); });
    EXPECT_EQ(timeSlice(), own);
  });
}

TEST(TimeSlice, threads_that_take_requests_have_a_short_one) {
  ros::CallbackQueue queue;
  RequestThreads threads(queue, 2);
  const auto request = boost::make_shared<Request>();
  queue.addCallback(request);
  threads.start();
  std::future<microseconds> slice = request->slice.get_future();
  ASSERT_EQ(slice.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  EXPECT_EQ(slice.get(), kernelHasSlices() ? SHORT_SLICE : timeSlice());
}

} // namespace
} // namespace curve_proximity
