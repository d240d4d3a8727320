/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials on [0, 1] by their Bernstein coefficients, of which there are few: de Casteljau's scheme. Cubics, the
 * usual ones, by what is at hand; others along the scheme's diagonals, each entry from the one before. Row by row, in
 * place, a compiler would have vector loads wait for the two stores that they straddle, which takes longer than all the
 * arithmetic. The entries are the same to the last bit. */
#ifndef CPROX_BASE_BERNSTEIN_H
#define CPROX_BASE_BERNSTEIN_H

#include <stddef.h>

enum { BERNSTEIN_MOST = 9 }; /* the highest degree of bernstein_at */

/* The rows of a cubic's scheme below its coefficients: of three, two and one. */
typedef struct bernstein_cubic {
  double first[3], second[2], value;
} bernstein_cubic;

static inline bernstein_cubic bernstein_cubic_at(const double c[4], double u) {
  const double s = 1.0 - u, c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  const double f0 = s * c0 + u * c1, f1 = s * c1 + u * c2, f2 = s * c2 + u * c3;
  const double g0 = s * f0 + u * f1, g1 = s * f1 + u * f2;
  return (bernstein_cubic){{f0, f1, f2}, {g0, g1}, s * g0 + u * g1};
}

static inline double bernstein_at(const double *coefficients, size_t degree, double u) {
  if (degree == 3) return bernstein_cubic_at(coefficients, u).value;
  double c[BERNSTEIN_MOST + 1];
  for (size_t j = 0; j <= degree; j++) {
    c[j] = coefficients[j];
    for (size_t i = j; i > 0; i--) c[i - 1] = (1.0 - u) * c[i - 1] + u * c[i];
  }
  return c[0];
}

#endif
