/* SPDX-License-Identifier: BSD-3-Clause */
/* Trigonometric series against themselves in long double: every point of the compiled pieces is within their error. */
#include <string.h>

#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"
#include "support/reference.h"

/* Long double's unit roundoff. */
#define UL (0.5L * LDBL_EPSILON)

/* psi(t); *reference is a bound of its own error: an angle kt is off by its rounding, a term by a few more. */
static quad3 series(const vec3 *c, size_t degree, double t, double *reference) {
  quad3 sum = {{(quad)c[0].x, (quad)c[0].y, (quad)c[0].z}};
  double size = vec_norm(c[0]);
  for (size_t k = 1; k <= degree; k++) {
    const long double angle = (long double)k * t;
    sum = quad_axpy(quad_axpy(sum, cosl(angle), c[2 * k - 1]), sinl(angle), c[2 * k]);
    size += (4.0 + (double)fabsl(angle)) * (vec_norm(c[2 * k - 1]) + vec_norm(c[2 * k]));
  }
  *reference = (double)UL * size;
  return sum;
}

static void random_series(rng *r, size_t degree, vec3 *c) {
  const double scale = rng_log_uniform(r, 1e-6, 1e6), fall = rng_uniform(r, 0.2, 1.0);
  c[0] = vec_scale(rng_index(r, 2) ? 0.0 : scale * rng_log_uniform(r, 1e-3, 1e6), rng_unit(r));
  for (size_t i = 1; i <= 2 * degree; i++) {
    c[i] = rng_in_cube(r, scale * pow(fall, (double)((i - 1) / 2)));
    if (rng_index(r, 4) == 0) c[i] = vec(0, 0, 0);
    if (rng_index(r, 8) == 0) c[i].z = 0.0;
  }
}

/* seed 511, 4000 series, 40 parameters each. The bound is no margin: the remainder of an ellipse reaches it. */
CASE(every_piece_is_within_its_error_of_the_series) {
  rng r = rng_seed(511);
  double largest = 0.0, largest_rounding = 0.0;
  size_t pieces = 0;
  for (size_t i = test_cases(4000); i-- > 0;) {
    vec3 c[121];
    const size_t degree = 1 + (rng_index(&r, 8) ? rng_index(&r, 6) : rng_index(&r, 60));
    random_series(&r, degree, c);
    const double t0 = rng_index(&r, 4) ? rng_uniform(&r, -7.0, 7.0) : rng_awkward(&r, 100.0);
    const double t1 = t0 + rng_log_uniform(&r, 1e-6, 7.0);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_trigonometric(c, 2 * degree + 1, t0, t1), NULL, &curve), CPROX_OK);
    pieces += curve->n_pieces;
    for (int k = 0; k < 40; k++) {
      double t = quad_parameter(curve, &r), reference;
      size_t piece = quad_piece_at(curve, t);
      if (k % 4 == 0) {
        piece = rng_index(&r, curve->n_pieces);
        t = 0.5 * curve->breaks[piece] + 0.5 * curve->breaks[piece + 1];
      }
      const quad3 should = series(c, degree, t, &reference), is = quad_piece(curve, piece, t);
      const double error = quad_distance(should, is);
      if (!(error <= curve->error[piece] + reference))
        fail_msg("degree %zu, t = %.17g: off by %g, the bound is %g", degree, t, error, curve->error[piece]);
      if (reference > 0.05 * curve->error[piece]) continue;
      double *which = t == curve->breaks[piece] ? &largest_rounding : &largest;
      *which = fmax(*which, error / curve->error[piece]);
    }
    cprox_curve_free(curve);
  }
  print_message("largest error: %.2f of its bound; %zu pieces\n", largest, pieces);
  assert_true(largest > 0.5 && largest_rounding > 0.01);
}

/* seed 512, 2000 parameters at 1e9 and more. With k <= 7 an angle kt has at most 56 digits: more than a double holds,
 * none too many for a long double, whose cosine is the reference. */
CASE(parameters_far_from_zero_cost_nothing) {
  rng r = rng_seed(512);
  for (size_t i = test_cases(2000); i-- > 0;) {
    const double t0 = rng_log_uniform(&r, 1e9, 1e12);
    const size_t degree = 1 + rng_index(&r, 7);
    vec3 c[15];
    for (size_t k = 0; k <= 2 * degree; k++) c[k] = k == 0 ? vec(0, 0, 0) : rng_in_cube(&r, 1.0);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_trigonometric(c, 2 * degree + 1, t0, t0 + 0.1), NULL, &curve), CPROX_OK);
    for (int k = 0; k < 2; k++) {
      const size_t piece = k == 0 ? 0 : curve->n_pieces - 1;
      const double t = curve->breaks[k == 0 ? 0 : curve->n_pieces];
      double unused;
      const double error = quad_distance(series(c, degree, t, &unused), quad_piece(curve, piece, t));
      assert_true(error <= curve->error[piece] + 20.0 * (double)UL * (double)degree);
      assert_true(curve->error[piece] < 1e-11);
    }
    cprox_curve_free(curve);
  }
}

/* The remainder aimed at is reached, and so is the number of pieces that the header gives for a circle. */
CASE(a_circle_takes_about_a_hundred_pieces) {
  const vec3 c[3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_trigonometric(c, 3, 0, 6.283185307179586), NULL, &curve), CPROX_OK);
  print_message("a circle takes %u pieces, error %g of its radius\n", curve->n_pieces,
                0.5 * cprox_curve_get_info(curve).error);
  assert_true(cprox_curve_get_info(curve).error < 2.0 * 1.1e-13);
  assert_in_range(curve->n_pieces, 100, 160);
  assert_int_equal(cprox_curve_get_info(curve).degree, 5);
  cprox_curve_free(curve);
}

/* Terms that are all 0 are a point. */
CASE(a_series_of_zeros_stands_still) {
  const vec3 c[5] = {{1, 2, 3}};
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_trigonometric(c, 5, 0, 6.0), NULL, &curve), CPROX_OK);
  for (size_t i = 0; i < curve->n_pieces; i++)
    for (size_t j = 0; j < 6; j++) assert_memory_equal(&curve_piece(curve, i)[j], &c[0], sizeof c[0]);
  cprox_curve_free(curve);
}

static void refused(const vec3 *c, size_t n, double t0, double t1, const char *reason) {
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_trigonometric(c, n, t0, t1), workspace, &curve), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), reason);
  assert_int_equal(curve_from(describe_trigonometric(c, n, t0, t1), NULL, &curve), CPROX_INVALID);
  assert_null(curve);
  cprox_workspace_free(workspace);
}

CASE(bad_series_are_refused) {
  vec3 c[123] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  refused(c, 0, 0, 1, "there is no coefficient; a curve needs at least 1");
  refused(c, 1, 0, 1, "the trigonometric series has a constant but no terms");
  refused(c, 2, 0, 1, "a trigonometric series has an odd number of coefficients (constant, cos t, sin t, …), got 2");
  refused(c, 123, 0, 1, "there are 123 coefficients, above 121");
  refused(NULL, 3, 0, 1, "the coefficients are NULL");
  refused(c, 3, 1, 1, "t0 = 1 is not below t1 = 1");
  refused(c, 3, NAN, 1, "the parameter range [nan, 1] is not finite or beyond 1e+150");
  refused(c, 3, 1e16, 1e16 + 2.0,
          "at t = 1e+16 the curve needs pieces of 0, shorter than the steps of double arithmetic");
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_trigonometric(c, 3, 0, 1e9), workspace, &curve), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(workspace), "pieces of the series, above 65536"));
  assert_int_equal(curve_from(describe_trigonometric(c, 3, 0, 1), workspace, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "the pointer for the new curve is NULL");
  cprox_workspace_free(workspace);
  c[2].x = 1e80;
  refused(c, 3, 0, 1, "coefficient 2 is longer than 1e+75 m");
  c[2].x = NAN;
  refused(c, 3, 0, 1, "coefficient 2 is (nan, 1, 0), not finite");
}

int main(void) {
  return cases_run(NULL, NULL);
}
