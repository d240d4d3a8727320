/* SPDX-License-Identifier: BSD-3-Clause */
/** Clearance constraints for planners and optimisers: a value that is >= 0 where the constraint holds, and its
 *  gradient.
 *
 *  A provider is a pluginlib plugin with the base class curve_proximity::ConstraintProvider. An example is
 *  examples/provider. doc/constraint-providers.md lists signs, units, frames and thread rules.
 *  Nothing here needs ROS. Metres, radians, right-handed frames. */
#ifndef CURVE_PROXIMITY_CONSTRAINT_PROVIDER_HPP
#define CURVE_PROXIMITY_CONSTRAINT_PROVIDER_HPP

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/constraint_parameters.hpp>
#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/movers.hpp>

namespace curve_proximity {

/* ---- what a constraint is about ---- */

/** One side of a constraint: parts that move together, in the side's own frame. Parts are convex, but for points,
 * octrees and height fields. */
struct ConstraintBody {
  /** One shape. */
  struct Part {
    ShapeDescription shape; /**< the description; shape.pose is its pose in the side's frame */
    BodyHandle body;        /**< the body, in the shape's frame, a mesh by its hull; never null */
    double excess = 0.0;    /**< [m] no point of the shape is farther from the body than this (mesh hulls) */
    BodyHandle exact;       /**< a mesh with all of its triangles; else the body; null: the body alone is known */
  };
  std::vector<Part> parts; /**< the side is their union */
  double padding = 0.0;    /**< [m] >= 0, a ball that is added to the parts */
};

/** The two sides of a constraint. */
struct ConstraintPair {
  ConstraintBody a; /**< the first side */
  ConstraintBody b; /**< the second side */

  /** false: each evaluation gives the poses of both sides. true: each evaluation gives a curve. Side a then moves along
   *  the curve without turning, with its origin on the curve. Without parts, a is the curve's ball alone. */
  bool along_curve = false;

  /** false: the request names no providers, so that one that is second to another for such pairs may throw
   *  DoesNotApply. */
  bool is_named = true;

  /** Called now and then during prepare(); true ends it: it may then throw Error. NULL: nothing ends it. */
  bool (*stop)(void *user) = nullptr;
  void *stop_user = nullptr; /**< handed to stop */
};

/** A compiled curve with its description, from compile() or makeConstraintCurve(). */
struct ConstraintCurve {
  CurveDescription description;       /**< as given */
  CurveHandle curve;                  /**< compiled */
  CurveHandle radius_curve = nullptr; /**< compiled, of a radius that changes: its x is added to the radius; or null */
};

/** The poses of both sides, or a curve and the pose of b, in the fixed frame. The curve is kept by reference. */
struct ConstraintPlace {
  cprox_pose a = CPROX_POSE_IDENTITY;     /**< of side a; along a curve: the identity */
  cprox_pose b = CPROX_POSE_IDENTITY;     /**< of side b */
  const ConstraintCurve *curve = nullptr; /**< set if and only if the pair is along a curve */
};

/* ---- what a constraint answers ---- */

/** Derivative of a value by a small rigid step of one side: d value = linear·v + angular·w.
 *
 *  The step is position += v, R <- exp([w]) R, with the axes of the fixed frame, turning about the side's own origin.
 *  Along a curve, side a is the curve. It turns about the origin of the fixed frame; a carried body does not turn. */
struct ConstraintGradient {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();  /**< [unit of value/m] */
  Eigen::Vector3d angular = Eigen::Vector3d::Zero(); /**< [unit of value/rad] */
};

/** The result of an evaluation. Its vectors keep their memory between evaluations. */
struct ConstraintValue {
  cprox_status status = CPROX_OK; /**< never negative: a failure throws Error */
  double value =
      0.0; /**< >= 0 where the constraint holds (but for a penalty). [m] for distances; else as the provider states */
  bool bounded = false; /**< lower and upper are proven: lower <= true value <= upper */
  double lower = 0.0;   /**< if bounded: <= true value */
  double upper = 0.0;   /**< if bounded: >= true value */

  /** The value is a penalty and no constraint: the larger the freer, and its sign says nothing. Where the sides touch
   *  without an overlap it is between touching_least and touching_most, both proven; infinite where nothing is. */
  bool penalty = false;
  double touching_least = 0.0; /**< of a penalty: below it the sides overlap */
  double touching_most = 0.0;  /**< of a penalty: above it the sides do not meet */

  bool valid = false;         /**< the gradient exists; false: not differentiable here, or not shown to be */
  std::string reason;         /**< why valid is false, in a few words */
  ConstraintGradient a;       /**< by side a; if valid is false: that of one of the minimisers, or 0 */
  ConstraintGradient b;       /**< by side b, likewise */
  Eigen::Matrix3Xd points;    /**< gradient by the curve's points, as gradientByCurve(); 0 columns without a curve */
  Eigen::VectorXd parameters; /**< gradient by the curve's parameters, likewise */
  double range_start = 0.0;   /**< gradient by the start of the curve's range, the curve itself going on as it is */
  double range_end = 0.0;     /**< gradient by the end of the range, likewise; both are 0 where t is elsewhere */
  double radius = 0.0;        /**< gradient by the curve's radius; 0 without a curve */
  double t = std::numeric_limits<double>::quiet_NaN(); /**< the curve's parameter at which the value is attained */
  bool has_points = false;                             /**< the witness points and the normal are set */
  Eigen::Vector3d witness_a = Eigen::Vector3d::Zero(); /**< [m] witness point of a, fixed frame */
  Eigen::Vector3d witness_b = Eigen::Vector3d::Zero(); /**< [m] witness point of b, fixed frame */
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    /**< unit, from b to a */

  /** Where the search ended, for an evaluation into the same value at a place nearby. Zeros: from scratch. */
  cprox_pair_start start{};
};

/* ---- joint trajectories ---- */

/** A joint trajectory of the scene's robot, described and compiled. Both are kept by reference. */
struct ConstraintMotion {
  const TrajectoryDescription &description; /**< as given */
  const RobotMotion &motion;                /**< compiled; of the prepared robot */

  /** Called now and then; true ends the search, whose status is then CPROX_STOPPED. NULL: nothing ends it. */
  bool (*stop)(void *user) = nullptr;
  void *stop_user = nullptr; /**< handed to stop */

  /** Null, or all that moves at the same time: a value is then the clearance from this, too. */
  const Movers *movers = nullptr;
  const MovingRobot *robot = nullptr; /**< with movers: the one of them that moves along the trajectory */

  /** false: the request names no providers, so that one that is second to another for trajectories may throw
   *  DoesNotApply. */
  bool is_named = true;
};

/** One clearance of a robot along its trajectory. Of the members of ConstraintValue, t is in seconds; a is by a rigid
 *  step of the whole robot, which turns about the origin of the fixed frame; b is by one of the object side_b, 0 for a
 *  link of the robot; points, parameters, range and radius are not used. */
struct MotionRow : ConstraintValue {
  std::string kind;   /**< "environment" or "self" */
  std::string side_a; /**< the link or the attached object */
  std::string side_b; /**< the object, or the other link or attached object */
  double t0 = 0.0;    /**< [s] the row is the minimum from here */
  double t1 = 0.0;    /**< [s] to here */

  /** Gradients: a row a point of the trajectory, a column a joint, both in their order. Velocities and accelerations
   *  have no rows if no point of the trajectory has them. */
  Eigen::MatrixXd positions;
  Eigen::MatrixXd velocities;    /**< by the velocities of the points */
  Eigen::MatrixXd accelerations; /**< by the accelerations of the points */
  double duration = 0.0;         /**< by the duration, all times stretched alike [unit of value/s] */
  double start = 0.0;            /**< among movers: by the start on their clock [unit of value/s] */
};

/** The result of an evaluation along a trajectory. */
struct MotionValue {
  cprox_status status = CPROX_OK; /**< never negative: a failure throws Error */
  std::string message;            /**< why the status is not CPROX_OK, in a few words */
  double value = 0.0;             /**< >= 0 where the constraint holds: the least value of all rows */
  bool bounded = false;           /**< lower and upper are proven: lower <= true value <= upper */
  double lower = 0.0;             /**< if bounded: <= true value */
  double upper = 0.0;             /**< if bounded: >= true value */

  /** The least value first. One row, or one for each constraint that an optimiser should linearise. None: the value
   *  does not change with the trajectory (such as all pairs beyond a horizon). */
  std::vector<MotionRow> rows;
};

/** A robot made ready for any number of trajectories. It must not outlive its provider.
 *
 *  Immutable: any number of threads may evaluate at once, each with its own workspace and its own value. */
class MotionConstraint {
 public:
  virtual ~MotionConstraint() = default;

  /** Computes value and gradients. Throws Error with one line that says what is wrong; the value is then unspecified.
   */
  virtual void evaluate(const ConstraintMotion &motion, Workspace &workspace, MotionValue &value) const = 0;

  /** Does evaluate() measure against ConstraintMotion::movers? Where not, a case in which something moves is refused.
   */
  virtual bool takesMovers() const {
    return false;
  }
};

/* ---- providers ---- */

/** What prepare() and prepareMotion() throw where the provider is about something else altogether: trajectories, curves
 *  or standing pairs. A request that names no providers leaves these out; others fail with the line. */
class DoesNotApply : public Error {
 public:
  /** The line that a request which names the provider is answered with. */
  explicit DoesNotApply(const std::string &reason) : Error(reason) {}
};

/** A prepared pair for any number of evaluations. It must not outlive its provider.
 *
 *  Immutable: any number of threads may evaluate at once, each with its own workspace and its own value. */
class Constraint {
 public:
  virtual ~Constraint() = default;

  /** Computes value and gradient. Throws Error with one line that says what is wrong with the place; the value is then
   *  unspecified. Allocates nothing once workspace and value have grown. */
  virtual void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &value) const = 0;
};

/** The version of the plugin interface. It is raised when the order of virtual functions or the meaning of a member
 *  changes. */
constexpr std::uint64_t PROVIDER_VERSION = 6;

/** One number that a plugin and its loader must have in common: the interface version, the sizes of all shared types,
 *  and Eigen's alignment (-mavx changes how Eigen frees memory). */
constexpr std::uint64_t providerLayout() {
  std::uint64_t layout = PROVIDER_VERSION;
  for (const std::size_t part : {sizeof(ConstraintPair),
                                 sizeof(ConstraintBody::Part),
                                 sizeof(ShapeDescription),
                                 sizeof(CurveDescription),
                                 sizeof(ConstraintCurve),
                                 sizeof(ConstraintPlace),
                                 sizeof(ConstraintValue),
                                 sizeof(Workspace),
                                 sizeof(ParameterMap),
                                 sizeof(ParameterValue),
                                 sizeof(cprox_options),
                                 sizeof(cprox_obstacle),
                                 sizeof(cprox_mover),
                                 sizeof(cprox_result),
                                 sizeof(cprox_gradient),
                                 sizeof(ConstraintMotion),
                                 sizeof(MotionValue),
                                 sizeof(MotionRow),
                                 sizeof(TrajectoryDescription),
                                 sizeof(TrajectoryPoint),
                                 alignof(ConstraintValue),
                                 alignof(ConstraintPair),
                                 static_cast<std::size_t>(EIGEN_MAX_STATIC_ALIGN_BYTES)})
    layout = layout * 1000003u + part;
  return layout;
}

/** The base class of plugins; use it as ConstraintProvider.
 *
 *  The layout number is part of the type, so pluginlib finds no plugin in a library that was built against other
 *  headers, and calls none of its functions. */
template <std::uint64_t Layout>
class LayoutProvider {
 public:
  virtual ~LayoutProvider() = default;

  /** Called once, before all other functions. Throws Error that names wrong parameters (see ParameterReader). */
  virtual void initialise(const ParameterMap &parameters) = 0;

  /** Prepares a pair. Costly work that many evaluations share belongs here. Throws Error that names a shape which the
   *  provider does not support. Any number of threads at once. */
  virtual std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const = 0;

  /** Prepares a robot in its scene for trajectories. Throws Error; without an implementation of one's own always. Any
   *  number of threads at once. */
  virtual std::unique_ptr<const MotionConstraint> prepareMotion(const PreparedRobot & /*robot*/) const {
    throw DoesNotApply("this provider answers for curves and standing bodies, not for joint trajectories");
  }

  /** prepare() and Constraint::evaluate() in one step, for a pair that is evaluated once. */
  ConstraintValue evaluate(const ConstraintPair &pair, const ConstraintPlace &place, Workspace &workspace) const {
    ConstraintValue value;
    prepare(pair)->evaluate(place, workspace, value);
    return value;
  }
};

/** The base class of constraint provider plugins. */
using ConstraintProvider = LayoutProvider<providerLayout()>;

/* ---- for plugins ---- */

/** The side as one body: its only part if that stands at the side's origin, otherwise a compound of all parts. exact:
 * of meshes with all of their triangles. */
inline BodyHandle joinedBody(const ConstraintBody &side, bool exact = false) {
  if (side.parts.empty()) throw Error("the side has no shape");
  const auto bodyOf = [exact](const ConstraintBody::Part &part) {
    return exact && part.exact ? part.exact : part.body;
  };
  const ConstraintBody::Part &first = side.parts.front();
  if (side.parts.size() == 1 && first.shape.pose.matrix().isIdentity(0.0)) return bodyOf(first);
  std::vector<BodyHandle> bodies;
  std::vector<Eigen::Isometry3d> poses;
  for (const ConstraintBody::Part &part : side.parts) {
    bodies.push_back(bodyOf(part));
    poses.push_back(part.shape.pose);
  }
  return makeCompound(bodies, poses);
}

/** The largest excess of a side's parts [m]. */
inline double excessOf(const ConstraintBody &side, bool exact = false) {
  double excess = 0.0;
  for (const ConstraintBody::Part &part : side.parts)
    if (!exact || !part.exact) excess = std::max(excess, part.excess);
  return excess;
}

/** Throws Error if the pair is along a curve and the place has none, or the reverse. */
inline void requirePlace(const ConstraintPair &pair, const ConstraintPlace &place) {
  if (pair.along_curve && !place.curve) throw Error("the pair is along a curve, and there is none");
  if (!pair.along_curve && place.curve) throw Error("there is a curve, and the pair is not along one");
}

} // namespace curve_proximity
#endif
