/* SPDX-License-Identifier: BSD-3-Clause */
/* A series of Legendre polynomials, psi(t) = sum_k c_k P_k(2s - 1), s = (t - t0)/(t1 - t0). On [0,1] the Bézier points
 * of P_k are the integers (-1)^(k-i) C(k, i); the sum so far is raised by one degree and the next term added.
 *
 * Error: raising takes (i b_(i-1) + (k-i) b_i)/k, convex up to a scale, a sum and a division; adding a term takes a
 * scale and a sum. A term goes through no more than n of both, and as Bézier points its size is at most |c_k| C(k,
 * k/2): n (divide + 2 scale + 2 add) u² sum_k |c_k| C(k, k/2). Source: R. T. Farouki, "Legendre-Bernstein basis
 * transformations", 2000. */
#include "base/workspace.h"
#include "curve/convert.h"

/* The Bézier points of degree k - 1 as those of degree k. */
static void raise_degree(dd *b, size_t k) {
  const dd degree = dd_from((double)k);
  b[k] = b[k - 1];
  for (size_t i = k; i-- > 1;)
    b[i] = dd_divide(dd_add(dd_scale(b[i - 1], (double)i), dd_scale(b[i], (double)(k - i))), degree);
}

/* Adds c P_k to Bézier points of degree k. */
static void add_term(dd *b, size_t k, double c) {
  for (size_t i = 0; i <= k; i++)
    b[i] = dd_add(b[i], dd_scale(dd_from_count(convert_binomial(k, i)), (k - i) % 2 ? -c : c));
}

cprox_status curve_create_legendre(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 *coefficients = d->points;
  const size_t n_coefficients = d->n;
  const double t0 = d->t0, t1 = d->t1;
  const cprox_status status = curve_check_sum(coefficients, n_coefficients, t0, t1, workspace);
  if (status != CPROX_OK) return status;

  /* a constant is a line that stands still */
  const size_t n = n_coefficients > 1 ? n_coefficients - 1 : 1;
  convert_piece *piece = convert_allocate(1);
  if (!piece) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of degree %zu", n);
  piece->from = t0;
  piece->to = t1;
  vec3 size = vec(0, 0, 0);
  for (int k = 0; k < 3; k++) {
    dd b[CPROX_MAX_DEGREE + 1] = {dd_from(convert_coordinate(coefficients[0], k))};
    for (size_t degree = 1; degree <= n; degree++) {
      raise_degree(b, degree);
      if (degree < n_coefficients) add_term(b, degree, convert_coordinate(coefficients[degree], k));
    }
    for (size_t i = 0; i <= n; i++) piece->control[i].k[k] = b[i];
  }
  for (size_t k = 0; k < n_coefficients; k++) {
    const vec3 c = coefficients[k];
    size = vec_axpy(size, (double)convert_binomial(k, k / 2), vec(fabs(c.x), fabs(c.y), fabs(c.z)));
  }
  const double steps = (double)n * (DD_DIVIDE + 2.0 * (DD_SCALE + DD_ADD));
  piece->error = ROUND_UP * steps * DD_UNIT * vec_norm(size) + CURVE_LEAST;
  return convert_finish(piece, 1, n, workspace, curve);
}
