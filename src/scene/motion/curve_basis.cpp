/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_basis.h"

#include <curve_proximity/core.hpp>

namespace curve_proximity {
namespace {

bool isDubins(const std::string &basis) {
  return basis.rfind("dubins", 0) == 0;
}

} // namespace

bool isNamedBasis(const std::string &basis) {
  return basis == "clothoid" || isDubins(basis) || basis == "involute" || basis == "pythagorean_hodograph";
}

bool hasOwnRange(const std::string &basis) {
  return isDubins(basis) || basis == "piecewise";
}

/* Where its knots are too few for that compile() says so. */
void takeWholeRange(CurveDescription &curve) {
  if (curve.t0 != 0.0 || curve.t1 != 0.0) {
    if (hasOwnRange(curve.basis))
      throw Error("a " + curve.basis + " curve has a range of its own: t0 and t1 must be 0");
    return;
  }
  curve.t1 = 1.0;
  const auto n = static_cast<std::size_t>(curve.points.cols());
  const bool has_knots = curve.degree < n && n < curve.knots.size();
  if (has_knots && (curve.basis == "bspline" || curve.basis == "nurbs")) {
    curve.t0 = curve.knots[curve.degree];
    curve.t1 = curve.knots[n];
  }
}

CurveCounts countsOf(const std::string &basis, std::size_t degree, std::size_t n) {
  if (degree > CPROX_MAX_DEGREE)
    throw Error("the degree is " + std::to_string(degree) + ", above " + std::to_string(CPROX_MAX_DEGREE));
  if (basis == "bspline" || basis == "nurbs") {
    if (degree < 1) throw Error("the degree of a " + basis + " is at least 1");
    if (n <= degree)
      throw Error("a " + basis + " of degree " + std::to_string(degree) + " needs at least " +
                  std::to_string(degree + 1) + " points, got " + std::to_string(n));
    return {n, n + degree + 1, basis == "nurbs" ? n : 0};
  }
  const std::size_t most = degree + 1;
  if (basis == "bezier") return {degree == 0 ? n : most, 0, 0};
  if (basis == "rational_bezier") return degree == 0 ? CurveCounts{n, 0, n} : CurveCounts{most, 0, most};
  if (basis == "polynomial" || basis == "legendre") return {most, 0, 0};
  if (basis == "lagrange") return {most, most, 0};
  if (basis == "trigonometric") return {2 * degree + 1, 0, 0};
  if (basis == "pythagorean_hodograph") return {1, 0, 4 * most};
  if (!isNamedBasis(basis))
    throw Error("basis '" + basis +
                "' is not available: it must be bezier, bspline, polynomial, legendre, lagrange, trigonometric, "
                "rational_bezier, nurbs, clothoid, dubins, involute, pythagorean_hodograph or piecewise");
  if (degree != 0) throw Error("a " + basis + " curve has no degree: it must be 0, got " + std::to_string(degree));
  if (basis == "clothoid") return {1, 0, 3};
  return basis == "involute" ? CurveCounts{1, 0, 2} : CurveCounts{2, 0, 3};
}

} // namespace curve_proximity
