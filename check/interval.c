/* SPDX-License-Identifier: BSD-3-Clause */
#include "interval.h"

#include <stdio.h>
#include <stdlib.h>

static _Thread_local mpfr_prec_t precision = 640; /* of the thread that checks */
static _Thread_local double work;

void iv_precision(int bits) {
  precision = bits;
}

double iv_work(void) {
  return work;
}

/* Of operations that cost about so many products each. */
static void count(int products) {
  const double words = (double)precision / 64.0;
  work += products * words * words;
}

/* Sines, cosines, powers, roots, quotients: about so many products. */
enum { TRIGONOMETRIC_WORK = 60, ROOT_WORK = 4, QUOTIENT_WORK = 4 };

iv *iv_new(size_t n) {
  iv *a = malloc((n ? n : 1) * sizeof *a);
  if (!a) {
    fputs("cprox_check: out of memory\n", stderr);
    exit(2);
  }
  for (size_t i = 0; i < n; i++) {
    mpfr_init2(a[i].lo, precision);
    mpfr_init2(a[i].hi, precision);
    iv_set_d(&a[i], 0.0);
  }
  return a;
}

void iv_free(iv *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    mpfr_clear(a[i].lo);
    mpfr_clear(a[i].hi);
  }
  free(a);
}

void iv_set(iv *out, const iv *a) {
  mpfr_set(out->lo, a->lo, MPFR_RNDD);
  mpfr_set(out->hi, a->hi, MPFR_RNDU);
}

void iv_set_d(iv *out, double a) {
  mpfr_set_d(out->lo, a, MPFR_RNDD);
  mpfr_set_d(out->hi, a, MPFR_RNDU);
}

void iv_neg(iv *out, const iv *a) {
  if (out != a) iv_set(out, a);
  mpfr_swap(out->lo, out->hi);
  mpfr_neg(out->lo, out->lo, MPFR_RNDD);
  mpfr_neg(out->hi, out->hi, MPFR_RNDU);
}

void iv_abs(iv *out, const iv *a) {
  if (mpfr_sgn(a->lo) >= 0) {
    iv_set(out, a);
  } else if (mpfr_sgn(a->hi) <= 0) {
    iv_neg(out, a);
  } else {
    iv *minus = iv_new(1);
    iv_neg(minus, a);
    mpfr_max(out->hi, a->hi, minus->hi, MPFR_RNDU);
    mpfr_set_ui(out->lo, 0, MPFR_RNDD);
    iv_free(minus, 1);
  }
}

void iv_add(iv *out, const iv *a, const iv *b) {
  mpfr_add(out->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_add(out->hi, a->hi, b->hi, MPFR_RNDU);
}

void iv_sub(iv *out, const iv *a, const iv *b) {
  iv *difference = iv_new(1);
  mpfr_sub(difference->lo, a->lo, b->hi, MPFR_RNDD);
  mpfr_sub(difference->hi, a->hi, b->lo, MPFR_RNDU);
  iv_set(out, difference);
  iv_free(difference, 1);
}

/* Least and greatest of the four products of ends. */
void iv_mul(iv *out, const iv *a, const iv *b) {
  iv *product = iv_new(2);
  mpfr_srcptr ends[4][2] = {{a->lo, b->lo}, {a->lo, b->hi}, {a->hi, b->lo}, {a->hi, b->hi}};
  const int n = mpfr_equal_p(a->lo, a->hi) && mpfr_equal_p(b->lo, b->hi) ? 1 : 4;
  count(2 * n);
  for (int i = 0; i < n; i++) {
    iv *p = &product[i > 0];
    mpfr_mul(p->lo, ends[i][0], ends[i][1], MPFR_RNDD);
    mpfr_mul(p->hi, ends[i][0], ends[i][1], MPFR_RNDU);
    if (i > 0) {
      mpfr_min(product->lo, product->lo, p->lo, MPFR_RNDD);
      mpfr_max(product->hi, product->hi, p->hi, MPFR_RNDU);
    }
  }
  iv_set(out, product);
  iv_free(product, 2);
}

void iv_mul_d(iv *out, const iv *a, double b) {
  iv *factor = iv_new(1);
  iv_set_d(factor, b);
  iv_mul(out, a, factor);
  iv_free(factor, 1);
}

void iv_div(iv *out, const iv *a, const iv *b) {
  if (mpfr_sgn(b->lo) * mpfr_sgn(b->hi) <= 0) {
    mpfr_set_inf(out->lo, -1);
    mpfr_set_inf(out->hi, 1);
    return;
  }
  iv *inverse = iv_new(1);
  count(2 * QUOTIENT_WORK);
  mpfr_ui_div(inverse->lo, 1, b->hi, MPFR_RNDD);
  mpfr_ui_div(inverse->hi, 1, b->lo, MPFR_RNDU);
  iv_mul(out, a, inverse);
  iv_free(inverse, 1);
}

void iv_sqrt(iv *out, const iv *a) {
  count(2 * ROOT_WORK);
  if (mpfr_sgn(a->lo) < 0)
    mpfr_set_ui(out->lo, 0, MPFR_RNDD);
  else
    mpfr_sqrt(out->lo, a->lo, MPFR_RNDD);
  mpfr_sqrt(out->hi, a->hi, MPFR_RNDU);
}

void iv_exp(iv *out, const iv *a) {
  count(2 * TRIGONOMETRIC_WORK);
  mpfr_exp(out->lo, a->lo, MPFR_RNDD);
  mpfr_exp(out->hi, a->hi, MPFR_RNDU);
}

void iv_log(iv *out, const iv *a) {
  count(2 * TRIGONOMETRIC_WORK);
  if (mpfr_sgn(a->lo) <= 0)
    mpfr_set_inf(out->lo, -1);
  else
    mpfr_log(out->lo, a->lo, MPFR_RNDD);
  mpfr_log(out->hi, a->hi, MPFR_RNDU);
}

/* Both are within 1 of their slope: f(a) lies within the width of a of its value at one end. */
static void around(iv *out, const iv *a, int (*f)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t)) {
  iv *value = iv_new(1);
  count(2 * TRIGONOMETRIC_WORK);
  mpfr_t width;
  mpfr_init2(width, precision);
  mpfr_sub(width, a->hi, a->lo, MPFR_RNDU);
  f(value->lo, a->lo, MPFR_RNDD);
  f(value->hi, a->lo, MPFR_RNDU);
  mpfr_sub(out->lo, value->lo, width, MPFR_RNDD);
  mpfr_add(out->hi, value->hi, width, MPFR_RNDU);
  mpfr_clear(width);
  iv_free(value, 1);
}

void iv_cos(iv *out, const iv *a) {
  around(out, a, mpfr_cos);
}

void iv_sin(iv *out, const iv *a) {
  around(out, a, mpfr_sin);
}

void iv_max(iv *out, const iv *a, const iv *b) {
  mpfr_max(out->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_max(out->hi, a->hi, b->hi, MPFR_RNDU);
}

void iv_min(iv *out, const iv *a, const iv *b) {
  mpfr_min(out->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_min(out->hi, a->hi, b->hi, MPFR_RNDU);
}

bool iv_is_positive(const iv *a) {
  return mpfr_number_p(a->lo) && mpfr_sgn(a->lo) > 0;
}

void iv_blend(iv *a, const iv *b, const iv *s) {
  iv *step = iv_new(1);
  iv_sub(step, b, a);
  iv_mul(step, step, s);
  iv_add(a, a, step);
  iv_free(step, 1);
}

void iv_dot(iv *out, const iv a[3], const iv b[3]) {
  iv *sum = iv_new(2);
  for (int k = 0; k < 3; k++) {
    iv_mul(&sum[1], &a[k], &b[k]);
    iv_add(&sum[0], &sum[0], &sum[1]);
  }
  iv_set(out, &sum[0]);
  iv_free(sum, 2);
}

void iv_norm(iv *out, const iv a[3]) {
  iv_dot(out, a, a);
  iv_sqrt(out, out);
}
