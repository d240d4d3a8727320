/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/FourierGap: a smooth measure of overlap with its SE(2) or SE(3) gradient. */
#include <pluginlib/class_list_macros.hpp>

#include <cmath>
#include <limits>

#include <curve_proximity/constraint_provider.hpp>

#include "solids.h"

namespace curve_proximity {
namespace {

struct Parameters {
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  int dimension = 3;
  double level = 0.0; /* of the signal mode, subtracted */
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
    guaranteed_ = cprox_gap_get_info(gap).guaranteed;
  }

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (place.curve) throw Error("there is a curve, and the pair is not along one");
    cprox_gap_result r;
    const cprox_status status =
        require(cprox_gap_evaluate(gap_.get(), &place.a, &place.b, workspace.get(), &r), workspace);

    // By the mode, the constraint grows where the gap falls: 1 - V/t; or with the signal: c - level.
    const bool signal = parameters_.options.mode == CPROX_GAP_MODE_SIGNAL;
    const double sign = signal ? 1.0 : -1.0;
    out.status = status;
    out.value = signal ? r.value - parameters_.level : 1.0 - r.value;
    out.bounded = !signal && guaranteed_;
    out.lower = out.value - r.error;
    out.upper = out.value + r.error;
    out.a.linear = sign * toEigen(r.position_a);
    out.b.linear = sign * toEigen(r.position_b);
    out.a.angular = sign * turned(place.a.orientation, r.rotation_a);
    out.b.angular = sign * turned(place.b.orientation, r.rotation_b);
    out.points.resize(3, 0);
    out.radius = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
    out.has_points = false;

    // Where it says nothing about the way.
    out.valid = r.verdict != CPROX_GAP_VERDICT_FAR && status != CPROX_PRECISION && std::isfinite(out.value);
    if (out.valid)
      out.reason.clear();
    else
      out.reason = r.verdict == CPROX_GAP_VERDICT_FAR ? "beyond the bounding spheres the gap is flat"
                                                      : "the signal is below its rounding";
  }

 private:
  SolidHandle side(const ConstraintBody &described, const char *name) const {
    try {
      return makeSolid(described, parameters_.dimension);
    } catch (const Error &error) {
      throw Error(std::string("side ") + name + ": " + error.what(), error.status());
    }
  }

  /* From the body's own axes to those of the fixed frame. */
  static Eigen::Vector3d turned(const cprox_quat &q, const cprox_vec3 &v) {
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized() * toEigen(v);
  }

  const Parameters parameters_;
  std::shared_ptr<cprox_gap> gap_;
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
