/* SPDX-License-Identifier: BSD-3-Clause */
/* How near two pieces of curves come, by the first two derivatives of both at their middles. doc/curve-bound.md, "Curve
 * against curve", derives it. */
#ifndef CPROX_CURVE_QUERY_BENT_PIECES_H
#define CPROX_CURVE_QUERY_BENT_PIECES_H

#include "curve_query/curve_curve.h"

/* A lower bound on the distance of two pieces by their control points (curve/control.h), whose sizes are below the
 * magnitudes; rounding included, but not what the points are off. */
double bent_pieces_apart(const double *const points[2], const size_t degree[2], double magnitude);

#endif
