/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves by a caller's functions: the compiled pieces are within their error of them, and what the functions say
 * falsely is refused where it shows. */
#include <string.h>

#include "base/rounding.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"

/* Long double's unit roundoff. */
#define UL (0.5L * LDBL_EPSILON)

/* (a sin wt, b exp(kt), c log t), t > 0: bounds that are the same everywhere, larger to the right, larger to the left.
 */
typedef struct blend {
  double a, w, b, k, c;
  double spoilt_from; /* where the functions begin to misbehave */
  double sixth_factor, noise;
} blend;

static void exact(const blend *f, long double t, long double d[3][3]) {
  const long double sine = f->a * sinl(f->w * t), cosine = f->a * cosl(f->w * t), grown = f->b * expl(f->k * t);
  const long double at[3][3] = {{sine, grown, f->c * logl(t)},
                                {f->w * cosine, f->k * grown, f->c / t},
                                {-f->w * f->w * sine, f->k * f->k * grown, -f->c / (t * t)}};
  memcpy(d, at, sizeof at);
}

static void evaluate(void *user, double t, vec3 jet[3]) {
  const blend *f = user;
  long double d[3][3];
  exact(f, t, d);
  for (int k = 0; k < 3; k++) jet[k] = vec((double)d[k][0], (double)d[k][1], (double)d[k][2]);
  if (t >= f->spoilt_from) jet[1].y = NAN;
  jet[0].x += f->noise * sin(1e9 * t);
}

static double sixth(void *user, double from, double to) {
  const blend *f = user;
  const double w = f->a * pow(f->w, 6), k = f->b * pow(f->k, 6) * exp(f->k * to), l = 120.0 * f->c / pow(from, 6);
  return f->sixth_factor * 1.000001 * sqrt(w * w + k * k + l * l);
}

/* Each derivative is rounded once: u of its size, which is monotone in all three coordinates. */
static cprox_smooth_curve functions(blend *f, double t0, double t1) {
  cprox_smooth_curve s = {.evaluate = evaluate, .sixth = sixth, .user = f};
  for (int k = 0; k < 3; k++) {
    const double wave = f->a * pow(f->w, k), growth = f->b * pow(f->k, k) * exp(f->k * t1);
    const double logarithm = k == 0 ? f->c * fmax(fabs(log(t0)), fabs(log(t1))) : f->c / pow(t0, k);
    s.error[k] = 1.001 * ROUND_U * (wave + growth + logarithm);
  }
  s.accuracy = 1e-13 * (f->a + f->b + f->c);
  return s;
}

static blend random_blend(rng *r) {
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  return (blend){.a = scale * rng_uniform(r, 0.0, 2.0),
                 .w = rng_log_uniform(r, 0.1, 10.0),
                 .b = scale * rng_uniform(r, 0.0, 2.0),
                 .k = rng_log_uniform(r, 0.01, 2.0),
                 .c = scale * rng_uniform(r, 0.0, 2.0),
                 .spoilt_from = INFINITY,
                 .sixth_factor = 1.0};
}

/* seed 631, 2000 curves, 50 points each. */
CASE(every_piece_is_within_its_error) {
  rng r = rng_seed(631);
  double largest = 0.0;
  size_t pieces = 0;
  for (size_t i = test_cases(2000); i-- > 0;) {
    blend f = random_blend(&r);
    const double t0 = rng_log_uniform(&r, 1e-3, 2.0), t1 = t0 + rng_log_uniform(&r, 1e-3, 3.0);
    const cprox_smooth_curve given = functions(&f, t0, t1);
    cprox_curve *c = NULL;
    assert_int_equal(curve_from(describe_smooth(&given, t0, t1), NULL, &c), CPROX_OK);
    pieces += c->n_pieces;
    for (int k = 0; k < 50; k++) {
      double t = quad_parameter(c, &r);
      size_t piece = quad_piece_at(c, t);
      if (k % 2 == 0) {
        piece = rng_index(&r, c->n_pieces);
        t = 0.5 * c->breaks[piece] + 0.5 * c->breaks[piece + 1];
      }
      long double d[3][3];
      exact(&f, t, d);
      const quad3 should = {{d[0][0], d[0][1], d[0][2]}};
      const double error = quad_distance(should, quad_piece(c, piece, t)), bound = c->error[piece];
      const double reference = (double)UL * 40.0 * (f.a + f.b * exp(f.k * t) + f.c * fabs(log(t)));
      if (!(error <= bound + reference)) fail_msg("t = %.17g: off by %g, the bound is %g", t, error, bound);
      if (reference < 0.05 * bound) largest = fmax(largest, error / bound);
    }
    cprox_curve_free(c);
  }
  print_message("largest error: %.2f of its bound; %zu pieces\n", largest, pieces);
  assert_true(largest > 0.5);
}

/* A logarithm from 1e-3 on: its pieces grow with t, by 1000 from the first to the last. */
CASE(pieces_are_as_long_as_the_bound_allows_where_they_are) {
  blend f = {.c = 1.0, .spoilt_from = INFINITY, .sixth_factor = 1.0};
  cprox_smooth_curve given = functions(&f, 1e-3, 1.0);
  given.accuracy = 1e-12;
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_smooth(&given, 1e-3, 1.0), NULL, &c), CPROX_OK);
  const double first = c->breaks[1] - c->breaks[0], last = c->breaks[c->n_pieces] - c->breaks[c->n_pieces - 1];
  print_message("%u pieces from %g to %g long\n", c->n_pieces, first, last);
  assert_true(last > 300.0 * first);
  /* ln(1000) in pieces of h/t = (46080e-12/120)^(1/6) = 0.027 are 256 */
  assert_true(c->n_pieces < 300);
  cprox_curve_free(c);
}

static void refused(blend f, double t1, const char *reason) {
  const cprox_smooth_curve given = functions(&f, 0.5, t1);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_smooth(&given, 0.5, t1), ws, &c), CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), reason)) fail_msg("\"%s\", not \"%s\"", cprox_workspace_error(ws), reason);
  assert_null(c);
  cprox_workspace_free(ws);
}

/* A bound of 2/3 of the truth, an error that is not stated, a number that is none: all show. */
CASE(what_is_false_is_refused_where_it_shows) {
  const blend good = {.a = 1.0, .w = 3.0, .b = 1.0, .k = 1.0, .c = 0.5, .spoilt_from = INFINITY, .sixth_factor = 1.0};
  blend f = good;
  f.sixth_factor = 0.66;
  refused(f, 2.0, "a bound of its sixth derivative or of its errors is false");
  f = good, f.noise = 1e-9;
  refused(f, 2.0, "a bound of its sixth derivative or of its errors is false");
  f = good, f.spoilt_from = 1.3;
  refused(f, 2.0, "the curve's first derivative is (");
  f = good, f.sixth_factor = NAN;
  refused(f, 2.0, "on [0.5, 2] the bound of the sixth derivative is nan");
  f = good, f.sixth_factor = -1.0;
  refused(f, 2.0, "on [0.5, 2] the bound of the sixth derivative is -");
  f = good, f.sixth_factor = INFINITY;
  refused(f, 2.0, "at t = 0.5 the curve needs pieces of ");
  f = good, f.w = 1e6;
  refused(f, 2.0, "would need more than 65536 pieces");
  f = good;
  refused(f, 0.5, "t0 = 0.5 is not below t1 = 0.5");
}

CASE(functions_that_are_missing_are_refused) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  blend f = {.a = 1.0, .w = 1.0, .spoilt_from = INFINITY, .sixth_factor = 1.0};
  const cprox_smooth_curve good = functions(&f, 1.0, 2.0);
  cprox_smooth_curve bad[6] = {good, good, good, good, good, good};
  bad[0].evaluate = NULL, bad[1].sixth = NULL, bad[2].error[1] = -1.0, bad[3].error[2] = NAN, bad[4].accuracy = 0.0;
  const char *const reason[5] = {
      "the function evaluate is NULL", "the function sixth is NULL", "error[1] is -1; it must be at least 0 and finite",
      "error[2] is nan; it must be at least 0 and finite", "the accuracy is 0; it must be above 0 and finite"};
  for (int i = 0; i < 5; i++) {
    assert_int_equal(curve_from(describe_smooth(&bad[i], 1, 2), ws, &c), CPROX_INVALID);
    assert_string_equal(cprox_workspace_error(ws), reason[i]);
  }
  assert_int_equal(curve_from(describe_smooth(NULL, 1, 2), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the curve's functions are NULL");
  assert_null(c);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
