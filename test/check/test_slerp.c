/* SPDX-License-Identifier: BSD-3-Clause */
/* Rotations by slerp as the checker computes them, against long doubles. Numbers are drawn here: the vectors of the
 * library's tests and those of the checker have the same names. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "interval.h"
#include "slerp.h"

/* Uniform in [0, 1), by xorshift. */
static double draw(uint64_t *state) {
  *state ^= *state >> 12;
  *state ^= *state << 25;
  *state ^= *state >> 27;
  return (double)(*state * 0x2545f4914f6cdd1du >> 11) * 0x1p-53;
}

static void draw_unit(uint64_t *state, double q[4]) {
  double square = 2.0;
  while (square > 1.0 || square < 0.01) {
    square = 0.0;
    for (int k = 0; k < 4; k++) {
      q[k] = 2.0 * draw(state) - 1.0;
      square += q[k] * q[k];
    }
  }
  for (int k = 0; k < 4; k++) q[k] /= sqrt(square);
}

/* 20,000 pairs of quaternions, seed 10: one in four nearly equal, one in four nearly half a turn apart. Slerp in long
 * doubles: x sin((1 - s) a) + y sin(s a), over sin a. */
static void slerp_is_within_the_radii_that_the_checker_gives(void **state_of_test) {
  (void)state_of_test;
  uint64_t state = 10;
  double largest = 0.0;
  assert_true(iv_begin());
  for (size_t i = 0; i < 20000; i++) {
    num p[4], q[4];
    long double x[4], y[4], along = 0.0L, squares[2] = {0.0L, 0.0L};
    double from[4], to[4];
    draw_unit(&state, from), draw_unit(&state, to);
    const double norm = pow(10.0, 2.0 * draw(&state) - 1.0), off = pow(10.0, -18.0 + 16.0 * draw(&state));
    double across = 0.0;
    for (int k = 0; k < 4; k++) across += from[k] * to[k];
    for (int k = 0; k < 4; k++) {
      const double beside = to[k] - across * from[k];
      p[k] = num_of(from[k]);
      q[k] = num_of(i % 4 == 0 ? norm * (from[k] + off * to[k]) : i % 4 == 1 ? beside + off * from[k] : norm * to[k]);
      x[k] = p[k].m, y[k] = q[k].m;
      along += x[k] * y[k], squares[0] += x[k] * x[k], squares[1] += y[k] * y[k];
    }
    along /= sqrtl(squares[0] * squares[1]);
    slerp_arc found;
    if (!slerp_between(p, q, &found)) {
      assert_true(fabsl(along) < 1e-14L);
      continue;
    }
    long double apart = 0.0L;
    for (int k = 0; k < 4; k++) {
      x[k] /= sqrtl(squares[0]), y[k] /= sqrtl(squares[1]) * (along < 0.0L ? -1.0L : 1.0L);
      apart += (x[k] - y[k]) * (x[k] - y[k]);
    }
    const long double angle = 2.0L * asinl(sqrtl(apart) / 2.0L);
    for (int step = 0; step <= 4; step++) {
      const long double s = 0.25L * step, sine = sinl(angle);
      const long double m = angle > 1e-12L ? sinl((1.0L - s) * angle) / sine : 1.0L - s,
                        n = angle > 1e-12L ? sinl(s * angle) / sine : s;
      long double o[4];
      for (int k = 0; k < 4; k++) o[k] = m * x[k] + n * y[k];
      const long double wanted[9] = {1.0L - 2.0L * (o[1] * o[1] + o[2] * o[2]), 2.0L * (o[0] * o[1] - o[3] * o[2]),
                                     2.0L * (o[0] * o[2] + o[3] * o[1]),        2.0L * (o[0] * o[1] + o[3] * o[2]),
                                     1.0L - 2.0L * (o[0] * o[0] + o[2] * o[2]), 2.0L * (o[1] * o[2] - o[3] * o[0]),
                                     2.0L * (o[0] * o[2] - o[3] * o[1]),        2.0L * (o[1] * o[2] + o[3] * o[0]),
                                     1.0L - 2.0L * (o[0] * o[0] + o[1] * o[1])};
      const rot turned = rot_about(found.z, num_mul(num_of((double)s), found.angle));
      const rot all = rot_product(&turned, &found.start);
      for (int k = 0; k < 9; k++)
        if (!(fabsl((long double)all.m[k] - wanted[k]) <= all.e + 1e-18L))
          fail_msg("pair %zu at %g: number %d is off by %g, the radius is %g", i, (double)s, k,
                   (double)fabsl((long double)all.m[k] - wanted[k]), all.e);
      largest = fmax(largest, all.e);
    }
  }
  print_message("slerp: radii of at most %g\n", largest);
  assert_true(iv_end());
  assert_true(largest < 1e-13);
}

/* 200,000 angles, seed 11: of any size up to 10^5, in one of three near a multiple of a quarter turn. Long doubles have
 * 11 bits more, and their own reduction. */
static void sines_are_within_the_radii_that_the_checker_gives(void **state_of_test) {
  (void)state_of_test;
  uint64_t state = 11;
  double largest = 0.0;
  assert_true(iv_begin());
  for (size_t i = 0; i < 200000; i++) {
    double angle = pow(10.0, 25.0 * draw(&state) - 20.0) * (draw(&state) < 0.5 ? -1.0 : 1.0);
    if (i % 3 == 0) angle = rint(angle) * 1.5707963267948966 * (1.0 + 0x1p-50 * (double)(i % 7));
    const double off = i % 5 == 0 ? 1e-9 : 0.0;
    num sine, cosine;
    num_turn((num){angle, off}, &sine, &cosine);
    for (int side = -1; side <= 1; side++) {
      const long double at = (long double)angle + (long double)side * off;
      const long double own = 1e-19L + 0x1p-63L * fabsl(at);
      if (!(fabsl(sinl(at) - sine.m) <= sine.e + own) || !(fabsl(cosl(at) - cosine.m) <= cosine.e + own))
        fail_msg("%.17g: sine %g off, radius %g; cosine %g off, radius %g", angle, (double)(sinl(at) - sine.m), sine.e,
                 (double)(cosl(at) - cosine.m), cosine.e);
    }
    largest = fmax(largest, fmax(sine.e, cosine.e) - off);
  }
  print_message("sines: radii of at most %g\n", largest);
  assert_true(iv_end());
  assert_true(largest < 2e-15);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sines_are_within_the_radii_that_the_checker_gives),
                                     cmocka_unit_test(slerp_is_within_the_radii_that_the_checker_gives)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
