/* SPDX-License-Identifier: BSD-3-Clause */
/** What each basis of a CurveDescription consists of: the one table that compilation, files and messages read. */
#ifndef CURVE_PROXIMITY_SCENE_CURVE_BASIS_H
#define CURVE_PROXIMITY_SCENE_CURVE_BASIS_H

#include <cstddef>
#include <string>

#include <curve_proximity/description.hpp>

namespace curve_proximity {

/** How many points, knots and parameters a curve takes. */
struct CurveCounts {
  std::size_t points = 0, knots = 0, parameters = 0;
};

/** Of any basis but `piecewise`; n: the number of points that it has. Throws Error: a basis that there is not, a degree
 *  that it cannot have. */
CurveCounts countsOf(const std::string &basis, std::size_t degree, std::size_t n);

/** clothoid, dubins (with a word or without), involute, pythagorean_hodograph: start, headings and lengths say where it
 *  is. A frame moves such a curve, and piecewise ones, as a whole. */
bool isNamedBasis(const std::string &basis);

/** A range [0, 0] becomes that of the whole curve: [0, 1], or of a bspline and nurbs that of its knots. Throws Error
 * for a range of a basis that has its own. */
void takeWholeRange(CurveDescription &curve);

/** dubins and piecewise: t0 and t1 are not read. */
bool hasOwnRange(const std::string &basis);

} // namespace curve_proximity
#endif
