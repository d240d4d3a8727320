/* SPDX-License-Identifier: BSD-3-Clause */
/* Pythagorean-hodograph curves: psi' = A i A* for a polynomial A of quaternions, so that |psi'| = |A|² is a polynomial.
 * With the Bernstein coefficients A_i of degree m and the symmetric form B(P, Q) of P i Q*, those of psi' are h_k = sum
 * over i + j = k of C(m,i) C(m,j)/C(2m,k) B(A_i, A_j), and those of psi are P_0 = start, P_(k+1) = P_k + h_k/(2m + 1).
 *
 * Error: a coordinate of B is a sum of 4 products, at most |A_i||A_j|; the weights C(m,i) C(m,j) < 2^53 are exact. With
 * H = sum_k sum_(i+j=k) weight |A_i||A_j|/C(2m,k) a coordinate of every P is within
 *   (4 add + scale + (m+1) add + 2 divide + (2m+1) add) u² (|start| + H).
 * Source: R. T. Farouki, Pythagorean-Hodograph Curves, 2008, chapters 19 and 22. */
#include <stdlib.h>

#include "base/workspace.h"
#include "curve/convert.h"

/* The degree 2m + 1 must not be above CPROX_MAX_DEGREE. */
#define MOST_PREIMAGE ((CPROX_MAX_DEGREE - 1) / 2 + 1)

static dd sum_of_products(double a, double b, double c, double d, double e, double f, double g, double h) {
  return dd_add(dd_add(dd_product(a, b), dd_product(c, d)), dd_add(dd_product(e, f), dd_product(g, h)));
}

/* B(p, q) = (p i q* + q i p*)/2 */
static convert_point form(cprox_quat p, cprox_quat q) {
  const dd x = sum_of_products(p.w, q.w, p.x, q.x, -p.y, q.y, -p.z, q.z);
  const dd y = sum_of_products(p.w, q.z, p.z, q.w, p.x, q.y, p.y, q.x);
  const dd z = sum_of_products(p.x, q.z, p.z, q.x, -p.w, q.y, -p.y, q.w);
  return (convert_point){{x, y, z}};
}

static double norm_of(cprox_quat q) {
  return sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

static cprox_status check_preimage(const cprox_quat *preimage, size_t n, cprox_workspace *workspace) {
  if (n < 1) return workspace_fail(workspace, CPROX_INVALID, "the preimage has no coefficients; it needs at least 1");
  if (n > MOST_PREIMAGE)
    return workspace_fail(workspace, CPROX_INVALID, "the preimage has %zu coefficients, above %d", n, MOST_PREIMAGE);
  if (!preimage) return workspace_fail(workspace, CPROX_INVALID, "the preimage is NULL");
  for (size_t i = 0; i < n; i++) {
    const cprox_quat q = preimage[i];
    if (!(norm_of(q) <= sqrt(CURVE_LARGEST)))
      return workspace_fail(workspace, CPROX_INVALID,
                            "coefficient %zu of the preimage is (%g, %g, %g, %g), not finite or longer than %g", i, q.w,
                            q.x, q.y, q.z, sqrt(CURVE_LARGEST));
  }
  return CPROX_OK;
}

/* Coefficient k of the hodograph; *size is that of its terms. */
static convert_point hodograph(const cprox_quat *preimage, size_t m, size_t k, double *size) {
  convert_point sum = {{{0, 0}, {0, 0}, {0, 0}}};
  *size = 0.0;
  for (size_t i = k > m ? k - m : 0; i <= m && i <= k; i++) {
    const double weight = (double)(convert_binomial(m, i) * convert_binomial(m, k - i));
    const convert_point term = form(preimage[i], preimage[k - i]);
    for (int c = 0; c < 3; c++) sum.k[c] = dd_add(sum.k[c], dd_scale(term.k[c], weight));
    *size += weight * norm_of(preimage[i]) * norm_of(preimage[k - i]);
  }
  const dd divisor = dd_from_count(convert_binomial(2 * m, k));
  for (int c = 0; c < 3; c++) sum.k[c] = dd_divide(sum.k[c], divisor);
  *size /= divisor.high;
  return sum;
}

cprox_status curve_create_pythagorean_hodograph(const cprox_curve_description *d, cprox_workspace *workspace,
                                                cprox_curve **curve) {
  const cprox_vec3 start = d->start;
  const cprox_quat *preimage = d->preimage;
  const size_t n_preimage = d->n;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = curve_check_values("start point", &start, 1, 1, workspace);
  if (status == CPROX_OK) status = check_preimage(preimage, n_preimage, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  convert_piece *piece = convert_allocate(1);
  if (!piece) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve");
  piece->from = t0;
  piece->to = t1;
  const size_t m = n_preimage - 1, degree = 2 * m + 1;
  double sizes = vec_norm(start);
  for (int c = 0; c < 3; c++) piece->control[0].k[c] = dd_from(convert_coordinate(start, c));
  for (size_t k = 0; k < degree; k++) {
    double size;
    const convert_point h = hodograph(preimage, m, k, &size);
    for (int c = 0; c < 3; c++)
      piece->control[k + 1].k[c] = dd_add(piece->control[k].k[c], dd_divide(h.k[c], dd_from((double)degree)));
    sizes += size;
  }
  const double adds = 4.0 + (double)(m + 1) + (double)degree;
  const double steps = adds * DD_ADD + DD_SCALE + 2.0 * DD_DIVIDE;
  piece->error = ROUND_UP * 1.7320508075688774 * steps * DD_UNIT * sizes + CURVE_LEAST;
  return convert_finish(piece, 1, degree, workspace, curve);
}
