/* SPDX-License-Identifier: BSD-3-Clause */
/* Control points of one Bézier piece as three arrays (x, y, z; one after the other, degree + 1 numbers each), and what
 * they tell of the piece: its hull, its halves, its distance from a centre. */
#ifndef CPROX_CURVE_CONTROL_H
#define CPROX_CURVE_CONTROL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"
#include "curve_proximity/cprox/curve.h"

static inline size_t control_size(size_t degree) {
  return 3 * (degree + 1);
}

enum { CONTROL_MOST = 3 * (CPROX_MAX_DEGREE + 1) };

/* min over the control points of n·P. */
double control_least(const double *points, size_t degree, vec3 n);

/* Which control point is that, the first of several. */
size_t control_lowest(const double *points, size_t degree, vec3 n);

/* The largest |P|, an upper bound up to its own rounding. */
double control_magnitude(const double *points, size_t degree);

/* de Casteljau at s: `right` holds the control points on entry and those of [s, 1] on return, `left` gets those of [0,
 * s]. Both share the point at s, so the two cover the piece exactly. Returns the error added: |left or right - exact|.
 */
double control_split(double *left, double *right, size_t degree, double s, double magnitude);

/* A lower bound of |w| over the piece, w = psi - centre or its part orthogonal to the unit `axis` (NULL for none), from
 * the Bernstein coefficients of |w|^2, rounding included; 0 where they say nothing. Cost: degree^2. `binomial` is that
 * of curve_binomial(). */
double control_distance_from(const double *points, size_t degree, const double *binomial, vec3 centre,
                             const vec3 *axis);

#endif
