/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves with names (heart, ranunculoid, fish and Lissajous as trigonometric series, Euler spiral, involutes): the
 * intervals contain the reference answers of test/data/reference/named_ref.csv. */
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/make_curve.h"

#define MOST_DEGREE 6

/* Its coefficients in the order of the series; what is not set is 0. */
typedef struct series {
  vec3 c[2 * MOST_DEGREE + 1];
} series;

static vec3 *of_cos(series *s, size_t k) {
  return &s->c[2 * k - 1];
}

static vec3 *of_sin(series *s, size_t k) {
  return &s->c[2 * k];
}

static series heart(void) {
  series s = {0};
  of_sin(&s, 1)->x = 0.24, of_sin(&s, 3)->x = -0.08;
  of_cos(&s, 1)->y = 0.26, of_cos(&s, 2)->y = -0.1, of_cos(&s, 3)->y = -0.04, of_cos(&s, 4)->y = -0.02;
  return s;
}

static series ranunculoid(void) {
  series s = {0};
  *of_cos(&s, 1) = vec(0.3, 0, 0), *of_sin(&s, 1) = vec(0, 0.3, 0);
  *of_cos(&s, 6) = vec(-0.05, 0, 0), *of_sin(&s, 6) = vec(0, -0.05, 0);
  return s;
}

/* .3 (cos t - sin² t/sqrt(2), sin t cos t), with sin² t = (1 - cos 2t)/2 */
static series fish(void) {
  series s = {0};
  s.c[0].x = -0.15 / sqrt(2.0), of_cos(&s, 1)->x = 0.3, of_cos(&s, 2)->x = 0.15 / sqrt(2.0);
  of_sin(&s, 2)->y = 0.15;
  return s;
}

static series lissajous(size_t p, size_t q) {
  series s = {0};
  of_sin(&s, p)->x = 0.3, of_sin(&s, q)->y = 0.3;
  return s;
}

/* Turned by -angle about the origin, then moved. */
static series placed(series s, double angle, double x, double y) {
  const double c = cos(angle), d = sin(angle);
  for (size_t i = 0; i <= 2 * MOST_DEGREE; i++)
    s.c[i] = vec(c * s.c[i].x + d * s.c[i].y, c * s.c[i].y - d * s.c[i].x, 0);
  s.c[0] = vec_add(s.c[0], vec(x, y, 0));
  return s;
}

static cprox_curve *compile(series s) {
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_trigonometric(s.c, 2 * MOST_DEGREE + 1, 0.0, 6.283185307179586), NULL, &curve),
                   CPROX_OK);
  return curve;
}

static size_t asked;

/* The reference is rounded to 17 digits and coefficients to double: 1e-15. 2π as a double leaves out less than that. */
static void check(const char *id, const cprox_curve *curve, cprox_obstacle target) {
  csv_table ref = csv_read("reference/named_ref.csv");
  const double reference = csv_number(&ref, csv_find(&ref, id), 1);
  asked++;
  cprox_workspace *ws = cprox_workspace_create();
  for (int k = 0; k < 3; k++) {
    const double epsilon[3] = {1e-6, 1e-9, 1e-12};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = epsilon[k];
    cprox_result r;
    const cprox_status status = cprox_distance(cprox_point_along(curve), target, &options, ws, &r);
    if (status != CPROX_OK)
      fail_msg("%s: %s (%s), [%.17g, %.17g]", id, cprox_status_name(status), cprox_workspace_error(ws), r.lower,
               r.upper);
    if (!(r.lower <= reference + 1e-15 && reference - 1e-15 <= r.upper && r.upper - r.lower <= epsilon[k]))
      fail_msg("%s: [%.17g, %.17g], the reference is %.17g", id, r.lower, r.upper, reference);
  }
  cprox_workspace_free(ws);
  csv_free(&ref);
}

static void check_polygon(const char *id, cprox_curve *curve) {
  /* the third field: x;y;x;y... */
  csv_table in = csv_read("reference/named_inputs.csv");
  double xy[64][2];
  size_t n = 0;
  for (char *at = csv_find(&in, id)->field[2]; *at; n++) {
    assert_true(n < 128);
    xy[n / 2][n % 2] = strtod(at, &at);
    if (*at == ';') at++;
  }
  assert_true(n >= 6 && n % 2 == 0);
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polygon((const double(*)[2])xy, n / 2, NULL, &body), CPROX_OK);
  check(id, curve, cprox_obstacle_at(body, CPROX_POSE_IDENTITY));
  cprox_curve_free(curve);
  cprox_body_free(body);
  csv_free(&in);
}

static void check_curves(const char *id, cprox_curve *first, cprox_curve *second) {
  check(id, first, cprox_obstacle_curve(second, 0.0));
  cprox_curve_free(second);
  cprox_curve_free(first);
}

CASE(hearts_and_ranunculoids_against_polygons) {
  check_polygon("a_heart_poly", compile(heart()));
  check_polygon("b_ranunculoid_poly", compile(ranunculoid()));
  check_polygon("heart_in_collision_poly", compile(heart()));
}

CASE(a_fish_against_lissajous_curves) {
  check_curves("f_fish_lissajous32", compile(fish()), compile(placed(lissajous(3, 2), 0.0, 0.75, 0.2)));
  check_curves("f2_fish_lissajous54", compile(placed(fish(), 0.3, 0.0, 0.0)),
               compile(placed(lissajous(5, 4), 0.5, 0.8, 0.1)));
}

/* a (∫ cos s², ∫ sin s²) for t in [-2π, 2π]: of curvature 2t/a, at arc length a t. a = 1/2 costs no rounding. */
CASE(an_euler_spiral_against_a_polygon) {
  cprox_curve *curve = NULL;
  assert_int_equal(
      curve_from(describe_clothoid(vec(0, 0, 0), 0.0, 0.0, 8.0, -3.141592653589793, 3.141592653589793), NULL, &curve),
      CPROX_OK);
  check_polygon("c_euler_poly_table", curve);
}

/* The rows that are Bézier curves, in the layout of the other reference files. */
CASE(bezier_curves_with_names) {
  csv_table in = csv_read("reference/namedbez_inputs.csv");
  for (size_t i = 0; i < in.n; i++) {
    const csv_row *row = &in.row[i];
    const char *id = row->field[0];
    const bool polygon = strcmp(row->field[1], "polygon") == 0;
    const size_t n = csv_count(&in, row, 3) + 1, m = csv_count(&in, row, 4) + (polygon ? 0 : 1);
    vec3 first[64], second[64];
    assert_true(csv_count(&in, row, 2) == 2 && n <= 64 && m <= 64);
    csv_points(&in, row, 5, 2, n, first);
    csv_points(&in, row, 5 + 2 * n, 2, m, second);
    cprox_curve *curve = NULL, *other = NULL;
    cprox_body *body = NULL;
    assert_int_equal(curve_from(describe_bezier(first, n, 0, 1), NULL, &curve), CPROX_OK);
    if (polygon) {
      double xy[64][2];
      for (size_t k = 0; k < m; k++) xy[k][0] = second[k].x, xy[k][1] = second[k].y;
      assert_int_equal(cprox_body_create_polygon((const double(*)[2])xy, m, NULL, &body), CPROX_OK);
      check(id, curve, cprox_obstacle_at(body, CPROX_POSE_IDENTITY));
    } else {
      assert_int_equal(curve_from(describe_bezier(second, m, 0, 1), NULL, &other), CPROX_OK);
      check(id, curve, cprox_obstacle_curve(other, 0.0));
    }
    cprox_body_free(body);
    cprox_curve_free(other);
    cprox_curve_free(curve);
  }
  csv_free(&in);
}

static cprox_curve *involute(double turned, double x, double y) {
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_involute(vec(x, y, 0), 0.035, turned, 0.0, 10.0), NULL, &curve), CPROX_OK);
  return curve;
}

CASE(involutes_against_curves) {
  check_curves("e_involute_involute", involute(0.0, 0.0, 0.0), involute(3.141592653589793, 0.8, 0.15));
  check_curves("fig1b_heart_involute", compile(heart()), involute(3.141592653589793, -1.0, 0.0));
}

/* One row asks the Euler spiral by another method of its own; it has the reference of the other. */
CASE(every_reference_was_asked) {
  csv_table ref = csv_read("reference/named_ref.csv"), in = csv_read("reference/named_inputs.csv");
  assert_int_equal(asked, ref.n);
  assert_int_equal(asked + 1, in.n);
  csv_free(&in);
  csv_free(&ref);
}

int main(void) {
  return cases_run(NULL, NULL);
}
