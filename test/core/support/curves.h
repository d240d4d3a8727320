/* SPDX-License-Identifier: BSD-3-Clause */
/* Random curves that are hard on arithmetic: awkward mantissas, scales, offsets, repeated points and knots. */
#ifndef CPROX_TEST_CURVES_H
#define CPROX_TEST_CURVES_H

#include "support/random.h"

#define TEST_MAX_POINTS 80

typedef struct test_spline {
  size_t degree, n_points, n_knots;
  vec3 points[TEST_MAX_POINTS];
  double knots[TEST_MAX_POINTS + 61];
  double t0, t1; /* inside the domain; all of it in half of the cases */
} test_spline;

/* n control points of one of several kinds; scale up to 1e6, offset up to 1e6 scales. */
void random_points(rng *r, size_t n, vec3 *points);

/* A parameter of [0,1]: an end, near an end, a power of two, or anything. */
double random_parameter(rng *r);

/* A spline of the degree, with up to 12 points more than it needs, knots of any multiplicity, a domain of length > 0.
 */
test_spline random_spline(rng *r, size_t degree);

/* 1 … 60, the low ones more often. */
size_t random_degree(rng *r);

#endif
