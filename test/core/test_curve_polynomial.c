/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials given by powers, by Legendre coefficients and by values, each against its own definition in 113 bits. */
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
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

/* The size of the terms decides: coefficients that belong to the range, or (t - m)^n multiplied out, whose terms
 * cancel. */
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
CASE(polynomials_are_within_their_error) {
  rng r = rng_seed(501);
  tally all = {0};
  for (size_t i = test_cases(100000); i-- > 0;) {
    vec3 c[61];
    definition d = {.coefficient = c, .n = 1 + (rng_index(&r, 8) ? rng_index(&r, 13) : rng_index(&r, 61))};
    random_range(&r, &d.t0, &d.t1);
    random_powers(&r, &d, c);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_polynomial(c, d.n, d.t0, d.t1), NULL, &curve), CPROX_OK);
    stays_within_its_error(curve, &d, by_powers, &r, &all);

    double size = 0.0, terms = 0.0, most = 0.0;
    for (size_t k = 0; k <= curve->n_pieces; k++) {
      const quad3 p = by_powers(&d, curve->breaks[k], &terms);
      size = fmax(size, quad_distance(p, (quad3){{0, 0, 0}}));
      most = fmax(most, terms);
    }
    if (d.n <= 21 && most < 1e10 * size) assert_true(cprox_curve_get_info(curve).error <= 5.0 * U * size + 1e-149);
    cprox_curve_free(curve);
  }
  print_message("powers: largest error %.2f of its bound; %zu pieces, %zu at most\n", all.largest, all.pieces,
                all.most);
  assert_true(all.largest > 0.3);
}

/* ---- Legendre ---- */

/* By the three-term recurrence, whose rounding errors |P_k| <= 1 keeps small. */
static quad3 by_legendre(const definition *d, double t, double *terms) {
  const quad x = (2 * (quad)t - (quad)d->t0 - (quad)d->t1) / ((quad)d->t1 - (quad)d->t0);
  quad previous = 1, p = x;
  quad3 sum = quad_axpy((quad3){{0, 0, 0}}, 1, d->coefficient[0]);
  *terms = vec_norm(d->coefficient[0]);
  for (size_t k = 1; k < d->n; k++) {
    sum = quad_axpy(sum, p, d->coefficient[k]);
    *terms += vec_norm(d->coefficient[k]);
    const quad next = ((quad)(2 * k + 1) * x * p - (quad)k * previous) / (quad)(k + 1);
    previous = p;
    p = next;
  }
  *terms *= (double)(1 + d->n);
  return sum;
}

/* seed 502, 100,000 curves, three parameters each; coefficients that fall off, or not at all. The error allowed up to
 * degree 40 is 5 u of the coefficients' sum, which |psi| does not exceed. */
CASE(legendre_series_are_within_their_error) {
  rng r = rng_seed(502);
  tally all = {0};
  for (size_t i = test_cases(100000); i-- > 0;) {
    vec3 c[61];
    definition d = {.coefficient = c, .n = 1 + (rng_index(&r, 8) ? rng_index(&r, 13) : rng_index(&r, 61))};
    random_range(&r, &d.t0, &d.t1);
    random_points(&r, d.n, c);
    const double fall = rng_index(&r, 2) ? 1.0 : rng_uniform(&r, 0.3, 1.0);
    double sum = 0.0;
    for (size_t k = 0; k < d.n; k++) {
      c[k] = vec_scale(pow(fall, (double)k), c[k]);
      if (rng_index(&r, 16) == 0) c[k] = vec(0, 0, 0);
      sum += vec_norm(c[k]);
    }
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_legendre(c, d.n, d.t0, d.t1), NULL, &curve), CPROX_OK);
    stays_within_its_error(curve, &d, by_legendre, &r, &all);
    assert_true(cprox_curve_get_info(curve).error <= (d.n <= 41 ? 5.0 * U : 2e-12) * sum + 1e-149);
    cprox_curve_free(curve);
  }
  print_message("Legendre: largest error %.2f of its bound; %zu pieces, %zu at most\n", all.largest, all.pieces,
                all.most);
  assert_true(all.largest > 0.3);
}

/* ---- Lagrange ---- */

static quad3 by_values(const definition *d, double t, double *terms) {
  quad3 sum = {{0, 0, 0}};
  *terms = 0.0;
  for (size_t i = 0; i < d->n; i++) {
    quad l = 1;
    for (size_t m = 0; m < d->n; m++)
      if (m != i) l *= ((quad)t - (quad)d->node[m]) / ((quad)d->node[i] - (quad)d->node[m]);
    sum = quad_axpy(sum, l, d->coefficient[i]);
    *terms += fabs((double)l) * vec_norm(d->coefficient[i]);
  }
  return sum;
}

/* The largest sum of |y_i l_i| at 4n places of the range. */
static double largest_sum(const definition *d) {
  double largest = 0.0;
  for (size_t k = 0; k <= 4 * d->n; k++) {
    const double t = d->t0 + (d->t1 - d->t0) * (double)k / (4.0 * (double)d->n);
    double sum = 0.0;
    for (size_t i = 0; i < d->n; i++) {
      double l = vec_norm(d->coefficient[i]);
      for (size_t m = 0; m < d->n; m++)
        if (m != i) l *= fabs((t - d->node[m]) / (d->node[i] - d->node[m]));
      sum += l;
    }
    largest = fmax(largest, sum);
  }
  return largest;
}

/* Even, Chebyshev's, scattered or clustered, in any order. */
static void random_nodes(rng *r, const definition *d, size_t kind, double *x) {
  const double length = d->t1 - d->t0, n = (double)d->n;
  for (size_t i = 0; i < d->n; i++) {
    const double s = kind == 0   ? ((double)i + 0.5) / n
                     : kind == 1 ? 0.5 - 0.5 * cos(3.141592653589793 * ((double)i + 0.5) / n)
                     : kind == 2 ? ((double)i + rng_uniform(r, 0.1, 0.9)) / n
                                 : ((double)i + rng_uniform(r, 0.1, 0.9)) / n * rng_uniform(r, 0.9, 1.0);
    x[i] = d->t0 + s * length;
  }
  for (size_t i = d->n; i-- > 1;) {
    const size_t other = rng_index(r, i + 1);
    const double kept = x[i];
    x[i] = x[other];
    x[other] = kept;
  }
}

static bool all_differ(const double *x, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t m = 0; m < i; m++)
      if (x[i] == x[m]) return false;
  return true;
}

/* seed 503, 100,000 curves, three parameters each. Even nodes up to degree 20 and Chebyshev's up to 60 lose no more
 * than 5 u times the sum of |y_i l_i| where it is largest. */
CASE(lagrange_curves_are_within_their_error) {
  rng r = rng_seed(503);
  tally all = {0};
  double worst_even = 0.0, worst_chebyshev = 0.0;
  for (size_t i = test_cases(100000); i-- > 0;) {
    vec3 y[61];
    double x[61];
    definition d = {.coefficient = y, .node = x, .n = 1 + (rng_index(&r, 32) ? rng_index(&r, 11) : rng_index(&r, 61))};
    random_range(&r, &d.t0, &d.t1);
    random_points(&r, d.n, y);
    const size_t kind = rng_index(&r, 4);
    random_nodes(&r, &d, kind, x);
    if (!all_differ(x, d.n)) continue;
    if (rng_index(&r, 4) == 0) {
      /* a part of the range, or some beyond it */
      const double length = d.t1 - d.t0, low = d.t0 + rng_uniform(&r, -0.05, 0.5) * length,
                   high = d.t1 - rng_uniform(&r, -0.05, 0.5) * length;
      if (low < high) d.t0 = low, d.t1 = high;
    }
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_lagrange(y, x, d.n, d.t0, d.t1), NULL, &curve), CPROX_OK);
    stays_within_its_error(curve, &d, by_values, &r, &all);
    if ((kind == 0 && d.n <= 21) || kind == 1) {
      double *worst = kind == 0 ? &worst_even : &worst_chebyshev;
      *worst = fmax(*worst, cprox_curve_get_info(curve).error / (U * largest_sum(&d) + 1e-149));
    }
    cprox_curve_free(curve);
  }
  print_message(
      "Lagrange: largest error %.2f of its bound; %zu pieces, %zu at most; bound/(u sum|y l|) %.2f evenly to "
      "degree 20, %.2f Chebyshev to degree 60\n",
      all.largest, all.pieces, all.most, worst_even, worst_chebyshev);
  assert_true(all.largest > 0.3);
  assert_true(worst_even < 5.0 && worst_chebyshev < 5.0);
}

/* One coefficient is a curve that stands still, exactly. */
CASE(a_constant_stands_still) {
  const vec3 p = {0.1, -0.2, 1e6};
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_polynomial(&p, 1, -3.0, 5.0), NULL, &curve), CPROX_OK);
  assert_int_equal(cprox_curve_get_info(curve).degree, 1);
  for (size_t j = 0; j < 2; j++) assert_memory_equal(&curve_piece(curve, 0)[j], &p, sizeof p);
  cprox_curve_free(curve);

  assert_int_equal(curve_from(describe_legendre(&p, 1, -3.0, 5.0), NULL, &curve), CPROX_OK);
  for (size_t j = 0; j < 2; j++) assert_memory_equal(&curve_piece(curve, 0)[j], &p, sizeof p);
  cprox_curve_free(curve);

  const double node = 7.0;
  assert_int_equal(curve_from(describe_lagrange(&p, &node, 1, -3.0, 5.0), NULL, &curve), CPROX_OK);
  for (size_t j = 0; j < 2; j++) assert_memory_equal(&curve_piece(curve, 0)[j], &p, sizeof p);
  cprox_curve_free(curve);
}

int main(void) {
  return cases_run(NULL, NULL);
}
