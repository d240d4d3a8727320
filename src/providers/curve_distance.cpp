/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/CurveDistance: the distance of what rides a curve from bodies, by the core's search and its gradient.
 */
#include <algorithm>
#include <limits>
#include <optional>
#include <pluginlib/class_list_macros.hpp>

#include "distance_constraints.h"
#include "outline.h"

namespace curve_proximity {
namespace {

/* What rides a curve, and what it is measured against. */
struct Sides {
  BodyHandle carried, obstacle; /* carried: null for the curve's ball */
};

class CurveDistanceConstraint : public Constraint {
 public:
  CurveDistanceConstraint(const CurveDistanceParameters &parameters, const ConstraintPair &pair)
      : parameters_(parameters),
        pair_(pair),
        has_hulls_(hasHulls(pair.a) || hasHulls(pair.b)),
        excess_(excessOf(pair.a) + excessOf(pair.b)) {
    const bool carries = !pair.a.parts.empty(), exact = parameters.meshes == Meshes::EXACT;
    if (carries) hulls_.carried = joinedBody(pair.a);
    hulls_.obstacle = joinedBody(pair.b);
    if (!has_hulls_) return;
    if (exact) requireShapes(pair.b);
    if (carries && hasShapes(pair.a)) shapes_.carried = joinedBody(pair.a, true);
    if (hasShapes(pair.b)) shapes_.obstacle = joinedBody(pair.b, true);
    if (!exact) return;
    measured_.carried = carries && hasHulls(pair.a) ? convexElements(pair.a) : hulls_.carried;
    measured_.obstacle = shapes_.obstacle;
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    requirePlace(pair_, place);
    if (!has_hulls_)
      evaluateAll(hulls_, place, workspace, out);
    else if (parameters_.meshes == Meshes::HULL)
      evaluateHulls(std::nullopt, place, workspace, out);
    else
      evaluateShapes(place, workspace, out);
  }

 private:
  static double infinity() {
    return std::numeric_limits<double>::infinity();
  }

  static bool hasShapes(const ConstraintBody &side) {
    return std::all_of(side.parts.begin(), side.parts.end(),
                       [](const ConstraintBody::Part &part) { return part.exact || !isHull(part); });
  }

  static void requireShapes(const ConstraintBody &side) {
    if (!hasShapes(side))
      throw Error("a mesh that was simplified has no exact distance: ask with meshes: hull, or without a tolerance");
  }

  cprox_mover moverOf(const Sides &sides, const ConstraintPlace &place) const {
    cprox_mover mover = sides.carried ? cprox_body_along(sides.carried.get(), place.curve->curve.get())
                                      : cprox_tube_along(place.curve->curve.get(), 0.0);
    mover.radius = place.curve->description.radius + pair_.a.padding;
    mover.radius_curve = place.curve->radius_curve.get();
    return mover;
  }

  cprox_obstacle obstacleOf(const Sides &sides, const ConstraintPlace &place) const {
    return cprox_with_margin(cprox_obstacle_at(sides.obstacle.get(), place.b), pair_.b.padding);
  }

  /* The core's two calls, and what they say in the words of constraint_provider.hpp. */
  cprox_result measure(const Sides &sides, const ConstraintPlace &place, Workspace &workspace) const {
    cprox_result result{};
    require(
        cprox_distance(moverOf(sides, place), obstacleOf(sides, place), &parameters_.options, workspace.get(), &result),
        workspace);
    return result;
  }

  void fill(const Sides &sides, const cprox_result &result, const ConstraintPlace &place, Workspace &workspace,
            ConstraintValue &out) const {
    cprox_gradient gradient{};
    require(cprox_distance_gradient(moverOf(sides, place), obstacleOf(sides, place), &parameters_.options, &result,
                                    workspace.get(), &gradient),
            workspace);
    fillValue(result, out);
    out.valid = gradient.valid;
    out.reason = gradient.valid ? "" : cprox_workspace_error(workspace.get());
    out.t = gradient.t;
    out.b.linear = toEigen(gradient.position);
    out.b.angular = toEigen(gradient.rotation);
    out.radius = gradient.radius;
    out.range_start = gradient.t0, out.range_end = gradient.t1;
    fillCurve(*place.curve, gradient.t, toEigen(gradient.mover), workspace, out);
  }

  void evaluateAll(const Sides &sides, const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const {
    const cprox_result result = measure(sides, place, workspace);
    if (result.status == CPROX_OVERLAP)
      overlapping(result, place.curve->description, out);
    else
      fill(sides, result, place, workspace, out);
  }

  /* Apart, the shapes have their own distance and gradient. Where they overlap, their hulls say how deep at most. */
  void evaluateShapes(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const {
    const cprox_result result = measure(measured_, place, workspace);
    const bool inside = result.lower > 0.0 && isInside(result.t, place, workspace);
    const bool apart = result.lower > 0.0 && !inside;
    if (apart || !parameters_.options.signed_distance) {
      fill(measured_, result, place, workspace, out);
      if (!inside) return;
      out.value = out.lower = out.upper = -parameters_.margin;
      out.valid = false;
      out.reason = "one is inside of the other";
    } else {
      evaluateHulls(inside ? 0.0 : result.upper, place, workspace, out);
      out.status = result.status == CPROX_OK ? CPROX_OVERLAP : result.status;
    }
  }

  /* Value and gradient of the hulls, which bound the shapes' distance from below. Without an upper bound of that the
   * shapes are measured at the place where the hulls are nearest. */
  void evaluateHulls(std::optional<double> upper, const ConstraintPlace &place, Workspace &workspace,
                     ConstraintValue &out) const {
    const cprox_result result = measure(hulls_, place, workspace);
    if (result.status == CPROX_OVERLAP)
      overlapping(result, place.curve->description, out);
    else
      fill(hulls_, result, place, workspace, out);
    if (!upper) upper = pairAt(result.t, place, workspace).upper;
    if (!parameters_.options.signed_distance) upper = std::max(*upper, 0.0);
    out.lower -= excess_;
    out.upper = std::max(*upper - parameters_.margin, out.lower);
    out.value = std::min(out.value, out.upper);
  }

  /* The shapes themselves, where the curve is at t. Infinitely far where they are not known. */
  cprox_result pairAt(double t, const ConstraintPlace &place, Workspace &workspace) const {
    cprox_result result{};
    result.lower = -infinity();
    result.upper = infinity();
    if (!shapes_.obstacle || (hulls_.carried && !shapes_.carried)) return result;
    cprox_pose at = CPROX_POSE_IDENTITY;
    require(cprox_curve_evaluate(place.curve->curve.get(), t, workspace.get(), &at.position, nullptr, nullptr),
            workspace);
    const cprox_body *carried = shapes_.carried ? shapes_.carried.get() : point_.get();
    cprox_vec3 more{};
    if (place.curve->radius_curve)
      require(cprox_curve_evaluate(place.curve->radius_curve.get(), t, workspace.get(), &more, nullptr, nullptr),
              workspace);
    const double radius = std::max(0.0, place.curve->description.radius + more.x);
    const cprox_obstacle mover = cprox_with_margin(cprox_obstacle_at(carried, at), radius + pair_.a.padding);
    require(cprox_pair(mover, obstacleOf(shapes_, place), &parameters_.options, workspace.get(), &result), workspace);
    result.upper += curveError(place.curve->curve.get(), place.curve->description.points);
    if (place.curve->radius_curve) result.upper += curveError(place.curve->radius_curve.get(), Eigen::Matrix3Xd());
    return result;
  }

  /* How far a plain evaluation may be from the curve. */
  static double curveError(const cprox_curve *curve, const Eigen::Matrix3Xd &points) {
    const cprox_curve_info info = cprox_curve_get_info(curve);
    const double size = toEigen(info.lowest).cwiseAbs().cwiseMax(toEigen(info.highest).cwiseAbs()).maxCoeff();
    double coefficients = size;
    if (points.cols() > 0) coefficients += points.cwiseAbs().maxCoeff();
    return info.error + (12.0 * static_cast<double>(info.degree) + 20.0) * 0x1p-52 * coefficients;
  }

  /* What has come nowhere near a surface is inside of the other all along, or never. */
  bool isInside(double t, const ConstraintPlace &place, Workspace &workspace) const {
    return hulls_.carried && hasHulls(pair_.a) && pairAt(t, place, workspace).status == CPROX_OVERLAP;
  }

  void fillValue(const cprox_result &result, ConstraintValue &out) const {
    out.status = result.status;
    out.value = result.upper - parameters_.margin;
    out.bounded = true;
    out.lower = result.lower - parameters_.margin;
    out.upper = result.upper - parameters_.margin;
    out.has_points = true;
    out.witness_a = toEigen(result.witness_mover);
    out.witness_b = toEigen(result.witness_obstacle);
    out.normal = toEigen(result.normal);
  }

  /* By what defines the curve, and by the curve as a whole: its point at t moves and turns with it. */
  static void fillCurve(const ConstraintCurve &curve, double t, const Eigen::Vector3d &n, Workspace &workspace,
                        ConstraintValue &out) {
    gradientByCurve(curve.description, t, n, out.points, out.parameters);
    cprox_vec3 at{};
    require(cprox_curve_evaluate(curve.curve.get(), t, workspace.get(), &at, nullptr, nullptr), workspace);
    out.a.linear = n;
    out.a.angular = toEigen(at).cross(n);
  }

  /* They overlap, and the obstacle cannot tell how deep. */
  void overlapping(const cprox_result &result, const CurveDescription &curve, ConstraintValue &out) const {
    fillValue(result, out);
    out.valid = false;
    out.reason = "they overlap, and how deep is not known";
    out.a = out.b = ConstraintGradient();
    out.points.setZero(3, curve.points.cols());
    out.parameters.setZero(static_cast<Eigen::Index>(curve.parameters.size()));
    out.range_start = out.range_end = 0.0;
    out.radius = 0.0;
    out.t = result.t;
  }

  const CurveDistanceParameters parameters_;
  const ConstraintPair pair_;
  const bool has_hulls_;
  const double excess_; /* [m] of the hulls */
  Sides hulls_;    /* all that is not convex by its hull; the sides themselves where there is nothing of the kind */
  Sides shapes_;   /* as they are; null where that is not known */
  Sides measured_; /* as they are, what is carried by its triangles */
  const BodyHandle point_ = makePoint(Eigen::Vector3d::Zero());
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
    parameters_.meshes = readMeshes(reader);
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (pair.along_curve) return curveDistance(parameters_, pair);
    if (!pair.is_named) throw DoesNotApply("SuperquadricDistance answers about standing bodies");
    StandingDistanceParameters standing;
    standing.options.epsilon = parameters_.options.epsilon;
    standing.options.max_nodes = parameters_.options.max_nodes;
    standing.margin = parameters_.margin;
    standing.meshes = parameters_.meshes;
    return standingDistance(standing, pair);
  }

 private:
  CurveDistanceParameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CurveDistance, curve_proximity::ConstraintProvider)
