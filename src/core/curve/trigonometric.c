/* SPDX-License-Identifier: BSD-3-Clause */
/* psi(t) = c + sum over k of a_k cos kt + b_k sin kt, compiled (compile.h).
 *
 * The ellipse a cos + b sin has the semi-major axis A = sqrt((|a|² + |b|² + sqrt((|a|² - |b|²)² + 4 (a·b)²))/2), so
 * K6 = sum of k^6 A_k. The remainder aimed at is 1e-13 of the size sum of A_k, or the rounding of the constant c where
 * that is larger.
 *
 * Rounding: kt is taken exactly, as high + low, and its cosine and sine are within 6u (angle.h). The sums are
 * double-double, so that with M_d = sum of k^d (|a_k| + |b_k|), taken a coordinate at a time, derivative d is within
 * e_d = 9u M_d: 6 of the cosine, 2 of k^d a_k, 1 to round. */
#include <math.h>

#include "base/workspace.h"
#include "curve/angle.h"
#include "curve/compile.h"

/* K6 of a series, the sizes of its terms and of its derivatives' terms. */
typedef struct series_size {
  double axes, sixth; /* sum of A_k and of k^6 A_k */
  double terms[3];    /* M_0, M_1, M_2 */
} series_size;

static double semi_major_axis(vec3 a, vec3 b) {
  const double a2 = vec_norm2(a), b2 = vec_norm2(b);
  return sqrt(0.5 * (a2 + b2 + hypot(a2 - b2, 2.0 * vec_dot(a, b)))) + CURVE_LEAST;
}

static series_size measure(const vec3 *c, size_t degree) {
  series_size size = {0};
  vec3 terms[3] = {{0, 0, 0}};
  for (size_t i = 1; i <= degree; i++) {
    const vec3 a = c[2 * i - 1], b = c[2 * i];
    const vec3 sum = vec(fabs(a.x) + fabs(b.x), fabs(a.y) + fabs(b.y), fabs(a.z) + fabs(b.z));
    const double axis = semi_major_axis(a, b), k = (double)i;
    size.axes += axis;
    size.sixth += k * k * k * k * k * k * axis;
    for (int d = 0; d < 3; d++) terms[d] = vec_axpy(terms[d], d == 0 ? 1.0 : d == 1 ? k : k * k, sum);
  }
  for (int d = 0; d < 3; d++) size.terms[d] = vec_norm(terms[d]);
  return size;
}

typedef struct series {
  const vec3 *c;
  size_t degree;
  series_size size;
} series;

static void add_product(dd *sum, double a, double b) {
  *sum = dd_add(*sum, dd_product(a, b));
}

static void evaluate(void *self, double t, compile_jet *jet) {
  const series *s = self;
  const vec3 *c = s->c;
  dd sum[3][3] = {{{0, 0}}};
  for (size_t i = 1; i <= s->degree; i++) {
    const double k = (double)i;
    const angle at = angle_of(dd_product(k, t));
    const vec3 a = c[2 * i - 1], b = c[2 * i];
    const double of_cos[3] = {a.x, a.y, a.z}, of_sin[3] = {b.x, b.y, b.z};
    for (int j = 0; j < 3; j++) {
      add_product(&sum[0][j], of_cos[j], at.cosine);
      add_product(&sum[0][j], of_sin[j], at.sine);
      add_product(&sum[1][j], -k * of_cos[j], at.sine);
      add_product(&sum[1][j], k * of_sin[j], at.cosine);
      add_product(&sum[2][j], -k * k * of_cos[j], at.cosine);
      add_product(&sum[2][j], -k * k * of_sin[j], at.sine);
    }
  }
  for (int d = 0; d < 3; d++) {
    jet->d[d] = vec(sum[d][0].high, sum[d][1].high, sum[d][2].high);
    jet->error[d] = 9.0 * ROUND_U * s->size.terms[d];
  }
}

/* The same everywhere: that of the ellipses' long axes. */
static double sixth_derivative(void *self, double a, double b) {
  (void)a, (void)b;
  const series *s = self;
  return s->size.sixth;
}

static cprox_status check_series(const vec3 *coefficients, size_t n, cprox_workspace *workspace) {
  const cprox_status status = curve_check_values("coefficient", coefficients, n, 2 * CPROX_MAX_DEGREE + 1, workspace);
  if (status != CPROX_OK) return status;
  if (n % 2 == 0)
    return workspace_fail(
        workspace, CPROX_INVALID,
        "a trigonometric series has an odd number of coefficients (constant, cos t, sin t, …), got %zu", n);
  if (n == 1) return workspace_fail(workspace, CPROX_INVALID, "the trigonometric series has a constant but no terms");
  for (size_t i = 1; i < n; i++)
    if (vec_norm2(coefficients[i]) > CURVE_LARGEST)
      return workspace_fail(workspace, CPROX_INVALID, "coefficient %zu is longer than %g m", i, sqrt(CURVE_LARGEST));
  return CPROX_OK;
}

cprox_status curve_create_trigonometric(const cprox_curve_description *d, cprox_workspace *workspace,
                                        cprox_curve **curve) {
  const cprox_vec3 *coefficients = d->points;
  const size_t n_coefficients = d->n;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = check_series(coefficients, n_coefficients, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  series s = {.c = coefficients, .degree = n_coefficients / 2};
  s.size = measure(coefficients, s.degree);
  const compile_source source = {.self = &s,
                                 .evaluate = evaluate,
                                 .sixth = sixth_derivative,
                                 .constant = coefficients[0],
                                 .accuracy = COMPILE_ACCURACY * s.size.axes + ROUND_U * vec_norm(coefficients[0])};
  const double pieces = (t1 - t0) / compile_step(s.size.sixth, source.accuracy);
  if (!(pieces <= COMPILE_MOST_PIECES))
    return workspace_fail(workspace, CPROX_INVALID, "[%.15g, %.15g] would need %.3g pieces of the series, above %d", t0,
                          t1, pieces, COMPILE_MOST_PIECES);
  return compile_curve(&source, t0, t1, workspace, curve);
}
