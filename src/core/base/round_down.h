/* SPDX-License-Identifier: BSD-3-Clause */
/* A parameter between two others, from below: for what is certified of all smaller ones. And how far it lies between
 * them, from both sides: for what is certified of a part of the range. */
#ifndef CPROX_BASE_ROUND_DOWN_H
#define CPROX_BASE_ROUND_DOWN_H

#include "base/double_double.h"

/* A double that is at most t0 + s (t1 - t0), for t0 <= t1 and 0 <= s <= 1: the value itself where that is a double and
 * is computed without rounding, else within a few roundings below it. */
static inline double round_down_between(double t0, double t1, double s) {
  if (s == 0.0) return t0;
  if (s == 1.0) return t1;
  const dd length = dd_sum(t1, -t0), coarse = dd_product(s, length.high), t = dd_sum(t0, coarse.high);
  const double more = s * length.low, bound = 4.0 * ROUND_U * (fabs(t.low) + fabs(coarse.low) + fabs(more));
  /* at most what the rounding of t left out */
  const double rest = t.low + coarse.low + more - bound;
  if (rest >= 0.0) return t.high;
  return fmax(t0, nextafter(t.high + rest, -INFINITY));
}

/* (t - t0) / (t1 - t0) is computed within 3 u of itself, or within the least number. At most that, but for t <= t0. */
static inline double round_fraction_below(double t0, double t1, double t) {
  const double s = (t - t0) / (t1 - t0);
  return fmin(fmax(s - 5.0 * ROUND_U * s - 1e-300, 0.0), 1.0);
}

/* At least that, but for t >= t1. */
static inline double round_fraction_above(double t0, double t1, double t) {
  const double s = (t - t0) / (t1 - t0);
  return fmin(fmax(s + 5.0 * ROUND_U * s + 1e-300, 0.0), 1.0);
}

#endif
