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
    const double apart = between.norm(), touching = (1.0 - DRAWN) * (a.radius + b.radius);
    if (apart > 0.0) normal = between / apart;
    away = apart - touching;
    rounding = 1e-14 * (apart + toEigen(given.a.position).norm() + toEigen(given.b.position).norm() + arm_a.norm() +
                        arm_b.norm()) +
               DRAWN * (a.radius + b.radius);
    if (!isBeyond()) return;
    share = touching / apart;
    place.b.position = toVec3(toEigen(given.b.position) - away * normal);
  }

  bool isBeyond() const {
    return away > 0.0;
  }

  ConstraintPlace place;
  double away = 0.0;     /* [m] between the spheres, negative where they overlap */
  double rounding = 0.0; /* [m] the spheres' distance is no farther from `away` */
  double share = 1.0;    /* beyond: how far the drawn centre moves across the line for each metre of the other's way */
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); /* from a to b; 0 where the centres are one point */
  Eigen::Vector3d arm_a, arm_b;                     /* from the origins to the centres, fixed frame */
};

/* A value, and its derivatives by the gap's value and by the distance between the spheres. */
struct Mixture {
  double value, error, by_gap, by_distance;
};

/* Along a curve: parameters looked at first, so many for each sample's width of the gap, and how often the best
 * interval is halved. */
constexpr double LOOKS_A_SAMPLE = 2.0;
constexpr int LEAST_LOOKS = 16, MOST_LOOKS = 400, HALVINGS = 50;
constexpr std::uint32_t PROOF_NODES = 20000;

/* The gap of a standing pair; along a curve side a is the gap's second solid. */
class FourierGapConstraint : public Constraint {
 public:
  FourierGapConstraint(const Parameters &parameters, const ConstraintPair &pair) : parameters_(parameters) {
    if (pair.along_curve && pair.a.parts.empty())
      throw DoesNotApply("FourierGap carries a body along the curve, such as a sphere: give side a a shape");
    pair_.along_curve = pair.along_curve;
    const Stop stop = [&pair] { return pair.stop && pair.stop(pair.stop_user); };
    const SolidHandle a = side(pair.a, "a", stop), b = side(pair.b, "b", stop);
    const SolidHandle &first = pair.along_curve ? b : a, &second = pair.along_curve ? a : b;
    const Workspace workspace;
    cprox_workspace_set_stop(workspace.get(), pair.stop, pair.stop_user);
    cprox_gap *gap = nullptr;
    require(cprox_gap_create(first.get(), second.get(), &parameters.options, workspace.get(), &gap), workspace);
    gap_.reset(gap, cprox_gap_free);
    sphere_a_.emplace(first), sphere_b_.emplace(second);
    const cprox_gap_info info = cprox_gap_get_info(gap);
    guaranteed_ = info.guaranteed;
    sample_ = info.period / info.samples;
    size_ = sphere_a_->radius + sphere_b_->radius;
    fades_within_ = std::min(info.over_reach, size_);
    if (parameters.options.mode != CPROX_GAP_MODE_SIGNAL) depth_ = depthOf(workspace);
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    requirePlace(pair_, place);
    if (place.curve)
      evaluateAlong(place, workspace, out);
    else
      evaluateAt(place, workspace, out);
  }

 private:
  void evaluateAt(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const {
    const Asked asked(*sphere_a_, *sphere_b_, place);
    cprox_gap_result r;
    const cprox_status status =
        require(cprox_gap_evaluate(gap_.get(), &asked.place.a, &asked.place.b, workspace.get(), &r), workspace);

    const bool signal = parameters_.options.mode == CPROX_GAP_MODE_SIGNAL;
    Mixture mixed = signal ? mixSignal(asked, r) : mix(asked, r);
    out.status = status;
    out.value = mixed.value;
    out.bounded = !signal && guaranteed_;
    out.lower = mixed.value - mixed.error;
    out.upper = mixed.value + mixed.error;
    const bool known = status != CPROX_PRECISION && std::isfinite(mixed.value);
    if (!known) mixed.by_gap = 0.0;
    fillGradient(asked, r, mixed, out);
    out.valid = known || asked.isBeyond(); // beyond the spheres the distance still counts
    out.reason = out.valid ? "" : "the signal is below its rounding";
    out.points.resize(3, 0);
    out.radius = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
    out.has_points = false;
  }

  /* The place of the carried side at t, and the derivative of the value by t. */
  double slopeAt(const ConstraintPlace &place, double t, Workspace &workspace, ConstraintPlace &here,
                 ConstraintValue &out) const {
    cprox_vec3 velocity;
    here.a = place.b;
    here.b = CPROX_POSE_IDENTITY;
    require(cprox_curve_evaluate(place.curve->curve.get(), t, workspace.get(), &here.b.position, &velocity, nullptr),
            workspace);
    evaluateAt(here, workspace, out);
    return out.b.linear.dot(toEigen(velocity));
  }

  /* The least value of many parameters, then of the interval about it, by the sign of the derivative. */
  double nearestParameter(const ConstraintPlace &place, double t0, double t1, Workspace &workspace,
                          ConstraintValue &out) const {
    ConstraintPlace here;
    double length = 0.0;
    for (int i = 0; i <= LEAST_LOOKS; ++i) {
      const cprox_vec3 before = here.b.position;
      require(cprox_curve_evaluate(place.curve->curve.get(), at(t0, t1, i, LEAST_LOOKS), workspace.get(),
                                   &here.b.position, nullptr, nullptr),
              workspace);
      if (i > 0) length += (toEigen(here.b.position) - toEigen(before)).norm();
    }
    const double wanted = LOOKS_A_SAMPLE * length / sample_;
    const int looks = std::max(LEAST_LOOKS, static_cast<int>(std::min(wanted, double{MOST_LOOKS})));
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= looks; ++i) {
      slopeAt(place, at(t0, t1, i, looks), workspace, here, out);
      if (out.value < least) least = out.value, best = i;
    }
    double low = at(t0, t1, std::max(0, best - 1), looks), high = at(t0, t1, std::min(looks, best + 1), looks);
    for (int i = 0; i < HALVINGS; ++i) {
      const double t = 0.5 * (low + high);
      (slopeAt(place, t, workspace, here, out) > 0.0 ? high : low) = t;
    }
    const double t = 0.5 * (low + high);
    slopeAt(place, t, workspace, here, out);
    return out.value <= least ? t : at(t0, t1, best, looks);
  }

  static double at(double t0, double t1, int i, int of) {
    return i == of ? t1 : t0 + (t1 - t0) * i / of;
  }

  /* The least value along the curve: that of the parameters looked at, with its gradient. Where the gap proves that the
   * whole curve is clear, 0 is below it. */
  void evaluateAlong(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const {
    const CurveDescription &curve = place.curve->description;
    if (curve.radius != 0.0) throw DoesNotApply("FourierGap takes no radius of a curve: give side a padding");
    const cprox_curve_info info = cprox_curve_get_info(place.curve->curve.get());
    const double t = nearestParameter(place, info.t0, info.t1, workspace, out);
    ConstraintPlace here;
    slopeAt(place, t, workspace, here, out);
    if (out.bounded) out.bounded = out.value > 0.0 && isProvenClear(place, info, workspace);
    out.lower = 0.0;

    // Danskin: the value changes as at t. The carried side is the gap's second.
    const Eigen::Vector3d n = out.b.linear, position = toEigen(here.b.position);
    out.b = out.a;
    out.a.linear = n;
    out.a.angular = position.cross(n);
    // The weights stand at the front of the matrix; from the back, a column covers none that is still to be read.
    out.points.resize(3, curve.points.cols());
    double *weights = out.points.data();
    curveWeights(curve, t, weights);
    for (Eigen::Index i = curve.points.cols(); i-- > 0;) {
      const double w = weights[i];
      out.points.col(i) = w * n;
    }
    out.t = t;
  }

  bool isProvenClear(const ConstraintPlace &place, const cprox_curve_info &info, Workspace &workspace) const {
    const cprox_gap_carried carried{place.curve->curve.get(), {1, 0, 0, 0}, nullptr};
    cprox_gap_along_result r;
    require(cprox_gap_along_test(gap_.get(), &place.b, &carried, info.t0, info.t1, PROOF_NODES, workspace.get(), &r),
            workspace);
    return r.verdict == CPROX_GAP_VERDICT_CLEAR;
  }

  Mixture mixSignal(const Asked &asked, const cprox_gap_result &r) const {
    const double beyond = std::max(0.0, asked.away);
    return {r.value - parameters_.level + beyond / size_, r.error, 1.0, asked.isBeyond() ? 1.0 / size_ : 0.0};
  }

  /* The constraint grows where the gap falls, 1 - V/t, and is never negative where the spheres are apart. Inside it is
   * at least what rises to 0 where they touch; beyond them what is left of V/t fades away, and their distance is added.
   */
  Mixture mix(const Asked &asked, const cprox_gap_result &r) const {
    if (!asked.isBeyond()) {
      const double rise = depth_ / size_, floor = rise * asked.away;
      if (floor > 1.0 - r.value) return {floor, rise * asked.rounding, 0.0, rise};
      return {1.0 - r.value, r.error, -1.0, 0.0};
    }
    const double left = std::max(0.0, 1.0 - asked.away / fades_within_), fading = left * left;
    const bool above = r.value > 1.0;
    const double v = above ? 1.0 : r.value;
    return {1.0 - fading * v + asked.away / size_,
            fading * r.error + asked.rounding * (1.0 / size_ + 2.0 / fades_within_), above ? 0.0 : -fading,
            1.0 / size_ + 2.0 * left * v / fades_within_};
  }

  /* With D between the centres, P the part across the line, times `share`, and g the gap's gradient by b's position at
   * the drawn place: the drawn centre moves by P dD, so that g counts for dD as P g, and as g itself for what the turns
   * move the drawn place. */
  static void fillGradient(const Asked &asked, const cprox_gap_result &r, const Mixture &mixed, ConstraintValue &out) {
    const Eigen::Vector3d &n = asked.normal, g = mixed.by_gap * toEigen(r.position_b);
    const Eigen::Vector3d drawn = asked.isBeyond() ? Eigen::Vector3d(asked.share * (g - n * n.dot(g))) : g;
    const Eigen::Vector3d by_centres = drawn + mixed.by_distance * n;
    out.b.linear = by_centres;
    out.a.linear = -by_centres;
    out.b.angular = mixed.by_gap * turned(asked.place.b.orientation, r.rotation_b) + asked.arm_b.cross(by_centres - g);
    out.a.angular = mixed.by_gap * turned(asked.place.a.orientation, r.rotation_a) - asked.arm_a.cross(by_centres - g);
  }

  /* V/t where the centres are one point, at least 1: how deep a pair can be, for the floor inside the spheres. */
  double depthOf(const Workspace &workspace) const {
    const cprox_pose a = CPROX_POSE_IDENTITY;
    cprox_pose b = CPROX_POSE_IDENTITY;
    b.position = toVec3(sphere_a_->centre - sphere_b_->centre);
    cprox_gap_result r;
    require(cprox_gap_evaluate(gap_.get(), &a, &b, workspace.get(), &r), workspace);
    return std::max(1.0, r.value);
  }

  SolidHandle side(const ConstraintBody &described, const char *name, const Stop &stop) const {
    try {
      return makeSolid(described, parameters_.dimension, stop);
    } catch (const Error &error) {
      throw Error(std::string("side ") + name + ": " + error.what(), error.status());
    }
  }

  /* From the body's own axes to those of the fixed frame. */
  static Eigen::Vector3d turned(const cprox_quat &q, const cprox_vec3 &v) {
    return toQuaternion(q) * toEigen(v);
  }

  const Parameters parameters_;
  ConstraintPair pair_; /* without the sides */
  std::shared_ptr<cprox_gap> gap_;
  std::optional<Sphere> sphere_a_, sphere_b_; /* of the gap's first solid and of its second */
  double sample_ = 0.0;                       /* [m] the period over the samples */
  double size_ = 0.0;                         /* [m] both radii */
  double fades_within_ = 0.0;                 /* [m] beyond the spheres */
  double depth_ = 1.0;                        /* V/t of coinciding centres */
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
    if (parameters_.options.samples == 0 && parameters_.options.delta == 0.0) parameters_.options.samples = 33;
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
