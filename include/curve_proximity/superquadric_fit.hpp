/* SPDX-License-Identifier: BSD-3-Clause */
/** Superquadrics that enclose convex bodies, with a proven excess. */
#ifndef CURVE_PROXIMITY_SUPERQUADRIC_FIT_HPP
#define CURVE_PROXIMITY_SUPERQUADRIC_FIT_HPP

#include <functional>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** Options of a fit. */
struct SuperquadricFitOptions {
  double most_exponent = 16.0; /**< 2 … 1000; higher values fit boxes more tightly and have sharper edges */
  int cells = 20000;           /**< >= 8, the number of direction cells per proof */
};

/** A superquadric, the sum of |x_i/semi_axes_i|^exponents_i is <= 1, that encloses a body. */
struct SuperquadricFit {
  Eigen::Vector3d semi_axes; /**< [m] */
  Eigen::Vector3d exponents; /**< one an axis */
  Eigen::Isometry3d pose;    /**< in the frame of the enclosed body */
  BodyHandle body;           /**< the superquadric, in its own frame */
  double excess = 0.0; /**< [m] proven: no point of the superquadric is farther than this from the enclosed body */
};

/** Fits a superquadric to a convex body with an interior. Only the body's support function is used.
 *
 *  Every point of the body is proven to lie in the superquadric, rounding included. Throws Error for points,
 *  halfspaces, compounds, meshes, point clouds and octrees. Cost: some ten milliseconds. Derivation:
 *  doc/constraint-providers.md. */
SuperquadricFit fitSuperquadric(const BodyHandle &body, const SuperquadricFitOptions &options = {});

/** A support function: the maximum of u·x over a set for a unit vector u, and a point that attains it. */
using SupportFunction = std::function<double(const Eigen::Vector3d &direction, Eigen::Vector3d &point)>;

/** An upper bound of the maximum of h_inner(u) - h_outer(u) over all unit vectors u.
 *
 *  The bound is within `tolerance` of the maximum unless the cells run out. If it is at most 0, the first set lies in
 *  the second. Otherwise no point of the first set is farther than the bound from the second. Rounding of the support
 *  functions is not included. */
double supportGap(const SupportFunction &inner, const SupportFunction &outer, double tolerance, int cells);

} // namespace curve_proximity
#endif
