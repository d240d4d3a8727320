/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that are known by points and arc lengths alone, asked anew by every query: an interval lies in the ellipsoid
 * whose foci are its end points and whose axis is its arc length (A. Lakshmanan et al. 2019, Theorem 1). */
#ifndef CPROX_CURVE_RECTIFIABLE_H
#define CPROX_CURVE_RECTIFIABLE_H

#include "curve/curve.h"

/* psi(t), within curve->arcs->error of the exact one; CPROX_INVALID with the reason where it is not finite. */
cprox_status rectifiable_point(const cprox_curve *curve, double t, cprox_workspace *workspace, vec3 *point);

/* At least the arc length over [a, b]; CPROX_INVALID with the reason where what is said of it is unusable. */
cprox_status rectifiable_length(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                double *length);

/* An ellipsoid with the foci of an interval's computed end points, which contains its exact part of the curve. */
typedef struct rectifiable_hull {
  double axis;   /* the sum of the distances from the foci */
  double radius; /* half its minor axis: it lies in the capsule of this radius round its foci's segment */
} rectifiable_hull;

/* The hull of [ta, tb], whose end points are a and b, each within `error` of the exact one. CPROX_INVALID with the
 * reason where the points are farther apart than the arc length. */
cprox_status rectifiable_hull_of(const cprox_curve *curve, double ta, double tb, vec3 a, vec3 b, double error,
                                 cprox_workspace *workspace, rectifiable_hull *hull);

/* min n·x over the ellipsoid with the foci a and b, n unit within 4u: within 8u of (its axis + the largest |focus|) of
 * that. */
double rectifiable_reach(const rectifiable_hull *hull, vec3 a, vec3 b, vec3 n);

#endif
