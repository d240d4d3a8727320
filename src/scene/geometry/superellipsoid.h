/* SPDX-License-Identifier: BSD-3-Clause */
/** Superellipsoids with two exponents, which are no sum of three powers, by their support function. */
#ifndef CURVE_PROXIMITY_SCENE_SUPERELLIPSOID_H
#define CURVE_PROXIMITY_SCENE_SUPERELLIPSOID_H

#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** Barr's (|x/a1|^(2/e2) + |y/a2|^(2/e2))^(e2/e1) + |z/a3|^(2/e1) <= 1: semi_axes (a1, a2, a3) [m] above 0, exponents
 *  (e1, e2) from 0.002 to 2, where it is convex. Throws Error for others. */
BodyHandle makeSuperellipsoid(const Eigen::Vector3d &semi_axes, const Eigen::Vector2d &exponents);

} // namespace curve_proximity
#endif
