/* SPDX-License-Identifier: BSD-3-Clause */
/* The support function of Barr's superellipsoid (A. H. Barr, Superquadrics and angle-preserving transformations, 1981).
 *
 * Its gauge is a norm of norms: with p = 2/e2 and q = 2/e1 it is the q-norm of (r, z/a3), r the p-norm of (x/a1, y/a2).
 * So its support function is the dual norm of dual norms, and its support point is found in two steps of the plane: in
 * the unit ball of the p-norm along (a1 |nx|, a2 |ny|), then in that of the q-norm along (what the first step reached,
 * a3 |nz|).
 *
 * Rounding: in the plane the coordinates are powers s = 1/(p - 1) of numbers of at most 1, which are off by a few units
 * of 2^-53 and by s of them relatively. A rounded exponent moves u^(s + 1) by at most 2^-53 as t e^-t < 1. The terms of
 * n·x are positive, so n·x falls short by no more, relatively; and points are scaled to gauge 1 but for a few units.
 * slackOf() has a reserve of four. */
#include "superellipsoid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace curve_proximity {
namespace {

constexpr double LEAST_EXPONENT = 0.002, LARGEST_EXPONENT = 2.0; /* flat faces; an octahedron */

struct Superellipsoid {
  Eigen::Vector3d semi_axes;
  Eigen::Vector2d exponents;
};

/* The power of a support point's coordinates: 1/(p - 1) for p = 2/e. */
double powerOf(double e) {
  return e / (2.0 - e);
}

/* The point of |x|^(2/e) + |y|^(2/e) <= 1 that is farthest along (u, v), both not negative. */
std::array<double, 2> farthest(double u, double v, double e) {
  const double largest = std::max(u, v);
  if (largest == 0.0) return {0.0, 0.0};
  if (e == LARGEST_EXPONENT) return u >= v ? std::array<double, 2>{1.0, 0.0} : std::array<double, 2>{0.0, 1.0};
  const double p = 2.0 / e, x = std::pow(u / largest, powerOf(e)), y = std::pow(v / largest, powerOf(e));
  const double gauge = std::pow(std::pow(x, p) + std::pow(y, p), 1.0 / p);
  return {x / gauge, y / gauge};
}

void support(const void *shape, const double direction[3], double point[3]) {
  const auto &body = *static_cast<const Superellipsoid *>(shape);
  const Eigen::Vector3d along = body.semi_axes.cwiseProduct(Eigen::Vector3d(direction[0], direction[1], direction[2]));
  const auto [x, y] = farthest(std::fabs(along.x()), std::fabs(along.y()), body.exponents[1]);
  const double plane = std::fabs(along.x()) * x + std::fabs(along.y()) * y;
  const auto [r, z] = farthest(plane, std::fabs(along.z()), body.exponents[0]);
  point[0] = std::copysign(body.semi_axes.x() * r * x, direction[0]);
  point[1] = std::copysign(body.semi_axes.y() * r * y, direction[1]);
  point[2] = std::copysign(body.semi_axes.z() * z, direction[2]);
}

/* How far support points may be from the body and from the maximum. */
double slackOf(const Superellipsoid &body, double radius) {
  constexpr double UNITS = 16.0, RESERVE = 4.0;
  double units = UNITS;
  for (const double e : body.exponents) units += e == LARGEST_EXPONENT ? 0.0 : powerOf(e);
  return std::ldexp(RESERVE * units * radius, -53);
}

} // namespace

BodyHandle makeSuperellipsoid(const Eigen::Vector3d &semi_axes, const Eigen::Vector2d &exponents) {
  for (const double e : exponents)
    if (!(e >= LEAST_EXPONENT && e <= LARGEST_EXPONENT))
      throw Error(
          "superellipsoid: the exponents e1, e2 are from 0.002 to 2; a superquadric of powers has 6 dimensions");
  if (exponents[0] == exponents[1]) return makeSuperquadric(semi_axes, Eigen::Vector3d::Constant(2.0 / exponents[0]));
  const auto shape = std::make_shared<const Superellipsoid>(Superellipsoid{semi_axes, exponents});
  const double radius = semi_axes.norm();
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) {
        return cprox_body_create_support(support, shape.get(), {0.0, 0.0, 0.0}, radius, slackOf(*shape, radius), 0.0, w,
                                         b);
      },
      shape);
}

} // namespace curve_proximity
