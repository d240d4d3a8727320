/* SPDX-License-Identifier: BSD-3-Clause */
/* What is wrong is refused in one message that says what and where, *curve stays as it was, and nothing leaks. */
#include <stdio.h>
#include <string.h>

#include "curve/curve.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"

static cprox_workspace *workspace;

/* A good spline of degree 2, to be spoilt. */
typedef struct good_spline {
  vec3 points[5];
  double knots[8];
} good_spline;

static const good_spline good = {.points = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 0, 1}, {4, 0, 0}},
                                 .knots = {0, 0, 0, 0.4, 0.5, 1, 1, 1}};

static void refused(cprox_status status, const cprox_curve *curve, const char *reason) {
  assert_int_equal(status, CPROX_INVALID);
  assert_ptr_equal(curve, workspace); /* the mark that was there before */
  assert_string_equal(cprox_workspace_error(workspace), reason);
}

static void bezier_refused(const vec3 *points, size_t n, double t0, double t1, const char *reason) {
  cprox_curve *curve = (cprox_curve *)workspace;
  const size_t live = allocations_live();
  refused(curve_from(describe_bezier(points, n, t0, t1), workspace, &curve), curve, reason);
  assert_int_equal(curve_from(describe_bezier(points, n, t0, t1), NULL, &curve), CPROX_INVALID);
  assert_int_equal(allocations_live(), live);
}

static void bspline_refused(const good_spline *s, size_t n, size_t degree, size_t n_knots, double t0, double t1,
                            const char *reason) {
  cprox_curve *curve = (cprox_curve *)workspace;
  const size_t live = allocations_live();
  refused(curve_from(describe_bspline(s->points, n, degree, s->knots, n_knots, t0, t1), workspace, &curve), curve,
          reason);
  assert_int_equal(curve_from(describe_bspline(s->points, n, degree, s->knots, n_knots, t0, t1), NULL, &curve),
                   CPROX_INVALID);
  assert_int_equal(allocations_live(), live);
}

CASE(bad_control_points_are_refused) {
  vec3 many[62] = {{0, 0, 0}};
  bezier_refused(NULL, 3, 0, 1, "the control points are NULL");
  bezier_refused(NULL, 0, 0, 1, "a curve needs at least 2 control points, got 0");
  bezier_refused(many, 1, 0, 1, "a curve needs at least 2 control points, got 1");
  bezier_refused(many, 62, 0, 1, "a Bézier curve has at most 61 control points (degree 60), got 62");
  const double spoilt[3] = {NAN, INFINITY, -INFINITY};
  const char *const text[3] = {"nan", "inf", "-inf"};
  for (size_t k = 0; k < 3; k++) {
    char reason[100];
    vec3 points[4] = {{0, 0, 0}, {1, 2, 3}, {1, 2, 3}, {0, 0, 0}};
    good_spline s = good;
    points[2].y = s.points[3].y = spoilt[k];
    snprintf(reason, sizeof reason, "control point 2 is (1, %s, 3), not finite", text[k]);
    bezier_refused(points, 4, 0, 1, reason);
    snprintf(reason, sizeof reason, "control point 3 is (3, %s, 1), not finite", text[k]);
    bspline_refused(&s, 5, 2, 8, 0, 1, reason);
  }
  many[1].z = -2e150;
  bezier_refused(many, 3, 0, 1, "control point 1 is (0, 0, -2e+150), beyond 1e+150 m");
}

CASE(bad_ranges_are_refused) {
  const vec3 points[2] = {{0, 0, 0}, {1, 1, 1}};
  bezier_refused(points, 2, 1, 1, "t0 = 1 is not below t1 = 1");
  bezier_refused(points, 2, 2, 1, "t0 = 2 is not below t1 = 1");
  bezier_refused(points, 2, NAN, 1, "the parameter range [nan, 1] is not finite or beyond 1e+150");
  bezier_refused(points, 2, 0, INFINITY, "the parameter range [0, inf] is not finite or beyond 1e+150");
  bezier_refused(points, 2, -1e151, 0, "the parameter range [-1e+151, 0] is not finite or beyond 1e+150");
  bspline_refused(&good, 5, 2, 8, 0.5, 0.5, "t0 = 0.5 is not below t1 = 0.5");
  bspline_refused(&good, 5, 2, 8, -0.1, 0.5, "[t0, t1] = [-0.1, 0.5] leaves the spline's domain [0, 1]");
  bspline_refused(&good, 5, 2, 8, 0.5, 1.5, "[t0, t1] = [0.5, 1.5] leaves the spline's domain [0, 1]");

  /* knots before the domain are no part of it */
  const good_spline open = {.points = {{0, 0, 0}}, .knots = {0, 1, 2, 3, 4, 5, 6, 7}};
  bspline_refused(&open, 5, 2, 8, 1, 5, "[t0, t1] = [1, 5] leaves the spline's domain [2, 5]");
  bspline_refused(&open, 5, 2, 8, 2, 6, "[t0, t1] = [2, 6] leaves the spline's domain [2, 5]");
}

CASE(bad_degrees_and_knots_are_refused) {
  bspline_refused(&good, 5, 0, 6, 0, 1, "the degree is 0; a curve needs at least 1");
  bspline_refused(&good, 5, 61, 67, 0, 1, "the degree is 61, above 60");
  bspline_refused(&good, 2, 2, 5, 0, 1, "a B-spline of degree 2 needs at least 3 control points, got 2");
  bspline_refused(&good, 5, 2, 7, 0, 1, "5 control points of degree 2 need 8 knots, got 7");
  bspline_refused(&good, 5, 2, 9, 0, 1, "5 control points of degree 2 need 8 knots, got 9");
  good_spline s = good;
  s.knots[4] = 0.3;
  bspline_refused(&s, 5, 2, 8, 0, 1, "knot 4 is 0.3, below knot 3 at 0.4");
  s.knots[4] = NAN;
  bspline_refused(&s, 5, 2, 8, 0, 1, "knot 4 is nan, not finite or beyond 1e+150");
  s.knots[4] = INFINITY;
  bspline_refused(&s, 5, 2, 8, 0, 1, "knot 4 is inf, not finite or beyond 1e+150");
  for (size_t i = 0; i < 8; i++) s.knots[i] = 0.5;
  bspline_refused(&s, 5, 2, 8, 0, 1, "the spline's domain is empty: knots 2 to 5 are all 0.5");
  cprox_curve *curve = (cprox_curve *)workspace;
  refused(curve_from(describe_bspline(good.points, 5, 2, NULL, 8, 0, 1), workspace, &curve), curve,
          "the knots are NULL");
  refused(curve_from(describe_bspline(good.points, 5, 2, NULL, 0, 0, 1), workspace, &curve), curve,
          "5 control points of degree 2 need 8 knots, got 0");
}

static void polynomial_refused(const vec3 *c, size_t n, double t0, double t1, const char *reason) {
  cprox_curve *curve = (cprox_curve *)workspace;
  const size_t live = allocations_live();
  refused(curve_from(describe_polynomial(c, n, t0, t1), workspace, &curve), curve, reason);
  assert_int_equal(curve_from(describe_polynomial(c, n, t0, t1), NULL, &curve), CPROX_INVALID);
  assert_int_equal(allocations_live(), live);
}

CASE(bad_polynomials_are_refused) {
  vec3 c[62] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  polynomial_refused(c, 0, 0, 1, "there is no coefficient; a curve needs at least 1");
  polynomial_refused(c, 62, 0, 1, "there are 62 coefficients, above 61");
  polynomial_refused(NULL, 3, 0, 1, "the coefficients are NULL");
  polynomial_refused(c, 3, 1, 1, "t0 = 1 is not below t1 = 1");
  polynomial_refused(c, 3, NAN, 1, "the parameter range [nan, 1] is not finite or beyond 1e+150");
  polynomial_refused(c, 3, -1e100, 0, "coefficient 2 is too large for |t| up to 1e+100: its term may exceed 1e+150 m");
  c[0].x = c[1].x = 9e149;
  polynomial_refused(c, 3, 0, 0.75, "on [0, 0.75] the curve goes beyond 1e+150 m");
  c[1].x = 4;
  c[1].y = NAN;
  polynomial_refused(c, 3, 0, 1, "coefficient 1 is (4, nan, 6), not finite");
  c[1].y = -2e150;
  polynomial_refused(c, 3, 0, 1, "coefficient 1 is (4, -2e+150, 6), beyond 1e+150 m");
}

CASE(bad_legendre_series_are_refused) {
  cprox_curve *curve = (cprox_curve *)workspace;
  const size_t live = allocations_live();
  vec3 c[62] = {{1, 2, 3}, {4, 5, 6}, {9e149, 0, 0}, {9e149, 0, 0}};
  refused(curve_from(describe_legendre(c, 0, 0, 1), workspace, &curve), curve,
          "there is no coefficient; a curve needs at least 1");
  refused(curve_from(describe_legendre(c, 62, 0, 1), workspace, &curve), curve, "there are 62 coefficients, above 61");
  refused(curve_from(describe_legendre(NULL, 2, 0, 1), workspace, &curve), curve, "the coefficients are NULL");
  refused(curve_from(describe_legendre(c, 2, 2, 1), workspace, &curve), curve, "t0 = 2 is not below t1 = 1");
  refused(curve_from(describe_legendre(c, 4, 0, 1), workspace, &curve), curve,
          "on [0, 1] the curve goes beyond 1e+150 m");
  c[1].z = INFINITY;
  refused(curve_from(describe_legendre(c, 2, 0, 1), workspace, &curve), curve,
          "coefficient 1 is (4, 5, inf), not finite");
  refused(curve_from(describe_legendre(c, 2, 0, 1), workspace, NULL), curve, "the pointer for the new curve is NULL");
  assert_int_equal(allocations_live(), live);
}

static void lagrange_refused(const vec3 *y, const double *x, size_t n, const char *reason) {
  cprox_curve *curve = (cprox_curve *)workspace;
  const size_t live = allocations_live();
  refused(curve_from(describe_lagrange(y, x, n, 0, 1), workspace, &curve), curve, reason);
  assert_int_equal(curve_from(describe_lagrange(y, x, n, 0, 1), NULL, &curve), CPROX_INVALID);
  assert_int_equal(allocations_live(), live);
}

CASE(bad_nodes_and_values_are_refused) {
  vec3 y[62] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  double x[62] = {0, 0.5, 1};
  lagrange_refused(y, x, 0, "there is no point; a curve needs at least 1");
  lagrange_refused(y, x, 62, "there are 62 points, above 61");
  lagrange_refused(NULL, x, 3, "the points are NULL");
  lagrange_refused(y, NULL, 3, "the nodes are NULL");
  x[2] = 0.0;
  lagrange_refused(y, x, 3, "nodes 0 and 2 are both 0; nodes must differ");
  x[2] = 1e-120;
  lagrange_refused(y, x, 3, "nodes 0 and 2, 0 and 1e-120, are too close together");
  x[2] = 1e-90;
  x[3] = 2e-90;
  lagrange_refused(y, x, 4, "between its nodes the curve may go beyond 1e+150 m: they are too unevenly placed");
  x[2] = NAN;
  lagrange_refused(y, x, 3, "node 2 is nan, not finite or beyond 1e+150");
  x[2] = 1;
  y[2].x = NAN;
  lagrange_refused(y, x, 3, "point 2 is (nan, 8, 9), not finite");
  cprox_curve *curve = (cprox_curve *)workspace;
  refused(curve_from(describe_lagrange(y, x, 2, 1, 1), workspace, &curve), curve, "t0 = 1 is not below t1 = 1");
  refused(curve_from(describe_lagrange(y, x, 2, 0, 1), workspace, NULL), curve,
          "the pointer for the new curve is NULL");
}

CASE(a_missing_result_pointer_is_refused) {
  assert_int_equal(curve_from(describe_bezier(good.points, 5, 0, 1), workspace, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "the pointer for the new curve is NULL");
  assert_int_equal(curve_from(describe_polynomial(good.points, 5, 0, 1), workspace, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "the pointer for the new curve is NULL");
  assert_int_equal(curve_from(describe_bspline(good.points, 5, 2, good.knots, 8, 0, 1), workspace, NULL),
                   CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "the pointer for the new curve is NULL");
}

CASE(queries_outside_the_range_are_refused) {
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(good.points, 5, 2, good.knots, 8, 0, 1), workspace, &curve), CPROX_OK);
  assert_string_equal(cprox_workspace_error(workspace), "");
  vec3 p = {7, 7, 7}, part[3] = {{7, 7, 7}};
  const double outside[4] = {-1e-9, 1.5, NAN, INFINITY};
  for (size_t k = 0; k < 4; k++)
    assert_int_equal(cprox_curve_evaluate(curve, outside[k], workspace, &p, &p, &p), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "t = inf is outside the curve's range [0, 1]");
  assert_int_equal(cprox_curve_evaluate(NULL, 0.0, workspace, &p, NULL, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "the curve is NULL");

  assert_int_equal(cprox_curve_control_points(curve, 0.2, 0.2, workspace, part), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "a = 0.20000000000000001 is not below b = 0.20000000000000001");
  assert_int_equal(cprox_curve_control_points(curve, 0.0, NAN, workspace, part), CPROX_INVALID);
  assert_int_equal(cprox_curve_control_points(curve, -1.0, 0.1, workspace, part), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "[-1, 0.10000000000000001] leaves the curve's range [0, 1]");
  assert_int_equal(cprox_curve_control_points(curve, 0.75, 1.5, workspace, part), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "[0.75, 1.5] leaves the curve's range [0, 1]");
  assert_int_equal(cprox_curve_control_points(curve, 0.25, 0.75, workspace, part), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), "two pieces join at 0.40000000000000002, inside [0.25, 0.75]");
  assert_int_equal(cprox_curve_control_points(curve, 0.0, 0.1, workspace, NULL), CPROX_INVALID);
  assert_int_equal(cprox_curve_control_points(NULL, 0.0, 0.1, workspace, part), CPROX_INVALID);

  /* nothing was written, and the next good query is answered */
  assert_true(p.x == 7.0 && part[0].x == 7.0);
  assert_int_equal(cprox_curve_control_points(curve, 0.4, 0.5, workspace, part), CPROX_OK);
  assert_int_equal(cprox_curve_evaluate(curve, 1.0, workspace, &p, NULL, NULL), CPROX_OK);
  assert_string_equal(cprox_workspace_error(workspace), "");
  cprox_curve_free(curve);
}

/* Each allocation of a constructor fails in turn. */
CASE(memory_that_is_out_leaks_nothing) {
  cprox_curve_free(NULL);
  for (int kind = 0; kind < 7; kind++) {
    const size_t live = allocations_live();
    cprox_status status = CPROX_MEMORY;
    size_t successes = 0;
    for (; status != CPROX_OK; successes++) {
      cprox_curve *curve = (cprox_curve *)workspace;
      const size_t made = allocations_made();
      allocations_fail_after(successes);
      status = kind == 0   ? curve_from(describe_bezier(good.points, 2, 0, 1), workspace, &curve)
               : kind == 1 ? curve_from(describe_bezier(good.points, 5, 0, 1), workspace, &curve)
               : kind == 2 ? curve_from(describe_polynomial(good.points, 5, 0, 1), workspace, &curve)
               : kind == 3 ? curve_from(describe_legendre(good.points, 5, 0, 1), workspace, &curve)
               : kind == 4 ? curve_from(describe_lagrange(good.points, good.knots + 2, 4, 0, 1), workspace, &curve)
               : kind == 5 ? curve_from(describe_trigonometric(good.points, 5, 0, 1), workspace, &curve)
                           : curve_from(describe_bspline(good.points, 5, 2, good.knots, 8, 0, 1), workspace, &curve);
      allocations_allow();
      if (status == CPROX_OK) {
        assert_int_equal(allocations_made() - made, successes); /* each of them has failed before */
        cprox_curve_free(curve);
        continue;
      }
      assert_int_equal(status, CPROX_MEMORY);
      assert_ptr_equal(curve, workspace);
      assert_int_equal(strncmp(cprox_workspace_error(workspace), "no memory for a curve", 21), 0);
      assert_int_equal(allocations_live(), live);
    }
    assert_true(successes > 1); /* it did fail */
    assert_int_equal(allocations_live(), live);
  }
}

static int set_up(void **state) {
  (void)state;
  workspace = cprox_workspace_create();
  return workspace ? 0 : -1;
}

static int tear_down(void **state) {
  (void)state;
  cprox_workspace_free(workspace);
  return 0;
}

int main(void) {
  return cases_run(set_up, tear_down);
}
