/* SPDX-License-Identifier: BSD-3-Clause */
#include "inequalities.h"

#include <stdlib.h>

/* MULTIPLIERS: where there are quadrics x[3]; u16 m, m × {u16 row, number}. Rows count planes, quadrics, sums, terms, and
 * ascend. */
void inequalities_skip(const set *s, uint32_t width, reader *in) {
  double unused[3];
  if (s->rows.n_quadrics > 0) reader_normal(in, width, unused);
  const size_t m = (size_t)reader_bits(in, 2), size = m * (2 + width);
  if (in->bad || size > reader_left(in))
    in->bad = true;
  else
    in->at += size;
}

/* out += a b c for doubles */
static void add_product(iv *out, double a, double b, double c) {
  iv *w = iv_new(1);
  iv_set_d(w, a);
  iv_mul_d(w, w, b);
  iv_mul_d(w, w, c);
  iv_add(out, out, w);
  iv_free(w, 1);
}

/* ---- quadrics: xx, xy, xz, yy, yz, zz of Q, then b and c ---- */

/* Is Q positive semidefinite: no principal minor is negative? */
static bool is_convex(const double *q) {
  const double minors[3][3] = {{q[3], q[5], q[4]}, {q[0], q[5], q[2]}, {q[0], q[3], q[1]}};
  iv *w = iv_new(2);
  bool is_so = q[0] >= 0.0 && q[3] >= 0.0 && q[5] >= 0.0;
  for (int i = 2; i >= 0; i--) {
    iv_set_d(&w[0], 0.0);
    add_product(&w[0], minors[i][0], minors[i][1], 1.0);
    add_product(&w[0], minors[i][2], minors[i][2], -1.0);
    is_so = is_so && mpfr_number_p(w[0].lo) && mpfr_sgn(w[0].lo) >= 0;
  }
  iv_mul_d(&w[1], &w[0], q[0]); /* the determinant */
  add_product(&w[1], q[1], q[2], q[4]);
  add_product(&w[1], q[1], q[2], q[4]);
  add_product(&w[1], q[1], q[1], -q[5]);
  add_product(&w[1], q[2], q[2], -q[3]);
  is_so = is_so && mpfr_number_p(w[1].lo) && mpfr_sgn(w[1].lo) >= 0;
  iv_free(w, 2);
  return is_so;
}

/* Q x */
static void turn_by(iv out[3], const double *q, const iv x[3]) {
  const double rows[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  iv *w = iv_new(3);
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) iv_set_d(&w[k], rows[i][k]);
    iv_dot(&out[i], w, x);
  }
  iv_free(w, 3);
}

/* ---- terms ---- */

/* out = max over 0 <= u <= 1 of w u - mu u^p, from above, for w, mu >= 0. Inside it is where u^(p-1) = w/(mu p), and
 * then w u (p-1)/p. */
static void most_of_term(iv *out, double w, double mu, double p) {
  iv *v = iv_new(4);
  iv_set_d(&v[3], mu);
  iv_set_d(out, w);
  iv_sub(out, out, &v[3]); /* at 1; at 0 it is 0 */
  iv_max(out, out, &v[0]);
  if (p > 1.0 && w > 0.0 && mu > 0.0) {
    iv_set_d(&v[1], p);
    iv_set_d(&v[2], 1.0);
    iv_sub(&v[2], &v[1], &v[2]); /* p - 1 */
    iv_mul(&v[3], &v[3], &v[1]);
    iv_set_d(&v[0], w);
    iv_div(&v[0], &v[0], &v[3]);
    iv_log(&v[0], &v[0]);
    iv_div(&v[0], &v[0], &v[2]);
    iv_set_d(&v[3], 0.0);
    iv_min(&v[0], &v[0], &v[3]);
    iv_exp(&v[0], &v[0]); /* u */
    iv_mul(&v[0], &v[0], &v[2]);
    iv_div(&v[0], &v[0], &v[1]);
    iv_mul_d(&v[0], &v[0], w);
    iv_max(out, out, &v[0]);
  }
  iv_free(v, 4);
}

/* ---- MULTIPLIERS ---- */

/* What they make: n and the bound, about the centre. */
typedef struct sum {
  iv *n, *most;
  iv *x;      /* where quadrics are touched */
  double *mu; /* of sums */
} sum;

static void add_row(const sum *to, const double b[3], double c, double l) {
  for (int k = 0; k < 3; k++) add_product(&to->n[k], b[k], l, 1.0);
  add_product(to->most, c, l, -1.0);
}

/* A convex f lies above its tangent: g·z <= g·x - f(x) = x'Qx - c, g = 2Qx + b. */
static bool add_quadric(const sum *to, const double *q, double l) {
  if (!is_convex(q)) return false;
  iv *w = iv_new(4);
  turn_by(w, q, to->x);
  iv_dot(&w[3], w, to->x);
  iv_mul_d(&w[3], &w[3], l);
  iv_add(to->most, to->most, &w[3]);
  for (int k = 0; k < 3; k++) {
    iv_mul_d(&w[k], &w[k], l);
    iv_add(&to->n[k], &to->n[k], &w[k]);
    iv_add(&to->n[k], &to->n[k], &w[k]);
  }
  iv_free(w, 4);
  add_row(to, q + 6, q[9], l);
  return true;
}

/* w (a·x + d) less the share of its sum. */
static void add_term(const sum *to, const double *term, double mu, double l) {
  iv *w = iv_new(1);
  most_of_term(w, fabs(l), mu, term[4]);
  iv_add(to->most, to->most, w);
  iv_free(w, 1);
  add_row(to, term, term[3], l);
}

static bool add_multiplier(const sum *to, const inequalities *r, size_t row, double l) {
  if (row < r->n_planes + r->n_quadrics + r->n_sums && !(l >= 0.0)) return false;
  if (row < r->n_planes) {
    add_row(to, r->planes[row], r->planes[row][3], l);
    return true;
  }
  row -= r->n_planes;
  if (row < r->n_quadrics) return add_quadric(to, r->quadrics[row], l);
  row -= r->n_quadrics;
  if (row < r->n_sums) {
    add_product(to->most, l, 1.0, 1.0);
    to->mu[row] = l;
    return true;
  }
  row -= r->n_sums;
  if (row >= r->n_terms) return false;
  add_term(to, r->terms[row], to->mu[r->sum_of[row]], l);
  return true;
}

bool inequalities_reach(iv n[3], iv *most, const set *s, uint32_t width, reader *in) {
  const inequalities *r = &s->rows;
  double x[3] = {0.0, 0.0, 0.0};
  if (r->n_quadrics > 0) reader_normal(in, width, x);
  const size_t m = (size_t)reader_bits(in, 2);
  iv *at = iv_new(3);
  const sum to = {.n = n, .most = most, .x = at, .mu = calloc(r->n_sums + 1, sizeof(double))};
  for (int k = 0; k < 3; k++) {
    iv_set_d(&at[k], x[k]);
    iv_set_d(&n[k], 0.0);
  }
  iv_set_d(most, 0.0);
  bool holds = to.mu != NULL;
  size_t next = 0;
  for (size_t i = 0; i < m && holds; i++) {
    const size_t row = (size_t)reader_bits(in, 2);
    const double l = reader_real(in, width);
    holds = !in->bad && row >= next && add_multiplier(&to, r, row, l);
    next = row + 1;
  }
  for (int k = 0; k < 3; k++) iv_set_d(&at[k], s->centre[k]);
  iv *centre = iv_new(1);
  iv_dot(centre, n, at);
  iv_add(most, most, centre);
  iv_free(centre, 1);
  iv_free(at, 3);
  free(to.mu);
  return holds && !in->bad;
}

/* ---- a point ---- */

/* b·x + c */
static void value_of_row(iv *out, const double b[3], double c, const iv x[3]) {
  iv *w = iv_new(3);
  for (int k = 0; k < 3; k++) iv_set_d(&w[k], b[k]);
  iv_dot(out, w, x);
  iv_set_d(&w[0], c);
  iv_add(out, out, &w[0]);
  iv_free(w, 3);
}

void inequalities_value(iv *out, const set *s, const iv y[3]) {
  const inequalities *r = &s->rows;
  iv *x = iv_new(3), *w = iv_new(5), *sums = iv_new(r->n_sums);
  for (int k = 0; k < 3; k++) {
    iv_set_d(&w[0], s->centre[k]);
    iv_sub(&x[k], &y[k], &w[0]);
  }
  mpfr_set_inf(out->lo, -1);
  mpfr_set_inf(out->hi, -1);
  for (size_t i = 0; i < r->n_planes; i++) {
    value_of_row(&w[0], r->planes[i], r->planes[i][3], x);
    iv_max(out, out, &w[0]);
  }
  for (size_t i = 0; i < r->n_quadrics; i++) {
    value_of_row(&w[0], r->quadrics[i] + 6, r->quadrics[i][9], x);
    turn_by(w + 1, r->quadrics[i], x);
    iv_dot(&w[4], w + 1, x);
    iv_add(&w[0], &w[0], &w[4]);
    iv_max(out, out, &w[0]);
  }
  for (size_t i = 0; i < r->n_terms; i++) { /* |u|^p = exp(p log |u|) */
    value_of_row(&w[0], r->terms[i], r->terms[i][3], x);
    iv_abs(&w[0], &w[0]);
    iv_log(&w[0], &w[0]);
    iv_mul_d(&w[0], &w[0], r->terms[i][4]);
    iv_exp(&w[0], &w[0]);
    iv_add(&sums[r->sum_of[i]], &sums[r->sum_of[i]], &w[0]);
  }
  iv_set_d(&w[1], 1.0);
  for (size_t i = 0; i < r->n_sums; i++) {
    iv_sub(&w[0], &sums[i], &w[1]);
    iv_max(out, out, &w[0]);
  }
  iv_free(x, 3);
  iv_free(w, 5);
  iv_free(sums, r->n_sums);
}
