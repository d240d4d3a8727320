/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/statistics.h"

#include <algorithm>

#include <curve_proximity/cprox.h>
#include <ros/console.h>

namespace curve_proximity {

void Statistics::record(Clock::duration took, bool success, const std::vector<Proximity> &results) {
  const double seconds = std::chrono::duration<double>(took).count();
  std::uint64_t undecided = 0, failed = 0, opinions = 0, disputed = 0;
  for (const Proximity &row : results) {
    undecided += row.verdict == cprox_verdict_name(CPROX_VERDICT_UNDECIDED);
    failed += row.lower != row.lower;
    if (row.second_opinion.empty()) continue;
    opinions += row.second_opinion == Proximity::OPINION_AGREES || row.second_opinion == Proximity::OPINION_DISAGREES;
    if (row.second_opinion != Proximity::OPINION_DISAGREES) continue;
    ++disputed;
    if (disagreements_.isDue(row.id + "\n" + row.a + "\n" + row.b))
      ROS_WARN_STREAM("'" << row.id << (row.a.empty() || row.a == row.id ? "" : "', '" + row.a) << "' and '" << row.b
                          << "': " << row.message);
  }

  const std::lock_guard<std::mutex> lock(mutex_);
  ++now_.calls;
  now_.failed_calls += !success;
  now_.rows += results.size();
  now_.undecided += undecided;
  now_.failed += failed;
  now_.opinions += opinions;
  now_.disputed += disputed;
  now_.all_disputed += disputed;
  now_.busy += seconds;
  now_.longest = std::max(now_.longest, seconds);
}

Summary Statistics::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  Summary out = now_;
  out.seconds = std::chrono::duration<double>(now - since_).count();
  now_ = Summary();
  now_.all_disputed = out.all_disputed;
  since_ = now;
  return out;
}

} // namespace curve_proximity
