/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar curves run at unit speed whose heading is quadratic in arc length: lines, arcs, clothoids. */
#ifndef CPROX_CURVE_HEADING_H
#define CPROX_CURVE_HEADING_H

#include "curve/angle.h"
#include "curve/compile.h"

/* The remainder aimed at, in units of the arc length: a winding curve is several times as long as it is wide. */
#define HEADING_ACCURACY 2e-14

/* heading(t) = heading + curvature tau + rate tau²/2, tau = t - origin, and a point that goes along the curve: where it
 * is when the parameter is `at`, and how far that may be from the truth. */
typedef struct heading_curve {
  double origin, rate;
  dd heading, curvature;
  double heading_error; /* of `heading`, besides its representation [rad] */
  double at;
  dd x, y;
  double error;
  double steps; /* that the point has gone in all, and those that were one too many */
} heading_curve;

/* A point that has gone so many steps goes no farther: about a second. */
#define HEADING_MOST_STEPS 1e6

/* Takes the point to another parameter, forwards or backwards; false where it would go too far. */
bool heading_advance(heading_curve *c, double to);

/* The heading at a parameter, for a curve that goes on from there; *error grows by what that costs. */
dd heading_at(const heading_curve *c, double t, double *error);

/* moment[j] = the integral of tau^j (cos, sin)(heading) over tau in [0, to - origin], in plain doubles; false where
 * that takes too many steps. */
bool heading_moments(const heading_curve *c, double to, vec3 moment[3]);

/* The curve as a source of pieces; constant and accuracy are the caller's. */
compile_source heading_source(heading_curve *c);

#endif
