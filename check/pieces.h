/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve as Bézier pieces between given parameters, from its own basis: exactly, or in intervals where that takes
 * divisions, or with a remainder where the basis is no polynomial. */
#ifndef CHECK_PIECES_H
#define CHECK_PIECES_H

#include "interval.h"
#include "problem.h"

/* Arithmetic of few bits, and of many for what the few leave open. */
enum { PIECES_LEVELS = 2 };

/* What has been made of the pieces with so many bits; NULL where nothing has needed it. */
typedef struct pieces_level {
  iv **piece;  /* degree + 1 points of three numbers, and a remainder: every point of the curve is within this of the
                  piece's */
  iv **source; /* Bézier points of the span or the polynomial that pieces are cut from */
  iv **jet;    /* of a trigonometric series at the breaks */
  iv *sixth;   /* bounds its sixth derivative */
} pieces_level;

/* A piece in doubles: each of its points is within radius of the one here, the curve's within remainder more. */
typedef struct pieces_quick {
  double (*points)[3];
  double radius, remainder;
} pieces_quick;

typedef struct pieces {
  const curve *curve;
  size_t degree, n, n_sources;
  const double *breaks;
  size_t *span; /* of a spline: which one each piece is cut from */
  pieces_level at[PIECES_LEVELS];
  pieces_quick *quick; /* points NULL: not yet made */
} pieces;

/* Piece i runs from breaks[i] to breaks[i+1], which are kept by reference. NULL, or why these cannot be the breaks:
 * they do not ascend from t0 to t1, or a knot of a spline lies inside a piece. To be freed in any case. */
const char *pieces_make(pieces *p, const curve *c, const double *breaks, size_t n);
void pieces_free(pieces *p);

/* A curve and the direction that its points are seen along. */
typedef struct pieces_share {
  pieces *of;
  const iv *n;
} pieces_share;

/* The least of the sum of all n·x at one parameter, over the part [from, to] of the pieces, counted from 0 to their
 * number; all shares have the same breaks. The level's bits are those of the arithmetic. */
void pieces_least(iv *out, const pieces_share *shares, size_t n_shares, int level, double from, double to);

/* Piece i in doubles, by few bits; NULL where memory is out. The bits of the arithmetic are those of level 0. */
const pieces_quick *pieces_quick_at(pieces *p, size_t i);

/* The point of the curve at the parameter t of [t0, t1]: a piece of no length. At a knot where a spline jumps, its
 * limit from the left or from the right. */
const char *pieces_point(iv point[3], iv *remainder, const curve *c, double t, bool left);

#endif
