/* SPDX-License-Identifier: BSD-3-Clause */
/* Pythagorean-hodograph curves against their definition in 113 bits: the preimage by its powers, its form squared and
 * integrated term by term. */
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"

enum { MOST = 30 };

/* The powers of the preimage's four coordinates. */
typedef struct powers {
  quad c[4][MOST];
  size_t n;
} powers;

static double coordinate(cprox_quat q, int k) {
  const double all[4] = {q.w, q.x, q.y, q.z};
  return all[k];
}

/* sum_i C(m,i) A_i s^i (1-s)^(m-i) */
static powers powers_of(const cprox_quat *a, size_t n) {
  powers p = {.n = n};
  quad to_left = 1;
  for (size_t i = 0; i < n; i++) {
    quad factor = to_left;
    for (size_t j = 0; i + j < n; j++) {
      for (int k = 0; k < 4; k++) p.c[k][i + j] += factor * (quad)coordinate(a[i], k);
      factor = -factor * (quad)(n - 1 - i - j) / (quad)(j + 1);
    }
    to_left = to_left * (quad)(n - 1 - i) / (quad)(i + 1);
  }
  return p;
}

static quad absolute(quad x) {
  return x < 0 ? -x : x;
}

/* psi at s; *size is the sum of the sizes of all terms. */
static quad3 integrate(const powers *p, vec3 start, quad s, double *size) {
  static const int form[3][4][3] = {{{0, 0, 1}, {1, 1, 1}, {2, 2, -1}, {3, 3, -1}},
                                    {{0, 3, 1}, {3, 0, 1}, {1, 2, 1}, {2, 1, 1}},
                                    {{1, 3, 1}, {3, 1, 1}, {0, 2, -1}, {2, 0, -1}}};
  quad3 sum = {{(quad)start.x, (quad)start.y, (quad)start.z}};
  quad sizes = absolute(sum.k[0]) + absolute(sum.k[1]) + absolute(sum.k[2]);
  for (int c = 0; c < 3; c++) {
    for (size_t i = 0; i < p->n; i++) {
      quad power = s;
      for (size_t e = 0; e < i; e++) power *= s;
      for (size_t j = 0; j < p->n; j++, power *= s) {
        for (int term = 0; term < 4; term++) {
          const int *f = form[c][term];
          const quad value = (quad)f[2] * p->c[f[0]][i] * p->c[f[1]][j] * power / (quad)(i + j + 1);
          sum.k[c] += value;
          sizes += absolute(value);
        }
      }
    }
  }
  *size = (double)sizes;
  return sum;
}

static size_t random_preimage(rng *r, cprox_quat *a) {
  const size_t n = rng_index(r, 40) ? 1 + rng_index(r, 5) : 1 + rng_index(r, 12);
  const double scale = sqrt(rng_log_uniform(r, 1e-6, 1e6));
  const bool planar = rng_index(r, 2);
  for (size_t i = 0; i < n; i++) {
    a[i] = (cprox_quat){rng_awkward(r, scale), rng_awkward(r, scale), rng_awkward(r, scale), rng_awkward(r, scale)};
    if (planar) a[i].x = a[i].y = 0.0;
  }
  return n;
}

/* seed 611, 10000 curves, 12 points each. The reference adds a few roundings of 113 bits a term. */
CASE(every_piece_is_within_its_error_of_the_integral) {
  rng r = rng_seed(611);
  double largest = 0.0;
  for (size_t i = test_cases(10000); i-- > 0;) {
    cprox_quat a[MOST];
    const size_t n = random_preimage(&r, a);
    const vec3 start = rng_index(&r, 2) ? vec(0, 0, 0) : rng_in_cube(&r, rng_log_uniform(&r, 1e-6, 1e6));
    const double t0 = rng_uniform(&r, -5, 5), t1 = t0 + rng_log_uniform(&r, 1e-3, 10.0);
    cprox_curve *c = NULL;
    assert_int_equal(curve_from(describe_pythagorean_hodograph(start, a, n, t0, t1), NULL, &c), CPROX_OK);
    assert_int_equal(cprox_curve_get_info(c).degree, 2 * n - 1);
    const powers p = powers_of(a, n);
    for (int k = 0; k < 12; k++) {
      const double t = quad_parameter(c, &r);
      const size_t piece = quad_piece_at(c, t);
      double size;
      const quad3 should = integrate(&p, start, ((quad)t - (quad)t0) / ((quad)t1 - (quad)t0), &size);
      const double error = quad_distance(should, quad_piece(c, piece, t)), bound = c->error[piece];
      const double reference = 200.0 * QUAD_U * size;
      if (!(error <= bound + reference))
        fail_msg("%zu coefficients, t = %.17g: off by %g, the bound is %g", n, t, error, bound);
      if (reference < 0.05 * bound) largest = fmax(largest, error / bound);
    }
    cprox_curve_free(c);
  }
  print_message("largest error: %.2f of its bound\n", largest);
  assert_true(largest > 0.3);
}

/* (1 + is)² = 1 - s² + 2is: the curve (s - s³/3, s²), and its speed 1 + s². */
CASE(a_planar_cubic_is_the_known_one) {
  const cprox_quat a[2] = {{1, 0, 0, 0}, {1, 0, 0, 1}};
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_pythagorean_hodograph(vec(0, 0, 0), a, 2, 0, 1), NULL, &c), CPROX_OK);
  for (double s = 0.0; s <= 1.0; s += 0.125) {
    vec3 x, v;
    assert_int_equal(cprox_curve_evaluate(c, s, NULL, &x, &v, NULL), CPROX_OK);
    assert_true(fabs(x.x - (s - s * s * s / 3.0)) < 1e-15 && fabs(x.y - s * s) < 1e-15 && x.z == 0.0);
    assert_true(fabs(vec_norm(v) - (1.0 + s * s)) < 1e-14);
  }
  cprox_curve_free(c);
}

CASE(bad_preimages_are_refused) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  cprox_quat a[31] = {{1, 0, 0, 0}};
  const struct {
    const cprox_quat *a;
    size_t n;
    const char *reason;
  } bad[] = {{a, 0, "the preimage has no coefficients; it needs at least 1"},
             {NULL, 3, "the preimage is NULL"},
             {a, 31, "the preimage has 31 coefficients, above 30"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(curve_from(describe_pythagorean_hodograph(vec(0, 0, 0), bad[i].a, bad[i].n, 0, 1), ws, &c),
                     CPROX_INVALID);
    assert_string_equal(cprox_workspace_error(ws), bad[i].reason);
  }
  a[2].y = NAN;
  assert_int_equal(curve_from(describe_pythagorean_hodograph(vec(0, 0, 0), a, 3, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws),
                      "coefficient 2 of the preimage is (0, 0, nan, 0), not finite or longer than 1e+75");
  assert_int_equal(curve_from(describe_pythagorean_hodograph(vec(0, NAN, 0), a, 2, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "start point 0 is (0, nan, 0), not finite");
  assert_null(c);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
