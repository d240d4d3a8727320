/* SPDX-License-Identifier: BSD-3-Clause */
#include "pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- polynomials: Bézier points are values of the blossom f, b_j = f(lo, …, lo, hi, …, hi) with hi j times ---- */

/* A polynomial of one coordinate whose arguments are given away one by one: a spline's span over its 2p knots, or sum
 * c_k x^k with d_k = c_k / C(p, k). */
typedef struct blossom {
  size_t p;
  const double *knots; /* NULL: powers */
} blossom;

/* Gives x away as argument l = 1 … p; of d, p + 1 - l numbers are left. */
static void give(const blossom *b, iv *d, size_t l, const iv *x) {
  iv *w = iv_new(3);
  for (size_t i = 0; i + l <= b->p; i++) {
    if (!b->knots) { /* d_k <- d_k + x d_(k+1) */
      iv_mul(&w[0], x, &d[i + 1]);
      iv_add(&d[i], &d[i], &w[0]);
      continue;
    }
    iv_set_d(&w[0], b->knots[i + l - 1]);
    iv_set_d(&w[1], b->knots[i + b->p]);
    iv_sub(&w[1], &w[1], &w[0]);
    iv_sub(&w[2], x, &w[0]);
    iv_div(&w[2], &w[2], &w[1]);
    iv_blend(&d[i], &d[i + 1], &w[2]);
  }
  iv_free(w, 3);
}

/* out[j * stride] = f(lo p - j times, hi j times) for all j; d is spoilt. */
static void blossom_all(const blossom *b, iv *d, const iv *lo, const iv *hi, iv *out, size_t stride) {
  iv *rest = iv_new(b->p + 1);
  for (size_t j = b->p + 1; j-- > 0;) { /* lo has been given p - j times */
    for (size_t i = 0; i <= j; i++) iv_set(&rest[i], &d[i]);
    for (size_t l = b->p - j + 1; l <= b->p; l++) give(b, rest, l, hi);
    iv_set(&out[j * stride], &rest[0]);
    if (j > 0) give(b, d, b->p - j + 1, lo);
  }
  iv_free(rest, b->p + 1);
}

/* x = (a t + b) / (t1 - t0): from t0 … t1 to -1 … 1 for a Legendre series, to 0 … 1 for Lagrange's nodes and Bézier's
 * parameter. */
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

/* Where a piece is cut from: a span of a spline, the whole of another polynomial. */
typedef struct source {
  size_t span;
  double from, to;
} source;

static source source_of(const curve *c, size_t span) {
  if (c->basis != BSPLINE) return (source){c->degree, c->t0, c->t1};
  return (source){span, c->knots[span], c->knots[span + 1]};
}

/* One coordinate of a source, ready to be given arguments. */
static void coefficients(const curve *c, const source *s, int k, iv *d) {
  const bool spline = c->basis == BSPLINE || c->basis == BEZIER;
  for (size_t i = 0; i <= c->degree && spline; i++) iv_set_d(&d[i], c->points[s->span - c->degree + i][k]);
  if (!spline) power_of(d, c, k);
}

/* Its argument at t: a spline's and a polynomial's own parameter, else that of the basis. */
static void argument(iv *x, const curve *c, double t) {
  if (c->basis == BSPLINE || c->basis == POLYNOMIAL)
    iv_set_d(x, t);
  else
    normal_parameter(x, c, t);
}

enum { MOST_KNOTS = 120 };

static blossom blossom_of(const curve *c, const source *s, double knots[MOST_KNOTS]) {
  const size_t p = c->degree;
  for (size_t i = 0; i < p; i++)
    knots[i] = 0.0, knots[p + i] = 1.0; /* a Bézier curve is a span whose knots are 0 and 1 */
  if (c->basis == BSPLINE) memcpy(knots, c->knots + (s->span - p + 1), 2 * p * sizeof *knots);
  return (blossom){p, c->basis == BSPLINE || c->basis == BEZIER ? knots : NULL};
}

/* The Bézier points of a source, three numbers each. */
static void source_points(const curve *c, const source *s, iv *points) {
  const size_t p = c->degree;
  double knots[MOST_KNOTS];
  const blossom b = blossom_of(c, s, knots);
  iv *x = iv_new(2), *d = iv_new(p + 1);
  argument(&x[0], c, s->from);
  argument(&x[1], c, s->to);
  for (int k = 0; k < 3; k++) {
    coefficients(c, s, k, d);
    for (size_t j = 0; j <= p && c->basis == BEZIER; j++) iv_set(&points[3 * j + (size_t)k], &d[j]);
    if (c->basis != BEZIER) blossom_all(&b, d, &x[0], &x[1], points + k, 3);
  }
  iv_free(x, 2);
  iv_free(d, p + 1);
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

/* s = (t - from) / (to - from) */
static void fraction(iv *s, double t, double from, double to) {
  iv *w = iv_new(2);
  iv_set_d(&w[0], from);
  iv_set_d(&w[1], to);
  iv_sub(&w[1], &w[1], &w[0]);
  iv_set_d(s, t);
  iv_sub(s, s, &w[0]);
  iv_div(s, s, &w[1]);
  iv_free(w, 2);
}

/* The part [lo, hi] of a source. */
static void polynomial_piece(const iv *whole, size_t p, const source *s, double lo, double hi, iv *points) {
  iv *a = iv_new(p + 1), *at = iv_new(1);
  for (size_t k = 0; k < 3; k++) {
    for (size_t j = 0; j <= p; j++) iv_set(&a[j], &whole[3 * j + k]);
    if (hi != s->to) {
      fraction(at, hi, s->from, s->to);
      cut(a, p, at, true);
    }
    if (lo != s->from) {
      fraction(at, lo, s->from, hi);
      cut(a, p, at, false);
    }
    for (size_t j = 0; j <= p; j++) iv_set(&points[3 * j + k], &a[j]);
  }
  iv_free(a, p + 1);
  iv_free(at, 1);
}

static const char *polynomial_point(const curve *c, double t, bool left, iv point[3]) {
  const size_t span = c->basis == BSPLINE ? span_of(c, t, t, left) : c->degree;
  if (span == 0 && c->degree > 0) return "a knot of the spline lies inside a piece";
  const source s = source_of(c, span);
  double knots[MOST_KNOTS];
  const blossom b = blossom_of(c, &s, knots);
  iv *x = iv_new(1), *d = iv_new(c->degree + 1);
  argument(x, c, t);
  for (int k = 0; k < 3; k++) {
    coefficients(c, &s, k, d);
    for (size_t l = 1; l <= c->degree; l++) give(&b, d, l, x);
    iv_set(&point[k], &d[0]);
  }
  iv_free(x, 1);
  iv_free(d, c->degree + 1);
  return NULL;
}

/* ---- trigonometric series: quintic Hermite pieces, remainder K6 h^6 / 46080 ---- */

/* (c, s) of an angle becomes that of the sum with another: c c1 - s s1, s c1 + c s1. */
static void turn_on(iv *angle, const iv *by) {
  iv *w = iv_new(4);
  iv_mul(&w[0], &angle[0], &by[0]);
  iv_mul(&w[1], &angle[1], &by[1]);
  iv_mul(&w[2], &angle[1], &by[0]);
  iv_mul(&w[3], &angle[0], &by[1]);
  iv_sub(&angle[0], &w[0], &w[1]);
  iv_add(&angle[1], &w[2], &w[3]);
  iv_free(w, 4);
}

/* Value, first and second derivative at t, three numbers each. */
static void series_jet(iv jet[9], const curve *c, double t) {
  iv *w = iv_new(6), *angle = w, *once = w + 2;
  for (size_t i = 0; i < 9; i++) iv_set_d(&jet[i], i < 3 ? c->points[0][i] : 0.0);
  iv_set_d(&w[4], t);
  iv_turn(&once[0], &once[1], &w[4]);
  iv_set_d(&angle[0], 1.0);
  for (size_t m = 1; m <= c->degree; m++) {
    const double f = (double)m;
    turn_on(angle, once);
    for (size_t k = 0; k < 3; k++) {
      const double a = c->points[2 * m - 1][k], b = c->points[2 * m][k];
      for (int order = 0; order < 3; order++) { /* a cos + b sin, m (b cos - a sin), -m² (a cos + b sin) */
        iv_mul_d(&w[4], &angle[0], order == 1 ? b : a);
        iv_mul_d(&w[5], &angle[1], order == 1 ? -a : b);
        iv_add(&w[4], &w[4], &w[5]);
        if (order > 0) iv_mul_d(&w[4], &w[4], order == 1 ? f : -f * f);
        iv_add(&jet[3 * (size_t)order + k], &jet[3 * (size_t)order + k], &w[4]);
      }
    }
  }
  iv_free(w, 6);
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

/* From the jets at both ends. */
static void series_piece(double lo, double hi, const iv *at_lo, const iv *at_hi, const iv *sixth, iv *points,
                         iv *remainder) {
  iv *h = iv_new(4), *w = iv_new(1);
  iv_set_d(&h[0], lo);
  iv_set_d(&h[1], hi);
  iv_sub(&h[0], &h[1], &h[0]);
  iv_set_d(w, 5.0);
  iv_div(&h[1], &h[0], w); /* h/5 */
  iv_mul(&h[2], &h[0], &h[0]);
  iv_set_d(w, 20.0);
  iv_div(&h[3], &h[2], w); /* h²/20 */
  for (size_t j = 0; j < 6; j++) {
    /* from its own end: p, p ± h/5 p', p ± 2h/5 p' + h²/20 p'' */
    const iv *at = j < 3 ? at_lo : at_hi;
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
  iv_mul(&h[0], &h[2], &h[2]);
  iv_mul(&h[0], &h[0], &h[2]);
  iv_mul(remainder, sixth, &h[0]);
  iv_set_d(w, 46080.0);
  iv_div(remainder, remainder, w);
  iv_free(h, 4);
  iv_free(w, 1);
}

/* ---- any basis ---- */

/* Which source a piece is cut from; the pieces are asked about in order. NULL, or why it is cut from none. */
static const char *find_source(pieces *p, size_t i) {
  const curve *c = p->curve;
  if (c->basis != BSPLINE) return NULL;
  size_t r = i == 0 ? c->degree : p->span[i - 1];
  while (r + 1 < c->n && !(p->breaks[i] < c->knots[r + 1])) r++;
  p->span[i] = r;
  const bool inside = c->knots[r] <= p->breaks[i] && p->breaks[i + 1] <= c->knots[r + 1];
  return inside ? NULL : "a knot of the spline lies inside a piece";
}

const char *pieces_make(pieces *p, const curve *c, const double *breaks, size_t n) {
  const size_t degree = c->basis == TRIGONOMETRIC ? 5 : c->degree;
  *p = (pieces){.curve = c, .degree = degree, .n = n, .n_sources = c->basis == BSPLINE ? c->n : 1, .breaks = breaks};
  p->span = calloc(n, sizeof *p->span);
  for (int level = 0; level < PIECES_LEVELS; level++) {
    p->at[level].piece = calloc(n, sizeof(iv *));
    p->at[level].jet = calloc(n + 1, sizeof(iv *));
    p->at[level].source = calloc(p->n_sources, sizeof(iv *));
    if (!p->at[level].piece || !p->at[level].jet || !p->at[level].source) return "memory is out";
  }
  p->quick = calloc(n, sizeof *p->quick);
  if (!p->span || !p->quick) return "memory is out";
  if (breaks[0] != c->t0 || breaks[n] != c->t1) return "the pieces do not cover the curve";
  for (size_t i = 0; i < n; i++) {
    if (!(breaks[i] < breaks[i + 1])) return "the pieces do not follow each other";
    const char *fault = find_source(p, i);
    if (fault) return fault;
  }
  return NULL;
}

const char *pieces_point(iv point[3], iv *remainder, const curve *c, double t, bool left) {
  iv_set_d(remainder, 0.0);
  if (c->basis != TRIGONOMETRIC) return polynomial_point(c, t, left, point);
  iv *jet = iv_new(9);
  series_jet(jet, c, t);
  for (int k = 0; k < 3; k++) iv_set(&point[k], &jet[k]);
  iv_free(jet, 9);
  return NULL;
}

static size_t numbers_of(const pieces *p) {
  return 3 * (p->degree + 1);
}

static void free_rows(iv **rows, size_t n, size_t numbers) {
  for (size_t i = 0; rows && i < n; i++)
    if (rows[i]) iv_free(rows[i], numbers);
  free(rows);
}

void pieces_free(pieces *p) {
  for (int level = 0; level < PIECES_LEVELS; level++) {
    pieces_level *l = &p->at[level];
    free_rows(l->piece, p->n, numbers_of(p) + 1);
    free_rows(l->jet, p->n + 1, 9);
    free_rows(l->source, p->n_sources, numbers_of(p));
    if (l->sixth) iv_free(l->sixth, 1);
  }
  for (size_t i = 0; p->quick && i < p->n; i++) free(p->quick[i].points);
  free(p->quick);
  free(p->span);
  *p = (pieces){0};
}

static const iv *jet_at(const pieces *p, pieces_level *l, size_t i) {
  if (!l->jet[i]) {
    l->jet[i] = iv_new(9);
    series_jet(l->jet[i], p->curve, p->breaks[i]);
  }
  return l->jet[i];
}

/* The points of piece i and behind them its remainder: made when they are first needed. */
static const iv *piece_at(const pieces *p, pieces_level *l, size_t i) {
  if (l->piece[i]) return l->piece[i];
  const curve *c = p->curve;
  const double lo = p->breaks[i], hi = p->breaks[i + 1];
  iv *made = iv_new(numbers_of(p) + 1);
  if (c->basis == TRIGONOMETRIC) {
    if (!l->sixth) {
      l->sixth = iv_new(1);
      series_sixth(l->sixth, c);
    }
    series_piece(lo, hi, jet_at(p, l, i), jet_at(p, l, i + 1), l->sixth, made, made + numbers_of(p));
  } else {
    const source s = source_of(c, p->span[i]);
    iv **whole = &l->source[c->basis == BSPLINE ? s.span : 0];
    if (!*whole) {
      *whole = iv_new(numbers_of(p));
      source_points(c, &s, *whole);
    }
    polynomial_piece(*whole, p->degree, &s, lo, hi, made);
  }
  l->piece[i] = made;
  return made;
}

/* The middle of an interval, and at least how far its ends are from it. */
static double middle_of(const iv *a, double *off) {
  const double lo = mpfr_get_d(a->lo, MPFR_RNDD), hi = mpfr_get_d(a->hi, MPFR_RNDU), m = 0.5 * lo + 0.5 * hi;
  *off = fmax(hi - m, m - lo) * (1.0 + 0x1p-50) + 0x1p-1000;
  return m;
}

const pieces_quick *pieces_quick_at(pieces *p, size_t i) {
  pieces_quick *q = &p->quick[i];
  if (q->points) return q;
  q->points = calloc(p->degree + 1, sizeof *q->points);
  if (!q->points) return NULL;
  if (p->curve->basis == BEZIER && p->n == 1) { /* as it is given */
    memcpy(q->points, p->curve->points, (p->degree + 1) * sizeof *q->points);
    return q;
  }
  const iv *piece = piece_at(p, &p->at[0], i);
  double most = 0.0;
  for (size_t j = 0; j <= p->degree; j++) {
    double off[3];
    for (size_t k = 0; k < 3; k++) q->points[j][k] = middle_of(&piece[3 * j + k], &off[k]);
    const double sum = off[0] + off[1] + off[2];
    if (!(sum <= most)) most = isfinite(sum) ? sum : INFINITY;
  }
  q->radius = most * (1.0 + 0x1p-50);
  q->remainder = mpfr_get_d(piece[numbers_of(p)].hi, MPFR_RNDU);
  return q;
}

/* Bernstein numbers of one degree more: b_j = j/m b_(j-1) + (1 - j/m) b_j. */
static void raise_degree(iv *b, size_t degree) {
  const size_t m = degree + 1;
  iv *w = iv_new(2);
  iv_set(&b[m], &b[degree]);
  iv_set_d(&w[1], (double)m);
  for (size_t j = degree; j > 0; j--) {
    iv_mul_d(&w[0], &b[j - 1], (double)j);
    iv_mul_d(&b[j], &b[j], (double)(m - j));
    iv_add(&b[j], &b[j], &w[0]);
    iv_div(&b[j], &b[j], &w[1]);
  }
  iv_free(w, 2);
}

/* The Bernstein numbers of the sum over piece i, less the remainders. */
static void add_shares(iv *a, const pieces_share *shares, size_t n_shares, const iv *lengths, int level, size_t i,
                       size_t degree) {
  iv *b = iv_new(degree + 1), *moved = iv_new(1);
  for (size_t k = 0; k < n_shares; k++) {
    pieces *p = shares[k].of;
    const iv *piece = piece_at(p, &p->at[level], i);
    for (size_t j = 0; j <= p->degree; j++) iv_dot(&b[j], shares[k].n, piece + 3 * j);
    for (size_t d = p->degree; d < degree; d++) raise_degree(b, d);
    iv_mul(moved, &lengths[k], &piece[numbers_of(p)]);
    for (size_t j = 0; j <= degree; j++) {
      iv_sub(&b[j], &b[j], moved);
      if (k == 0)
        iv_set(&a[j], &b[j]);
      else
        iv_add(&a[j], &a[j], &b[j]);
    }
  }
  iv_free(b, degree + 1);
  iv_free(moved, 1);
}

void pieces_least(iv *out, const pieces_share *shares, size_t n_shares, int level, double from, double to) {
  size_t degree = 0;
  for (size_t k = 0; k < n_shares; k++) degree = shares[k].of->degree > degree ? shares[k].of->degree : degree;
  iv *a = iv_new(degree + 1), *s = iv_new(3), *lengths = iv_new(n_shares);
  for (size_t k = 0; k < n_shares; k++) iv_norm(&lengths[k], shares[k].n);
  bool first = true;
  for (size_t i = (size_t)floor(from); i < (size_t)ceil(to) && i < shares[0].of->n; i++) {
    const double k = (double)i, s0 = fmax(from - k, 0.0), s1 = fmin(to - k, 1.0);
    add_shares(a, shares, n_shares, lengths, level, i, degree);
    iv_set_d(&s[0], s0);
    if (s0 > 0.0) cut(a, degree, &s[0], false);
    if (s1 < 1.0) { /* (s1 - s0) / (1 - s0) of what is left */
      iv_set_d(&s[1], s1);
      iv_set_d(&s[2], 1.0);
      iv_sub(&s[1], &s[1], &s[0]);
      iv_sub(&s[2], &s[2], &s[0]);
      iv_div(&s[1], &s[1], &s[2]);
      cut(a, degree, &s[1], true);
    }
    for (size_t j = 0; j <= degree; j++) {
      if (first) iv_set(out, &a[j]);
      iv_min(out, out, &a[j]);
      first = false;
    }
  }
  iv_free(a, degree + 1);
  iv_free(s, 3);
  iv_free(lengths, n_shares);
}
