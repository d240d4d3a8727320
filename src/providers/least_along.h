/* SPDX-License-Identifier: BSD-3-Clause */
/** The least value along a curve that carries a body, of values that are known at one place at a time. */
#ifndef CURVE_PROXIMITY_PROVIDERS_LEAST_ALONG_H
#define CURVE_PROXIMITY_PROVIDERS_LEAST_ALONG_H

#include <algorithm>
#include <array>
#include <cmath>
#include <curve_proximity/constraint_provider.hpp>
#include <limits>
#include <optional>

namespace curve_proximity {

/** Parameters looked at first, so many for each sample's width of the gap, and how often the interval about the best is
 *  halved. */
constexpr double LOOKS_A_SAMPLE = 2.0;
constexpr int LEAST_LOOKS = 16, MOST_LOOKS = 400, HALVINGS = 50;

/** Puts the place at t of the curve, without turning; the velocity there [m a unit of t]. */
inline Eigen::Vector3d carryTo(const ConstraintCurve &curve, double t, Workspace &workspace, cprox_pose &place) {
  cprox_vec3 velocity;
  place = CPROX_POSE_IDENTITY;
  require(cprox_curve_evaluate(curve.curve.get(), t, workspace.get(), &place.position, &velocity, nullptr), workspace);
  return toEigen(velocity);
}

/** A gap takes no radius of a curve. */
inline void requireNoRadius(const ConstraintCurve &curve) {
  if (curve.description.radius != 0.0 || curve.radius_curve)
    throw DoesNotApply("FourierGap takes no radius of a curve: give side a padding");
}

inline double parameterAt(double t0, double t1, int i, int of) {
  return i == of ? t1 : t0 + (t1 - t0) * i / of;
}

/** Where a value along a curve is least, and whether no other parameter, farther away than two looks, has as small a
 *  value. */
struct LeastAlong {
  double t = 0.0;
  bool is_alone = true;
};

/** The parameter of the least value of many, then of the interval about it by the sign of the derivative; so of other
 *  local minima that may be as low. slope(t) evaluates into out and returns the derivative by t; also: one more
 *  parameter to look at. sample [m]. */
template <class Slope>
LeastAlong leastAlong(const ConstraintCurve &curve, double sample, std::optional<double> also, Workspace &workspace,
                      const Slope &slope, const ConstraintValue &out) {
  constexpr double ALIKE = 1e-9; // of a sample: values are the same
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  const double t0 = info.t0, t1 = info.t1;
  double length = 0.0;
  cprox_pose before, here = CPROX_POSE_IDENTITY;
  for (int i = 0; i <= LEAST_LOOKS; ++i) {
    before = here;
    carryTo(curve, parameterAt(t0, t1, i, LEAST_LOOKS), workspace, here);
    if (i > 0) length += (toEigen(here.position) - toEigen(before.position)).norm();
  }
  const double wanted = LOOKS_A_SAMPLE * length / sample;
  const int looks = std::max(LEAST_LOOKS, static_cast<int>(std::min(wanted, double{MOST_LOOKS})));
  const double width = (t1 - t0) / looks;

  struct Look {
    double t, value, slope;
  };
  std::array<Look, MOST_LOOKS + 1> seen;
  const auto look = [&](double t) {
    const double by_t = slope(t);
    return Look{t, out.value, by_t};
  };
  const auto refined = [&](const Look &from) {
    double low = std::max(t0, from.t - width), high = std::min(t1, from.t + width);
    for (int i = 0; i < HALVINGS; ++i) {
      const double t = 0.5 * (low + high);
      (slope(t) > 0.0 ? high : low) = t;
    }
    const Look end = look(0.5 * (low + high));
    return end.value <= from.value ? end : from;
  };

  int first = 0;
  for (int i = 0; i <= looks; ++i) {
    seen[static_cast<std::size_t>(i)] = look(parameterAt(t0, t1, i, looks));
    if (seen[static_cast<std::size_t>(i)].value < seen[static_cast<std::size_t>(first)].value) first = i;
  }
  Look best = refined(seen[static_cast<std::size_t>(first)]);
  if (also) {
    const Look other = refined(look(*also));
    if (other.value < best.value) best = other;
  }
  LeastAlong least;
  for (int i = 0; i <= looks && least.is_alone; ++i) {
    const Look &one = seen[static_cast<std::size_t>(i)];
    const bool is_low = (i == 0 || one.value <= seen[static_cast<std::size_t>(i - 1)].value) &&
                        (i == looks || one.value <= seen[static_cast<std::size_t>(i + 1)].value);
    const double alike = ALIKE * (sample + std::abs(best.value));
    if (!is_low || std::abs(one.t - best.t) <= 2.0 * width ||
        one.value - std::abs(one.slope) * width > best.value + alike)
      continue;
    const Look other = refined(one);
    least.is_alone = std::abs(other.value - best.value) > alike;
    if (other.value < best.value) best = other;
  }
  least.t = best.t;
  return least;
}

/** The gradient of a value at t by what defines the curve and by its range, n being that by the carried place
 *  (Danskin). */
inline void fillByCurve(const ConstraintCurve &curve, double t, const Eigen::Vector3d &n, Workspace &workspace,
                        ConstraintValue &out) {
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  const double end = 1e-12 * (info.t1 - info.t0);
  const bool at_start = t <= info.t0 + end, at_end = t >= info.t1 - end;
  cprox_pose place;
  const double slope = at_start || at_end ? n.dot(carryTo(curve, t, workspace, place)) : 0.0;
  out.range_start = at_start ? slope : 0.0;
  out.range_end = at_end ? slope : 0.0;
  gradientByCurve(curve.description, at_end ? info.t1 : t, n, out.points, out.parameters);
}

/** The gradient of the least value by all of the curve, where n is that by the carried place. */
inline void fillAlong(const ConstraintCurve &curve, const LeastAlong &least, const Eigen::Vector3d &position,
                      const Eigen::Vector3d &n, Workspace &workspace, ConstraintValue &out) {
  out.a.linear = n;
  out.a.angular = position.cross(n);
  fillByCurve(curve, least.t, n, workspace, out);
  out.t = least.t;
  out.has_points = false;
  if (least.is_alone || !out.valid) return;
  out.valid = false;
  out.reason = "the value is as small elsewhere along the curve";
}

} // namespace curve_proximity
#endif
