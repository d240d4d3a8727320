/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/GrowthDistance: by how much standing convex bodies, each scaled about its centre, may grow until they
 * touch. It is as smooth in contact and deep inside as apart. */
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <limits>

#include "distance_constraints.h"
#include "outline.h"

namespace curve_proximity {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/* Growth distances of two pairs of parts that differ by less are the same. */
constexpr double ALIKE = 1e-9;

struct Parameters {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  double level = 1.0;
  Meshes meshes = Meshes::EXACT;
};

/* A part with its pose in the side's frame. */
struct Element {
  BodyHandle body;
  Eigen::Isometry3d pose;
  Eigen::Vector3d centre; /* of the body, in its own frame */
};

std::vector<Element> makeSide(const ConstraintBody &described, const Parameters &parameters, const char *name) {
  const std::string side = std::string("side ") + name;
  if (described.parts.empty()) throw Error(side + " has no shape");
  if (described.padding > 0.0) throw Error(side + " has padding, which does not grow with a body: it must be 0");
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
  const cprox_quat &q = pose.orientation;
  return Eigen::Translation3d(toEigen(pose.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
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
        has_hulls_(hasHulls(pair.a) || hasHulls(pair.b)) {}

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (place.curve) throw Error("there is a curve, and the pair is not along one");
    Found best;
    double lower = INFINITE, upper = INFINITE, next = INFINITE;
    for (const Element &a : a_) {
      for (const Element &b : b_) {
        const Found found = ask(a, b, place, workspace);
        lower = std::min(lower, found.growth.lower);
        upper = std::min(upper, found.growth.upper);
        next = std::min(next, std::max(found.value(), best.value()));
        if (!best.a || found.value() < best.value()) best = found;
      }
    }
    fill(best, lower, upper, place, out);
    out.valid = best.derivatives.valid && next > best.value() + ALIKE * (1.0 + best.value());
    out.reason = !best.derivatives.valid ? best.reason : out.valid ? "" : "two pairs of parts are equally near";
  }

 private:
  /* What a pair of parts says. */
  struct Found {
    const Element *a = nullptr, *b = nullptr;
    cprox_growth growth{};
    cprox_growth_derivatives derivatives{};
    std::string reason;
    double value() const {
      return !a ? INFINITE : growth.upper < INFINITE ? 0.5 * (growth.lower + growth.upper) : growth.lower;
    }
  };

  Found ask(const Element &a, const Element &b, const ConstraintPlace &place, Workspace &workspace) const {
    Found out;
    out.a = &a;
    out.b = &b;
    const cprox_obstacle first = cprox_obstacle_at(a.body.get(), toPose(toIsometry(place.a) * a.pose)),
                         second = cprox_obstacle_at(b.body.get(), toPose(toIsometry(place.b) * b.pose));
    out.growth = growthGradient(first, second, parameters_.options, workspace, out.derivatives);
    if (!out.derivatives.valid) out.reason = cprox_workspace_error(workspace.get());
    return out;
  }

  /* A turn about the side's origin: the touching point moves by w x (touch - origin). */
  void fill(const Found &best, double lower, double upper, const ConstraintPlace &place, ConstraintValue &out) const {
    const cprox_growth_derivatives &d = best.derivatives;
    out.status = best.growth.status;
    out.value = best.value() - parameters_.level;
    out.bounded = true;
    out.lower = lower - parameters_.level;
    out.upper = has_hulls_ ? INFINITE : upper - parameters_.level;
    out.a.linear = toEigen(d.a_position);
    out.b.linear = toEigen(d.b_position);
    out.normal = toEigen(best.growth.normal);
    const Eigen::Vector3d touch = toEigen(d.touch);
    out.has_points = touch.allFinite() && best.value() > 0.0;
    if (out.has_points) {
      out.a.angular = (touch - toEigen(place.a.position)).cross(out.a.linear);
      out.b.angular = (touch - toEigen(place.b.position)).cross(out.b.linear);
      out.witness_a = unscaled(touch, *best.a, place.a, best.value());
      out.witness_b = unscaled(touch, *best.b, place.b, best.value());
    } else {
      out.a.angular = out.b.angular = out.witness_a = out.witness_b = Eigen::Vector3d::Zero();
    }
    out.points.resize(3, 0);
    out.radius = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
  }

  /* The body's own point that is where both touch once it is scaled. */
  static Eigen::Vector3d unscaled(const Eigen::Vector3d &touch, const Element &element, const cprox_pose &place,
                                  double growth) {
    const Eigen::Vector3d centre = toIsometry(place) * element.pose * element.centre;
    return centre + (touch - centre) / growth;
  }

  const Parameters parameters_;
  const std::vector<Element> a_, b_;
  const bool has_hulls_;
};

} // namespace

class GrowthDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    parameters_.options.epsilon = reader.number("epsilon", 1e-9, 0.0);
    parameters_.level = reader.number("level", 1.0, 0.0);
    parameters_.meshes = readMeshes(reader);
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (pair.along_curve) throw DoesNotApply("GrowthDistance answers about standing bodies, not along curves");
    if (!pair.is_named) throw DoesNotApply("SuperquadricDistance answers about standing bodies");
    return std::make_unique<GrowthConstraint>(parameters_, pair);
  }

 private:
  Parameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::GrowthDistance, curve_proximity::ConstraintProvider)
