/* SPDX-License-Identifier: BSD-3-Clause */
/** What the server has done since somebody last asked: counts, and how long its answers took. */
#ifndef CURVE_PROXIMITY_ROS_STATISTICS_H
#define CURVE_PROXIMITY_ROS_STATISTICS_H

#include <curve_proximity/Proximity.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <vector>

#include "transport/log_limit.h"

namespace curve_proximity {

/** A window of time. */
struct Summary {
  double seconds = 0.0;                              /**< how long the window was */
  std::uint64_t calls = 0, failed_calls = 0;         /**< requests answered; those with success false */
  std::uint64_t rows = 0, undecided = 0, failed = 0; /**< rows answered; without a verdict; without an answer */
  std::uint64_t opinions = 0, disputed = 0;          /**< rows with a second opinion; where it disagrees */
  std::uint64_t all_disputed = 0;                    /**< rows ever where it disagreed */
  double busy = 0.0, longest = 0.0;                  /**< [s] of the times of requests: the sum, the longest */
};

/** Any number of threads. */
class Statistics {
 public:
  using Clock = std::chrono::steady_clock;

  void record(Clock::duration took, bool success, const std::vector<Proximity> &results);

  /** What was recorded since the last call; the next window begins. */
  Summary take();

 private:
  LogLimit disagreements_{std::chrono::seconds(60)}; /* of second opinions, by row and pair */
  std::mutex mutex_;
  Clock::time_point since_ = Clock::now();
  Summary now_;
};

} // namespace curve_proximity
#endif
