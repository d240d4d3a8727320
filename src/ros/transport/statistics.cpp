/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/statistics.h"

#include <algorithm>
#include <cmath>

#include <curve_proximity/cprox.h>
#include <ros/console.h>

namespace curve_proximity {

void Statistics::record(Clock::duration took, bool success, const std::vector<Proximity> &results) {
  const double us = std::chrono::duration<double, std::micro>(took).count();
  const double place = std::floor(std::log2(std::max(1.0, us)) * static_cast<double>(PER_OCTAVE));
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
  ++buckets_[std::min(static_cast<std::size_t>(place), buckets_.size() - 1)];
  ++now_.calls;
  now_.failed_calls += !success;
  now_.rows += results.size();
  now_.undecided += undecided;
  now_.failed += failed;
  now_.opinions += opinions;
  now_.disputed += disputed;
  disputed_ += disputed;
}

/** The middle of the bucket in which that share of the calls is reached. */
double Statistics::percentile(double fraction) const {
  if (now_.calls == 0) return 0.0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(now_.calls)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_[i];
    if (seen >= wanted) return std::exp2((static_cast<double>(i) + 0.5) / static_cast<double>(PER_OCTAVE));
  }
  return 0.0;
}

Summary Statistics::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  Summary out = now_;
  out.all_disputed = disputed_;
  out.seconds = std::chrono::duration<double>(now - since_).count();
  out.p50_us = percentile(0.5);
  out.p99_us = percentile(0.99);
  now_ = Summary();
  buckets_.fill(0);
  since_ = now;
  return out;
}

} // namespace curve_proximity
