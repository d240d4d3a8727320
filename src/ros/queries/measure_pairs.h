/* SPDX-License-Identifier: BSD-3-Clause */
/** ~measure_pairs: two bodies at a time, without the scene. */
#ifndef CURVE_PROXIMITY_ROS_MEASURE_PAIRS_H
#define CURVE_PROXIMITY_ROS_MEASURE_PAIRS_H

#include <curve_proximity/MeasurePairs.h>

#include <curve_proximity/second_opinion.hpp>
#include <memory>

#include "parameters/parameters.h"
#include "parameters/tuning.h"
#include "queries/time_budget.h"
#include "transport/statistics.h"
#include "transport/workspaces.h"

namespace curve_proximity {

/** Any number of threads. All is kept by reference but the opinions, which may be null. */
class Pairs {
 public:
  Pairs(const Parameters &parameters, const Tuning &tuning, Statistics &statistics,
        std::shared_ptr<const SecondOpinions> opinions);

  /** Throws Error where nothing can be answered at all; what is wrong with one pair becomes its row. */
  void answer(const MeasurePairs::Request &request, MeasurePairs::Response &response, TimeBudget &budget);

 private:
  const Parameters &parameters_;
  const Tuning &tuning_;
  Statistics &statistics_;
  const std::shared_ptr<const SecondOpinions> opinions_;
  WorkspacePool workspaces_;
};

} // namespace curve_proximity
#endif
