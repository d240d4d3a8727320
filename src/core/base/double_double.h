/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as unevaluated sums of two doubles, for conversions whose terms cancel. The algorithms and their relative
 * error bounds are those of M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building
 * blocks of double-word arithmetic", 2017; they hold where nothing overflows or underflows. A product that underflows
 * is off by a few 2^-1074 besides, which is the caller's to count. */
#ifndef CPROX_BASE_DOUBLE_DOUBLE_H
#define CPROX_BASE_DOUBLE_DOUBLE_H

#include <math.h>
#include <stdint.h>

#include "base/rounding.h"

/* high is the double nearest to high + low. */
typedef struct dd {
  double high, low;
} dd;

/* Relative errors, in units of u². */
#define DD_ADD 3.1
#define DD_SCALE 2.0
#define DD_MULTIPLY 7.0
#define DD_DIVIDE 15.1
#define DD_UNIT (ROUND_U * ROUND_U)

/* a + b exactly, for |a| >= |b| or a = 0. */
static inline dd dd_fast_sum(double a, double b) {
  const double high = a + b;
  return (dd){high, b - (high - a)};
}

/* a + b exactly. */
static inline dd dd_sum(double a, double b) {
  const double high = a + b, of_b = high - a, of_a = high - of_b;
  return (dd){high, (a - of_a) + (b - of_b)};
}

/* a b exactly. */
static inline dd dd_product(double a, double b) {
  const double high = a * b;
  return (dd){high, fma(a, b, -high)};
}

static inline dd dd_from(double a) {
  return (dd){a, 0.0};
}

/* A whole number, exactly. */
static inline dd dd_from_count(uint64_t n) {
  const uint64_t low = n & 0xffffffffu;
  return dd_sum((double)(n - low), (double)low);
}

static inline dd dd_add(dd a, dd b) {
  const dd s = dd_sum(a.high, b.high), t = dd_sum(a.low, b.low);
  const dd v = dd_fast_sum(s.high, s.low + t.high);
  return dd_fast_sum(v.high, t.low + v.low);
}

/* a b for a double b. */
static inline dd dd_scale(dd a, double b) {
  const dd c = dd_product(a.high, b), t = dd_fast_sum(c.high, a.low * b);
  return dd_fast_sum(t.high, t.low + c.low);
}

static inline dd dd_multiply(dd a, dd b) {
  const dd c = dd_product(a.high, b.high);
  return dd_fast_sum(c.high, c.low + (a.high * b.low + a.low * b.high));
}

/* a / b, b != 0. */
static inline dd dd_divide(dd a, dd b) {
  const double high = a.high / b.high;
  const dd r = dd_scale(b, high);
  return dd_fast_sum(high, ((a.high - r.high) + (a.low - r.low)) / b.high);
}

#endif
