/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials given by powers, by Legendre coefficients and by values, each against its own definition in 113 bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/curves.h"
#include "support/quad.h"
#include "support/reference.h"

#define U 0x1p-53

/* What a basis has to say about one case: the exact curve at t, and the sum of the sizes of its terms. */
typedef struct definition {
  const vec3 *coefficient;
  const double *node; /* of Lagrange's basis */
  size_t n;
  double t0, t1;
} definition;

typedef quad3 (*exact_curve)(const definition *d, double t, double *terms);

typedef struct tally {
  double largest; /* actual / bound */
  size_t pieces, most;
} tally;

/* Every point of the computed pieces is within their error of the exact curve. The reference itself is off by a few
 * roundings a term and level. */
static void stays_within_its_error(const cprox_curve *c, const definition *d, exact_curve exact, rng *r, tally *all) {
  for (int i = 0; i < 3; i++) {
    const double t = quad_parameter(c, r);
    const size_t piece = quad_piece_at(c, t);
    double terms;
    const quad3 should = exact(d, t, &terms), is = quad_piece(c, piece, t);
    const double size = terms + ref_largest(curve_piece(c, piece), c->degree + 1);
    const double error = quad_distance(should, is), reference = 20.0 * (double)(c->degree + 1) * QUAD_U * size;
    if (!(error <= c->error[piece] + reference))
      fail_msg("degree %zu, t = %.17g of [%.17g, %.17g]: off by %g, the bound is %g", c->degree, t, d->t0, d->t1, error,
               c->error[piece]);
    if (reference < 0.01 * c->error[piece]) all->largest = fmax(all->largest, error / c->error[piece]);
  }
  all->pieces += c->n_pieces;
  if (c->n_pieces > all->most) all->most = c->n_pieces;
}

static void random_range(rng *r, double *t0, double *t1) {
  switch (rng_index(r, 5)) {
    case 0: *t0 = 0.0, *t1 = 1.0; break;
    case 1: *t0 = -1.0, *t1 = 1.0; break;
    case 2: *t0 = rng_uniform(r, -2.0, 2.0), *t1 = *t0 + rng_log_uniform(r, 1e-9, 4.0); break;
    case 3: *t0 = rng_awkward(r, 1.0), *t1 = *t0 + rng_log_uniform(r, 1e-2, 1e2); break;
    default: *t1 = rng_log_uniform(r, 1e-2, 1e2), *t0 = -rng_uniform(r, -0.5, 1.0) * *t1; break;
  }
}

/* ---- powers ---- */

static quad3 by_powers(const definition *d, double t, double *terms) {
  quad3 sum = {{0, 0, 0}};
  *terms = 0.0;
  for (size_t k = d->n; k-- > 0;) {
    for (int i = 0; i < 3; i++) sum.k[i] *= (quad)t;
    sum = quad_axpy(sum, 1, d->coefficient[k]);
    *terms = *terms * fabs(t) + vec_norm(d->coefficient[k]);
  }
  return sum;
}

/* The size of the terms decides: coefficients that belong to the range, or (t - m)^n multiplied out, whose terms cancel. */
static void random_powers(rng *r, definition *d, vec3 *c) {
  const double largest = fmax(fabs(d->t0), fabs(d->t1));
  random_points(r, d->n, c);
  if (rng_index(r, 4) == 0) {
    const double m = 0.5 * (d->t0 + d->t1), scale = rng_log_uniform(r, 1e-3, 1e3);
    const vec3 direction = rng_unit(r);
    double power = scale;
    for (size_t k = d->n; k-- > 0;) {
      c[k] = vec_scale(power, direction);
      power *= -m * (double)k / (double)(d->n - k);
    }
    return;
  }
  for (size_t k = 0; k < d->n; k++) c[k] = vec_scale(fmin(pow(largest, -(double)k), 1e130), c[k]);
}

/* seed 501, 100,000 curves, three parameters each. Up to degree 20, with terms no larger than 1e10 times the curve, no
 * more than 5 u max|psi| is lost (4 by the halving, the rest by what the ends miss of the maximum). */
static void polynomials_are_within_their_error(void **state) {
  (void)state;
  rng r = rng_seed(501);
  tally all = {0};
  for (size_t i = test_cases(100000); i-- > 0;) {
    vec3 c[61];
    definition d = {.coefficient = c, .n = 1 + (rng_index(&r, 8) ? rng_index(&r, 13) : rng_index(&r, 61))};
    random_range(&r, &d.t0, &d.t1);
    random_powers(&r, &d, c);
    cprox_curve *curve = NULL;
    assert_int_equal(cprox_curve_create_polynomial(c, d.n, d.t0, d.t1, NULL, &curve), CPROX_OK);
    stays_within_its_error(curve, &d, by_powers, &r, &all);

    double size = 0.0, terms = 0.0, most = 0.0;
    for (size_t k = 0; k <= curve->n_pieces; k++) {
      const quad3 p = by_powers(&d, curve->breaks[k], &terms);
      size = fmax(size, quad_distance(p, (quad3){{0, 0, 0}}));
      most = fmax(most, terms);
    }
    if (d.n <= 21 && most < 1e10 * size) assert_true(cprox_curve_error(curve) <= 5.0 * U * size + 1e-149);
    cprox_curve_free(curve);
  }
  print_message("powers: largest error %.2f of its bound; %zu pieces, %zu at most\n", all.largest, all.pieces,
                all.most);
  assert_true(all.largest > 0.3);
}

/* One coefficient is a curve that stands still, exactly. */
static void a_constant_stands_still(void **state) {
  (void)state;
  const vec3 p = {0.1, -0.2, 1e6};
  cprox_curve *curve = NULL;
  assert_int_equal(cprox_curve_create_polynomial(&p, 1, -3.0, 5.0, NULL, &curve), CPROX_OK);
  assert_int_equal(cprox_curve_degree(curve), 1);
  for (size_t j = 0; j < 2; j++) assert_memory_equal(&curve_piece(curve, 0)[j], &p, sizeof p);
  cprox_curve_free(curve);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polynomials_are_within_their_error),
      cmocka_unit_test(a_constant_stands_still),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
