/* SPDX-License-Identifier: BSD-3-Clause */
/** Constraints for planners and optimisers: a clearance as a number that is positive where all is well, and how it
 *  changes.
 *
 *  A provider is a pluginlib plugin whose base class is curve_proximity::ConstraintProvider; one example stands in
 *  test/install/example_provider, signs, units, frames and thread rules on one page in doc/constraint-providers.md.
 *  Nothing here needs ROS. Metres, radians, right-handed frames. */
#ifndef CURVE_PROXIMITY_CONSTRAINT_PROVIDER_HPP
#define CURVE_PROXIMITY_CONSTRAINT_PROVIDER_HPP

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/constraint_parameters.hpp>
#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

namespace curve_proximity {

/* ---- what a constraint is about ---------------------------------------------------------------------------------- */

/** One side of a constraint: convex parts that move together, in the side's own frame. */
struct ConstraintBody {
  struct Part {
    ShapeDescription shape; /**< as described; shape.pose: where it stands in the side's frame */
    BodyHandle body;        /**< made of it, in the shape's frame; never null */
    double excess = 0.0;    /**< [m] no point of the shape is farther from the body than this (mesh hulls) */
  };
  std::vector<Part> parts;
  double padding = 0.0; /**< [m] >= 0: all points within this of the parts */
};

/** Two sides that are held against each other. */
struct ConstraintPair {
  ConstraintBody a, b;

  /** false: both stand where an evaluation's poses say. true: a rides the curve of each evaluation without turning, its
   *  origin on the curve; a without parts is the curve's ball alone. */
  bool along_curve = false;
};

/** A curve made ready: of compile() or makeConstraintCurve(). */
struct ConstraintCurve {
  CurveDescription description;
  CurveHandle curve;
};

/** Where the two sides stand, in the fixed frame. A value: what it names is kept by reference. */
struct ConstraintPlace {
  cprox_pose a = cprox_pose_identity(); /**< of a pair along a curve the identity: a's place is the curve's */
  cprox_pose b = cprox_pose_identity();
  const ConstraintCurve *curve = nullptr; /**< of a pair along a curve, and of no other */
};

/* ---- what a constraint answers ----------------------------------------------------------------------------------- */

/** How a value changes when one side moves rigidly by a small step: d value = linear·v + angular·w, for the step
 *  position += v, R <- exp([w]) R: axes of the fixed frame, turning about the side's own origin. Of a pair along a
 *  curve, side a is the curve: it turns about the origin of the fixed frame, and what rides it does not turn. */
struct ConstraintGradient {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();  /**< [unit of value/m] */
  Eigen::Vector3d angular = Eigen::Vector3d::Zero(); /**< [unit of value/rad] */
};

/** One answer. Its vectors keep their memory from evaluation to evaluation. */
struct ConstraintValue {
  cprox_status status = CPROX_OK; /**< never negative: what has no answer is an Error */
  double value = 0.0;   /**< >= 0: the constraint holds. [m] for distances; other units are the provider's to say */
  bool bounded = false; /**< lower and upper are proven: lower <= true value <= upper */
  double lower = 0.0, upper = 0.0;

  bool valid = false;      /**< false: the value is not differentiable here, or cannot be told to be */
  std::string reason;      /**< why not, in a few words */
  ConstraintGradient a, b; /**< where valid is false: those of one of the minimisers, or 0 */
  /** by the curve's control points or coefficients, a column each; of other pairs 0 columns */
  Eigen::Matrix3Xd points;
  double radius = 0.0;                                 /**< by the curve's radius (of other pairs 0) */
  double t = std::numeric_limits<double>::quiet_NaN(); /**< the curve's parameter where the value is attained */
  bool has_points = false;                             /**< witness_a, witness_b and normal are set */
  Eigen::Vector3d witness_a = Eigen::Vector3d::Zero(); /**< [m] the nearest points, in the fixed frame */
  Eigen::Vector3d witness_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); /**< unit, from b to a */
};

/* ---- providers --------------------------------------------------------------------------------------------------- */

/** A pair made ready for any number of evaluations. Immutable: any number of threads may evaluate at once, each with
 *  its own workspace and its own value. It must not outlive its provider. */
class Constraint {
 public:
  virtual ~Constraint() = default;

  /** Value and gradient where the two sides stand so. Throws Error, one line that says what is wrong with the place;
   *  the value is then unspecified. Allocates nothing once workspace and value have grown. */
  virtual void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &value) const = 0;
};

/** Raised with every change of what plugin and loader share that no size shows: the order of virtual functions, what a
 *  field means. */
constexpr std::uint64_t PROVIDER_VERSION = 1;

/** What a plugin and whoever loads it must have in common, as one number: the version, the size of all that they hand
 *  each other, and how Eigen and the standard library were set up (-mavx alone changes how Eigen's memory is given
 *  back). */
constexpr std::uint64_t providerLayout() {
  std::uint64_t layout = PROVIDER_VERSION;
  for (const std::size_t part :
       {sizeof(ConstraintPair), sizeof(ConstraintBody::Part), sizeof(ShapeDescription), sizeof(CurveDescription),
        sizeof(ConstraintCurve), sizeof(ConstraintPlace), sizeof(ConstraintValue), sizeof(Workspace),
        sizeof(ParameterMap), sizeof(ParameterValue), sizeof(cprox_options), sizeof(cprox_obstacle),
        sizeof(cprox_mover), sizeof(cprox_result), sizeof(cprox_gradient), alignof(ConstraintValue),
        alignof(ConstraintPair), static_cast<std::size_t>(EIGEN_MAX_STATIC_ALIGN_BYTES)})
    layout = layout * 1000003u + part;
  return layout;
}

/** The base class of the plugins, under its name ConstraintProvider. What is shared is part of its type: pluginlib
 *  finds no plugin in a library that was built against other headers, so that none of its functions is ever called. */
template <std::uint64_t Layout>
class LayoutProvider {
 public:
  virtual ~LayoutProvider() = default;

  /** Called once, before all else. Throws Error for parameters that are wrong, and names them (ParameterReader
   *  does). */
  virtual void initialise(const ParameterMap &parameters) = 0;

  /** Makes a pair ready. What costs more than one evaluation belongs in here. Throws Error: a shape that this provider
   *  cannot answer for, named by its type. Any number of threads at once. */
  virtual std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const = 0;

  /** Both in one step, for a pair that is asked about once. */
  ConstraintValue evaluate(const ConstraintPair &pair, const ConstraintPlace &place, Workspace &workspace) const {
    ConstraintValue value;
    prepare(pair)->evaluate(place, workspace, value);
    return value;
  }
};
using ConstraintProvider = LayoutProvider<providerLayout()>;

/* ---- for plugins ------------------------------------------------------------------------------------------------- */

/** The weight of each control point or coefficient in the curve's point at t; n = description.points.cols() of them. */
inline void curveWeights(const CurveDescription &curve, double t, double *weights) {
  const auto n = static_cast<std::size_t>(curve.points.cols());
  if (curve.basis == "bezier")
    cprox_bezier_weights(n, curve.t0, curve.t1, t, weights);
  else if (curve.basis == "bspline")
    cprox_bspline_weights(n, curve.degree, curve.knots.data(), t, weights);
  else if (curve.basis == "polynomial")
    cprox_polynomial_weights(n, t, weights);
  else if (curve.basis == "legendre")
    cprox_legendre_weights(n, curve.t0, curve.t1, t, weights);
  else if (curve.basis == "lagrange")
    cprox_lagrange_weights(curve.knots.data(), n, t, weights);
  else if (curve.basis == "trigonometric")
    cprox_trigonometric_weights(n, t, weights);
  else
    throw Error("no weights are known of the basis '" + curve.basis + "'");
}

/** The side as one body: that of its only part where it stands at the side's origin, else a compound of all. */
inline BodyHandle joinedBody(const ConstraintBody &side) {
  if (side.parts.empty()) throw Error("the side has no shape");
  const ConstraintBody::Part &first = side.parts.front();
  if (side.parts.size() == 1 && first.shape.pose.matrix().isIdentity(0.0)) return first.body;
  std::vector<BodyHandle> bodies;
  std::vector<Eigen::Isometry3d> poses;
  for (const ConstraintBody::Part &part : side.parts) {
    bodies.push_back(part.body);
    poses.push_back(part.shape.pose);
  }
  return makeCompound(bodies, poses);
}

/** The largest excess of a side's parts [m]. */
inline double excessOf(const ConstraintBody &side) {
  double excess = 0.0;
  for (const ConstraintBody::Part &part : side.parts) excess = std::max(excess, part.excess);
  return excess;
}

/** Throws Error where the place does not suit the pair. */
inline void requirePlace(const ConstraintPair &pair, const ConstraintPlace &place) {
  if (pair.along_curve && !place.curve) throw Error("the pair is along a curve, and there is none");
  if (!pair.along_curve && place.curve) throw Error("there is a curve, and the pair is not along one");
}

} // namespace curve_proximity
#endif
