/* SPDX-License-Identifier: BSD-3-Clause */
#include "ball.h"

#include <mpfr.h>

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

/* By MPFR; both have slopes of at most 1. */
static void sine_and_cosine(num angle, num *sine, num *cosine) {
  MPFR_DECL_INIT(x, 64);
  MPFR_DECL_INIT(s, 64);
  MPFR_DECL_INIT(c, 64);
  mpfr_set_d(x, angle.m, MPFR_RNDN);
  mpfr_sin_cos(s, c, x, MPFR_RNDN);
  *sine = (num){mpfr_get_d(s, MPFR_RNDN), GROW(angle.e + 4.0 * BALL_U)};
  *cosine = (num){mpfr_get_d(c, MPFR_RNDN), GROW(angle.e + 4.0 * BALL_U)};
}

/* cos + sin [z] + (1 - cos) z zᵀ */
rot rot_about(const num *z, num angle) {
  num s, c, k[9];
  sine_and_cosine(angle, &s, &c);
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
