/* SPDX-License-Identifier: BSD-3-Clause */
#include "ball.h"

#include "interval.h"

/* R = 1 + s (w [v] + [v]²), s = 2/q·q; [v]² = v vᵀ - v·v, of the four middles. Unit quaternions that are d apart make
 * rotations that are at most 2 d apart. */
rot rot_of_quaternion(const num given[4]) {
  num square = num_of(0.0), k[9], q[4];
  double off = 0.0;
  for (int i = 0; i < 4; i++) {
    q[i] = num_of(given[i].m);
    square = num_add(square, num_mul(q[i], q[i]));
    off = GROW(off + given[i].e);
  }
  const num s = num_div(num_of(2.0), square), *v = q + 1;
  for (int i = 0; i < 3; i++) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    const num others = num_add(num_mul(v[a], v[a]), num_mul(v[b], v[b]));
    k[4 * i] = num_sub(num_of(1.0), num_mul(s, others));
    const num across = num_mul(v[a], v[b]), along = num_mul(q[0], v[i]);
    k[3 * b + a] = num_mul(s, num_add(across, along));
    k[3 * a + b] = num_mul(s, num_sub(across, along));
  }
  rot r = rot_of(k);
  const double length = (1.0 - 0x1p-40) * sqrt(square.m);
  r.e = off < length ? GROW(r.e + 2.0 * off / ((length - off) * (1.0 - 0x1p-40))) : INFINITY;
  return r;
}

/* A number in the interval, which is narrower than 4 roundings of 1; slopes are at most 1. */
static num num_of_interval(const iv *a, double slope) {
  const double low = mpfr_get_d(a->lo, MPFR_RNDD), high = mpfr_get_d(a->hi, MPFR_RNDU);
  return (num){low, GROW(high - low + slope)};
}

/* Of a large angle. */
static void turn_far(num angle, num *sine, num *cosine) {
  const int before = iv_precision(64);
  iv *w = iv_new(3);
  iv_set_d(&w[0], angle.m);
  iv_turn(&w[1], &w[2], &w[0]);
  *cosine = num_of_interval(&w[1], angle.e);
  *sine = num_of_interval(&w[2], angle.e);
  iv_free(w, 3);
  iv_precision(before);
}

/* 1 - x²/((n - 1) n) (1 - x²/((n + 1) (n + 2)) (...)), of x² below .63: what is left out is below 2^-57. */
static num series(num square, int n) {
  enum { LAST = 16 };
  num sum = num_of(1.0);
  for (int k = LAST + n % 2; k >= n; k -= 2)
    sum = num_sub(num_of(1.0), num_mul(square, num_div(sum, num_of((double)((k - 1) * k)))));
  sum.e += 0x1p-57;
  return sum;
}

/* A quarter turn is NEAR + REST; NEAR has 33 bits, so that up to 2^20 quarters of it are doubles. */
void num_turn(num angle, num *sine, num *cosine) {
  static const double NEAR = 0x1.921fb544p+0, QUARTERS = 0x1.45f306dc9c883p-1;
  static const num REST = {0x1.0b4611a626331p-34, 0x1p-87};
  const double quarters = rint(angle.m * QUARTERS);
  if (!(fabs(quarters) < 0x1p20)) {
    turn_far(angle, sine, cosine);
    return;
  }
  const double near = quarters * NEAR;
  const num x = num_sub(num_sub(num_of(angle.m), num_of(near)), num_mul(num_of(quarters), REST));
  const num square = num_mul(x, x), s = num_mul(x, series(square, 3)), c = series(square, 2);
  const bool odd = fmod(quarters, 2.0) != 0.0;
  const double quarter = fmod(fmod(quarters, 4.0) + 4.0, 4.0);
  *sine = odd ? c : s;
  *cosine = odd ? s : c;
  if (quarter >= 2.0) *sine = num_neg(*sine);
  if (quarter == 1.0 || quarter == 2.0) *cosine = num_neg(*cosine);
  sine->e += angle.e;
  cosine->e += angle.e;
}

/* cos + sin [z] + (1 - cos) z zᵀ */
rot rot_about(const num *z, num angle) {
  num s, c, k[9];
  num_turn(angle, &s, &c);
  const num d = num_sub(num_of(1.0), c);
  for (int i = 0; i < 3; i++) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    k[4 * i] = num_add(c, num_mul(d, num_mul(z[i], z[i])));
    const num across = num_mul(d, num_mul(z[a], z[b])), along = num_mul(s, z[i]);
    k[3 * b + a] = num_add(across, along);
    k[3 * a + b] = num_sub(across, along);
  }
  return rot_of(k);
}
