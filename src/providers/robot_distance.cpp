/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/RobotDistance: the clearance of a robot along a joint trajectory, from the scene and from itself,
 * with its gradient by the trajectory's points. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <pluginlib/class_list_macros.hpp>
#include <utility>

#include "motion_row.h"

namespace curve_proximity {
namespace {

struct RobotDistanceParameters {
  RobotPairs against = RobotPairs::WHOLE;
  Query query;
  RowLimits limits;       /* a horizon of 0: the least clearance alone */
  double smoothing = 0.0; /* [m] 0: rows, else one soft minimum of them */
  double margin = 0.0;    /* [m] */
};

/* A soft minimum of numbers below a horizon h: with x_i = (h - v_i) / smoothing,
 *
 *     h - smoothing (log(1 + sum (exp(x_i) - 1 - x_i)) + MOST_ABOVE).
 *
 * A number that comes below the horizon enters with a derivative of 0, so that it is smooth there as well. Its excess
 * below the least one is between 0 and smoothing (log n + MOST_ABOVE), n >= 1 numbers (doc/constraint-providers.md). */
class SoftMinimum {
 public:
  SoftMinimum(double horizon, double smoothing, double least)
      : horizon_(horizon),
        smoothing_(smoothing),
        most_(std::max(0.0, (horizon - least) / smoothing)),
        sum_(std::exp(-most_)) {}

  void add(double value) {
    const double x = std::max(0.0, (horizon_ - value) / smoothing_);
    sum_ += std::exp(x - most_) - (1.0 + x) * std::exp(-most_);
  }

  double value() const {
    return horizon_ - smoothing_ * (most_ + std::log(sum_) + MOST_ABOVE);
  }

  /* Its derivative by one of the numbers. */
  double weight(double value) const {
    const double x = std::max(0.0, (horizon_ - value) / smoothing_);
    return (std::exp(x - most_) - std::exp(-most_)) / sum_;
  }

 private:
  static constexpr double MOST_ABOVE = 0.4586751453870819; /* -log(1 - 1/e) */
  const double horizon_, smoothing_, most_;
  double sum_; /* over exp(most_), so that nothing overflows */
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
    if (asked.movers)
      evaluateAmong(asked, query, workspace, out);
    else if (parameters_.limits.horizon > 0.0)
      evaluateRows(clearanceRows(asked.motion, parameters_.against, parameters_.limits, query, workspace), out);
    else
      evaluateLeast(clearanceGradient(asked.motion, parameters_.against, query, workspace), out);
  }

  bool takesMovers() const override {
    return true;
  }

 private:
  MotionRow toRow(ClearanceRow &&found) const {
    /* where meshes overlap the gradient is that of their hulls, and so is the value */
    const cprox_result &result = found.answer.result;
    const double value = result.status == CPROX_OVERLAP ? result.lower : result.upper;
    return motionRow(std::move(found), value, parameters_.margin);
  }

  /* A row against all that stands and moves, and one of the robot with itself. */
  void evaluateAmong(const ConstraintMotion &asked, const Query &query, Workspace &workspace, MotionValue &out) const {
    if (parameters_.limits.horizon > 0.0)
      throw Error(
          "a horizon is not available where objects or further robots move: leave it out for the least clearance");
    std::vector<ClearanceRow> found;
    if (parameters_.against != RobotPairs::SELF)
      found.push_back(clearanceGradient(*asked.movers, *asked.robot, query, workspace));
    if (parameters_.against != RobotPairs::ENVIRONMENT)
      found.push_back(clearanceGradient(asked.motion, RobotPairs::SELF, query, workspace));
    std::stable_sort(found.begin(), found.end(), [](const ClearanceRow &x, const ClearanceRow &y) {
      return x.answer.result.upper < y.answer.result.upper;
    });
    evaluateLeast(std::move(found.front()), out);
    if (found.size() == 1 || found.back().answer.b.empty()) return; // nothing to measure against has no row
    out.rows.push_back(toRow(std::move(found.back())));
    out.lower = std::min(out.lower, out.rows.back().lower);
  }

  void evaluateLeast(ClearanceRow &&found, MotionValue &out) const {
    out.status = found.answer.result.status;
    if (out.status != CPROX_OK || found.answer.gap) out.message = found.answer.message;
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
      out.value = std::min(out.value, row.value);
      out.lower = std::min(out.lower, row.lower);
      out.upper = std::min(out.upper, row.upper);
      if (row.status == CPROX_OVERLAP && out.status == CPROX_OK) {
        out.status = CPROX_OVERLAP;
        out.message = "meshes overlap: their convex hulls say how deep at most";
      }
    }
    const double least = parameters_.query.options.signed_distance ? -INFINITE : -parameters_.margin;
    const bool whole = (out.status == CPROX_OK || out.status == CPROX_OVERLAP) && !found.gap;
    if (!whole) out.lower = least;
    if (parameters_.smoothing > 0.0) soften(whole, out);
  }

  SoftMinimum softMinimum(const std::vector<MotionRow> &rows, double MotionRow::*number) const {
    const double horizon = parameters_.limits.horizon - parameters_.margin;
    double least = horizon;
    for (const MotionRow &row : rows) least = std::min(least, row.*number);
    SoftMinimum out(horizon, parameters_.smoothing, least);
    for (const MotionRow &row : rows) out.add(row.*number);
    return out;
  }

  /* One row in the place of all: the nearest one's witness, and the sum of the weighted gradients. The object's is that
   * by a step of the nearest one. whole: no row is missing. */
  void soften(bool whole, MotionValue &out) const {
    const SoftMinimum soft = softMinimum(out.rows, &MotionRow::value);
    out.value = soft.value();
    /* the sum of a million rows is known to 1e-10 of itself */
    const double rounding = 1e-9 * (parameters_.smoothing + parameters_.limits.horizon);
    out.lower = -std::numeric_limits<double>::infinity();
    if (whole) out.lower = softMinimum(out.rows, &MotionRow::lower).value() - rounding;
    out.upper = softMinimum(out.rows, &MotionRow::upper).value() + rounding;
    if (out.rows.empty()) return;
    MotionRow sum = out.rows.front();
    for (Eigen::MatrixXd *matrix : {&sum.positions, &sum.velocities, &sum.accelerations}) matrix->setZero();
    sum.a = sum.b = ConstraintGradient();
    sum.duration = 0.0;
    for (const MotionRow &row : out.rows) {
      const double weight = soft.weight(row.value);
      sum.positions += weight * row.positions;
      sum.velocities += weight * row.velocities;
      sum.accelerations += weight * row.accelerations;
      sum.duration += weight * row.duration;
      sum.a.linear += weight * row.a.linear;
      sum.a.angular += weight * row.a.angular;
      if (row.kind == sum.kind && row.side_b == sum.side_b) {
        sum.b.linear += weight * row.b.linear;
        sum.b.angular += weight * row.b.angular;
      }
      if (weight > 0.0 && !row.valid && sum.valid) {
        sum.valid = false;
        sum.reason = row.reason;
      }
      sum.t0 = std::min(sum.t0, row.t0);
      sum.t1 = std::max(sum.t1, row.t1);
    }
    sum.value = out.value, sum.lower = out.lower, sum.upper = out.upper;
    out.rows = {std::move(sum)};
  }

  const RobotDistanceParameters parameters_;
};

} // namespace

class RobotDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    parameters_.against = readAgainst(reader);
    parameters_.limits.horizon = reader.number("horizon", 0.0, 0.0);
    parameters_.smoothing = reader.number("smoothing", 0.0, 0.0);
    if (parameters_.smoothing > 0.0 && !(parameters_.limits.horizon > 0.0))
      throw Error("parameter smoothing: it is a soft minimum of the rows within a horizon: give one");
    /* a row that is left out would make a step in the soft minimum */
    const int rows = parameters_.smoothing > 0.0 ? 1000000 : 1;
    parameters_.limits.per_pair = static_cast<std::size_t>(reader.count("per_pair", rows, 1, 1000000));
    parameters_.limits.most = static_cast<std::size_t>(reader.count("max_rows", 1000, 1, 1000000));
    parameters_.query.options.epsilon = reader.number("epsilon", 1e-6, 0.0, true);
    parameters_.query.options.max_nodes = static_cast<std::uint32_t>(reader.count("max_nodes", 500000, 1, 2000000000));
    parameters_.margin = reader.number("margin", 0.0, 0.0);
    parameters_.query.options.signed_distance = reader.truth("signed", false);
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair & /*pair*/) const override {
    throw DoesNotApply(
        "RobotDistance is about joint trajectories: give one, or ask CurveDistance or SuperquadricDistance");
  }

  std::unique_ptr<const MotionConstraint> prepareMotion(const PreparedRobot & /*robot*/) const override {
    return std::make_unique<RobotDistanceConstraint>(parameters_);
  }

 private:
  RobotDistanceParameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::RobotDistance, curve_proximity::ConstraintProvider)
