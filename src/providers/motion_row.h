/* SPDX-License-Identifier: BSD-3-Clause */
/** A clearance along a motion as a row of a provider's answer. */
#ifndef CURVE_PROXIMITY_PROVIDERS_MOTION_ROW_H
#define CURVE_PROXIMITY_PROVIDERS_MOTION_ROW_H

#include <curve_proximity/constraint_provider.hpp>
#include <string>
#include <utility>

namespace curve_proximity {

/** The pairs that the parameter of that name asks about. */
inline RobotPairs readAgainst(ParameterReader &reader) {
  const std::string against = reader.word("against", "whole", {"environment", "self", "whole"});
  return against == "whole" ? RobotPairs::WHOLE : against == "self" ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
}

/** value is that of the row; margin comes off the value and its bounds. */
inline MotionRow motionRow(ClearanceRow &&found, double value, double margin) {
  MotionRow row;
  const cprox_result &result = found.answer.result;
  ClearanceGradient &gradient = found.gradient;
  row.status = result.status;
  row.value = value - margin;
  row.bounded = true;
  row.lower = result.lower - margin;
  row.upper = result.upper - margin;
  row.valid = gradient.valid;
  row.reason = std::move(gradient.reason);
  row.a = {gradient.base_linear, gradient.base_angular};
  row.b = {gradient.object_linear, gradient.object_angular};
  row.t = result.t;
  row.has_points = !found.answer.b.empty();
  row.witness_a = toEigen(result.witness_mover);
  row.witness_b = toEigen(result.witness_obstacle);
  row.normal = toEigen(result.normal);
  row.kind = std::move(found.answer.kind);
  row.side_a = std::move(found.answer.a);
  row.side_b = std::move(found.answer.b);
  row.t0 = found.t0;
  row.t1 = found.t1;
  row.positions = std::move(gradient.positions);
  row.velocities = std::move(gradient.velocities);
  row.accelerations = std::move(gradient.accelerations);
  row.duration = gradient.duration;
  row.start = gradient.start;
  return row;
}

} // namespace curve_proximity
#endif
