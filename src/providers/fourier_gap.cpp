/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/FourierGap: a smooth measure of overlap with its SE(2) or SE(3) gradient. */
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <curve_proximity/constraint_provider.hpp>

#include "solids.h"

namespace curve_proximity {
namespace {

struct Parameters {
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  int dimension = 3;
  double level = 0.0; /* of the signal mode, subtracted */
};

Eigen::Quaterniond toQuaternion(const cprox_quat &q) {
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

/* The sphere round a solid, in the frame of its side. */
struct Sphere {
  explicit Sphere(const SolidHandle &solid) {
    const cprox_solid_info info = cprox_solid_get_info(solid.get());
    centre = toEigen(info.centre);
    radius = info.radius;
  }
  Eigen::Vector3d centre;
  double radius;
};

/* Spheres are drawn in by this much, so that where they touch the gap knows that they do. */
constexpr double DRAWN = 1e-9;

/* Where the gap is asked. Beyond the spheres: b is drawn towards a along the line between the centres until they touch.
 */
struct Asked {
  Asked(const Sphere &a, const Sphere &b, const ConstraintPlace &given) : place(given) {
    arm_a = toQuaternion(given.a.orientation) * a.centre;
    arm_b = toQuaternion(given.b.orientation) * b.centre;
    const Eigen::Vector3d between = toEigen(given.b.position) + arm_b - toEigen(given.a.position) - arm_a;
    const double away = between.norm(), touching = (1.0 - DRAWN) * (a.radius + b.radius);
    if (!(away > touching)) return;
    beyond = away - touching;
    rounding = 1e-14 * (away + toEigen(given.a.position).norm() + toEigen(given.b.position).norm() + arm_a.norm() +
                        arm_b.norm());
    normal = between / away;
    share = touching / away;
    place.b.position = toVec3(toEigen(given.b.position) - beyond * normal);
  }

  ConstraintPlace place;
  double beyond = 0.0;   /* [m] between the spheres; 0 where they meet, and the rest is not used */
  double rounding = 0.0; /* [m] of `beyond` */
  double share = 1.0;    /* how far the drawn centre moves across the line for each metre of the other's way */
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); /* from a to b */
  Eigen::Vector3d arm_a, arm_b;                     /* from the origins to the centres, fixed frame */
};

class FourierGapConstraint : public Constraint {
 public:
  FourierGapConstraint(const Parameters &parameters, const ConstraintPair &pair) : parameters_(parameters) {
    if (pair.along_curve) throw DoesNotApply("FourierGap is about standing bodies: ask CurveDistance about curves");
    const SolidHandle a = side(pair.a, "a"), b = side(pair.b, "b");
    const Workspace workspace;
    cprox_gap *gap = nullptr;
    require(cprox_gap_create(a.get(), b.get(), &parameters.options, workspace.get(), &gap), workspace);
    gap_.reset(gap, cprox_gap_free);
    sphere_a_.emplace(a), sphere_b_.emplace(b);
    const cprox_gap_info info = cprox_gap_get_info(gap);
    guaranteed_ = info.guaranteed;
    size_ = sphere_a_->radius + sphere_b_->radius;
    fades_within_ = std::min(info.over_reach, size_);
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (place.curve) throw Error("there is a curve, and the pair is not along one");
    const Asked asked(*sphere_a_, *sphere_b_, place);
    cprox_gap_result r;
    const cprox_status status =
        require(cprox_gap_evaluate(gap_.get(), &asked.place.a, &asked.place.b, workspace.get(), &r), workspace);

    // By the mode, the constraint grows where the gap falls: 1 - V/t; or with the signal: c - level. Beyond the spheres
    // V/t fades away, and the distance between them is added.
    const bool signal = parameters_.options.mode == CPROX_GAP_MODE_SIGNAL;
    const double left = signal ? 0.0 : std::max(0.0, 1.0 - asked.beyond / fades_within_), fading = left * left;
    const double value = signal ? r.value - parameters_.level : 1.0 - fading * r.value;
    const double error = signal ? r.error : fading * r.error + asked.rounding / size_;
    out.status = status;
    out.value = value + asked.beyond / size_;
    out.bounded = !signal && guaranteed_;
    out.lower = out.value - error;
    out.upper = out.value + error;
    const bool known = status != CPROX_PRECISION && std::isfinite(out.value);
    const double by_gap = !known ? 0.0 : signal ? 1.0 : -fading;
    const double by_distance = 1.0 / size_ + (signal ? 0.0 : 2.0 * left * r.value / fades_within_);
    fillGradient(asked, r, by_gap, by_distance, out);
    out.valid = known || asked.beyond > 0.0; // beyond the spheres the distance still counts
    out.reason = out.valid ? "" : "the signal is below its rounding";
    out.points.resize(3, 0);
    out.radius = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
    out.has_points = false;
  }

 private:
  /* By the drawn place, times by_gap, and by the distance between the spheres. With D between the centres, P the part
   * across the line, times `share`, and g the gap's gradient by b's position at the drawn place: the drawn centre moves
   * by P dD, so that g counts for dD as h = P g, and as g itself for what the turns move the drawn place. */
  static void fillGradient(const Asked &asked, const cprox_gap_result &r, double by_gap, double by_distance,
                           ConstraintValue &out) {
    const Eigen::Vector3d &n = asked.normal, g = by_gap * toEigen(r.position_b);
    const Eigen::Vector3d across = asked.share * (g - n * n.dot(g));
    const Eigen::Vector3d by_centres = across + (asked.beyond > 0.0 ? by_distance : 0.0) * n;
    out.b.linear = by_centres;
    out.a.linear = -by_centres;
    out.b.angular = by_gap * turned(asked.place.b.orientation, r.rotation_b) + asked.arm_b.cross(by_centres - g);
    out.a.angular = by_gap * turned(asked.place.a.orientation, r.rotation_a) - asked.arm_a.cross(by_centres - g);
  }

  SolidHandle side(const ConstraintBody &described, const char *name) const {
    try {
      return makeSolid(described, parameters_.dimension);
    } catch (const Error &error) {
      throw Error(std::string("side ") + name + ": " + error.what(), error.status());
    }
  }

  /* From the body's own axes to those of the fixed frame. */
  static Eigen::Vector3d turned(const cprox_quat &q, const cprox_vec3 &v) {
    return toQuaternion(q) * toEigen(v);
  }

  const Parameters parameters_;
  std::shared_ptr<cprox_gap> gap_;
  std::optional<Sphere> sphere_a_, sphere_b_;
  double size_ = 0.0;         /* [m] both radii */
  double fades_within_ = 0.0; /* [m] beyond the spheres */
  bool guaranteed_ = false;
};

} // namespace

class FourierGap : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    const std::string mode = reader.word("mode", "certified", {"certified", "tuned", "signal"});
    parameters_.options.mode = mode == "signal"  ? CPROX_GAP_MODE_SIGNAL
                               : mode == "tuned" ? CPROX_GAP_MODE_TUNED
                                                 : CPROX_GAP_MODE_CERTIFIED;
    parameters_.dimension = reader.count("dimension", 3, 2, 3);
    parameters_.options.delta = reader.number("delta", 0.0, 0.0);
    parameters_.options.samples = static_cast<std::uint32_t>(reader.count("samples", 0, 0, 1025));
    parameters_.options.period = reader.number("period", 0.0, 0.0);
    parameters_.level = reader.number("level", 0.0, -std::numeric_limits<double>::infinity());
    reader.end();

    // What one value alone cannot say.
    if (parameters_.options.samples != 0 && parameters_.options.samples % 2 == 0)
      throw Error("parameter samples: an odd number is expected");
    if (parameters_.options.samples == 1) throw Error("parameter samples: 1 is not at least 3");
    if (parameters_.options.samples != 0 && parameters_.options.delta != 0.0)
      throw Error("parameters samples and delta: give one of the two, delta chooses the samples");
    if (parameters_.options.samples == 0 && parameters_.options.delta == 0.0)
      parameters_.options.samples = parameters_.dimension == 2 ? 33 : 17;
    if (parameters_.level != 0.0 && parameters_.options.mode != CPROX_GAP_MODE_SIGNAL)
      throw Error("parameter level: only the mode signal has one");
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    return std::make_unique<FourierGapConstraint>(parameters_, pair);
  }

 private:
  Parameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::FourierGap, curve_proximity::ConstraintProvider)
