/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of a Panda at single states, by FCL: what optimisers by samples ask for. */
#ifndef CPROX_BENCH_SAMPLED_ARM_H
#define CPROX_BENCH_SAMPLED_ARM_H

#include <memory>
#include <vector>

#include "arm_problems.h"

namespace curve_proximity {

struct PairDistance {
  std::size_t pair;             /* its number */
  double distance;              /* [m] below 0: minus the penetration depth */
  Eigen::RowVectorXd by_joints; /* [m/rad] by FCL's normal and the Jacobian of the witness points */
};

/* The convex hulls of the links against the objects, and of the links that no SRDF disables against each other. */
class SampledArm {
 public:
  explicit SampledArm(const ArmScene &scene);
  ~SampledArm();

  /* The pairs that come within the horizon at a state of the scene's joints. Others are not looked at closely: their
   * bounding boxes are farther. */
  void measure(const Eigen::RowVectorXd &state, double horizon, std::vector<PairDistance> &out);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

} // namespace curve_proximity
#endif
