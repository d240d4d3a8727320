/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/GrowthDistance: by how much convex bodies, each scaled about its centre, may grow until they touch;
 * along a curve that carries one side, and of a robot along a joint trajectory, the least of that. It is as smooth in
 * contact and deep inside as apart. */
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "distance_constraints.h"
#include "least_along.h"
#include "motion_row.h"
#include "outline.h"

namespace curve_proximity {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/* Growth distances of two pairs of parts that differ by less are the same. */
constexpr double ALIKE = 1e-9;

struct Parameters {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  double level = 1.0;
  double smoothing = 0.0; /* [rad] 0: none */
  Meshes meshes = Meshes::EXACT;
  RobotPairs against = RobotPairs::WHOLE; /* along a joint trajectory */
};

/* The axes that b is turned about for a smoothing, in its own frame: the corners of a cube that lies along no face or
 * edge of a usual body. */
std::array<Eigen::Vector3d, 8> tiltAxes() {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.48, 0.6, 0.64)));
  std::array<Eigen::Vector3d, 8> out;
  for (int i = 0; i < 8; ++i)
    out[static_cast<std::size_t>(i)] =
        turned * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) / std::sqrt(3.0);
  return out;
}

/* A part with its pose in the side's frame. */
struct Element {
  BodyHandle body;
  Eigen::Isometry3d pose;
  Eigen::Vector3d centre; /* of the body, in its own frame */
};

std::vector<Element> makeSide(const ConstraintBody &described, const Parameters &parameters, const char *name) {
  const std::string side = std::string("side ") + name;
  if (described.parts.empty()) throw Error(side + " has no shape");
  if (described.padding != 0.0) throw Error(side + " has padding, which does not grow with a body: it must be 0");
  Workspace workspace;
  std::vector<Element> out;
  for (const ConstraintBody::Part &part : described.parts) {
    if (isHull(part) && parameters.meshes != Meshes::HULL)
      throw Error(side + ": a " + shapeTypeName(part.shape.type) +
                  " that is not convex has no growth distance: ask with meshes: hull");
    const cprox_obstacle body = cprox_obstacle_at(part.body.get(), CPROX_POSE_IDENTITY);
    cprox_growth unused{};
    if (cprox_growth_distance(body, body, nullptr, workspace.get(), &unused) < 0) /* says whether it may be asked */
      throw Error(side + ": " + shapeTypeName(part.shape.type) +
                  ": it must be convex, bounded and have its centre inside");
    out.push_back({part.body, part.shape.pose, toEigen(cprox_body_get_info(part.body.get()).centre)});
  }
  return out;
}

Eigen::Isometry3d toIsometry(const cprox_pose &pose) {
  const cprox_quat &given = pose.orientation;
  const Eigen::Quaterniond q(given.w, given.x, given.y, given.z);
  if (!(q.squaredNorm() > 0.0) || !std::isfinite(q.squaredNorm()))
    throw Error("the quaternion of a pose is 0, or its norm is out of range");
  return Eigen::Translation3d(toEigen(pose.position)) * q.normalized();
}

cprox_pose toPose(const Eigen::Isometry3d &pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {toVec3(pose.translation()), {q.w(), q.x(), q.y(), q.z()}};
}

class GrowthConstraint : public Constraint {
 public:
  GrowthConstraint(const Parameters &parameters, const ConstraintPair &pair)
      : parameters_(parameters),
        a_(makeSide(pair.a, parameters, "a")),
        b_(makeSide(pair.b, parameters, "b")),
        has_hulls_(hasHulls(pair.a) || hasHulls(pair.b)),
        along_curve_(pair.along_curve) {
    if (along_curve_ && parameters.smoothing > 0.0)
      throw Error("parameter smoothing: it is for standing bodies, not along curves");
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (along_curve_ != (place.curve != nullptr))
      throw Error(place.curve ? "there is a curve, and the pair is not along one"
                              : "the pair is along a curve, and there is none");
    if (place.curve && (place.curve->description.radius != 0.0 || place.curve->radius_curve))
      throw DoesNotApply("GrowthDistance scales bodies about their centres and takes no radius of a curve");
    Found best;
    double lower = INFINITE, upper = INFINITE, next = INFINITE;
    for (const Element &a : a_) {
      for (const Element &b : b_) {
        const Found found = place.curve ? askAlong(a, b, place, workspace) : askStanding(a, b, place, workspace);
        lower = std::min(lower, found.growth.lower);
        upper = std::min(upper, found.growth.upper);
        next = std::min(next, std::max(found.value, best.value));
        if (!best.a || found.value < best.value) best = found;
      }
    }
    fill(best, lower, upper, place, workspace, out);
    out.valid = best.valid && next > best.value + ALIKE * (1.0 + best.value);
    out.reason = !best.valid ? best.reason : out.valid ? "" : "two pairs of parts are equally near";
  }

 private:
  /* What a pair of parts says. */
  struct Found {
    const Element *a = nullptr, *b = nullptr;
    cprox_growth growth{};
    double value = INFINITE;                             /* its own, or that of a smoothing */
    double t = std::numeric_limits<double>::quiet_NaN(); /* along a curve */
    bool valid = false;
    std::string reason;
    Eigen::Vector3d by_b = Eigen::Vector3d::Zero();   /* by b's position; minus that by a's */
    Eigen::Vector3d moment = Eigen::Vector3d::Zero(); /* touch x by_b */
    Eigen::Vector3d touch = Eigen::Vector3d::Zero();
  };

  static double middle(const cprox_growth &growth) {
    return growth.upper < INFINITE ? 0.5 * (growth.lower + growth.upper) : growth.lower;
  }

  /* Adds a part of what one place says. */
  static void add(const cprox_growth_derivatives &d, double part, const Workspace &workspace, Found &out) {
    const Eigen::Vector3d touch = toEigen(d.touch), by_b = toEigen(d.b_position);
    out.by_b += part * by_b;
    out.touch += part * touch;
    out.moment += part * touch.cross(by_b);
    if (d.valid) return;
    out.valid = false;
    out.reason = cprox_workspace_error(workspace.get());
  }

  static cprox_obstacle at(const Element &element, const Eigen::Isometry3d &side) {
    return cprox_obstacle_at(element.body.get(), toPose(side * element.pose));
  }

  Found askStanding(const Element &a, const Element &b, const ConstraintPlace &place, Workspace &workspace) const {
    Found out;
    out.a = &a;
    out.b = &b;
    out.valid = true;
    const Eigen::Isometry3d side = toIsometry(place.b);
    const cprox_obstacle first = at(a, toIsometry(place.a)), second = at(b, side);
    cprox_growth_derivatives derivatives{};
    if (!(parameters_.smoothing > 0.0)) {
      out.growth = growthGradient(first, second, parameters_.options, workspace, derivatives);
      out.value = middle(out.growth);
      add(derivatives, 1.0, workspace, out);
      return out;
    }
    /* the mean over b turned a little about its centre, in eight ways that turn with it */
    static const std::array<Eigen::Vector3d, 8> axes = tiltAxes();
    out.growth = growthDistance(first, second, parameters_.options, workspace);
    out.value = 0.0;
    const double part = 1.0 / static_cast<double>(axes.size());
    for (const Eigen::Vector3d &axis : axes) {
      const Eigen::Isometry3d tilted = side * b.pose * Eigen::Translation3d(b.centre) *
                                       Eigen::AngleAxisd(parameters_.smoothing, axis) * Eigen::Translation3d(-b.centre);
      const cprox_growth growth = growthGradient(first, cprox_obstacle_at(b.body.get(), toPose(tilted)),
                                                 parameters_.options, workspace, derivatives);
      out.value += part * middle(growth);
      add(derivatives, part, workspace, out);
    }
    return out;
  }

  Found askAlong(const Element &a, const Element &b, const ConstraintPlace &place, Workspace &workspace) const {
    Found out;
    out.a = &a;
    out.b = &b;
    out.valid = true;
    cprox_growth_derivatives derivatives{};
    out.growth = growthAlong(at(a, Eigen::Isometry3d::Identity()), place.curve->curve.get(), at(b, toIsometry(place.b)),
                             parameters_.options, workspace, out.t, derivatives);
    out.value = out.growth.upper;
    add(derivatives, 1.0, workspace, out);
    return out;
  }

  /* A turn about the side's origin x moves the touching point w by ω x (w - x): the derivative is (w - x) x N. */
  void fill(const Found &best, double lower, double upper, const ConstraintPlace &place, Workspace &workspace,
            ConstraintValue &out) const {
    out.status = best.growth.status;
    out.value = best.value - parameters_.level;
    out.bounded = true;
    out.lower = lower - parameters_.level;
    out.upper = has_hulls_ ? INFINITE : upper - parameters_.level;
    out.a.linear = -best.by_b;
    out.b.linear = best.by_b;
    out.normal = toEigen(best.growth.normal);
    out.points.resize(3, 0), out.parameters.resize(0);
    out.radius = out.range_start = out.range_end = 0.0;
    out.t = best.t;
    cprox_pose place_a = place.a;
    if (place.curve) {
      require(
          cprox_curve_evaluate(place.curve->curve.get(), best.t, workspace.get(), &place_a.position, nullptr, nullptr),
          workspace);
      fillByCurve(*place.curve, best.t, out.a.linear, workspace, out);
    }
    out.has_points = best.touch.allFinite() && best.value > 0.0;
    if (!out.has_points) {
      out.a.angular = out.b.angular = out.witness_a = out.witness_b = Eigen::Vector3d::Zero();
      return;
    }
    const Eigen::Vector3d x_a = toEigen(place_a.position), x_b = toEigen(place.b.position);
    /* the curve turns about the fixed frame's origin, and what it carries does not */
    out.a.angular =
        place.curve ? Eigen::Vector3d(x_a.cross(out.a.linear)) : Eigen::Vector3d(x_a.cross(best.by_b) - best.moment);
    out.b.angular = best.moment - x_b.cross(best.by_b);
    out.witness_a = unscaled(best.touch, *best.a, place_a, best.value);
    out.witness_b = unscaled(best.touch, *best.b, place.b, best.value);
  }

  /* The body's own point that is where both touch once it is scaled. */
  static Eigen::Vector3d unscaled(const Eigen::Vector3d &touch, const Element &element, const cprox_pose &place,
                                  double growth) {
    const Eigen::Vector3d centre = toIsometry(place) * element.pose * element.centre;
    return centre + (touch - centre) / growth;
  }

  const Parameters parameters_;
  const std::vector<Element> a_, b_;
  const bool has_hulls_, along_curve_;
};

class GrowthMotion : public MotionConstraint {
 public:
  explicit GrowthMotion(const Parameters &parameters) : parameters_(parameters) {}

  void evaluate(const ConstraintMotion &asked, Workspace &workspace, MotionValue &out) const override {
    if (!asked.is_named) throw DoesNotApply("RobotDistance answers about joint trajectories");
    Query query;
    query.options = parameters_.options;
    query.options.stop = asked.stop;
    query.options.stop_user = asked.stop_user;
    query.options.max_lod = parameters_.meshes == Meshes::HULL ? CPROX_LOD_HULL : CPROX_LOD_MESH;
    ClearanceRow found = growthGradient(asked.motion, parameters_.against, query, workspace);
    const cprox_result &result = found.answer.result;
    out = MotionValue();
    out.status = result.status;
    if (out.status != CPROX_OK || found.answer.gap) out.message = found.answer.message;
    const double value = result.upper < INFINITE ? result.upper : result.lower; // a hull's bounds nothing from above
    out.rows.push_back(motionRow(std::move(found), value, parameters_.level));
    out.bounded = true;
    out.value = out.rows.front().value;
    out.lower = out.rows.front().lower;
    out.upper = out.rows.front().upper;
  }

 private:
  const Parameters parameters_;
};

} // namespace

class GrowthDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    parameters_.options.epsilon = reader.number("epsilon", 1e-9, 0.0);
    parameters_.level = reader.number("level", 1.0, 0.0);
    parameters_.smoothing = reader.number("smoothing", 0.0, 0.0);
    parameters_.meshes = readMeshes(reader);
    parameters_.against = readAgainst(reader);
    reader.end();
    if (parameters_.smoothing > 0.1) throw Error("parameter smoothing: it is an angle of at most 0.1 rad");
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (!pair.is_named)
      throw DoesNotApply(pair.along_curve ? "CurveDistance answers about curves"
                                          : "SuperquadricDistance answers about standing bodies");
    return std::make_unique<GrowthConstraint>(parameters_, pair);
  }

  std::unique_ptr<const MotionConstraint> prepareMotion(const PreparedRobot & /*robot*/) const override {
    if (parameters_.smoothing > 0.0)
      throw Error("parameter smoothing: it is for standing bodies, not for trajectories");
    return std::make_unique<GrowthMotion>(parameters_);
  }

 private:
  Parameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::GrowthDistance, curve_proximity::ConstraintProvider)
