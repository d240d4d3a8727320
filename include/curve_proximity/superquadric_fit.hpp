/* SPDX-License-Identifier: BSD-3-Clause */
/** A superquadric round a convex body: it encloses the body, and says by how much it stands out. */
#ifndef CURVE_PROXIMITY_SUPERQUADRIC_FIT_HPP
#define CURVE_PROXIMITY_SUPERQUADRIC_FIT_HPP

#include <functional>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** How a fit is looked for. */
struct SuperquadricFitOptions {
  double most_exponent = 16.0; /**< 2 … 1000: the higher, the tighter to boxes, and the sharper its edges */
  int cells = 20000;           /**< >= 8: of directions looked at by each proof */
};

struct SuperquadricFit {
  Eigen::Vector3d semi_axes, exponents; /**< sum |x_i/semi_axes_i|^exponents_i <= 1, [m] */
  Eigen::Isometry3d pose;               /**< where it stands in the body's frame */
  BodyHandle body;                      /**< in its own frame */
  double excess = 0.0; /**< [m] proven: no point of the superquadric is farther than this from the body */
};

/** Fits a superquadric to a convex body with an interior (any kind but points, halfspaces, compounds, meshes and others
 *  that are many pieces), known by its support function alone. Every point of the body is proven to lie in the
 *  superquadric, rounding included. Throws Error for a body of another kind. Cost: some ten milliseconds. Source:
 *  doc/constraint-providers.md. */
SuperquadricFit fitSuperquadric(const BodyHandle &body, const SuperquadricFitOptions &options = {});

/** A support function: max over the set of u·x for a unit vector u, and a point where it is attained. */
using SupportFunction = std::function<double(const Eigen::Vector3d &direction, Eigen::Vector3d &point)>;

/** An upper bound of max over all unit vectors u of h_inner(u) - h_outer(u), within `tolerance` of it unless the cells
 *  run out: at most 0 means that the first set lies in the second; else no point of the first is farther than this from
 *  the second. Rounding of the support functions is not in it. */
double supportGap(const SupportFunction &inner, const SupportFunction &outer, double tolerance, int cells);

} // namespace curve_proximity
#endif
