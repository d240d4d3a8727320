/* SPDX-License-Identifier: BSD-3-Clause */
/* B-splines against the Cox-de Boor basis in long double. u = 2^-53, p the degree, M = max|control point of the span|.
 */
#include <stdlib.h>

#include "curve/curve.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/reference.h"

#define U 0x1p-53

static cprox_curve *compile(const test_spline *s) {
  cprox_curve *c = NULL;
  assert_int_equal(
      curve_from(describe_bspline(s->points, s->n_points, s->degree, s->knots, s->n_knots, s->t0, s->t1), NULL, &c),
      CPROX_OK);
  return c;
}

/* The span that a piece was made from. */
static size_t span_of(const test_spline *s, const cprox_curve *c, size_t piece) {
  size_t r = s->degree;
  while (!(s->knots[r] <= c->breaks[piece] && c->breaks[piece + 1] <= s->knots[r + 1])) r++;
  return r;
}

/* seed 201, 100,000 pieces and more: every point of the computed piece is within the piece's error of the exact curve.
 * The reference itself may be off by 8p roundings of long double. */
CASE(every_piece_is_within_its_error_of_the_spline) {
  rng r = rng_seed(201);
  double largest = 0.0;
  size_t offset = 0;
  for (size_t left = test_cases(100000); left > 0;) {
    const test_spline s = random_spline(&r, random_degree(&r));
    cprox_curve *c = compile(&s);
    const double p = (double)s.degree;
    for (size_t i = 0; i<c->n_pieces; i++, left -= left> 0) {
      const size_t span = span_of(&s, c, i);
      const double size = ref_largest(s.points + (span - s.degree), s.degree + 1);
      const double allowed = c->error[i] + 8.0 * p * 0x1p-64 * size;

      /* the contract: never more than 9 p u M; far from the origin the error is that of the span's own size */
      assert_true(c->error[i] <= 9.0 * p * U * size + 1e-160);
      offset += c->error[i] < 3.0 * p * U * size;

      /* at the ends and between, the parameter being a double and so exact in both */
      const double a = c->breaks[i], b = c->breaks[i + 1];
      const double t[4] = {a, b, rng_uniform(&r, a, b), fmin(a + random_parameter(&r) * (b - a), b)};
      for (size_t k = 0; k < 4; k++) {
        const long double at = ((long double)t[k] - a) / ((long double)b - a);
        const vec3l computed = ref_bezier(curve_piece(c, i), s.degree, at, 0);
        const vec3l exact = ref_bspline(s.points, s.degree, s.knots, span, t[k], 0);
        const double error = (double)ref_norm(ref_sub(exact, computed));
        assert_true(error <= allowed);
        largest = fmax(largest, error / allowed);
      }
    }
    cprox_curve_free(c);
  }
  print_message("largest conversion error: %.2f of its bound; %zu spans far from the origin\n", largest, offset);
  assert_true(largest > 0.05);
  assert_true(offset > 1000);
}

/* seed 202: pieces follow each other, begin at t0, end at t1 and never have length 0 */
CASE(pieces_cover_the_range_exactly) {
  rng r = rng_seed(202);
  for (size_t i = test_cases(20000); i-- > 0;) {
    const test_spline s = random_spline(&r, random_degree(&r));
    cprox_curve *c = compile(&s);
    double t0, t1;
    t0 = cprox_curve_get_info(c).t0, t1 = cprox_curve_get_info(c).t1;
    assert_true(t0 == s.t0 && t1 == s.t1);
    for (size_t k = 0; k < c->n_pieces; k++) {
      assert_true(c->breaks[k] < c->breaks[k + 1]);
      if (k > 0) {
        size_t knot = 0;
        while (knot < s.n_knots && s.knots[knot] != c->breaks[k]) knot++;
        assert_true(knot < s.n_knots);
      }
    }
    cprox_curve_free(c);
  }
}

/* seed 203, 100,000 parameters, knots and ends among them: (12p + 20) u M, of which 5p are the conversion's.
 * Derivatives: the conversion adds 2p · 5p and 4p(p-1) · 5p to the bounds of the Bézier test. */
CASE(evaluation_by_t_stays_within_its_bound) {
  rng r = rng_seed(203);
  for (size_t i = test_cases(20000); i-- > 0;) {
    const test_spline s = random_spline(&r, 1 + rng_index(&r, rng_index(&r, 8) ? 8 : 60));
    cprox_curve *c = compile(&s);
    const double p = (double)s.degree;
    for (size_t k = 0; k < 5; k++) {
      const double t = k == 0   ? s.t1
                       : k == 1 ? c->breaks[rng_index(&r, c->n_pieces)]
                                : fmin(rng_uniform(&r, s.t0, s.t1), s.t1);
      size_t piece = 0;
      while (piece + 1 < c->n_pieces && c->breaks[piece + 1] <= t) piece++;
      const size_t span = span_of(&s, c, piece);
      const double size = U * ref_largest(s.points + (span - s.degree), s.degree + 1);
      const double length = c->breaks[piece + 1] - c->breaks[piece];

      vec3 value, first, second;
      assert_int_equal(cprox_curve_evaluate(c, t, NULL, &value, &first, &second), CPROX_OK);
      assert_true(ref_error(ref_bspline(s.points, s.degree, s.knots, span, t, 0), value) <= (12 * p + 20) * size);
      const vec3l exact_first = ref_bspline(s.points, s.degree, s.knots, span, t, 1);
      const vec3l exact_second = ref_bspline(s.points, s.degree, s.knots, span, t, 2);
      assert_true(ref_error(exact_first, first) <= p * (24 * p + 16) * size / length);
      assert_true(ref_error(exact_second, second) <= p * (p - 1) * (48 * p + 28) * size / (length * length));
    }
    cprox_curve_free(c);
  }
}

/* seed 204, 20,000 parts: within 5p u M' of the computed piece's, M' that piece's largest control point */
CASE(control_points_of_a_part_lie_inside_one_piece) {
  rng r = rng_seed(204);
  for (size_t i = test_cases(20000); i-- > 0;) {
    const test_spline s = random_spline(&r, 1 + rng_index(&r, 8));
    cprox_curve *c = compile(&s);
    const size_t piece = rng_index(&r, c->n_pieces);
    const double low = c->breaks[piece], high = c->breaks[piece + 1];
    const double a = rng_index(&r, 3) ? rng_uniform(&r, low, high) : low;
    const double b = rng_index(&r, 3) ? fmin(rng_uniform(&r, a, high), high) : high;
    vec3 part[61];
    vec3l exact[61];
    if (a < b) {
      assert_int_equal(cprox_curve_control_points(c, a, b, NULL, part), CPROX_OK);
      const long double length = (long double)high - low;
      const vec3 *p = curve_piece(c, piece);
      ref_bezier_section(p, s.degree, (a - (long double)low) / length, (b - (long double)low) / length, exact);
      const double bound = 5.0 * (double)s.degree * U * ref_largest(p, s.degree + 1);
      for (size_t k = 0; k <= s.degree; k++) assert_true(ref_error(exact[k], part[k]) <= bound);
    }
    if (c->n_pieces > 1) {
      const double before = c->breaks[0], after = c->breaks[c->n_pieces];
      assert_int_equal(cprox_curve_control_points(c, before, after, NULL, part), CPROX_INVALID);
    }
    cprox_curve_free(c);
  }
}

/* seed 205: a spline on Bézier knots about the origin is that Bézier curve, bit by bit */
CASE(bezier_knots_give_the_bezier_curve) {
  rng r = rng_seed(205);
  for (size_t degree = 1; degree <= 60; degree++) {
    test_spline s = {.degree = degree, .n_points = degree + 1, .n_knots = 2 * degree + 2, .t0 = 0.0, .t1 = 1.0};
    for (size_t k = 0; k <= degree; k++) {
      s.points[k] = vec_scale(k % 2 ? 1.0 : -1.0, rng_unit(&r));
      s.knots[degree + 1 + k] = 1.0;
    }
    cprox_curve *c = compile(&s);
    assert_int_equal(c->n_pieces, 1);
    for (size_t k = 0; k <= degree; k++) assert_true(vec_equal(curve_piece(c, 0)[k], s.points[k]));
    cprox_curve_free(c);
  }
}

/* A double knot of a linear spline: the curve jumps from (1,0,0) to (5,0,0), and the right piece answers at the joint.
 */
CASE(a_curve_that_jumps_keeps_both_sides) {
  const vec3 p[4] = {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {6, 0, 0}};
  const double knots[6] = {0, 0, 1, 1, 2, 2};
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_bspline(p, 4, 1, knots, 6, 0.0, 2.0), NULL, &c), CPROX_OK);
  assert_int_equal(c->n_pieces, 2);
  assert_true(curve_piece(c, 0)[1].x == 1.0 && curve_piece(c, 1)[0].x == 5.0);
  vec3 at;
  assert_int_equal(cprox_curve_evaluate(c, 1.0, NULL, &at, NULL, NULL), CPROX_OK);
  assert_true(at.x == 5.0);
  vec3 low, high;
  low = cprox_curve_get_info(c).lowest, high = cprox_curve_get_info(c).highest;
  assert_true(low.x <= 0.0 && low.x > -1e-14 && high.x >= 6.0 && high.x < 6.0 + 1e-14);
  cprox_curve_free(c);
}

/* 100,000 control points: memory in proportion (the pieces themselves, and two capsules a piece at most four times
 * over), the answer right at the far end. */
CASE(a_hundred_thousand_control_points_are_taken) {
  const size_t n = 100000, degree = 3;
  vec3 *p = calloc(n, sizeof *p);
  double *knots = calloc(n + degree + 1, sizeof *knots);
  assert_non_null(p);
  assert_non_null(knots);
  for (size_t i = 0; i < n; i++) p[i] = vec((double)i * 1e-3, sin((double)i * 0.01), 0.0);
  for (size_t i = 0; i < n + degree + 1; i++) knots[i] = (double)i;
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_bspline(p, n, degree, knots, n + degree + 1, 3.0, (double)n), NULL, &c),
                   CPROX_OK);
  assert_int_equal(cprox_curve_get_info(c).n_pieces, n - degree);
  vec3 at;
  assert_int_equal(cprox_curve_evaluate(c, (double)n - 0.5, NULL, &at, NULL, NULL), CPROX_OK);
  const vec3l exact = ref_bspline(p, degree, knots, n - 1, (long double)n - 0.5L, 0);
  assert_true(ref_error(exact, at) <= 56 * U * vec_norm(at));
  cprox_curve_free(c);
  free(p);
  free(knots);
}

int main(void) {
  return cases_run(NULL, NULL);
}
