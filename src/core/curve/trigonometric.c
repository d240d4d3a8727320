/* SPDX-License-Identifier: BSD-3-Clause */
/* psi(t) = c + sum over k of a_k cos kt + b_k sin kt, compiled to quintic Hermite pieces of nearly equal length h.
 *
 * Remainder: K6 h^6/46080, K6 >= |psi^(6)|. The ellipse a cos + b sin has the semi-major axis
 * A = sqrt((|a|² + |b|² + sqrt((|a|² - |b|²)² + 4 (a·b)²))/2), so K6 = sum of k^6 A_k. h is chosen so that this is 1e-13 of
 * the size sum of A_k, or the rounding of the constant c where that is larger.
 *
 * Rounding: kt is taken exactly, as high + low, and cos and sin of it by the sum formulas from those of high and low, within
 * 6u given a libm that is within 2u. The sums are double-double, so that with M_d = sum of k^d (|a_k| + |b_k|), taken a
 * coordinate at a time, derivative d is within 9u M_d: 6 of the cosine, 2 of k^d a_k, 1 to round. The inner Bézier points
 * are p + 2h/5 v + h²/20 w; h, its factors and products cost at most 5u of the second and 6u of the third term, the two
 * sums 2u of all. With e_d = 9u M_d this is
 *   e_0 + .4h e_1 + .05h² e_2 + u(2 M_0 + 7 (.4h) M_1 + 8 (.05h²) M_2).
 * The constant is added at the very end, which costs u of the result. Hermite's points depend on the data by convex sums of
 * these, so their error bounds the curve's. Where |psi| underflows CURVE_LEAST covers it. */
#include <math.h>

#include "base/double_double.h"
#include "base/workspace.h"
#include "curve/curve.h"

#define MOST_PIECES 65536

/* The remainder that is aimed at, in units of the curve's size. */
#define ACCURACY 1e-13

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

/* Value and derivatives at one parameter, without the constant. */
typedef struct jet {
  vec3 d[3];
} jet;

static void add_product(dd *sum, double a, double b) {
  *sum = dd_add(*sum, dd_product(a, b));
}

static jet evaluate(const vec3 *c, size_t degree, double t) {
  dd sum[3][3] = {{{0, 0}}};
  for (size_t i = 1; i <= degree; i++) {
    const double k = (double)i;
    const dd angle = dd_product(k, t);
    const double cos_high = cos(angle.high), sin_high = sin(angle.high);
    const double cos_low = cos(angle.low), sin_low = sin(angle.low);
    const double cosine = cos_high * cos_low - sin_high * sin_low, sine = sin_high * cos_low + cos_high * sin_low;
    const vec3 a = c[2 * i - 1], b = c[2 * i];
    const double of_cos[3] = {a.x, a.y, a.z}, of_sin[3] = {b.x, b.y, b.z};
    for (int j = 0; j < 3; j++) {
      add_product(&sum[0][j], of_cos[j], cosine);
      add_product(&sum[0][j], of_sin[j], sine);
      add_product(&sum[1][j], -k * of_cos[j], sine);
      add_product(&sum[1][j], k * of_sin[j], cosine);
      add_product(&sum[2][j], -k * k * of_cos[j], cosine);
      add_product(&sum[2][j], -k * k * of_sin[j], sine);
    }
  }
  jet at;
  for (int d = 0; d < 3; d++) at.d[d] = vec(sum[d][0].high, sum[d][1].high, sum[d][2].high);
  return at;
}

/* The quintic with the given values and derivatives at both ends, the constant added. */
static void hermite(const jet *at0, const jet *at1, double h, vec3 constant, vec3 *bezier) {
  const double first = 0.4 * h, second = h * h / 20.0;
  bezier[0] = at0->d[0];
  bezier[1] = vec_axpy(at0->d[0], 0.5 * first, at0->d[1]);
  bezier[2] = vec_axpy(vec_axpy(at0->d[0], first, at0->d[1]), second, at0->d[2]);
  bezier[3] = vec_axpy(vec_axpy(at1->d[0], -first, at1->d[1]), second, at1->d[2]);
  bezier[4] = vec_axpy(at1->d[0], -0.5 * first, at1->d[1]);
  bezier[5] = at1->d[0];
  for (int j = 0; j <= 5; j++) bezier[j] = vec_add(bezier[j], constant);
}

static double piece_error(const series_size *size, double h, double largest) {
  const double h2 = h * h, remainder = size->sixth * h2 * h2 * h2 / 46080.0;
  const double of_data = 11.0 * size->terms[0] + 16.0 * 0.4 * h * size->terms[1] + 17.0 * 0.05 * h2 * size->terms[2];
  return ROUND_UP * (remainder + ROUND_U * (of_data + largest)) + CURVE_LEAST;
}

static double largest_norm(const vec3 *p, size_t n) {
  double largest = 0.0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, vec_norm2(p[i]));
  return sqrt(largest);
}

/* The number of pieces: 0 and the reason where there would be too many, or no doubles to cut at. */
static size_t count_pieces(const series_size *size, vec3 constant, double t0, double t1, cprox_workspace *workspace) {
  const double aim = ACCURACY * size->axes + ROUND_U * vec_norm(constant);
  const double step = pow(46080.0 * (aim / size->sixth), 1.0 / 6.0), n = fmax(1.0, ceil((t1 - t0) / step));
  if (!(n <= MOST_PIECES)) {
    workspace_fail(workspace, CPROX_INVALID, "[%.15g, %.15g] would need %.3g pieces of the series, above %d", t0, t1, n,
                   MOST_PIECES);
    return 0;
  }
  if (n > 1.0 && !((t1 - t0) / n > 4.0 * ROUND_U * fmax(fabs(t0), fabs(t1)))) {
    workspace_fail(workspace, CPROX_INVALID, "[%.15g, %.15g] is too far from 0 to be cut into %.0f pieces", t0, t1, n);
    return 0;
  }
  return (size_t)n;
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

cprox_status cprox_curve_create_trigonometric(const cprox_vec3 *coefficients, size_t n_coefficients, double t0,
                                              double t1, cprox_workspace *workspace, cprox_curve **curve) {
  workspace_clear(workspace);
  if (!curve) return workspace_fail(workspace, CPROX_INVALID, "the pointer for the new curve is NULL");
  cprox_status status = check_series(coefficients, n_coefficients, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  const size_t degree = n_coefficients / 2;
  const vec3 constant = coefficients[0];
  const series_size size = measure(coefficients, degree);
  const size_t n = count_pieces(&size, constant, t0, t1, workspace);
  if (n == 0) return CPROX_INVALID;

  cprox_curve *c = curve_allocate(5, n);
  if (!c) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  c->breaks[0] = t0;
  jet before = evaluate(coefficients, degree, t0);
  for (size_t i = 0; i < n; i++) {
    const double s = (double)(i + 1) / (double)n, end = i + 1 == n ? t1 : (1.0 - s) * t0 + s * t1;
    const double h = end - c->breaks[i];
    const jet after = evaluate(coefficients, degree, end);
    vec3 *points = c->points + 6 * i;
    hermite(&before, &after, h, constant, points);
    c->error[i] = piece_error(&size, h, largest_norm(points, 6));
    c->breaks[i + 1] = end;
    before = after;
  }
  curve_finish(c);
  *curve = c;
  return CPROX_OK;
}
