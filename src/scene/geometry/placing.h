/* SPDX-License-Identifier: BSD-3-Clause */
/* A body brought into the fixed frame, with all that rounding can do on the way. */
#ifndef CURVE_PROXIMITY_SCENE_PLACING_H
#define CURVE_PROXIMITY_SCENE_PLACING_H

#include <curve_proximity/scene.hpp>

namespace curve_proximity {

/* How far beyond its box a body may be, per metre of size and distance from the origin: rounding of support values, the
 * rotation of their directions, sums. */
inline constexpr double BOXING = 1e-13;

/* Throws Error, with `who` before the reason, for a transform that is not finite or does not keep lengths. */
void checkPose(const Eigen::Isometry3d &pose, const std::string &who);

/* Throws Error for a padding that is not finite and >= 0. */
void checkPadding(double padding);

/* How far rounding can move a point of a body that is placed at outer * inner; reach: the body's largest distance from
 * its own origin, finite. */
double placingError(const Eigen::Isometry3d &outer, const Eigen::Isometry3d &inner, double reach);

/* The geometry at outer * inner, padded. Both poses finite, padding >= 0. Throws Error where the composed pose is not
 * finite. */
PlacedShape place(const Geometry &geometry, const Eigen::Isometry3d &outer, const Eigen::Isometry3d &inner,
                  double padding);

/* Is it a halfspace: without a finite box? */
inline bool unbounded(const PlacedShape &shape) {
  return !shape.box.sizes().allFinite();
}

} // namespace curve_proximity
#endif
