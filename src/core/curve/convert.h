/* SPDX-License-Identifier: BSD-3-Clause */
/* From a polynomial to Bézier pieces whose rounding is small against the curve, however the polynomial was given.
 *
 * A basis writes its polynomial as Bézier points in double-double arithmetic, with a proven bound of their error. Where
 * those points are far larger than the curve itself (up to C(n, n/2) times for a Legendre polynomial), rounding them to
 * double would cost as many digits; pieces are halved, still in double-double, until they are not. */
#ifndef CPROX_CURVE_CONVERT_H
#define CPROX_CURVE_CONVERT_H

#include "base/double_double.h"
#include "curve/curve.h"

typedef struct convert_point {
  dd k[3]; /* x, y, z */
} convert_point;

typedef struct convert_piece {
  double from, to;                             /* its parameters */
  double error;                                /* every exact point of the curve is within this of the piece's */
  convert_point control[CPROX_MAX_DEGREE + 1]; /* degree + 1 of them */
} convert_piece;

/* Room for n pieces, or NULL where memory is out; convert_finish() or free() frees. */
convert_piece *convert_allocate(size_t n);

/* Coordinate k = 0, 1, 2 of a point. */
static inline double convert_coordinate(vec3 p, int k) {
  return k == 0 ? p.x : k == 1 ? p.y : p.z;
}

/* C(n, k), exact for n <= 60. */
uint64_t convert_binomial(size_t n, size_t k);

/* Halves pieces where that helps, rounds all, makes the curve, and frees the pieces. They must follow each other
 * without a gap; degree >= 1. */
cprox_status convert_finish(convert_piece *pieces, size_t n, size_t degree, cprox_workspace *workspace,
                            cprox_curve **curve);

#endif
