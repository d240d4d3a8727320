/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "distance_constraints.h"
#include "least_along.h"
#include "outline.h"

namespace curve_proximity {
namespace {

/* Rises from 0 at x <= 0 to 1 at x >= 1, with its derivative. Between, no slope is above STEEPEST. */
constexpr double STEEPEST = 1.5;

struct Rise {
  explicit Rise(double x) {
    const double y = std::clamp(x, 0.0, 1.0);
    value = y * y * (3.0 - 2.0 * y);
    slope = 6.0 * y * (1.0 - y);
  }
  double value, slope;
};

/* Where a value of two ingredients is `value`, and how far from the true one at most. */
struct Blend {
  double value, error;
};

/* (1 - w) x + w y with w = rise(x/length + offset). No derivative by x is above 1 + |y - x| STEEPEST/length, and none
 * by y above 1, wherever both are within their errors. */
double errorOf(const Blend &x, const Blend &y, double length) {
  const double apart = std::fabs(y.value - x.value) + x.error + y.error;
  return (1.0 + STEEPEST * apart / length) * x.error + y.error;
}

double errorOf(const ConstraintValue &value) {
  return std::max(value.upper - value.value, value.value - value.lower);
}

/* sum = factor · sum + share · other, of all gradients. */
void addGradient(double share, const ConstraintValue &other, double factor, ConstraintValue &sum) {
  for (ConstraintGradient ConstraintValue::*side : {&ConstraintValue::a, &ConstraintValue::b}) {
    (sum.*side).linear = factor * (sum.*side).linear + share * (other.*side).linear;
    (sum.*side).angular = factor * (sum.*side).angular + share * (other.*side).angular;
  }
}

class Guide : public Constraint {
 public:
  Guide(std::unique_ptr<const Constraint> exact, std::vector<GuideStage> stages)
      : exact_(std::move(exact)), stages_(std::move(stages)) {}

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (place.curve) throw Error("there is a curve, and the pair is not along one");
    exact_->evaluate(place, workspace, out);
    if (out.bounded && out.lower >= 0.0) return;

    // What a thread needs beside the value that it is asked for.
    static thread_local std::vector<ConstraintValue> scratch;
    if (scratch.size() < stages_.size()) scratch.resize(stages_.size());
    bool known = true, bounded = out.bounded;
    std::size_t last = 0;
    for (;; ++last) {
      stages_[last].gap->evaluate(place, workspace, scratch[last]);
      known = known && scratch[last].valid;
      bounded = bounded && scratch[last].bounded;
      if (last + 1 == stages_.size() || scratch[last].value <= -2.0 * stages_[last].sample) break;
    }

    // From the finest stage that counts to the coarsest. A gap's value at an overlap is at most 0: so is what is mixed.
    ConstraintValue &mixed = scratch[last];
    Blend all{mixed.value, errorOf(mixed)};
    for (std::size_t k = last; k-- > 0;) {
      const ConstraintValue &coarse = scratch[k];
      const double length = stages_[k].sample;
      const Rise fine(coarse.value / length + 2.0);
      const Blend one{coarse.value, errorOf(coarse)};
      const double by_coarse = 1.0 - fine.value + (all.value - one.value) * fine.slope / length;
      addGradient(by_coarse, coarse, fine.value, mixed);
      all = {one.value + fine.value * (all.value - one.value), errorOf(one, all, length)};
    }

    // About contact: the distance.
    const double length = stages_.back().sample;
    const Rise near(1.0 + out.value / length);
    const Blend one{out.value, errorOf(out)};
    const double by_exact = near.value + (one.value - all.value) * near.slope / length;
    if (near.value < 1.0) {
      addGradient(1.0 - near.value, mixed, by_exact, out);
      out.value = all.value + near.value * (one.value - all.value);
    }
    out.bounded = bounded;
    const double error = errorOf(one, all, length);
    out.lower = out.value - error;
    out.upper = out.value + error;
    if (near.value > 0.0) known = known && out.valid;
    if (near.value == 1.0) known = out.valid;
    const bool was = out.valid;
    out.valid = known;
    if (known)
      out.reason.clear();
    else if (was)
      out.reason = mixed.reason.empty() ? "a gap is flat" : mixed.reason;
  }

 private:
  const std::unique_ptr<const Constraint> exact_;
  const std::vector<GuideStage> stages_;
};

/* The least value along a curve. Where the distance proves the curve clear, that is the value. Else the guide is asked
 * at many parameters, and at the one where the overlap is deepest. */
class GuideAlong : public Constraint {
 public:
  GuideAlong(std::unique_ptr<const Constraint> exact, std::unique_ptr<const Constraint> standing, double sample)
      : exact_(std::move(exact)), standing_(std::move(standing)), sample_(sample) {}

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (!place.curve) throw Error("the pair is along a curve, and there is none");
    requireNoRadius(*place.curve);
    exact_->evaluate(place, workspace, out);
    if (out.bounded && out.lower >= 0.0) return;
    ConstraintPlace here;
    here.b = place.b;
    const auto slope = [&](double t) {
      const Eigen::Vector3d velocity = carryTo(*place.curve, t, workspace, here.a);
      standing_->evaluate(here, workspace, out);
      return out.a.linear.dot(velocity);
    };
    const LeastAlong least = leastAlong(*place.curve, sample_, out.t, workspace, slope, out);
    slope(least.t);
    out.bounded = false;
    const Eigen::Vector3d n = out.a.linear;
    fillAlong(*place.curve, least, toEigen(here.a.position), n, workspace, out);
  }

 private:
  const std::unique_ptr<const Constraint> exact_, standing_;
  const double sample_; /* [m] of the finest stage */
};

void requireDepth(const ConstraintBody &side, const char *name) {
  for (const ConstraintBody::Part &part : side.parts) {
    const ShapeType type = part.shape.type;
    if (!isHull(part) && type != ShapeType::POINTS && type != ShapeType::OCTREE) continue;
    throw Error(std::string("side ") + name + ": " + shapeTypeName(type) +
                ": the mode guide needs the depth of overlaps: give convex parts");
  }
}

} // namespace

std::unique_ptr<const Constraint> makeGuide(const ConstraintPair &pair, std::vector<GuideStage> stages) {
  requireDepth(pair.a, "a");
  requireDepth(pair.b, "b");
  constexpr double EPSILON = 1e-9;
  ConstraintPair standing = pair;
  standing.along_curve = false;
  StandingDistanceParameters parameters;
  parameters.options.epsilon = EPSILON;
  const double sample = stages.back().sample;
  auto guide = std::make_unique<Guide>(standingDistance(parameters, standing), std::move(stages));
  if (!pair.along_curve) return guide;
  CurveDistanceParameters along;
  along.options.epsilon = EPSILON;
  along.options.signed_distance = true;
  return std::make_unique<GuideAlong>(curveDistance(along, pair), std::move(guide), sample);
}

} // namespace curve_proximity
