/* SPDX-License-Identifier: BSD-3-Clause */
/* Points, derivatives and sub-intervals of Bézier curves against de Casteljau in long double, whose own error is 1/2000
 * of every bound here. u = 2^-53, M = max|control point|, n the degree. */
#include "curve/curve.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/reference.h"

#define U 0x1p-53

static cprox_curve *bezier(const vec3 *p, size_t degree, double t0, double t1) {
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_bezier(p, degree + 1, t0, t1), NULL, &c), CPROX_OK);
  return c;
}

/* The constants of low degrees are the numbers that are computed for others. */
CASE(low_degrees_share_their_tables) {
  for (size_t degree = 1; degree <= CURVE_LOW_DEGREE; degree++) {
    double tables[64];
    assert_true(curve_tables_size(degree) <= 64);
    curve_fill_tables(degree, tables);
    for (size_t k = 0; k < curve_tables_size(degree); k++) assert_true(curve_low_tables[degree][k] == tables[k]);
  }
}

/* What each takes beside the block's head of the allocator. */
CASE(curves_take_few_bytes) {
  assert_true(sizeof(cprox_curve) + curve_arrays_size(5, 1) <= 232);
  for (size_t n = 100; n <= 1100; n += 100)
    assert_true((double)(sizeof(cprox_curve) + curve_arrays_size(5, n)) <= 180.0 * (double)n);
}

/* seed 101, 100,000 cases. Value: (3n + 8) u M, derived beside the function. The derivatives are n(d1 - d0) and so on
 * of points that are off by 3n u M each: n (6n + 8) u M and n(n-1)(12n + 12) u M. */
CASE(a_bezier_point_and_its_derivatives_stay_within_their_bounds) {
  rng r = rng_seed(101);
  double largest = 0.0;
  for (size_t i = test_cases(100000); i-- > 0;) {
    const size_t degree = random_degree(&r);
    const double n = (double)degree;
    vec3 p[61], value, first, second;
    random_points(&r, degree + 1, p);
    const double s = random_parameter(&r), size = U * ref_largest(p, degree + 1);
    cprox_curve *c = bezier(p, degree, 0.0, 1.0);
    curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, degree, curve_binomial(c), s, &value, &first, &second);
    cprox_curve_free(c);

    const double error = (double)ref_error(ref_bezier(p, degree, s, 0), value);
    assert_true(error <= (3 * n + 8) * size);
    assert_true(ref_error(ref_bezier(p, degree, s, 1), first) <= n * (6 * n + 8) * size);
    assert_true(ref_error(ref_bezier(p, degree, s, 2), second) <= n * (n - 1) * (12 * n + 12) * size);
    if (size > 0.0) largest = fmax(largest, error / ((3 * n + 8) * size));
  }
  print_message("largest error of a point: %.2f of its bound\n", largest);
  assert_true(largest > 0.05);
}

/* seed 102, 20,000 cases */
CASE(ends_are_exact_and_a_stride_changes_nothing) {
  rng r = rng_seed(102);
  for (size_t i = test_cases(20000); i-- > 0;) {
    const size_t degree = random_degree(&r);
    vec3 p[61], a, b, da, db, dda, ddb;
    double x[61], y[61], z[61];
    random_points(&r, degree + 1, p);
    for (size_t k = 0; k <= degree; k++) x[k] = p[k].x, y[k] = p[k].y, z[k] = p[k].z;
    cprox_curve *c = bezier(p, degree, -1.0, 3.0);
    const double s = random_parameter(&r);
    curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, degree, curve_binomial(c), s, &a, &da, &dda);
    curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(c), s, &b, &db, &ddb);
    assert_true(vec_equal(a, b) && vec_equal(da, db) && vec_equal(dda, ddb));

    assert_int_equal(cprox_curve_evaluate(c, -1.0, NULL, &a, NULL, NULL), CPROX_OK);
    assert_int_equal(cprox_curve_evaluate(c, 3.0, NULL, &b, NULL, NULL), CPROX_OK);
    assert_true(vec_equal(a, p[0]) && vec_equal(b, p[degree]));
    cprox_curve_free(c);
  }
}

/* Powers of s down to 1e-300^58 vanish on the way; what is left must be the true point. */
CASE(powers_that_underflow_do_no_harm) {
  rng r = rng_seed(103);
  vec3 p[61], value;
  for (int exponent = -1074; exponent < 0; exponent++) {
    random_points(&r, 61, p);
    cprox_curve *c = bezier(p, 60, 0.0, 1.0);
    const double s = ldexp(1.0, exponent);
    curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, 60, curve_binomial(c), s, &value, NULL, NULL);
    assert_true(ref_error(ref_bezier(p, 60, s, 0), value) <= 188 * U * ref_largest(p, 61));
    cprox_curve_free(c);
  }
}

/* seed 104, 100,000 cases, (6n + 20) u M as the header promises; derivatives by t: rounding s moves them by at most
 * 2u times the next derivative, 2n·n M and 4n·n·n M, and the quotient rounds twice. */
CASE(evaluation_by_t_stays_within_its_bound) {
  rng r = rng_seed(104);
  for (size_t i = test_cases(100000); i-- > 0;) {
    const size_t degree = random_degree(&r);
    const double n = (double)degree;
    vec3 p[61], value, first, second;
    random_points(&r, degree + 1, p);
    const double t0 = rng_awkward(&r, 100.0), t1 = t0 + rng_log_uniform(&r, 1e-3, 1e3);
    const double t = fmin(fmax(t0 + random_parameter(&r) * (t1 - t0), t0), t1);
    cprox_curve *c = bezier(p, degree, t0, t1);
    assert_int_equal(cprox_curve_evaluate(c, t, NULL, &value, &first, &second), CPROX_OK);
    cprox_curve_free(c);

    const long double length = (long double)t1 - t0, s = ((long double)t - t0) / length;
    const double size = U * ref_largest(p, degree + 1);
    assert_true(ref_error(ref_bezier(p, degree, s, 0), value) <= (6 * n + 20) * size);
    const vec3l exact_first = ref_scale(1 / length, ref_bezier(p, degree, s, 1));
    const vec3l exact_second = ref_scale(1 / length / length, ref_bezier(p, degree, s, 2));
    assert_true(ref_error(exact_first, first) <= n * (14 * n + 16) * size / length);
    assert_true(ref_error(exact_second, second) <= n * (n - 1) * (28 * n + 28) * size / (length * length));
  }
}

/* seed 105, 100,000 sub-intervals, 5n u M a control point (curve_blossom). The reference cuts twice, in long double, on
 * doubles a and b that share a binade with the ends: 2000 times finer than the bound. */
CASE(control_points_of_a_part_stay_within_their_bound) {
  rng r = rng_seed(105);
  double largest = 0.0;
  for (size_t i = test_cases(100000); i-- > 0;) {
    const size_t degree = 1 + rng_index(&r, rng_index(&r, 16) ? 10 : 60);
    vec3 p[61], part[61];
    vec3l exact[61];
    random_points(&r, degree + 1, p);
    const double t0 = rng_index(&r, 2) ? 0.0 : rng_awkward(&r, 2.0), t1 = t0 + 1.0;
    double a = fmin(fmax(t0 + random_parameter(&r), t0), t1), b = fmin(fmax(t0 + random_parameter(&r), t0), t1);
    if (a > b) {
      const double swap = a;
      a = b, b = swap;
    }
    if (!(a < b)) continue;
    cprox_curve *c = bezier(p, degree, t0, t1);
    assert_int_equal(cprox_curve_control_points(c, a, b, NULL, part), CPROX_OK);
    cprox_curve_free(c);

    const long double length = (long double)t1 - t0;
    const double bound = 5.0 * (double)degree * U * ref_largest(p, degree + 1);
    ref_bezier_section(p, degree, (a - (long double)t0) / length, (b - (long double)t0) / length, exact);
    for (size_t k = 0; k <= degree; k++) {
      const double error = (double)ref_error(exact[k], part[k]);
      assert_true(error <= bound);
      if (bound > 0.0) largest = fmax(largest, error / bound);
    }
  }
  print_message("largest error of a part's control point: %.2f of its bound\n", largest);
  assert_true(largest > 0.05);
}

CASE(the_whole_range_gives_the_control_points_back) {
  rng r = rng_seed(106);
  for (size_t degree = 1; degree <= 60; degree++) {
    vec3 p[61], part[61], low, high;
    random_points(&r, degree + 1, p);
    cprox_curve *c = bezier(p, degree, 0.3, 0.7);
    assert_int_equal(cprox_curve_control_points(c, 0.3, 0.7, NULL, part), CPROX_OK);
    for (size_t k = 0; k <= degree; k++) assert_true(vec_equal(p[k], part[k]));

    /* and the box of a Bézier curve is that of its points, exactly */
    low = cprox_curve_get_info(c).lowest, high = cprox_curve_get_info(c).highest;
    double least = p[0].x, most = p[0].x;
    for (size_t k = 1; k <= degree; k++) least = fmin(least, p[k].x), most = fmax(most, p[k].x);
    assert_true(low.x == least && high.x == most);

    double t0, t1;
    t0 = cprox_curve_get_info(c).t0, t1 = cprox_curve_get_info(c).t1;
    assert_true(t0 == 0.3 && t1 == 0.7);
    assert_int_equal(cprox_curve_get_info(c).degree, degree);
    assert_int_equal(cprox_curve_get_info(c).n_pieces, 1);
    cprox_curve_free(c);
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
