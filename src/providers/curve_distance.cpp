/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/CurveDistance: the distance of what rides a curve from bodies, by the core's search and its gradient.
 */
#include <pluginlib/class_list_macros.hpp>

#include "distance_constraints.h"

namespace curve_proximity {
namespace {

class CurveDistanceConstraint : public Constraint {
 public:
  CurveDistanceConstraint(const CurveDistanceParameters &parameters, const ConstraintPair &pair)
      : parameters_(parameters), pair_(pair), excess_(excessOf(pair.a) + excessOf(pair.b, parameters.exact_meshes)) {
    if (!pair.a.parts.empty()) carried_ = joinedBody(pair.a);
    target_ = joinedBody(pair.b, parameters.exact_meshes);
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    requirePlace(pair_, place);
    const CurveDescription &curve = place.curve->description;
    cprox_mover mover = carried_ ? cprox_body_along(carried_.get(), place.curve->curve.get())
                                 : cprox_tube_along(place.curve->curve.get(), 0.0);
    mover.radius = curve.radius + pair_.a.padding;
    const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(target_.get(), place.b), pair_.b.padding);

    // The core's two calls.
    cprox_result result{};
    cprox_gradient gradient{};
    require(cprox_distance(mover, target, &parameters_.options, workspace.get(), &result), workspace);
    if (result.status == CPROX_OVERLAP) return overlapping(result, curve, out);
    require(cprox_distance_gradient(mover, target, &parameters_.options, &result, workspace.get(), &gradient),
            workspace);

    // What they say, in the words of constraint_provider.hpp.
    fillValue(result, out);
    out.valid = gradient.valid;
    out.reason = gradient.valid ? "" : cprox_workspace_error(workspace.get());
    out.t = gradient.t;
    out.b.linear = toEigen(gradient.position);
    out.b.angular = toEigen(gradient.rotation);
    out.radius = gradient.radius;
    fillCurve(curve, gradient.t, toEigen(gradient.mover), out);
  }

 private:
  void fillValue(const cprox_result &result, ConstraintValue &out) const {
    out.status = result.status;
    out.value = result.upper - parameters_.margin;
    out.bounded = true;
    out.lower = result.lower - excess_ - parameters_.margin;
    out.upper = result.upper - parameters_.margin;
    out.has_points = true;
    out.witness_a = toEigen(result.witness_mover);
    out.witness_b = toEigen(result.witness_obstacle);
    out.normal = toEigen(result.normal);
  }

  /* By the curve's points, and by the curve as a whole: psi(t) changes by the weights, and the value by n for psi(t).
   * The weights stand at the front of the matrix; from the back, a column never covers a weight that is still to be
   * read. */
  static void fillCurve(const CurveDescription &curve, double t, const Eigen::Vector3d &n, ConstraintValue &out) {
    const Eigen::Index count = curve.points.cols();
    out.points.resize(3, count);
    double *weights = out.points.data();
    curveWeights(curve, t, weights);
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (Eigen::Index i = count; i-- > 0;) {
      const double w = weights[i];
      at += w * curve.points.col(i);
      out.points.col(i) = w * n;
    }
    out.a.linear = n;
    out.a.angular = at.cross(n);
  }

  /* They overlap, and the target cannot tell how deep. */
  void overlapping(const cprox_result &result, const CurveDescription &curve, ConstraintValue &out) const {
    fillValue(result, out);
    out.valid = false;
    out.reason = "they overlap, and how deep is not known";
    out.a = out.b = ConstraintGradient();
    out.points.setZero(3, curve.points.cols());
    out.radius = 0.0;
    out.t = result.t;
  }

  const CurveDistanceParameters parameters_;
  const ConstraintPair pair_;
  const double excess_;
  BodyHandle carried_, target_;
};

} // namespace

std::unique_ptr<const Constraint> curveDistance(const CurveDistanceParameters &parameters, const ConstraintPair &pair) {
  return std::make_unique<CurveDistanceConstraint>(parameters, pair);
}

class CurveDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    parameters_.options.epsilon = reader.number("epsilon", 1e-9, 0.0);
    parameters_.options.max_nodes = static_cast<std::uint32_t>(reader.count("max_nodes", 500000, 1, 2000000000));
    parameters_.options.signed_distance = reader.truth("signed", true);
    parameters_.margin = reader.number("margin", 0.0, 0.0);
    const std::string meshes = reader.word("meshes", "hull", {"hull", "exact"});
    parameters_.exact_meshes = meshes == "exact";
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (pair.along_curve) return curveDistance(parameters_, pair);
    if (!pair.is_named) throw DoesNotApply("SuperquadricDistance answers about standing bodies");
    StandingDistanceParameters standing;
    standing.options.epsilon = parameters_.options.epsilon;
    standing.options.max_nodes = parameters_.options.max_nodes;
    standing.margin = parameters_.margin;
    return standingDistance(standing, pair);
  }

 private:
  CurveDistanceParameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CurveDistance, curve_proximity::ConstraintProvider)
