/* SPDX-License-Identifier: BSD-3-Clause */
/* Divided differences of exp(-it): the transforms of segments, triangles and tetrahedra (Hermite-Genocchi). */
#ifndef CPROX_FOURIER_DIVIDED_H
#define CPROX_FOURIER_DIVIDED_H

#include "fourier/wave.h"

enum { DIVIDED_MOST = 6 };

/* The divided difference of exp(-it) over n nodes, 1 <= n <= DIVIDED_MOST, in any order, equal ones allowed. Its
 * absolute error is below 50 u for n <= 4, 400 u beyond, plus u max|t|/(n-1)! by the phases: it never cancels, because
 * nodes are sorted so that each quotient divides by the whole spread, and spreads below 0.6 go by series. */
wave divided_exponential(const double *nodes, int n);

#endif
