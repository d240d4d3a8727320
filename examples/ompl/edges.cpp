/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges.hpp"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <cmath>

namespace {

const double *valuesOf(const ompl::base::State *state) {
  return state->as<ompl::base::RealVectorStateSpace::StateType>()->values;
}

} // namespace

bool isClear(const Task &task, const double *from, const double *to, curve_proximity::Workspace &workspace) {
  return task.checker->ask(from, to, workspace) == CPROX_VERDICT_CLEAR;
}

bool isClearAtSamples(const Task &task, const double *from, const double *to, double step,
                      curve_proximity::Workspace &workspace) {
  std::vector<double> at(task.joints.size());
  double length = 0.0;
  for (std::size_t k = 0; k < at.size(); ++k) length += (to[k] - from[k]) * (to[k] - from[k]);
  const int n = std::max(1, static_cast<int>(std::ceil(std::sqrt(length) / step)));
  for (int i = n; i >= 0; --i) {
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = from[k] + (to[k] - from[k]) * i / n;
    if (!isClear(task, at.data(), at.data(), workspace)) return false;
  }
  return true;
}

bool CertifiedMotionValidator::checkMotion(const ompl::base::State *from, const ompl::base::State *to) const {
  const bool clear = isClear(task_, valuesOf(from), valuesOf(to), workspace_);
  ++(clear ? valid_ : invalid_);
  return clear;
}

bool CertifiedMotionValidator::checkMotion(const ompl::base::State *from, const ompl::base::State *to,
                                           std::pair<ompl::base::State *, double> &last_valid) const {
  const bool clear = checkMotion(from, to);
  if (!clear) {
    last_valid.second = 0.0;
    if (last_valid.first) si_->copyState(last_valid.first, from);
  }
  return clear;
}

bool StateChecker::isValid(const ompl::base::State *state) const {
  return si_->satisfiesBounds(state) && isClear(task_, valuesOf(state), valuesOf(state), workspace_);
}
