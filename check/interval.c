/* SPDX-License-Identifier: BSD-3-Clause */
#include "interval.h"

#include <math.h>
#include <stdlib.h>

static _Thread_local mpfr_prec_t precision = 640; /* of the thread that checks */
static _Thread_local double work;

/* Stands in for all intervals that there is no memory for. */
static _Thread_local iv *spare;
static _Thread_local bool spare_used;

int iv_precision(int bits) {
  const int before = (int)precision;
  precision = bits;
  return before;
}

double iv_work(void) {
  return work;
}

/* Of operations that cost about so many products each. */
static void count(int products) {
  const double words = (double)precision / 64.0;
  work += products * words * words;
}

/* Roots, quotients: about so many products. */
enum { ROOT_WORK = 4, QUOTIENT_WORK = 4 };

/* ---- memory: MPFR's own ends the program where there is none ---- */

enum { MOST_BITS = 4352 };

static size_t size_of(size_t n, mpfr_prec_t bits) {
  return n * (sizeof(iv) + 2 * mpfr_custom_get_size(bits));
}

/* Numbers behind each other, after the n intervals. */
static void make_zeros(iv *a, size_t n, mpfr_prec_t bits) {
  char *limbs = (char *)(a + n);
  for (size_t i = 0; i < n; i++) {
    mpfr_ptr ends[2] = {a[i].lo, a[i].hi};
    for (int k = 0; k < 2; k++, limbs += mpfr_custom_get_size(bits)) {
      mpfr_custom_init(limbs, bits);
      mpfr_custom_init_set(ends[k], MPFR_ZERO_KIND, 0, bits, limbs);
    }
  }
}

bool iv_begin(void) {
  spare_used = false;
  spare = malloc(size_of(IV_MOST, MOST_BITS));
  return spare != NULL;
}

bool iv_end(void) {
  free(spare);
  spare = NULL;
  return !spare_used;
}

iv *iv_new(size_t n) {
  iv *a = malloc(size_of(n ? n : 1, precision));
  if (a) {
    make_zeros(a, n, precision);
    return a;
  }
  if (!spare_used) make_zeros(spare, IV_MOST, MOST_BITS);
  spare_used = true;
  return spare;
}

void iv_free(iv *a, size_t n) {
  (void)n;
  if (a != spare) free(a);
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
  if (mpfr_sgn(a->lo) >= 0 && mpfr_sgn(b->lo) >= 0) {
    count(2);
    mpfr_mul(product->lo, a->lo, b->lo, MPFR_RNDD);
    mpfr_mul(product->hi, a->hi, b->hi, MPFR_RNDU);
    iv_set(out, product);
    iv_free(product, 2);
    return;
  }
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

/* ---- exponential and logarithm ---- */

/* SMALL: the series is of an argument below 2^-SMALL; HUGE: exponent of the largest that something is said of. */
enum { SMALL = 12, HUGE_ARGUMENT = 40, POWER_BITS = SMALL + HUGE_ARGUMENT + 24 };

/* Room for the work: with more bits. */
static iv *power_room(size_t n) {
  const mpfr_prec_t wanted = precision;
  precision += POWER_BITS;
  iv *w = iv_new(n);
  precision = wanted;
  return w;
}

/* e^x, |x| < 2^HUGE_ARGUMENT, within 2^-precision of itself: the square of a square and so on of a series. Let v =
 * 2^-bits. The series has bits / 12 < 400 sums and as many products: it is off by 2^10 v of itself at most, a square by
 * twice as much and v. After h <= 52 squares that is below 2^(h + 12) v, less than 2^-(precision + 12). */
static void power_of_e(mpfr_ptr out, mpfr_srcptr x, iv w[2]) {
  const mpfr_prec_t bits = precision + POWER_BITS;
  const mpfr_exp_t size = mpfr_sgn(x) != 0 ? mpfr_get_exp(x) : -SMALL;
  const int halvings = size > -SMALL ? (int)size + SMALL : 0;
  mpfr_ptr y = w[0].lo, term = w[0].hi, sum = w[1].lo;
  mpfr_div_2si(y, x, halvings, MPFR_RNDN);
  mpfr_set_ui(term, 1, MPFR_RNDN);
  mpfr_set_ui(sum, 1, MPFR_RNDN);
  for (int k = 1; (k - 1) * SMALL <= bits; k++) {
    mpfr_mul(term, term, y, MPFR_RNDN);
    mpfr_div_ui(term, term, (unsigned long)k, MPFR_RNDN);
    mpfr_add(sum, sum, term, MPFR_RNDN);
    count(1);
  }
  for (int i = 0; i < halvings; i++) mpfr_mul(sum, sum, sum, MPFR_RNDN);
  count(halvings);
  mpfr_set(out, sum, MPFR_RNDN);
}

/* One end, rounded down or up. */
static void exponential(mpfr_ptr out, mpfr_srcptr x, mpfr_rnd_t to, iv w[3]) {
  const bool up = to == MPFR_RNDU, less = !mpfr_nan_p(x) && mpfr_sgn(x) < 0;
  if (mpfr_number_p(x) && (mpfr_zero_p(x) || mpfr_get_exp(x) <= HUGE_ARGUMENT)) {
    mpfr_ptr around = w[2].lo, off = w[2].hi;
    power_of_e(around, x, w);
    mpfr_set_ui_2exp(off, 1, 2 - precision, MPFR_RNDU);
    if (up)
      mpfr_add_ui(off, off, 1, MPFR_RNDU);
    else
      mpfr_ui_sub(off, 1, off, MPFR_RNDD);
    mpfr_mul(out, around, off, to);
  } else if (up && less) {
    mpfr_set_ui_2exp(out, mpfr_inf_p(x) ? 0 : 1, -(1L << (HUGE_ARGUMENT - 20)), MPFR_RNDU);
  } else if (up) {
    mpfr_set_inf(out, 1);
  } else {
    mpfr_set_ui(out, mpfr_nan_p(x) || less ? 0 : 1, MPFR_RNDD);
  }
}

void iv_exp(iv *out, const iv *a) {
  iv *w = power_room(4);
  exponential(w[3].lo, a->lo, MPFR_RNDD, w);
  exponential(w[3].hi, a->hi, MPFR_RNDU, w);
  iv_set(out, &w[3]);
  iv_free(w, 4);
}

/* Of a positive number: y by Halley's steps, each of which has three times as many bits. Then with x = (1 + t) e^y,
 * t/(1 + t) <= log(1 + t) <= t, whatever y is. */
static void logarithm(iv *out, mpfr_srcptr x, iv w[6]) {
  enum { DOUBLE_BITS = 40 };
  long exponent;
  const double m = mpfr_get_d_2exp(&exponent, x, MPFR_RNDN);
  mpfr_ptr y = w[3].lo, e = w[3].hi, up = w[4].lo, down = w[4].hi;
  mpfr_set_d(y, log(m) + 0.69314718055994531 * (double)exponent, MPFR_RNDN);
  for (long bits = DOUBLE_BITS; bits < precision; bits *= 3) { /* y += 2 (x - e^y) / (x + e^y) */
    power_of_e(e, y, w);
    mpfr_sub(up, x, e, MPFR_RNDN);
    mpfr_add(down, x, e, MPFR_RNDN);
    mpfr_div(up, up, down, MPFR_RNDN);
    mpfr_mul_2ui(up, up, 1, MPFR_RNDN);
    mpfr_add(y, y, up, MPFR_RNDN);
  }
  exponential(w[5].lo, y, MPFR_RNDD, w);
  exponential(w[5].hi, y, MPFR_RNDU, w);
  mpfr_div(up, x, w[5].lo, MPFR_RNDU); /* at least 1 + t */
  mpfr_sub_ui(up, up, 1, MPFR_RNDU);
  mpfr_div(down, w[5].hi, x, MPFR_RNDU); /* at least 1/(1 + t) = 1 - t/(1 + t) */
  mpfr_ui_sub(down, 1, down, MPFR_RNDD);
  mpfr_add(out->lo, y, down, MPFR_RNDD);
  mpfr_add(out->hi, y, up, MPFR_RNDU);
}

void iv_log(iv *out, const iv *a) {
  iv *w = power_room(8), *end = w + 6;
  for (int k = 0; k < 2; k++) {
    mpfr_srcptr x = k == 0 ? a->lo : a->hi;
    if (mpfr_number_p(x) && mpfr_sgn(x) > 0) {
      logarithm(&end[k], x, w);
    } else {
      mpfr_set_inf(end[k].lo, -1);
      mpfr_set_inf(end[k].hi, !mpfr_nan_p(x) && mpfr_sgn(x) <= 0 ? -1 : 1);
    }
  }
  mpfr_set(out->lo, end[0].lo, MPFR_RNDD);
  mpfr_set(out->hi, end[1].hi, MPFR_RNDU);
  iv_free(w, 8);
}

/* ---- cosine and sine: MPFR's would take memory of its own ---- */

/* HALVINGS: of an angle below 1; LARGEST: exponent of the largest angle that something is said of. */
enum { HALVINGS = 12, LARGEST = 64, MOST_HALVINGS = HALVINGS + LARGEST };

/* More bits for the work than for what comes of it. Let v = 2^-bits, and e what cosine and sine are off by. The series
 * has bits / 24 < 190 sums of at most 1 + 2^-20, and ends below v: e < 2^8 v. A doubling makes it at most 4.01 e + 4 v:
 * after h of them it is below 2^(2.1 h + 9) v, less than one of the bits that are wanted. */
static int bits_more(int halvings) {
  return 3 * halvings + 16;
}

/* sum (-1)^k x^(2k + first) / (2k + first)!, first 0 or 1, of 0 <= x <= 2^-12. */
static void series(mpfr_ptr sum, mpfr_srcptr x, mpfr_srcptr square, mpfr_ptr term, int first, mpfr_prec_t bits) {
  if (first == 1)
    mpfr_set(term, x, MPFR_RNDN);
  else
    mpfr_set_ui(term, 1, MPFR_RNDN);
  mpfr_set_ui(sum, 0, MPFR_RNDN);
  bool minus = false;
  for (int k = first; (k - first) * HALVINGS <= bits; k += 2, minus = !minus) {
    if (minus)
      mpfr_sub(sum, sum, term, MPFR_RNDN);
    else
      mpfr_add(sum, sum, term, MPFR_RNDN);
    mpfr_mul(term, term, square, MPFR_RNDN);
    mpfr_div_ui(term, term, (unsigned long)(k + 1) * (unsigned long)(k + 2), MPFR_RNDN);
    count(1);
  }
}

/* By halves until the series ends soon, and doubles again: sin 2x = 2 sin x cos x, cos 2x = 1 - 2 sin² x. */
static void turn_within(mpfr_ptr cosine, mpfr_ptr sine, mpfr_srcptr angle, int halvings, mpfr_prec_t bits) {
  iv *w = iv_new(2);
  mpfr_ptr x = w[0].lo, square = w[0].hi, other = w[1].lo;
  mpfr_div_2si(x, angle, halvings, MPFR_RNDN);
  mpfr_abs(x, x, MPFR_RNDN);
  mpfr_mul(square, x, x, MPFR_RNDN);
  series(cosine, x, square, other, 0, bits);
  series(sine, x, square, other, 1, bits);
  for (int i = 0; i < halvings; i++) {
    mpfr_mul(other, sine, sine, MPFR_RNDN);
    mpfr_mul_2ui(other, other, 1, MPFR_RNDN);
    mpfr_mul(sine, sine, cosine, MPFR_RNDN);
    mpfr_mul_2ui(sine, sine, 1, MPFR_RNDN);
    mpfr_ui_sub(cosine, 1, other, MPFR_RNDN);
    count(2);
  }
  if (mpfr_sgn(angle) < 0) mpfr_neg(sine, sine, MPFR_RNDN);
  iv_free(w, 2);
}

/* Both are within 1 of their slope: they lie within the width of the angle of their values at one end. */
void iv_turn(iv *cosine, iv *sine, const iv *angle) {
  const mpfr_prec_t wanted = precision;
  const bool known = mpfr_number_p(angle->lo) && mpfr_number_p(angle->hi);
  const mpfr_exp_t size = known && mpfr_sgn(angle->lo) != 0 ? mpfr_get_exp(angle->lo) : 0;
  const int halvings = HALVINGS + (size > 0 && size <= LARGEST ? (int)size : 0);
  precision = wanted + bits_more(halvings);
  iv *off = iv_new(2), *found = &off[1];
  if (known && size <= LARGEST) {
    mpfr_sub(off->hi, angle->hi, angle->lo, MPFR_RNDU);
    mpfr_set_ui_2exp(off->lo, 1, -wanted, MPFR_RNDU);
    mpfr_add(off->hi, off->hi, off->lo, MPFR_RNDU);
    turn_within(found->lo, found->hi, angle->lo, halvings, precision);
    mpfr_sub(cosine->lo, found->lo, off->hi, MPFR_RNDD);
    mpfr_add(cosine->hi, found->lo, off->hi, MPFR_RNDU);
    mpfr_sub(sine->lo, found->hi, off->hi, MPFR_RNDD);
    mpfr_add(sine->hi, found->hi, off->hi, MPFR_RNDU);
  } else {
    mpfr_set_si(off->lo, -1, MPFR_RNDD);
    mpfr_set_si(off->hi, 1, MPFR_RNDU);
    iv_set(cosine, off);
    iv_set(sine, off);
  }
  iv_free(off, 2);
  precision = wanted;
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
