/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/RobotDistance: the clearance of a robot along a joint trajectory, from the scene and from itself,
 * with its gradient by the trajectory's points. */
#include <algorithm>
#include <limits>
#include <pluginlib/class_list_macros.hpp>
#include <utility>

#include <curve_proximity/constraint_provider.hpp>

namespace curve_proximity {
namespace {

struct RobotDistanceParameters {
  RobotPairs against = RobotPairs::WHOLE;
  Query query;
  RowLimits limits;    /* a horizon of 0: the least clearance alone */
  double margin = 0.0; /* [m] */
};

class RobotDistanceConstraint : public MotionConstraint {
 public:
  explicit RobotDistanceConstraint(const RobotDistanceParameters &parameters) : parameters_(parameters) {}

  void evaluate(const ConstraintMotion &asked, Workspace &workspace, MotionValue &out) const override {
    Query query = parameters_.query;
    query.options.stop = asked.stop;
    query.options.stop_user = asked.stop_user;
    out = MotionValue();
    out.bounded = true;
    if (parameters_.limits.horizon > 0.0)
      evaluateRows(clearanceRows(asked.motion, parameters_.against, parameters_.limits, query, workspace), out);
    else
      evaluateLeast(clearanceGradient(asked.motion, parameters_.against, query, workspace), out);
  }

 private:
  MotionRow toRow(ClearanceRow &&found) const {
    MotionRow row;
    const cprox_result &result = found.answer.result;
    ClearanceGradient &gradient = found.gradient;
    row.status = result.status;
    row.value = result.upper - parameters_.margin;
    row.bounded = true;
    row.lower = result.lower - parameters_.margin;
    row.upper = row.value;
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
    return row;
  }

  void evaluateLeast(ClearanceRow &&found, MotionValue &out) const {
    out.status = found.answer.result.status;
    if (out.status != CPROX_OK) out.message = found.answer.message;
    out.rows.push_back(toRow(std::move(found)));
    out.value = out.rows.front().value;
    out.lower = out.rows.front().lower;
    out.upper = out.rows.front().upper;
  }

  /* What has no row is farther than the horizon. Where rows may be missing they prove no lower end. */
  void evaluateRows(ClearanceRows &&found, MotionValue &out) const {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    out.status = found.status;
    out.message = std::move(found.message);
    out.value = out.lower = parameters_.limits.horizon - parameters_.margin;
    out.upper = INFINITE;
    for (ClearanceRow &row : found.rows) out.rows.push_back(toRow(std::move(row)));
    std::stable_sort(out.rows.begin(), out.rows.end(),
                     [](const MotionRow &x, const MotionRow &y) { return x.value < y.value; });
    for (const MotionRow &row : out.rows) {
      out.lower = std::min(out.lower, row.lower);
      out.upper = std::min(out.upper, row.upper);
    }
    out.value = std::min(out.value, out.upper);
    if (out.status != CPROX_OK) out.lower = parameters_.query.options.signed_distance ? -INFINITE : -parameters_.margin;
  }

  const RobotDistanceParameters parameters_;
};

} // namespace

class RobotDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    const std::string against = reader.word("against", "whole", {"environment", "self", "whole"});
    parameters_.against = against == "whole"  ? RobotPairs::WHOLE
                          : against == "self" ? RobotPairs::SELF
                                              : RobotPairs::ENVIRONMENT;
    parameters_.limits.horizon = reader.number("horizon", 0.0, 0.0);
    parameters_.limits.per_pair = static_cast<std::size_t>(reader.count("per_pair", 1, 1, 1000000));
    parameters_.limits.most = static_cast<std::size_t>(reader.count("max_rows", 1000, 1, 1000000));
    parameters_.query.options.epsilon = reader.number("epsilon", 1e-6, 0.0, true);
    parameters_.query.options.max_nodes = static_cast<std::uint32_t>(reader.count("max_nodes", 20000, 1, 2000000000));
    parameters_.margin = reader.number("margin", 0.0, 0.0);
    parameters_.query.options.signed_distance = reader.truth("signed", false);
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair & /*pair*/) const override {
    throw Error("RobotDistance is about joint trajectories: give one, or ask CurveDistance or SuperquadricDistance");
  }

  std::unique_ptr<const MotionConstraint> prepareMotion(const PreparedRobot & /*robot*/) const override {
    return std::make_unique<RobotDistanceConstraint>(parameters_);
  }

 private:
  RobotDistanceParameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::RobotDistance, curve_proximity::ConstraintProvider)
