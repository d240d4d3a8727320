/* SPDX-License-Identifier: BSD-3-Clause */
/* Rational Bézier curves and NURBS against their definition in 113 bits, and against circles. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"
#include "support/refused_curve.h"

enum { MOST = TEST_MAX_POINTS };

/* The basis functions of a spline at t by Cox and de Boor's recurrence over all knots; of the span that `inside`
 * belongs to, which decides between the two limits at a jump. */
static void basis(const double *knots, size_t n, size_t degree, double t, double inside, quad *b) {
  size_t span = degree;
  for (size_t i = degree; i < n; i++)
    if (knots[i] < knots[i + 1] && knots[i] <= inside) span = i;
  quad all[MOST + CPROX_MAX_DEGREE + 1] = {0};
  all[span] = 1;
  for (size_t p = 1; p <= degree; p++) {
    for (size_t i = 0; i + p < n + degree; i++) {
      const quad left = (quad)knots[i + p] - (quad)knots[i], right = (quad)knots[i + p + 1] - (quad)knots[i + 1];
      const quad rising = left > 0 ? ((quad)t - (quad)knots[i]) / left * all[i] : 0;
      const quad falling = right > 0 ? ((quad)knots[i + p + 1] - (quad)t) / right * all[i + 1] : 0;
      all[i] = rising + falling;
    }
  }
  for (size_t i = 0; i < n; i++) b[i] = all[i];
}

static quad3 quotient(const test_spline *s, const double *weights, double t, double inside) {
  quad b[MOST], sum = 0;
  quad3 point = {{0, 0, 0}};
  basis(s->knots, s->n_points, s->degree, t, inside, b);
  for (size_t i = 0; i < s->n_points; i++) {
    point = quad_axpy(point, b[i] * (quad)weights[i], s->points[i]);
    sum += b[i] * (quad)weights[i];
  }
  for (int k = 0; k < 3; k++) point.k[k] /= sum;
  return point;
}

static void random_weights(rng *r, size_t n, double *weights) {
  const double spread = rng_index(r, 4) ? rng_log_uniform(r, 1.0, 30.0) : rng_log_uniform(r, 1.0, 900.0);
  const double unit = rng_log_uniform(r, 1e-6, 1e6);
  for (size_t i = 0; i < n; i++) weights[i] = unit * (spread > 1.0 ? rng_log_uniform(r, 1.0 / spread, spread) : 1.0);
}

/* A rational Bézier curve is a NURBS curve whose knots stand at its ends. */
static cprox_curve *random_curve(rng *r, test_spline *s, double *weights) {
  size_t degree = 1 + rng_index(r, rng_index(r, 8) ? 5 : 12);
  const bool bezier = rng_index(r, 2);
  *s = random_spline(r, degree);
  if (bezier) {
    s->n_points = degree + 1;
    s->n_knots = 2 * degree + 2;
    s->t0 = rng_uniform(r, -2.0, 1.0);
    s->t1 = s->t0 + rng_log_uniform(r, 1e-3, 1e3);
    for (size_t i = 0; i <= degree; i++) s->knots[i] = s->t0, s->knots[degree + 1 + i] = s->t1;
  }
  random_weights(r, s->n_points, weights);
  cprox_curve *curve = NULL;
  const cprox_curve_description d =
      bezier ? describe_rational_bezier(s->points, weights, s->n_points, s->t0, s->t1)
             : describe_nurbs(s->points, weights, s->n_points, degree, s->knots, s->n_knots, s->t0, s->t1);
  curve_from(d, NULL, &curve);
  return curve;
}

/* seed 1901, 60 curves of 60 points each (scale 30: 1e5 points). A piece's error is its bound of the distance from the
 * quotient; 113 bits add a rounding of 1e-30 of the sizes. */
CASE(every_piece_is_within_its_error_of_the_quotient) {
  rng r = rng_seed(1901);
  double largest = 0.0;
  size_t made = 0;
  const size_t cases = test_cases(60);
  for (size_t i = 0; i < cases; i++) {
    test_spline s;
    double weights[MOST];
    cprox_curve *curve = random_curve(&r, &s, weights);
    if (!curve) continue; /* spans that need too many pieces, or jump by knots that are almost alike */
    made++;
    for (int k = 0; k < 60; k++) {
      const double t = quad_parameter(curve, &r);
      const size_t piece = quad_piece_at(curve, t);
      const double inside = 0.5 * (curve->breaks[piece] + curve->breaks[piece + 1]);
      const double apart = quad_distance(quad_piece(curve, piece, t), quotient(&s, weights, t, inside));
      assert_true(apart <= curve->error[piece]);
      largest = fmax(largest, apart / curve->error[piece]);
    }
    cprox_curve_free(curve);
  }
  assert_true(made > cases - cases / 5 - 1);
  assert_true(largest > 0.05 && largest <= 1.0);
}

/* seed 1902: a bound of the sixth derivative that were too small would show in the middle of the longest pieces, which
 * are those of few and smooth weights. 300 curves, the middle of every piece (scale 30: 2e5 middles). */
CASE(the_middle_of_every_piece_is_within_its_error) {
  rng r = rng_seed(1902);
  const size_t cases = test_cases(40);
  for (size_t i = 0; i < cases; i++) {
    test_spline s = {.degree = 2 + rng_index(&r, 3), .t0 = 0.0, .t1 = 1.0};
    double weights[MOST];
    s.n_points = s.degree + 1;
    for (size_t k = 0; k <= s.degree; k++) {
      s.points[k] = rng_in_cube(&r, 1.0);
      s.knots[k] = 0.0, s.knots[s.degree + 1 + k] = 1.0;
      weights[k] = rng_uniform(&r, 0.2, 1.0);
    }
    cprox_curve *curve;
    assert_int_equal(curve_from(describe_rational_bezier(s.points, weights, s.n_points, 0.0, 1.0), NULL, &curve),
                     CPROX_OK);
    for (size_t piece = 0; piece < curve->n_pieces; piece++) {
      const double t = 0.5 * (curve->breaks[piece] + curve->breaks[piece + 1]);
      const double apart = quad_distance(quad_piece(curve, piece, t), quotient(&s, weights, t, t));
      assert_true(apart <= curve->error[piece]);
      assert_true(curve->error[piece] <= 1e-12);
    }
    cprox_curve_free(curve);
  }
}

/* An arc of the angle 2a is the quadratic with weights 1, cos a, 1; the middle point is the corner of its tangents. */
CASE(arcs_are_circles_for_the_queries) {
  cprox_workspace *ws = cprox_workspace_create();
  const cprox_vec3 centre = {3.0, -2.0, 0.5};
  const double radius = 1.25;
  for (int k = 1; k <= 8; k++) {
    const double a = 0.18 * k;
    const cprox_vec3 points[3] = {
        {centre.x + radius * cos(a), centre.y - radius * sin(a), centre.z},
        {centre.x + radius / cos(a), centre.y, centre.z},
        {centre.x + radius * cos(a), centre.y + radius * sin(a), centre.z},
    };
    const double weights[3] = {1.0, cos(a), 1.0};
    cprox_curve *arc;
    assert_int_equal(curve_from(describe_rational_bezier(points, weights, 3, 0.0, 2.0), ws, &arc), CPROX_OK);
    assert_true(cprox_curve_get_info(arc).error <= 1e-12 * radius);
    cprox_body *point;
    assert_int_equal(cprox_body_create_point((cprox_vec3){0, 0, 0}, ws, &point), CPROX_OK);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result result;
    const cprox_pose at_centre = {centre, {1, 0, 0, 0}};
    assert_true(cprox_distance(cprox_point_along(arc), cprox_obstacle_at(point, at_centre), &options, ws, &result) >=
                0);
    assert_true(result.lower <= radius + 1e-15 && result.upper >= radius - 1e-15);
    assert_true(result.upper - result.lower <= 1e-9);
    /* from outside, through the middle of the arc */
    const cprox_pose outside = {{centre.x + 3.0, centre.y, centre.z}, {1, 0, 0, 0}};
    assert_int_equal(cprox_distance(cprox_point_along(arc), cprox_obstacle_at(point, outside), &options, ws, &result),
                     CPROX_OK);
    assert_true(result.lower <= 3.0 - radius && 3.0 - radius <= result.upper + 1e-15);
    assert_true(fabs(result.t - 1.0) <= 1e-4);
    cprox_body_free(point);
    cprox_curve_free(arc);
  }
  cprox_workspace_free(ws);
}

/* The full circle of four quarters, 9 points of degree 2 over the knots 0 0 0 1 1 2 2 3 3 4 4 4. */
CASE(a_nurbs_circle_is_as_far_from_its_axis_everywhere) {
  const double h = sqrt(0.5), knots[12] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  const cprox_vec3 points[9] = {{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                                {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}};
  const double weights[9] = {1, h, 1, h, 1, h, 1, h, 1};
  cprox_curve *circle;
  assert_int_equal(curve_from(describe_nurbs(points, weights, 9, 2, knots, 12, 0.0, 4.0), NULL, &circle), CPROX_OK);
  const cprox_curve_info info = cprox_curve_get_info(circle);
  assert_true(info.n_pieces <= 400);
  assert_true(info.error <= 1e-12);
  for (int i = 0; i <= 4000; i++) {
    cprox_vec3 p;
    assert_int_equal(cprox_curve_evaluate(circle, 0.001 * i, NULL, &p, NULL, NULL), CPROX_OK);
    assert_true(fabs(hypot(p.x, p.y) - 1.0) <= info.error + 2e-14);
  }
  cprox_curve_free(circle);
}

/* Weights that are all alike leave the polynomial curve. */
CASE(equal_weights_are_the_bezier_curve_in_one_piece) {
  rng r = rng_seed(1903);
  for (int i = 0; i < 100; i++) {
    const size_t n = 2 + rng_index(&r, 5);
    cprox_vec3 points[6];
    double weights[6];
    for (size_t k = 0; k < n; k++) points[k] = rng_in_cube(&r, 2.0), weights[k] = 0.7;
    cprox_curve *rational, *bezier;
    assert_int_equal(curve_from(describe_rational_bezier(points, weights, n, -1.0, 2.0), NULL, &rational), CPROX_OK);
    assert_int_equal(curve_from(describe_bezier(points, n, -1.0, 2.0), NULL, &bezier), CPROX_OK);
    assert_int_equal(rational->n_pieces, 1);
    for (int k = 0; k <= 10; k++) {
      cprox_vec3 a, b;
      cprox_curve_evaluate(rational, -1.0 + 0.3 * k, NULL, &a, NULL, NULL);
      cprox_curve_evaluate(bezier, -1.0 + 0.3 * k, NULL, &b, NULL, NULL);
      assert_true(vec_norm(vec_sub(a, b)) <= 1e-13);
    }
    cprox_curve_free(rational);
    cprox_curve_free(bezier);
  }
}

/* seed 1904, 300 curves; the sum of weights times points is the evaluated point. */
CASE(weights_make_the_point) {
  rng r = rng_seed(1904);
  for (size_t i = 0; i < 60; i++) {
    test_spline s;
    double weights[MOST], share[MOST];
    cprox_curve *curve = random_curve(&r, &s, weights);
    if (!curve) continue;
    const double t = rng_uniform(&r, s.t0, s.t1);
    const cprox_curve_description d =
        describe_nurbs(s.points, weights, s.n_points, s.degree, s.knots, s.n_knots, s.t0, s.t1);
    assert_int_equal(cprox_curve_weights(&d, t, share), CPROX_OK);
    vec3 sum = vec(0, 0, 0), point;
    double size = 0.0;
    for (size_t k = 0; k < s.n_points; k++) {
      sum = vec_axpy(sum, share[k], s.points[k]);
      size = fmax(size, vec_norm(s.points[k]));
    }
    assert_int_equal(cprox_curve_evaluate(curve, t, NULL, &point, NULL, NULL), CPROX_OK);
    assert_true(vec_norm(vec_sub(sum, point)) <= 1e-12 * size + curve_error(curve));
    cprox_curve_free(curve);
  }
}

CASE(weights_that_cannot_be_used_are_refused) {
  const cprox_vec3 points[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  const double nan_weight[3] = {1, NAN, 1}, zero[3] = {1, 1, 0}, negative[3] = {1, -1, 1}, far[3] = {1, 1e-7, 1};
  const double fine[3] = {1, 2, 1}, knots[6] = {0, 0, 0, 1, 1, 1};
  refuses_curve(describe_rational_bezier(points, NULL, 3, 0, 1), "the weights are NULL");
  refuses_curve(describe_rational_bezier(points, nan_weight, 3, 0, 1), "weight 1 is");
  refuses_curve(describe_rational_bezier(points, zero, 3, 0, 1), "weight 2 is 0; it must be positive");
  refuses_curve(describe_rational_bezier(points, negative, 3, 0, 1), "weight 1 is -1");
  refuses_curve(describe_rational_bezier(points, far, 3, 0, 1), "differ by a factor of more than 1e+06");
  refuses_curve(describe_rational_bezier(points, fine, 3, 1, 1), "t0");
  refuses_curve(describe_rational_bezier(points, fine, 3, 0, 1e-31), "long");
  refuses_curve(describe_rational_bezier(points, fine, 1, 0, 1), "at least 2 control points");
  refuses_curve(describe_nurbs(points, fine, 3, 2, knots, 5, 0, 1), "need 6 knots");
  refuses_curve(describe_nurbs(points, fine, 3, 2, knots, 6, 0, 1.5), "leaves the spline's domain");
}

int main(void) {
  return cases_run(NULL, NULL);
}
