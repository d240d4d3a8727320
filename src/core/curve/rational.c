/* SPDX-License-Identifier: BSD-3-Clause */
/* Rational Bézier curves and NURBS. On a span of length L, psi = o + N/W: N and W have the homogeneous Bézier points
 * w_i (P_i - o) and w_i > 0, o being a control point in the middle of the span. compile.c makes quintic pieces of it.
 *
 * Sixth derivative on [a, b]: W psi = N gives W psi^(k) = N^(k) - sum_(j=1..k) C(k,j) W^(j) psi^(k-j). The Bernstein
 * coefficients of N^(j) and W^(j) restricted to [a, b] bound |N^(j)| <= A_j, |W^(j)| <= B_j and W >= w, so that
 *
 *   D_0 = A_0/w,   D_k = (A_k + sum_(j=1..k) C(k,j) B_j D_(k-j))/w   and   |psi^(k)| <= D_k.
 *
 * Restricting is convex: two splits of n levels with 3u each, and u of the coefficients themselves, cost 8 (n + 1) u of
 * the largest coefficient; its interval is widened by the rounding of its ends.
 *
 * Value and derivatives are computed in double-double arithmetic. A level of de Casteljau's or of the blossom's costs
 * (divide + multiply + add) u², 26 u²; of both n each, and what is left (products, the last three points) is below 200
 * u²: E = (60 n + 200) u² of the largest coefficient, twice as much a difference. With e_N, e_W those errors of the
 * derivatives of N and W, dividing by W >= w:
 *
 *   e_0 = (e_N0 + e_W0 D_0)/w,   e_1 = (e_N1 + e_W1 D_0 + B_1 e_0 + e_W0 D_1)/w,
 *   e_2 = (e_N2 + 2 e_W1 D_1 + 2 B_1 e_1 + e_W2 D_0 + B_2 e_0 + e_W0 D_2)/w,
 *
 * with A, B, D over all of the span; the arithmetic of the quotients adds at most 200 u² of their terms. As weights
 * differ by no more than WEIGHTS_MOST, E is far below w: a factor 1.01 covers the second order. doc/rounding.md. */
#include <math.h>

#include "base/workspace.h"
#include "curve/compile.h"
#include "curve/convert.h"

/* The largest weight is at most so many times the least. */
#define WEIGHTS_MOST 1e6

/* Spans are longer and shorter than these: their sixth power does not overflow. */
#define SPAN_LEAST 1e-30
#define SPAN_MOST 1e30

enum { ROWS = 4, ORDER = 6, MOST = CPROX_MAX_DEGREE + 1 };

/* x, y, z of N, and W */
typedef struct homogeneous {
  dd row[ROWS][MOST];
} homogeneous;

typedef struct rational_span {
  double from, to;
  size_t degree; /* at least 2 */
  homogeneous bezier;
  /* the Bernstein coefficients of the derivatives of N and W by t, of degree `degree` - k */
  double derivative[ORDER + 1][ROWS][MOST];
  double least_weight;
  double error[3]; /* of value and derivatives, before they are rounded to double */
} rational_span;

/* ---- bounds ---- */

/* Coefficients of degree n on [0, 1] become those on [s0, s1]. */
static void restrict_row(double *c, size_t n, double s0, double s1) {
  for (size_t k = 1; k <= n && s1 < 1.0; k++)
    for (size_t i = n; i >= k; i--) c[i] = (1.0 - s1) * c[i - 1] + s1 * c[i];
  const double s = s0 / s1;
  for (size_t k = 1; k <= n && s > 0.0; k++)
    for (size_t i = 0; i + k <= n; i++) c[i] = (1.0 - s) * c[i] + s * c[i + 1];
}

/* At least max|psi^(k)|, max|N^(k)| and max|W^(k)| on a part of a span, and at most min W. */
typedef struct span_bounds {
  double d[ORDER + 1], a[ORDER + 1], b[ORDER + 1];
  double least;
} span_bounds;

static void bound_derivative(const rational_span *span, size_t k, double s0, double s1, span_bounds *out) {
  double row[ROWS][MOST], largest[2] = {0.0, 0.0}, restricted[2] = {0.0, 0.0}, least = INFINITY;
  const size_t n = span->degree - k;
  for (int r = 0; r < ROWS; r++)
    for (size_t i = 0; i <= n; i++) row[r][i] = span->derivative[k][r][i];
  for (int pass = 0; pass < 2; pass++) {
    double *most = pass ? restricted : largest;
    for (size_t i = 0; i <= n; i++) {
      most[0] = fmax(most[0], vec_norm(vec(row[0][i], row[1][i], row[2][i])));
      most[1] = fmax(most[1], fabs(row[3][i]));
    }
    for (int r = 0; r < ROWS && !pass; r++) restrict_row(row[r], n, s0, s1);
  }
  const double rounding = 8.0 * (double)(n + 1) * ROUND_U;
  out->a[k] = ROUND_UP * (restricted[0] + rounding * largest[0]);
  out->b[k] = ROUND_UP * (restricted[1] + rounding * largest[1]);
  if (k > 0) return;
  for (size_t i = 0; i <= n; i++) least = fmin(least, row[3][i]);
  out->least = fmax(span->least_weight, least / ROUND_UP - rounding * largest[1]);
}

static span_bounds bounds_on(const rational_span *span, double a, double b) {
  const double length = span->to - span->from, widened = 8.0 * ROUND_U;
  const double s0 = fmax(0.0, (a - span->from) / length - widened);
  const double s1 = fmin(1.0, (b - span->from) / length + widened);
  span_bounds out = {{0}, {0}, {0}, 0.0};
  for (size_t k = 0; k <= ORDER && k <= span->degree; k++) bound_derivative(span, k, s0, s1, &out);
  for (size_t k = 0; k <= ORDER; k++) {
    double sum = out.a[k];
    for (size_t j = 1; j <= k; j++) sum += (double)convert_binomial(k, j) * out.b[j] * out.d[k - j];
    out.d[k] = ROUND_UP * sum / out.least;
  }
  return out;
}

static double sixth(void *self, double a, double b) {
  const double bound = bounds_on(self, a, b).d[ORDER];
  return isnan(bound) ? INFINITY : bound;
}

/* ---- values ---- */

static dd negative(dd a) {
  return (dd){-a.high, -a.low};
}

static dd difference(dd a, dd b) {
  return dd_add(a, negative(b));
}

/* The weights of t between `left` and `right`. */
static void weigh(double left, double t, double right, dd *of_left, dd *of_right) {
  const dd length = dd_sum(right, -left);
  *of_left = dd_divide(dd_sum(right, -t), length);
  *of_right = dd_divide(dd_sum(t, -left), length);
}

static dd combine(dd of_left, dd a, dd of_right, dd b) {
  return dd_add(dd_multiply(of_left, a), dd_multiply(of_right, b));
}

/* Value and two derivatives by t of one row. */
static void differentiate(const rational_span *span, int r, dd before, dd after, dd out[3]) {
  dd c[MOST] = {{0.0, 0.0}};
  const size_t n = span->degree;
  for (size_t i = 0; i <= n; i++) c[i] = span->bezier.row[r][i];
  for (size_t k = 1; k + 2 <= n; k++)
    for (size_t i = 0; i + k <= n; i++) c[i] = combine(before, c[i], after, c[i + 1]);
  const dd length = dd_sum(span->to, -span->from);
  const dd low = combine(before, c[0], after, c[1]), high = combine(before, c[1], after, c[2]);
  out[0] = combine(before, low, after, high);
  out[1] = dd_divide(dd_scale(difference(high, low), (double)n), length);
  const dd bend = difference(difference(c[2], c[1]), difference(c[1], c[0]));
  out[2] = dd_divide(dd_divide(dd_scale(bend, (double)(n * (n - 1))), length), length);
}

static void evaluate(void *self, double t, compile_jet *jet) {
  const rational_span *span = self;
  dd before, after, w[3], x[3][3];
  weigh(span->from, t, span->to, &before, &after);
  differentiate(span, 3, before, after, w);
  for (int r = 0; r < 3; r++) {
    dd n[3];
    differentiate(span, r, before, after, n);
    x[0][r] = dd_divide(n[0], w[0]);
    x[1][r] = dd_divide(difference(n[1], dd_multiply(w[1], x[0][r])), w[0]);
    const dd known = dd_add(dd_scale(dd_multiply(w[1], x[1][r]), 2.0), dd_multiply(w[2], x[0][r]));
    x[2][r] = dd_divide(difference(n[2], known), w[0]);
  }
  for (int k = 0; k < 3; k++) {
    jet->d[k] = vec(x[k][0].high, x[k][1].high, x[k][2].high);
    jet->error[k] = ROUND_UP * (span->error[k] + ROUND_U * vec_norm(jet->d[k])) + CURVE_LEAST;
  }
}

/* ---- spans ---- */

static void fill_derivatives(rational_span *span) {
  dd c[MOST];
  const dd length = dd_sum(span->to, -span->from);
  for (int r = 0; r < ROWS; r++) {
    for (size_t i = 0; i <= span->degree; i++) c[i] = span->bezier.row[r][i];
    for (size_t k = 0; k <= ORDER && k <= span->degree; k++) {
      const size_t n = span->degree - k;
      for (size_t i = 0; i <= n; i++) {
        if (k > 0) c[i] = dd_divide(dd_scale(difference(c[i + 1], c[i]), (double)(n + 1)), length);
        span->derivative[k][r][i] = c[i].high;
      }
    }
  }
}

static void fill_errors(rational_span *span) {
  const span_bounds s = bounds_on(span, span->from, span->to);
  const double n = (double)span->degree, length = span->to - span->from;
  const double unit = (60.0 * n + 200.0) * DD_UNIT, w = s.least / 1.01, more = 200.0 * DD_UNIT;
  double of_n[3], of_w[3];
  for (int k = 0; k < 3; k++) {
    const double factor = k == 0 ? 1.0 : k == 1 ? 4.0 * n / length : 8.0 * n * n / (length * length);
    of_n[k] = factor * unit * s.a[0];
    of_w[k] = factor * unit * s.b[0];
  }
  const double e0 = (of_n[0] + of_w[0] * s.d[0]) / w + more * s.d[0];
  const double e1 = (of_n[1] + of_w[1] * s.d[0] + s.b[1] * e0 + of_w[0] * s.d[1]) / w +
                    more * (s.a[1] + s.b[1] * s.d[0] + s.b[0] * s.d[1]) / w;
  const double e2 =
      (of_n[2] + 2.0 * of_w[1] * s.d[1] + 2.0 * s.b[1] * e1 + of_w[2] * s.d[0] + s.b[2] * e0 + of_w[0] * s.d[2]) / w +
      more * (s.a[2] + 2.0 * s.b[1] * s.d[1] + s.b[2] * s.d[0] + s.b[0] * s.d[2]) / w;
  span->error[0] = e0, span->error[1] = e1, span->error[2] = e2;
}

/* The de Boor points over the 2n knots u become Bézier points on [u[n-1], u[n]]. */
static void blossom(homogeneous *points, const double *u, size_t n) {
  const double lo = u[n - 1], hi = u[n];
  dd left, right;
  for (int r = 0; r < ROWS; r++) {
    dd row[MOST], high[MOST];
    for (size_t i = 0; i <= n; i++) row[i] = points->row[r][i];
    for (size_t given = 0;; given++) {
      for (size_t i = 0; i + given <= n; i++) high[i] = row[i];
      for (size_t l = given + 1; l <= n; l++) {
        for (size_t i = 0; i + l <= n; i++) {
          weigh(u[i + l - 1], hi, u[i + n], &left, &right);
          high[i] = combine(left, high[i], right, high[i + 1]);
        }
      }
      points->row[r][n - given] = high[0];
      if (given == n) break;
      for (size_t i = 0; i + given < n; i++) {
        weigh(u[i + given], lo, u[i + n], &left, &right);
        row[i] = combine(left, row[i], right, row[i + 1]);
      }
    }
  }
}

/* Degree 1 as degree 2. */
static void raise_line(homogeneous *points) {
  for (int r = 0; r < ROWS; r++) {
    points->row[r][2] = points->row[r][1];
    points->row[r][1] = dd_scale(dd_add(points->row[r][0], points->row[r][2]), 0.5);
  }
}

/* Appends the part of a span that lies inside [t0, t1]; knots: 2 degree of them, NULL for a Bézier curve over [from,
 * to]. `unit` scales the weights. */
static cprox_status append_span(compile *c, const vec3 *points, const double *weights, double unit, size_t degree,
                                const double *knots, double from, double to, double t0, double t1) {
  if (!(to - from >= SPAN_LEAST && to - from <= SPAN_MOST))
    return workspace_fail(c->workspace, CPROX_INVALID, "the span [%.15g, %.15g] is not between %g and %g long", from,
                          to, SPAN_LEAST, SPAN_MOST);
  rational_span span = {.from = from, .to = to, .degree = degree, .least_weight = INFINITY};
  const vec3 origin = points[degree / 2];
  double size = 0.0;
  for (size_t i = 0; i <= degree; i++) {
    const double w = weights[i] * unit;
    for (int k = 0; k < 3; k++)
      span.bezier.row[k][i] = dd_scale(dd_sum(convert_coordinate(points[i], k), -convert_coordinate(origin, k)), w);
    span.bezier.row[3][i] = dd_from(w);
    span.least_weight = fmin(span.least_weight, w);
    size = fmax(size, vec_norm(vec_sub(points[i], origin)));
  }
  span.least_weight /= ROUND_UP;
  if (knots) blossom(&span.bezier, knots, degree);
  if (degree == 1) {
    raise_line(&span.bezier);
    span.degree = 2;
  }
  fill_derivatives(&span);
  fill_errors(&span);
  const compile_source source = {.self = &span,
                                 .evaluate = evaluate,
                                 .sixth = sixth,
                                 .constant = origin,
                                 .accuracy = COMPILE_ACCURACY * size + ROUND_U * vec_norm(origin)};
  return compile_append(c, &source, fmax(from, t0), fmin(to, t1));
}

/* ---- constructors ---- */

/* *unit: the power of two that brings the largest weight into [1/2, 1). */
static cprox_status check_weights(const double *weights, size_t n, double *unit, cprox_workspace *workspace) {
  if (!weights) return workspace_fail(workspace, CPROX_INVALID, "the weights are NULL");
  double least = INFINITY, most = 0.0;
  for (size_t i = 0; i < n; i++) {
    if (!(weights[i] >= 1e-100 && weights[i] <= 1e100))
      return workspace_fail(workspace, CPROX_INVALID, "weight %zu is %g; it must be positive, between 1e-100 and 1e100",
                            i, weights[i]);
    least = fmin(least, weights[i]);
    most = fmax(most, weights[i]);
  }
  if (most > WEIGHTS_MOST * least)
    return workspace_fail(workspace, CPROX_INVALID, "weights from %g to %g differ by a factor of more than %g", least,
                          most, WEIGHTS_MOST);
  int exponent;
  frexp(most, &exponent);
  *unit = ldexp(1.0, -exponent);
  return CPROX_OK;
}

cprox_status curve_create_rational_bezier(const cprox_curve_description *d, cprox_workspace *workspace,
                                          cprox_curve **curve) {
  double unit = 1.0;
  if (d->n > MOST)
    return workspace_fail(workspace, CPROX_INVALID,
                          "a rational Bézier curve has at most %d control points (degree %d), got %zu", MOST,
                          CPROX_MAX_DEGREE, d->n);
  cprox_status status = curve_check_points(d->points, d->n, workspace);
  if (status == CPROX_OK) status = check_weights(d->weights, d->n, &unit, workspace);
  if (status == CPROX_OK) status = curve_check_range(d->t0, d->t1, workspace);
  if (status != CPROX_OK) return status;
  compile c = {.workspace = workspace};
  status = append_span(&c, d->points, d->weights, unit, d->n - 1, NULL, d->t0, d->t1, d->t0, d->t1);
  return status == CPROX_OK ? compile_finish(&c, curve) : status;
}

cprox_status curve_create_nurbs(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  double unit = 1.0;
  cprox_status status = curve_check_spline(d, workspace);
  if (status == CPROX_OK) status = check_weights(d->weights, d->n, &unit, workspace);
  if (status != CPROX_OK) return status;
  compile c = {.workspace = workspace};
  const size_t degree = d->degree;
  for (size_t r = degree; r < d->n && status == CPROX_OK; r++) {
    const double from = d->knots[r], to = d->knots[r + 1];
    if (!(from < to && from < d->t1 && to > d->t0)) continue;
    status = append_span(&c, d->points + (r - degree), d->weights + (r - degree), unit, degree,
                         d->knots + (r - degree + 1), from, to, d->t0, d->t1);
  }
  return status == CPROX_OK ? compile_finish(&c, curve) : status;
}
