/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves end to end are the curves they are made of: point for point in 113 bits, at their own parameters. */
#include "base/rounding.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"

static cprox_curve *random_curve(rng *r, double t0) {
  cprox_curve *c = NULL;
  const double t1 = t0 + rng_log_uniform(r, 1e-2, 3.0), scale = rng_log_uniform(r, 1e-6, 1e6);
  cprox_status status = CPROX_OK;
  vec3 p[61];
  switch (rng_index(r, 4)) {
    case 0:
      status = curve_from(describe_clothoid(rng_in_cube(r, scale), rng_uniform(r, -3, 3), rng_uniform(r, -2, 2),
                                            rng_uniform(r, -2, 2), t0, t1),
                          NULL, &c);
      break;
    case 1:
      for (int i = 0; i < 3; i++) p[i] = rng_in_cube(r, scale);
      status = curve_from(describe_trigonometric(p, 3, t0, t1), NULL, &c);
      break;
    default: {
      const size_t degree = random_degree(r);
      random_points(r, degree + 1, p);
      status = curve_from(describe_bezier(p, degree + 1, t0, t1), NULL, &c);
    }
  }
  assert_int_equal(status, CPROX_OK);
  return c;
}

/* Bernstein's sum at s, by Horner's rule. */
static quad3 bernstein(const vec3 *p, size_t degree, quad s) {
  quad3 sum = {{(quad)p[0].x, (quad)p[0].y, (quad)p[0].z}};
  quad weight = 1;
  for (size_t j = 1; j <= degree; j++) {
    weight = weight * s * (quad)(degree - j + 1) / (quad)j;
    for (int k = 0; k < 3; k++) sum.k[k] *= (quad)1 - s;
    sum = quad_axpy(sum, weight, p[j]);
  }
  return sum;
}

/* seed 621, 1400 curves of 1 … 5, about 80 points each. */
CASE(the_whole_is_its_parts) {
  rng r = rng_seed(621);
  double largest = 0.0, largest_moved = 0.0;
  for (size_t i = test_cases(1400); i-- > 0;) {
    cprox_curve *part[5], *whole = NULL;
    double ends[6] = {rng_uniform(&r, -10.0, 10.0)}, from = rng_uniform(&r, -10.0, 10.0);
    const size_t n = 1 + rng_index(&r, 5);
    const bool own = rng_index(&r, 2);
    for (size_t k = 0; k < n; k++) {
      part[k] = random_curve(&r, from);
      from = part[k]->breaks[part[k]->n_pieces];
      ends[k + 1] = ends[k] + rng_log_uniform(&r, 1e-2, 3.0);
    }
    assert_int_equal(
        curve_from(describe_piecewise((const cprox_curve *const *)part, n, own ? NULL : ends, INFINITY), NULL, &whole),
        CPROX_OK);
    size_t first = 0, last = 0;
    for (size_t k = 0; k < n; k++, first = last) {
      const cprox_curve *p = part[k];
      last = first + p->n_pieces;
      const quad a = whole->breaks[first], b = whole->breaks[last], to = p->breaks[0], end = p->breaks[p->n_pieces];
      for (int point = 0; point < 80 / (int)n; point++) {
        const size_t piece = rng_index(&r, p->n_pieces);
        const double s = random_parameter(&r), left = whole->breaks[first + piece];
        const double t = fmin(left + s * (whole->breaks[first + piece + 1] - left), whole->breaks[first + piece + 1]);
        /* the part's own parameter, in 113 bits; the rounding of its argument to double is avoided by its own pieces */
        const quad mine = own ? (quad)t : to + ((quad)t - a) / (b - a) * (end - to);
        const quad length = (quad)p->breaks[piece + 1] - (quad)p->breaks[piece];
        const quad local = (mine - (quad)p->breaks[piece]) / length;
        const quad3 should = bernstein(curve_piece(p, piece), p->degree, local);
        const double error = quad_distance(should, quad_piece(whole, first + piece, t));
        const double bound = whole->error[first + piece] - p->error[piece];
        double size = 0.0;
        for (size_t j = 0; j <= p->degree; j++) size = fmax(size, vec_norm(curve_piece(p, piece)[j]));
        const double reference = 1000.0 * QUAD_U * size * (own ? 1.0 : 100.0) + 2.0 * ROUND_U * p->error[piece];
        if (!(error <= bound + reference))
          fail_msg("part %zu of %zu, piece %zu, t = %.17g: off by %g, the bound is %g", k, n, piece, t, error, bound);
        if (reference > 0.05 * bound) continue;
        double *which = own ? &largest : &largest_moved;
        *which = fmax(*which, error / bound);
      }
    }
    assert_int_equal(last, whole->n_pieces);
    for (size_t k = 0; k < n; k++) cprox_curve_free(part[k]);
    cprox_curve_free(whole);
  }
  print_message("largest error: %.2f of its bound, %.2f where ranges moved\n", largest, largest_moved);
  assert_true(largest > 0.3);
}

/* A line, a jump, a line: the point between the two is nearer to neither end than both are. */
CASE(a_jump_is_not_bridged) {
  const vec3 a[2] = {{0, 0, 0}, {1, 0, 0}}, b[2] = {{1, 2, 0}, {2, 2, 0}};
  cprox_curve *part[2] = {NULL, NULL}, *whole = NULL;
  assert_int_equal(curve_from(describe_bezier(a, 2, 0, 1), NULL, &part[0]), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(b, 2, 0, 1), NULL, &part[1]), CPROX_OK);
  const double ends[3] = {0, 1, 3};
  assert_int_equal(curve_from(describe_piecewise((const cprox_curve *const *)part, 2, ends, INFINITY), NULL, &whole),
                   CPROX_OK);
  vec3 x;
  assert_int_equal(cprox_curve_evaluate(whole, 2.0, NULL, &x, NULL, NULL), CPROX_OK);
  assert_true(vec_equal(x, vec(1.5, 2, 0)));
  assert_int_equal(cprox_curve_evaluate(whole, 0.5, NULL, &x, NULL, NULL), CPROX_OK);
  assert_true(vec_equal(x, vec(0.5, 0, 0)));
  cprox_curve_free(whole);
  cprox_curve_free(part[1]);
  cprox_curve_free(part[0]);
}

static void refused(const cprox_curve *const *curves, size_t n, const double *ends, double gap, const char *reason) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_piecewise(curves, n, ends, gap), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), reason);
  assert_null(c);
  cprox_workspace_free(ws);
}

CASE(bad_pieces_are_refused) {
  const vec3 a[2] = {{0, 0, 0}, {1, 0, 0}}, b[2] = {{1, 2, 0}, {2, 2, 0}};
  cprox_curve *part[3] = {NULL, NULL, NULL};
  assert_int_equal(curve_from(describe_bezier(a, 2, 0, 1), NULL, &part[0]), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(b, 2, 1, 2), NULL, &part[1]), CPROX_OK);
  const cprox_curve *const *curves = (const cprox_curve *const *)part;
  refused(curves, 0, NULL, 0, "there is no curve to put end to end");
  refused(NULL, 2, NULL, 0, "the curves are NULL");
  refused(curves, 3, NULL, INFINITY, "curve 2 is NULL");
  refused(curves, 2, NULL, NAN, "the largest gap is nan; it must be at least 0");
  refused(curves, 2, NULL, 1.5, "curves 0 and 1 do not join: they are 2 m apart, above 1.5");
  const double empty[3] = {0, 1, 1}, infinite[3] = {0, 1, INFINITY};
  refused(curves, 2, empty, INFINITY, "the range of curve 1 is empty: it ends at 1, after 1");
  refused(curves, 2, infinite, INFINITY, "the range [1, inf] of curve 1 is not finite or beyond 1e+150");
  const cprox_curve *turned[2] = {part[1], part[0]};
  refused(turned, 2, NULL, INFINITY, "curve 0 ends at t = 2, curve 1 begins at t = 0");
  cprox_curve_free(part[1]);
  cprox_curve_free(part[0]);
}

int main(void) {
  return cases_run(NULL, NULL);
}
