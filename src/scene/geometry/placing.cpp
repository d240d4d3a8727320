/* SPDX-License-Identifier: BSD-3-Clause */
#include "placing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

/* What composing two poses and passing from a rotation matrix to a quaternion can do, per unit of length: a product of
 * two 3×3 matrices and a sum (5 roundings an entry, rows of norm 1: 9 in all), the quaternion of a matrix (16, see
 * core.hpp) whose own departure from a rotation is of the same size, and second order. */
constexpr double COMPOSING = 64.0 * std::numeric_limits<double>::epsilon() / 2.0;

/* How far the columns of a rotation may be from unit length and right angles. */
constexpr double RIGID = 1e-9;

bool isRotated(const Eigen::Isometry3d &pose) {
  return !(pose.linear() == Eigen::Matrix3d::Identity());
}

/* spread: what belongs to the body beyond its support values, padding and rounding of poses. */
Eigen::AlignedBox3d boxOf(const cprox_body *body, const Eigen::Isometry3d &pose, double spread, double reach) {
  // The body's extent along each axis of the fixed frame, by its support function.
  const double margin = spread + BOXING * (reach + spread + pose.translation().norm());
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = pose.linear().row(axis).transpose();
    const double position = pose.translation()[axis];
    box.max()[axis] = position + cprox_body_support(body, toVec3(along), nullptr) + margin;
    box.min()[axis] = position - cprox_body_support(body, toVec3(-along), nullptr) - margin;
  }
  return box;
}

cprox_obstacle obstacleOf(const Geometry &geometry, const Eigen::Isometry3d &pose, double padding) {
  cprox_obstacle out = cprox_obstacle_curve(geometry.curve.get(), geometry.radius + padding);
  out.synchronized = geometry.synchronized;
  out.radius_curve = geometry.radius_curve.get();
  out.pose = toPose(pose);
  return out;
}

/* The curve's own box has the rounding of its points in it. */
PlacedShape placeCurve(const Geometry &geometry, const Eigen::Isometry3d &outer, const Eigen::Isometry3d &inner,
                       double padding) {
  const Eigen::Isometry3d pose = outer * inner;
  PlacedShape out;
  out.obstacle = out.hull = out.surface = obstacleOf(geometry, pose, padding);
  const cprox_curve_info info = cprox_curve_get_info(geometry.curve.get());
  const Eigen::Vector3d low = toEigen(info.lowest), high = toEigen(info.highest);
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm();
  const double more = geometry.radius_curve ? cprox_curve_get_info(geometry.radius_curve.get()).highest.x : 0.0;
  out.rounding = placingError(outer, inner, reach);
  const double spread = geometry.radius + std::max(0.0, more) + padding + out.rounding;
  const Eigen::Vector3d middle = pose * (0.5 * (low + high));
  const Eigen::Vector3d half = pose.linear().cwiseAbs() * (0.5 * (high - low));
  const double margin = spread + BOXING * (reach + spread + pose.translation().norm());
  const Eigen::Vector3d out_to = half + Eigen::Vector3d::Constant(margin);
  out.box = Eigen::AlignedBox3d(middle - out_to, middle + out_to);
  return out;
}

} // namespace

void checkPose(const Eigen::Isometry3d &pose, const std::string &who) {
  const Eigen::Matrix3d r = pose.linear();
  if (!pose.matrix().allFinite()) throw Error(who + " is not finite");
  const double skew = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew <= RIGID) || !(r.determinant() > 0.0)) throw Error(who + " is no rotation and translation");
}

void checkPadding(double padding) {
  if (!std::isfinite(padding) || padding < 0.0) throw Error("its padding must be finite and not below 0");
}

double placingError(const Eigen::Isometry3d &outer, const Eigen::Isometry3d &inner, double reach) {
  const double a = outer.translation().norm(), b = inner.translation().norm();
  const bool rotated = isRotated(outer) || isRotated(inner);
  double out = 0.0;
  if (rotated || (a > 0.0 && b > 0.0)) out += COMPOSING * (a + b);
  if (rotated) out += COMPOSING * reach;
  return out;
}

PlacedShape place(const Geometry &geometry, const Eigen::Isometry3d &outer, const Eigen::Isometry3d &inner,
                  double padding) {
  const Eigen::Isometry3d pose = outer * inner;
  if (!pose.matrix().allFinite()) throw Error("a shape's pose is not finite");

  if (geometry.curve) return placeCurve(geometry, outer, inner, padding);
  PlacedShape out;
  const BodyHandle &body = geometry.body;
  const double margin = padding + geometry.margin;
  out.obstacle = at(body, pose, margin);
  out.hull = at(geometry.hull, pose, margin);
  out.surface = at(geometry.surface, pose, margin);
  out.hull_excess = geometry.hull_excess;
  out.is_mesh = geometry.is_mesh;
  out.is_open = geometry.is_open;

  // How far the body extends from its position.
  const cprox_body_info info = cprox_body_get_info(body.get());
  const cprox_vec3 centre = info.centre;
  const double radius = info.radius;
  const double reach = toEigen(centre).norm() + radius;

  // Rounding: sums of two translations, and the turn of what is rotated.
  const bool bounded = std::isfinite(reach);
  out.rounding = geometry.excess + placingError(outer, inner, bounded ? reach : 0.0);
  if (!bounded && (isRotated(outer) || isRotated(inner))) out.turning = COMPOSING;

  const Eigen::Vector3d everywhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  out.box = std::isfinite(reach) ? boxOf(body.get(), pose, margin + out.rounding + out.hull_excess, reach)
                                 : Eigen::AlignedBox3d(-everywhere, everywhere);
  return out;
}

} // namespace curve_proximity
