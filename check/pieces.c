/* SPDX-License-Identifier: BSD-3-Clause */
#include "pieces.h"

#include <math.h>
#include <string.h>

/* ---- polynomials: Bézier points are values of the blossom f, b_j = f(lo, …, lo, hi, …, hi) with hi j times ---------------- */

/* The blossom of a spline's span over its 2p knots, of one coordinate; d is spoilt. Argument i is lo for i < p - j, else hi. */
static void spline_blossom(iv *out, iv *d, size_t p, const double *knots, const iv *lo, const iv *hi, size_t j) {
  iv *w = iv_new(3);
  for (size_t l = 1; l <= p; l++) {
    const iv *x = l <= p - j ? lo : hi;
    for (size_t i = 0; i + l <= p; i++) {
      iv_set_d(&w[0], knots[i + l - 1]);
      iv_set_d(&w[1], knots[i + p]);
      iv_sub(&w[1], &w[1], &w[0]);
      iv_sub(&w[2], x, &w[0]);
      iv_div(&w[2], &w[2], &w[1]);
      iv_blend(&d[i], &d[i + 1], &w[2]);
    }
  }
  iv_set(out, &d[0]);
  iv_free(w, 3);
}

/* The same of sum c_k x^k, d_k = c_k / C(p, k): giving x away is d_k <- d_k + x d_(k+1). */
static void power_blossom(iv *out, iv *d, size_t p, const iv *lo, const iv *hi, size_t j) {
  iv *step = iv_new(1);
  for (size_t l = 1; l <= p; l++) {
    for (size_t k = 0; k + l <= p; k++) {
      iv_mul(step, l <= p - j ? lo : hi, &d[k + 1]);
      iv_add(&d[k], &d[k], step);
    }
  }
  iv_set(out, &d[0]);
  iv_free(step, 1);
}

/* x = (a t + b) / (t1 - t0): from t0 … t1 to -1 … 1 for a Legendre series, to 0 … 1 for Lagrange's nodes and Bézier's parameter. */
static void normal_parameter(iv *x, const curve *c, double t) {
  iv *w = iv_new(3);
  iv_set_d(&w[0], c->t0);
  iv_set_d(&w[1], c->t1);
  iv_set_d(x, t);
  iv_sub(x, x, &w[0]);
  if (c->basis == LEGENDRE) {
    iv_set_d(&w[2], t);
    iv_sub(&w[2], &w[2], &w[1]);
    iv_add(x, x, &w[2]);
  }
  iv_sub(&w[1], &w[1], &w[0]);
  iv_div(x, x, &w[1]);
  iv_free(w, 3);
}

/* Multiplies the polynomial q of degree k by (x - r). */
static void times_linear(iv *q, size_t k, const iv *r) {
  iv *w = iv_new(1);
  for (size_t i = k + 2; i-- > 0;) {
    iv_set_d(w, 0.0);
    if (i <= k) iv_mul(w, r, &q[i]);
    iv_neg(w, w);
    if (i > 0) iv_add(w, w, &q[i - 1]);
    iv_set(&q[i], w);
  }
  iv_free(w, 1);
}

/* Adds a q to the polynomial c. */
static void add_multiple(iv *c, const iv *q, size_t n, const iv *a) {
  iv *w = iv_new(1);
  for (size_t i = 0; i < n; i++) {
    iv_mul(w, a, &q[i]);
    iv_add(&c[i], &c[i], w);
  }
  iv_free(w, 1);
}

/* (k + 1) P_(k+1) = (2k + 1) x P_k - k P_(k-1) */
static void legendre_to_power(iv *c, const curve *at, int k) {
  const size_t n = at->n;
  iv *q = iv_new(3 * (n + 1)), *a = iv_new(2);
  iv *before = q, *now = q + n + 1, *next = q + 2 * (n + 1);
  iv_set_d(&now[0], 1.0);
  for (size_t i = 0; i < n; i++) {
    iv_set_d(&a[0], at->points[i][k]);
    add_multiple(c, now, n, &a[0]);
    iv_set_d(&a[1], (double)(i + 1));
    for (size_t m = 0; m <= n; m++) {
      if (m > 0) iv_mul_d(&next[m], &now[m - 1], (double)(2 * i + 1));
      iv_mul_d(&a[0], &before[m], (double)i);
      iv_sub(&next[m], &next[m], &a[0]);
      iv_div(&next[m], &next[m], &a[1]);
    }
    iv *free_row = before;
    before = now, now = next, next = free_row;
    for (size_t m = 0; m <= n; m++) iv_set_d(&next[m], 0.0);
  }
  iv_free(q, 3 * (n + 1));
  iv_free(a, 2);
}

/* Newton's divided differences, and his form multiplied out. */
static void lagrange_to_power(iv *c, const curve *at, int k) {
  const size_t n = at->n;
  iv *x = iv_new(n), *f = iv_new(n), *q = iv_new(n + 1), *w = iv_new(1);
  for (size_t i = 0; i < n; i++) {
    normal_parameter(&x[i], at, at->knots[i]);
    iv_set_d(&f[i], at->points[i][k]);
  }
  for (size_t order = 1; order < n; order++) {
    for (size_t i = n - 1; i >= order; i--) {
      iv_sub(&f[i], &f[i], &f[i - 1]);
      iv_sub(w, &x[i], &x[i - order]);
      iv_div(&f[i], &f[i], w);
    }
  }
  iv_set_d(&q[0], 1.0);
  for (size_t i = 0; i < n; i++) {
    add_multiple(c, q, i + 1, &f[i]);
    times_linear(q, i, &x[i]);
  }
  iv_free(x, n);
  iv_free(f, n);
  iv_free(q, n + 1);
  iv_free(w, 1);
}

static void power_of(iv *d, const curve *c, int k) {
  iv *w = iv_new(1);
  for (size_t i = 0; i < c->n; i++) iv_set_d(&d[i], c->basis == POLYNOMIAL ? c->points[i][k] : 0.0);
  if (c->basis == LEGENDRE) legendre_to_power(d, c, k);
  if (c->basis == LAGRANGE) lagrange_to_power(d, c, k);
  iv_set_d(w, 1.0); /* C(p, i) */
  for (size_t i = 0; i < c->n; i++) {
    iv_div(&d[i], &d[i], w);
    iv_mul_d(w, w, (double)(c->degree - i));
    iv *divisor = iv_new(1);
    iv_set_d(divisor, (double)(i + 1));
    iv_div(w, w, divisor);
    iv_free(divisor, 1);
  }
  iv_free(w, 1);
}

/* The first or the last span of a spline that holds [lo, hi], or 0. */
static size_t span_of(const curve *c, double lo, double hi, bool first) {
  size_t found = 0;
  for (size_t r = c->degree; r < c->n; r++)
    if (c->knots[r] <= lo && hi <= c->knots[r + 1] && c->knots[r] < c->knots[r + 1] && !(first && found)) found = r;
  return found;
}

static const char *polynomial_piece(const curve *c, double lo, double hi, bool left, iv *points) {
  const size_t p = c->degree, span = c->basis == BSPLINE ? span_of(c, lo, hi, left) : p;
  if (span == 0 && p > 0) return "a knot of the spline lies inside a piece";
  double knots[120] = {0.0}; /* a Bézier curve is a span whose knots are 0 and 1 */
  for (size_t i = 0; i < p; i++) knots[p + i] = 1.0;
  if (c->basis == BSPLINE) memcpy(knots, c->knots + (span - p + 1), 2 * p * sizeof *knots);
  const bool direct = c->basis == BSPLINE || c->basis == POLYNOMIAL;
  iv *x = iv_new(2), *d = iv_new(p + 1), *spoilt = iv_new(p + 1);
  iv_set_d(&x[0], lo);
  iv_set_d(&x[1], hi);
  if (!direct) {
    normal_parameter(&x[0], c, lo);
    normal_parameter(&x[1], c, hi);
  }
  const bool spline = c->basis == BSPLINE || c->basis == BEZIER;
  const bool whole = c->basis == BEZIER && lo == c->t0 && hi == c->t1;
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i <= p && spline; i++) iv_set_d(&d[i], c->points[span - p + i][k]);
    if (!spline) power_of(d, c, k);
    for (size_t j = 0; j <= p; j++) {
      iv *out = &points[3 * j + (size_t)k];
      for (size_t i = 0; i <= p; i++) iv_set(&spoilt[i], &d[i]);
      if (whole)
        iv_set(out, &d[j]);
      else if (spline)
        spline_blossom(out, spoilt, p, knots, &x[0], &x[1], j);
      else
        power_blossom(out, spoilt, p, &x[0], &x[1], j);
    }
  }
  iv_free(x, 2);
  iv_free(d, p + 1);
  iv_free(spoilt, p + 1);
  return NULL;
}

/* ---- trigonometric series: quintic Hermite pieces, remainder K6 h^6 / 46080 ------------------------------------------------ */

/* Value, first and second derivative at t, three numbers each. */
static void series_jet(iv jet[9], const curve *c, double t) {
  iv *w = iv_new(5);
  for (size_t i = 0; i < 9; i++) iv_set_d(&jet[i], i < 3 ? c->points[0][i] : 0.0);
  for (size_t m = 1; m <= c->degree; m++) {
    const double f = (double)m;
    iv_set_d(&w[0], t);
    iv_mul_d(&w[0], &w[0], f);
    iv_cos(&w[1], &w[0]);
    iv_sin(&w[2], &w[0]);
    for (size_t k = 0; k < 3; k++) {
      const double a = c->points[2 * m - 1][k], b = c->points[2 * m][k];
      for (int order = 0; order < 3; order++) { /* a cos + b sin, m (b cos - a sin), -m² (a cos + b sin) */
        iv_mul_d(&w[3], &w[1], order == 1 ? b : a);
        iv_mul_d(&w[4], &w[2], order == 1 ? -a : b);
        iv_add(&w[3], &w[3], &w[4]);
        if (order > 0) iv_mul_d(&w[3], &w[3], order == 1 ? f : -f * f);
        iv_add(&jet[3 * (size_t)order + k], &jet[3 * (size_t)order + k], &w[3]);
      }
    }
  }
  iv_free(w, 5);
}

/* K6 = sum m^6 A_m with the semi-major axes A_m of the ellipses a cos + b sin. */
static void series_sixth(iv *sum, const curve *c) {
  iv *v = iv_new(6), *w = iv_new(4);
  for (size_t m = 1; m <= c->degree; m++) {
    for (size_t k = 0; k < 3; k++) {
      iv_set_d(&v[k], c->points[2 * m - 1][k]);
      iv_set_d(&v[3 + k], c->points[2 * m][k]);
    }
    iv_dot(&w[0], v, v);
    iv_dot(&w[1], v + 3, v + 3);
    iv_dot(&w[2], v, v + 3);
    iv_sub(&w[3], &w[0], &w[1]);
    iv_mul(&w[3], &w[3], &w[3]);
    iv_mul(&w[2], &w[2], &w[2]);
    iv_mul_d(&w[2], &w[2], 4.0);
    iv_add(&w[3], &w[3], &w[2]);
    iv_sqrt(&w[3], &w[3]);
    iv_add(&w[3], &w[3], &w[0]);
    iv_add(&w[3], &w[3], &w[1]);
    iv_mul_d(&w[3], &w[3], 0.5);
    iv_sqrt(&w[3], &w[3]);
    const double f = (double)m;
    iv_mul_d(&w[3], &w[3], f * f * f * f * f * f);
    iv_add(sum, sum, &w[3]);
  }
  iv_free(v, 6);
  iv_free(w, 4);
}

static void series_piece(const curve *c, double lo, double hi, iv *points, iv *remainder) {
  iv *jet = iv_new(18), *h = iv_new(4), *w = iv_new(1);
  iv_set_d(&h[0], lo);
  iv_set_d(&h[1], hi);
  iv_sub(&h[0], &h[1], &h[0]);
  iv_set_d(w, 5.0);
  iv_div(&h[1], &h[0], w); /* h/5 */
  iv_mul(&h[2], &h[0], &h[0]);
  iv_set_d(w, 20.0);
  iv_div(&h[3], &h[2], w); /* h²/20 */
  series_jet(jet, c, lo);
  series_jet(jet + 9, c, hi);
  for (size_t j = 0; j < 6; j++) {
    /* from its own end: p, p ± h/5 p', p ± 2h/5 p' + h²/20 p'' */
    const iv *at = j < 3 ? jet : jet + 9;
    const double steps = j < 3 ? (double)j : (double)j - 5.0;
    for (size_t k = 0; k < 3; k++) {
      iv *out = &points[3 * j + k];
      iv_mul(w, &h[1], &at[3 + k]);
      iv_mul_d(w, w, steps);
      iv_add(out, &at[k], w);
      iv_mul(w, &h[3], &at[6 + k]);
      if (fabs(steps) == 2.0) iv_add(out, out, w);
    }
  }
  series_sixth(remainder, c);
  iv_mul(&h[0], &h[2], &h[2]);
  iv_mul(&h[0], &h[0], &h[2]);
  iv_mul(remainder, remainder, &h[0]);
  iv_set_d(w, 46080.0);
  iv_div(remainder, remainder, w);
  iv_free(jet, 18);
  iv_free(h, 4);
  iv_free(w, 1);
}

/* ---- any basis --------------------------------------------------------------------------------------------------------------- */

const char *pieces_make(pieces *p, const curve *c, const double *breaks, size_t n) {
  const size_t degree = c->basis == TRIGONOMETRIC ? 5 : c->degree, stride = 3 * (degree + 1);
  *p = (pieces){.degree = degree, .n = n, .points = iv_new(n * stride), .remainder = iv_new(n)};
  if (breaks[0] != c->t0 || breaks[n] != c->t1) return "the pieces do not cover the curve";
  for (size_t i = 0; i < n; i++) {
    if (!(breaks[i] < breaks[i + 1])) return "the pieces do not follow each other";
    if (c->basis == TRIGONOMETRIC) {
      series_piece(c, breaks[i], breaks[i + 1], p->points + i * stride, &p->remainder[i]);
      continue;
    }
    const char *fault = polynomial_piece(c, breaks[i], breaks[i + 1], true, p->points + i * stride);
    if (fault) return fault;
  }
  return NULL;
}

const char *pieces_point(iv point[3], iv *remainder, const curve *c, double t, bool left) {
  iv *points = iv_new(3 * (c->degree > 5 ? c->degree + 1 : 6));
  const char *fault = NULL;
  iv_set_d(remainder, 0.0);
  if (c->basis == TRIGONOMETRIC) {
    iv *jet = iv_new(9);
    series_jet(jet, c, t);
    for (int k = 0; k < 3; k++) iv_set(&points[k], &jet[k]);
    iv_free(jet, 9);
  } else {
    fault = polynomial_piece(c, t, t, left, points);
  }
  for (int k = 0; k < 3; k++) iv_set(&point[k], &points[k]);
  iv_free(points, 3 * (c->degree > 5 ? c->degree + 1 : 6));
  return fault;
}

void pieces_free(pieces *p) {
  iv_free(p->points, p->n * 3 * (p->degree + 1));
  iv_free(p->remainder, p->n);
}

/* de Casteljau: the ordinates of the part right of s, or left of it. */
static void cut(iv *a, size_t degree, const iv *s, bool left) {
  for (size_t level = 1; level <= degree; level++) {
    if (!left)
      for (size_t i = 0; i + level <= degree; i++) iv_blend(&a[i], &a[i + 1], s);
    else
      for (size_t i = degree; i >= level; i--) {
        iv *right = iv_new(1); /* (1 - s) a[i-1] + s a[i] */
        iv_set(right, &a[i]);
        iv_set(&a[i], &a[i - 1]);
        iv_blend(&a[i], right, s);
        iv_free(right, 1);
      }
  }
}

void pieces_least(iv *out, const pieces *p, const iv n[3], double from, double to) {
  iv *a = iv_new(p->degree + 1), *s = iv_new(3), *length = iv_new(1);
  iv_norm(length, n);
  bool first = true;
  for (size_t i = (size_t)floor(from); i < (size_t)ceil(to) && i < p->n; i++) {
    const double k = (double)i, s0 = fmax(from - k, 0.0), s1 = fmin(to - k, 1.0);
    for (size_t j = 0; j <= p->degree; j++) iv_dot(&a[j], n, p->points + 3 * (i * (p->degree + 1) + j));
    iv_set_d(&s[0], s0);
    if (s0 > 0.0) cut(a, p->degree, &s[0], false);
    if (s1 < 1.0) { /* (s1 - s0) / (1 - s0) of what is left */
      iv_set_d(&s[1], s1);
      iv_set_d(&s[2], 1.0);
      iv_sub(&s[1], &s[1], &s[0]);
      iv_sub(&s[2], &s[2], &s[0]);
      iv_div(&s[1], &s[1], &s[2]);
      cut(a, p->degree, &s[1], true);
    }
    iv_mul(&s[0], length, &p->remainder[i]);
    for (size_t j = 0; j <= p->degree; j++) {
      iv_sub(&a[j], &a[j], &s[0]);
      if (first) iv_set(out, &a[j]);
      iv_min(out, out, &a[j]);
      first = false;
    }
  }
  iv_free(a, p->degree + 1);
  iv_free(s, 3);
  iv_free(length, 1);
}
