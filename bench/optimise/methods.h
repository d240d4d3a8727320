/* SPDX-License-Identifier: BSD-3-Clause */
/* One optimiser, NLopt's SLSQP, with clearances of the whole motion and with clearances of sampled states. */
#ifndef CPROX_BENCH_METHODS_H
#define CPROX_BENCH_METHODS_H

#include "arm_problems.h"

namespace curve_proximity {

struct Outcome {
  Eigen::MatrixXd control;  /* of the spline that it ends with */
  bool says_clear = false;  /* by more than kClear everywhere */
  bool says_free = false;   /* of contact */
  unsigned evaluations = 0; /* of all clearances of a motion */
  double microseconds = 0.0;
};

/* Constraints are the rows of clearanceRows(); the end is proven. As examples/push_out_arm.cpp. */
Outcome by_rows(const ArmProblem &problem, Workspace &workspace);

/* The same constraints of sampled states, evenly spaced in time: of each span the pairs that come nearest. */
Outcome by_sampled_rows(const ArmProblem &problem, int states);

/* The squared jerk and a weight times the mean over sampled states of sum max(0, wanted - distance)². The weight grows
 * tenfold until all samples are clear. */
Outcome by_sampled_hinges(const ArmProblem &problem, int states);

/* What is true of a spline's motion: where it comes, certified, and where FCL finds it at `states` of its states. */
struct Truth {
  double lower = 0.0, upper = 0.0; /* [m] of the least signed distance */
  double sampled = 0.0;            /* [m] the least of the samples that are within 20 mm, else that */
};
Truth truth_of(const ArmProblem &problem, const Eigen::MatrixXd &control, int states, Workspace &workspace);

} // namespace curve_proximity
#endif
