/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/FourierGap: a smooth measure of overlap in metres, with its SE(2) or SE(3) gradient. */
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <curve_proximity/constraint_provider.hpp>

#include "fourier_guide.h"
#include "least_along.h"
#include "solids.h"

namespace curve_proximity {
namespace {

struct Parameters {
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  int dimension = 3;
  double level = 0.0; /* of the signal mode, subtracted */
  bool guide = false;
};

/* The samples of a guide's coarsest stage. Each further one has twice as many, less one. */
constexpr std::uint32_t COARSEST = 9;

/* -log(v) for v >= LEAST, below that its tangent: there V is all but flat, and its logarithm is not. */
constexpr double LEAST = 0.05;

double negativeLog(double v) {
  return v >= LEAST ? -std::log(v) : 1.0 - std::log(LEAST) - v / LEAST;
}

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
  /* As far as rounding tells. */
  bool isTouching() const {
    return std::abs(away) <= rounding;
  }

  ConstraintPlace place;
  double away = 0.0;     /* [m] between the spheres, negative where they overlap */
  double rounding = 0.0; /* [m] the spheres' distance is no farther from `away` */
  double share = 1.0;    /* beyond: how far the drawn centre moves across the line for each metre of the other's way */
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); /* from a to b; 0 where the centres are one point */
  Eigen::Vector3d arm_a, arm_b;                     /* from the origins to the centres, fixed frame */
};

/* A value between its bounds, and its derivatives by the gap's value and by the distance between the spheres. kink:
 * another part of the value may be the larger one, with other derivatives. */
struct Mixture {
  double value, lower, upper, by_gap, by_distance;
  bool kink;
};

constexpr std::uint32_t PROOF_NODES = 20000;

void requireCarried(const ConstraintPair &pair) {
  if (pair.along_curve && pair.a.parts.empty())
    throw DoesNotApply("FourierGap carries a body along the curve, such as a sphere: give side a a shape");
}

/* The gap of a standing pair; along a curve side a is the gap's second solid. */
class FourierGapConstraint : public Constraint {
 public:
  FourierGapConstraint(const Parameters &parameters, const ConstraintPair &pair) : parameters_(parameters) {
    requireCarried(pair);
    pair_.along_curve = pair.along_curve;
    const Stop stop = [&pair] { return pair.stop && pair.stop(pair.stop_user); };
    const SolidHandle a = side(pair.a, "a", stop), b = side(pair.b, "b", stop);
    const SolidHandle &first = pair.along_curve ? b : a, &second = pair.along_curve ? a : b;
    const Workspace workspace;
    cprox_workspace_set_stop(workspace.get(), pair.stop, pair.stop_user);
    gap_ = makeGap(first, second, parameters.options, workspace);
    sphere_a_.emplace(first), sphere_b_.emplace(second);
    const cprox_gap_info info = cprox_gap_get_info(gap_.get());
    sample_ = info.period / info.samples;
    length_ = info.length;
    touching_least_ = length_ * (info.touching_least - parameters.level);
    touching_most_ = length_ * (info.touching_most - parameters.level);
  }

  /* [m] The period over the samples. */
  double sample() const {
    return sample_;
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
    out.bounded = !signal;
    out.lower = mixed.lower;
    out.upper = mixed.upper;
    out.penalty = signal;
    out.touching_least = touching_least_;
    out.touching_most = touching_most_;
    const bool known = status != CPROX_PRECISION && std::isfinite(mixed.value);
    if (!known) mixed.by_gap = 0.0;
    fillGradient(asked, r, mixed, out);
    out.valid = !mixed.kink && (known || asked.isBeyond()); // beyond the spheres the distance still counts
    out.reason = out.valid ? "" : mixed.kink ? "the value has a kink here" : "the signal is below its rounding";
    out.points.resize(3, 0), out.parameters.resize(0);
    out.radius = out.range_start = out.range_end = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
    out.has_points = false;
  }

  /* With the carried side at t of the curve; the derivative of the value by t. */
  double slopeAt(const ConstraintPlace &place, double t, Workspace &workspace, ConstraintPlace &here,
                 ConstraintValue &out) const {
    const Eigen::Vector3d velocity = carryTo(*place.curve, t, workspace, here.b);
    here.a = place.b;
    evaluateAt(here, workspace, out);
    return out.b.linear.dot(velocity);
  }

  /* The least value along the curve: that of the parameters looked at, with its gradient. Where the gap proves that the
   * whole curve is clear, 0 is below it. */
  void evaluateAlong(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const {
    requireNoRadius(*place.curve);
    const cprox_curve_info info = cprox_curve_get_info(place.curve->curve.get());
    ConstraintPlace here;
    const auto slope = [&](double t) { return slopeAt(place, t, workspace, here, out); };
    const LeastAlong least = leastAlong(*place.curve, sample_, {}, workspace, slope, out);
    slope(least.t);
    if (out.bounded) out.bounded = out.value > 0.0 && isProvenClear(place, info, workspace);
    out.lower = 0.0;

    // The carried side is the gap's second.
    const Eigen::Vector3d n = out.b.linear;
    out.b = out.a;
    fillAlong(*place.curve, least, toEigen(here.b.position), n, workspace, out);
  }

  bool isProvenClear(const ConstraintPlace &place, const cprox_curve_info &info, Workspace &workspace) const {
    const cprox_gap_carried carried{place.curve->curve.get(), {1, 0, 0, 0}, nullptr};
    cprox_gap_along_result r;
    require(cprox_gap_along_test(gap_.get(), &place.b, &carried, info.t0, info.t1, PROOF_NODES, workspace.get(), &r),
            workspace);
    return r.verdict == CPROX_GAP_VERDICT_CLEAR;
  }

  Mixture mixSignal(const Asked &asked, const cprox_gap_result &r) const {
    const double value = length_ * (r.value - parameters_.level) + std::max(0.0, asked.away);
    return {value, value, value, length_, asked.isBeyond() ? 1.0 : 0.0, asked.isTouching()};
  }

  /* -length log(V/t), and never less than the distance between the spheres. Beyond them what the gap has where they
   * touch, if that is above 0, and their distance. It rises with both numbers, so that bounds go through. */
  Mixture mix(const Asked &asked, const cprox_gap_result &r) const {
    const auto at = [&](double v, double away) {
      const double metres = length_ * negativeLog(v);
      return asked.isBeyond() ? std::max(0.0, metres) + away : std::max(metres, away);
    };
    const double lower = at(r.value + r.error, asked.away - asked.rounding),
                 upper = at(r.value - r.error, asked.away + asked.rounding);
    const double metres = length_ * negativeLog(r.value), least = asked.isBeyond() ? 0.0 : asked.away;
    const double rounding = asked.isBeyond() ? 0.0 : asked.rounding;
    const bool counts = metres > least, kink = length_ * negativeLog(r.value + r.error) <= least + rounding &&
                                               length_ * negativeLog(r.value - r.error) >= least - rounding;
    return {at(r.value, asked.away),
            lower,
            upper,
            counts ? -length_ / std::max(r.value, LEAST) : 0.0,
            asked.isBeyond() || !counts ? 1.0 : 0.0,
            kink || asked.isTouching()};
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
  GapHandle gap_;
  std::optional<Sphere> sphere_a_, sphere_b_;         /* of the gap's first solid and of its second */
  double sample_ = 0.0;                               /* [m] the period over the samples */
  double length_ = 0.0;                               /* [m] by which the gap's logarithm is multiplied */
  double touching_least_ = 0.0, touching_most_ = 0.0; /* [m] of the signal mode */
};

} // namespace

class FourierGap : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    const auto given = parameters.find("mode");
    if (given != parameters.end() && given->second == ParameterValue(std::string("tuned")))
      throw Error(
          "parameter mode: tuned is no constraint: its value falls again outwards beyond contact, and clear is "
          "not proven; take certified or guide");
    const std::string mode = reader.word("mode", "certified", {"certified", "guide", "signal"});
    parameters_.options.mode = mode == "signal" ? CPROX_GAP_MODE_SIGNAL : CPROX_GAP_MODE_CERTIFIED;
    parameters_.guide = mode == "guide";
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
    if (parameters_.guide && parameters_.options.delta != 0.0)
      throw Error("parameter delta: the mode guide takes samples, those of its finest stage");
    if (parameters_.guide && parameters_.options.samples < COARSEST)
      throw Error("parameter samples: the coarsest stage of the mode guide has " + std::to_string(COARSEST));
    if (parameters_.guide && parameters_.dimension == 2)
      throw Error("parameter mode: guide is for space: in the plane no depth of an overlap is measured");
    if (parameters_.level != 0.0 && parameters_.options.mode != CPROX_GAP_MODE_SIGNAL)
      throw Error("parameter level: only the mode signal has one");
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (!parameters_.guide) return std::make_unique<FourierGapConstraint>(parameters_, pair);
    requireCarried(pair);
    ConstraintPair standing = pair;
    standing.along_curve = false;
    std::vector<GuideStage> stages;
    for (std::uint32_t samples = COARSEST;; samples = std::min(2 * samples - 1, parameters_.options.samples)) {
      Parameters stage = parameters_;
      stage.options.samples = samples;
      auto gap = std::make_unique<FourierGapConstraint>(stage, standing);
      const double sample = gap->sample();
      stages.push_back({std::move(gap), sample});
      if (samples == parameters_.options.samples) break;
    }
    return makeGuide(pair, std::move(stages));
  }

 private:
  Parameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::FourierGap, curve_proximity::ConstraintProvider)
