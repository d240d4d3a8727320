/* SPDX-License-Identifier: BSD-3-Clause */
/* Intervals of real numbers, their ends rounded outwards by MPFR: what holds for both ends holds for the number. Sums
 * and products of doubles stay single points as long as they fit into the precision, so polynomials of them are exact.
 */
#ifndef CHECK_INTERVAL_H
#define CHECK_INTERVAL_H

#include <mpfr.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct iv {
  mpfr_t lo, hi;
} iv;

/* Bits of every number made from now on; the number of bits before. */
int iv_precision(int bits);

/* Around all that a check does with intervals. Where memory is out, intervals go on with numbers that mean nothing, and
 * iv_end() returns false: then nothing is proven. False, where memory is out at once; then there is no end. */
bool iv_begin(void);
bool iv_end(void);

/* What has been done since the program began, in products of two words of 64 bits: a measure that is the same on all
 * machines. */
double iv_work(void);

/* n <= IV_MOST intervals, all [0, 0]; between iv_begin() and iv_end(). iv_free() takes the same n. */
enum { IV_MOST = 256 };
iv *iv_new(size_t n);
void iv_free(iv *a, size_t n);

void iv_set(iv *out, const iv *a);
void iv_set_d(iv *out, double a);
void iv_neg(iv *out, const iv *a);
void iv_abs(iv *out, const iv *a);
void iv_add(iv *out, const iv *a, const iv *b);
void iv_sub(iv *out, const iv *a, const iv *b);
void iv_mul(iv *out, const iv *a, const iv *b);
void iv_mul_d(iv *out, const iv *a, double b);
void iv_div(iv *out, const iv *a, const iv *b);      /* everything, where b may be 0 */
void iv_sqrt(iv *out, const iv *a);                  /* of the part that is not negative */
void iv_exp(iv *out, const iv *a);                   /* in memory of MPFR's own */
void iv_log(iv *out, const iv *a);                   /* of the part that is not negative; likewise */
void iv_turn(iv *cosine, iv *sine, const iv *angle); /* neither is the angle */
void iv_max(iv *out, const iv *a, const iv *b);
void iv_min(iv *out, const iv *a, const iv *b);

/* The number is greater than 0, whatever it is in the interval; false for what is not a number. */
bool iv_is_positive(const iv *a);

/* a becomes (1 - s) a + s b. */
void iv_blend(iv *a, const iv *b, const iv *s);

/* Vectors are three intervals in a row. */
void iv_dot(iv *out, const iv a[3], const iv b[3]);
void iv_norm(iv *out, const iv a[3]);

#endif
