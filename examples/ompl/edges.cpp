/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges.hpp"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

using curve_proximity::Answer;
using curve_proximity::Query;
using curve_proximity::QueryType;
using curve_proximity::RobotMotion;
using curve_proximity::TrajectoryDescription;

namespace {

std::vector<double> valuesOf(const Task &task, const ompl::base::State *state) {
  const double *values = state->as<ompl::base::RealVectorStateSpace::StateType>()->values;
  return {values, values + task.joints.size()};
}

} // namespace

bool clearBetween(const Task &task, const std::vector<double> &from, const std::vector<double> &to,
                  curve_proximity::Workspace &workspace) {
  TrajectoryDescription edge;
  edge.joints = task.joints;
  edge.points = {{from, {}, {}, 0.0}, {to, {}, {}, 1.0}};
  const RobotMotion motion(task.snapshot, edge, task.rest, task.disabled);

  Query query;
  query.query_type = QueryType::TOLERANCE;
  query.delta = task.clearance;
  for (const Answer &answer : askEnvironment(motion, query, workspace)) {
    if (answer.result.verdict != CPROX_VERDICT_CLEAR) return false;
  }
  query.delta = 0.0;
  return askSelf(motion, query, workspace).result.verdict == CPROX_VERDICT_CLEAR;
}

bool CertifiedMotionValidator::checkMotion(const ompl::base::State *from, const ompl::base::State *to) const {
  const bool clear = clearBetween(task_, valuesOf(task_, from), valuesOf(task_, to), workspace_);
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
  if (!si_->satisfiesBounds(state)) return false;
  const std::vector<double> values = valuesOf(task_, state);
  return clearBetween(task_, values, values, workspace_);
}
