/* SPDX-License-Identifier: BSD-3-Clause */
/** The parameters that may change while queries run. */
#ifndef CURVE_PROXIMITY_ROS_TUNING_H
#define CURVE_PROXIMITY_ROS_TUNING_H

#include <atomic>

#include "parameters/parameters.h"

namespace curve_proximity {

/** Each query reads them once, at its start. */
struct Tuning {
  explicit Tuning(const Parameters &parameters)
      : epsilon(parameters.epsilon),
        delta(parameters.delta),
        budget_ms(parameters.budget_ms),
        max_nodes(parameters.max_nodes),
        threads(parameters.threads) {}

  std::atomic<double> epsilon, delta, budget_ms;
  std::atomic<int> max_nodes, threads;
};

} // namespace curve_proximity
#endif
