/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve as Bézier pieces between given parameters, from its own basis: exactly, or in intervals where that takes divisions, or
 * with a remainder where the basis is no polynomial. */
#ifndef CHECK_PIECES_H
#define CHECK_PIECES_H

#include "interval.h"
#include "problem.h"

typedef struct pieces {
  size_t degree, n;
  iv *points;    /* piece by piece, degree + 1 points of three numbers */
  iv *remainder; /* a piece's: every point of the curve is within this of the piece's */
} pieces;

/* Piece i runs from breaks[i] to breaks[i+1]. NULL, or why these cannot be the breaks: they do not ascend from t0 to t1, or a knot
 * of a spline lies inside a piece. To be freed in any case. */
const char *pieces_make(pieces *p, const curve *c, const double *breaks, size_t n);
void pieces_free(pieces *p);

/* min n·x over the part [from, to] of the pieces, counted from 0 to their number. */
void pieces_least(iv *out, const pieces *p, const iv n[3], double from, double to);

/* The point of the curve at the parameter t of [t0, t1]: a piece of no length. At a knot where a spline jumps, its limit from the left
 * or from the right. */
const char *pieces_point(iv point[3], iv *remainder, const curve *c, double t, bool left);

#endif
