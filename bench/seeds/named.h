/* SPDX-License-Identifier: BSD-3-Clause */
/* The kinds of curves in Fig. 11 of Lakshmanan et al. (2019), for us and for their method: each with the integral of
 * |psi'|² in closed form. The sizes and places are ours: the paper does not print them. */
#ifndef CPROX_BENCH_SEEDS_NAMED_H
#define CPROX_BENCH_SEEDS_NAMED_H

#include "../paper/paper.h"
#include "curve_proximity/cprox.h"

enum { NAMED_MAX_HARMONIC = 8 };

/* A planar curve that the paper's method can take: what `paper.self` points to is this. */
typedef struct named_curve {
  cprox_curve *curve;
  paper_curve paper;
  size_t harmonics;
  vec3 coefficient[2 * NAMED_MAX_HARMONIC + 1]; /* 1, cos t, sin t, cos 2t, … */
  double energy[4 * NAMED_MAX_HARMONIC + 1];    /* of |psi'|²: 1, cos t, sin t, … */
  vec3 centre;                                  /* of the involute's circle */
  double stretch;                               /* of the compiled spiral: |psi'|² is at most 1 + this */
} named_curve;

/* The integral of |psi'|² over [a, b], for short intervals as exact as for long ones: less than it by at most
 * *error, which is in proportion to b - a. Of series and of the spiral. */
double named_energy(const named_curve *c, double a, double b, double *error);

/* How far a computed point may be from the curve's: the series, or the compiled spiral, which is 2e-13 from a clothoid. */
double named_error(const named_curve *c);

/* Made in place, since paper.self is the curve itself. */
void named_heart(vec3 centre, double size, named_curve *c);
void named_epicycloid(vec3 centre, double size, named_curve *c);
void named_fish(vec3 centre, double size, named_curve *c);
void named_lissajous(vec3 centre, double size, named_curve *c);
void named_involute(vec3 centre, double t1, named_curve *c);
/* Of unit speed, its curvature t, t from -2 pi to 2 pi. The paper's method gets our compiled points: it need not
 * integrate. */
void named_spiral(vec3 centre, named_curve *c);

#endif
