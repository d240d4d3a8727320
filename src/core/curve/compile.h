/* SPDX-License-Identifier: BSD-3-Clause */
/* From any smooth curve to quintic Bézier pieces with a certified remainder. A basis supplies its value and two
 * derivatives with bounds of their errors, and a bound of its sixth derivative over an interval; the pieces are as long
 * as that allows. */
#ifndef CPROX_CURVE_COMPILE_H
#define CPROX_CURVE_COMPILE_H

#include "curve/curve.h"

/* Value, without the source's constant, and derivatives at one parameter; how far each may be from the exact one. */
typedef struct compile_jet {
  vec3 d[3];
  double error[3];
} compile_jet;

typedef struct compile_source {
  void *self;
  /* Asked at ascending parameters (unless `doubted`), so that a source may go along. What is not finite ends it all. */
  void (*evaluate)(void *self, double t, compile_jet *jet);
  /* At least |psi^(6)| on [a, b], and less on a part of it. */
  double (*sixth)(void *self, double a, double b);
  vec3 constant;   /* added to all points at the very end, so that its size enters but one rounding */
  double accuracy; /* [m] the remainder to aim at */
  bool doubted;    /* what it says of its sixth derivative is checked against its points in the middle of pieces */
} compile_source;

/* The remainder that the bases here aim at, in units of the curve's size. */
#define COMPILE_ACCURACY 1e-13

/* The length of pieces that a bound of the sixth derivative allows. */
double compile_step(double sixth, double accuracy);

enum { COMPILE_MOST_PIECES = 65536 };

/* The pieces so far; {.workspace = …} is an empty one. */
typedef struct compile {
  cprox_workspace *workspace;
  size_t n, room;
  double *breaks; /* the ends of the pieces after the first one's beginning, which is `from` */
  double from;
  vec3 *points; /* 6 a piece */
  double *error;
  size_t beside; /* bytes that the caller wants at curve_room() of the curve */
} compile;

/* Appends the source on [t0, t1]; t0 is where the last one ended. On failure, with the reason set, all memory is given
 * back. */
cprox_status compile_append(compile *c, const compile_source *source, double t0, double t1);

/* The curve of all pieces; gives the memory back. */
cprox_status compile_finish(compile *c, cprox_curve **curve);

/* Both, for a curve of one source. */
cprox_status compile_curve(const compile_source *source, double t0, double t1, cprox_workspace *workspace,
                           cprox_curve **curve);

#endif
