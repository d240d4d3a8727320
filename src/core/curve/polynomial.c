/* SPDX-License-Identifier: BSD-3-Clause */
/* A polynomial by its powers, psi(t) = sum_k c_k t^k. With d_k = c_k / C(n, k) its blossom takes one argument x away by
 * d_k <- d_k + x d_(k+1), so n arguments, each t0 or t1, leave a Bézier point.
 *
 * Error: with T = max(|t0|, |t1|), every number on the way to a Bézier point is a part of sum_k |c_k| T^k =: S. A term
 * has the error of its division and, n times, that of a product and a sum: (divide + n (scale + add)) u² S. This is the
 * problem's own condition: where the terms cancel S is larger than the curve, and the error grows with it.
 * Parameters are scaled by a power of two to T in [1/2, 1), so that no product overflows; what underflows is off by
 * fewer than 1e5 times 2^-1074, far below CURVE_LEAST. */
#include <stdlib.h>

#include "base/workspace.h"
#include "curve/convert.h"

/* The Bézier points of one coordinate over [lo, hi]; d is spoilt. */
static void blossom(dd *d, size_t n, double lo, double hi, convert_point *bezier, int k) {
  dd high[CPROX_MAX_DEGREE + 1];
  for (size_t given = 0;; given++) {
    /* lo has been given `given` times, the other arguments are hi */
    for (size_t i = 0; i + given <= n; i++) high[i] = d[i];
    for (size_t l = given + 1; l <= n; l++)
      for (size_t i = 0; i + l <= n; i++) high[i] = dd_add(high[i], dd_scale(high[i + 1], hi));
    bezier[n - given].k[k] = high[0];
    if (given == n) return;
    for (size_t i = 0; i + given < n; i++) d[i] = dd_add(d[i], dd_scale(d[i + 1], lo));
  }
}

/* sum_k |c_k| t^k */
static double sum_of_sizes(const double *c, size_t n, double t) {
  double sum = 0.0;
  for (size_t k = n + 1; k-- > 0;) sum = sum * t + fabs(c[k]);
  return sum;
}

cprox_status curve_create_polynomial(const cprox_curve_description *d, cprox_workspace *workspace,
                                     cprox_curve **curve) {
  const cprox_vec3 *coefficients = d->points;
  const size_t n_coefficients = d->n;
  const double t0 = d->t0, t1 = d->t1;
  const cprox_status status = curve_check_sum(coefficients, n_coefficients, t0, t1, workspace);
  if (status != CPROX_OK) return status;

  /* a constant is a line that stands still */
  const size_t n = n_coefficients > 1 ? n_coefficients - 1 : 1;
  int exponent;
  frexp(fmax(fabs(t0), fabs(t1)), &exponent);
  const double lo = ldexp(t0, -exponent), hi = ldexp(t1, -exponent);

  convert_piece *piece = convert_allocate(1);
  if (!piece) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of degree %zu", n);
  piece->from = t0;
  piece->to = t1;
  double size[3];
  for (int k = 0; k < 3; k++) {
    double c[CPROX_MAX_DEGREE + 1] = {0.0};
    dd de_boor[CPROX_MAX_DEGREE + 1];
    for (size_t i = 0; i <= n; i++) {
      if (i < n_coefficients) c[i] = ldexp(convert_coordinate(coefficients[i], k), (int)i * exponent);
      if (!(fabs(c[i]) <= CURVE_LARGEST)) {
        free(piece);
        return workspace_fail(workspace, CPROX_INVALID,
                              "coefficient %zu is too large for |t| up to %g: its term may exceed %g m", i,
                              fmax(fabs(t0), fabs(t1)), CURVE_LARGEST);
      }
      de_boor[i] = dd_divide(dd_from(c[i]), dd_from_count(convert_binomial(n, i)));
    }
    blossom(de_boor, n, lo, hi, piece->control, k);
    size[k] = sum_of_sizes(c, n, fmax(fabs(lo), fabs(hi)));
  }
  const double steps = DD_DIVIDE + (double)n * (DD_SCALE + DD_ADD);
  piece->error = ROUND_UP * steps * DD_UNIT * vec_norm(vec(size[0], size[1], size[2])) + CURVE_LEAST;
  return convert_finish(piece, 1, n, workspace, curve);
}
