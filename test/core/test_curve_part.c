/* SPDX-License-Identifier: BSD-3-Clause */
/* A part of a curve of every kind, at a pose, against the whole curve in 113 bits. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"
#include "support/refused_curve.h"

static void helix_jet(void *user, double t, cprox_vec3 jet[3]) {
  (void)user;
  jet[0] = (cprox_vec3){cos(t), sin(t), 0.1 * t};
  jet[1] = (cprox_vec3){-sin(t), cos(t), 0.1};
  jet[2] = (cprox_vec3){-cos(t), -sin(t), 0.0};
}

static double helix_sixth(void *user, double a, double b) {
  (void)user, (void)a, (void)b;
  return 1.0;
}

static void line_point(void *user, double t, cprox_vec3 *point) {
  (void)user;
  *point = (cprox_vec3){t, 0.0, 0.0};
}

static double line_length(void *user, double a, double b) {
  (void)user;
  return (b - a) * (1.0 + 1e-12);
}

#define KINDS 14

/* A curve of each kind that has pieces; its range holds [0, 1]. */
static cprox_curve *make_kind(int kind, rng *r) {
  vec3 p[9];
  double weights[6];
  for (int i = 0; i < 9; i++) p[i] = vec_add(rng_in_cube(r, 1.0), vec(kind % 2 ? 50.0 : 0.0, 0.0, 1.0));
  for (int i = 0; i < 6; i++) weights[i] = rng_uniform(r, 0.3, 2.0);
  const double knots[10] = {-1, -1, -1, -1, 0.3, 0.6, 2, 2, 2, 2}, nodes[5] = {-1, -0.4, 0.2, 0.9, 2};
  const cprox_quat preimage[3] = {{1, 0.2, 0, 0.1}, {0.8, 0, 0.3, 0.2}, {1.1, 0, 0, -0.4}};
  const cprox_smooth_curve smooth = {
      .evaluate = helix_jet, .sixth = helix_sixth, .error = {1e-15, 1e-15, 1e-15}, .accuracy = 1e-13};
  p[3] = kind == 10 ? p[2] : p[3];
  cprox_curve *curve = NULL, *halves[2] = {NULL, NULL};
  curve_from(describe_bezier(p, 3, -1, 0.5), NULL, &halves[0]);
  curve_from(describe_bezier(p + 3, 5, 0.5, 2), NULL, &halves[1]);
  const cprox_curve *const both[2] = {halves[0], halves[1]};
  const cprox_curve_description kinds[KINDS] = {
      describe_bezier(p, 6, -0.5, 1.5),
      describe_bspline(p, 6, 3, knots, 10, -1, 2),
      describe_polynomial(p, 5, -1, 2),
      describe_legendre(p, 6, -1, 2),
      describe_lagrange(p, nodes, 5, -1, 2),
      describe_trigonometric(p, 5, -3, 3),
      describe_clothoid(p[0], 0.4, 0.5, -1.5, -1, 2),
      describe_dubins(vec(0, 0, 1), 0.3, vec(4, 1, 1), -2.0, 0.7, CPROX_DUBINS_SHORTEST),
      describe_involute(p[0], 0.3, 0.2, -2, 5),
      describe_pythagorean_hodograph(p[0], preimage, 3, -1, 2),
      describe_piecewise(both, 2, NULL, 0.0),
      describe_smooth(&smooth, -1, 2),
      describe_rational_bezier(p, weights, 4, -1, 2),
      describe_nurbs(p, weights, 6, 3, knots, 10, -1, 2),
  };
  curve_from(kinds[kind], NULL, &curve);
  cprox_curve_free(halves[0]);
  cprox_curve_free(halves[1]);
  return curve;
}

/* R(q) p + x, by the products of quaternions. */
static quad3 moved(const cprox_pose *pose, quad3 p) {
  const cprox_quat o = pose->orientation;
  const quad w = o.w, x = o.x, y = o.y, z = o.z, n = w * w + x * x + y * y + z * z;
  const quad a = p.k[0], b = p.k[1], c = p.k[2];
  return (quad3){{(a * (w * w + x * x - y * y - z * z) + 2 * b * (x * y - w * z) + 2 * c * (x * z + w * y)) / n +
                      (quad)pose->position.x,
                  (2 * a * (x * y + w * z) + b * (w * w - x * x + y * y - z * z) + 2 * c * (y * z - w * x)) / n +
                      (quad)pose->position.y,
                  (2 * a * (x * z - w * y) + 2 * b * (y * z + w * x) + c * (w * w - x * x - y * y + z * z)) / n +
                      (quad)pose->position.z}};
}

/* seed 1911, each kind 30 times, 20 points (scale 12: 1e5). What a part adds to the error of the whole is the bound
 * that is tested. */
CASE(a_part_is_the_whole_curve_there) {
  rng r = rng_seed(1911);
  double largest = 0.0;
  const size_t cases = test_cases(30 * KINDS);
  for (size_t i = 0; i < cases; i++) {
    cprox_curve *whole = make_kind((int)(i % KINDS), &r), *part;
    assert_non_null(whole);
    double a = rng_uniform(&r, 0.0, 0.5), b = a + (rng_index(&r, 3) ? rng_uniform(&r, 0.01, 0.5) : 1e-9);
    if (rng_index(&r, 8) == 0) a = whole->breaks[0];
    if (rng_index(&r, 8) == 0) b = whole->breaks[whole->n_pieces];
    const cprox_pose pose = rng_pose(&r, 10.0);
    const bool placed = rng_index(&r, 2);
    assert_int_equal(
        curve_from(describe_part((const cprox_curve *[]){whole}, a, b, placed ? &pose : NULL), NULL, &part), CPROX_OK);
    assert_true(part->breaks[0] == a && part->breaks[part->n_pieces] == b);
    assert_int_equal(cprox_curve_get_info(part).kind, CPROX_CURVE_PART);
    for (int k = 0; k < 20; k++) {
      const double t = quad_parameter(part, &r);
      const size_t piece = quad_piece_at(part, t), of_whole = quad_piece_at(whole, t);
      /* at an end of the part the piece of the whole that t belongs to may be the next one */
      const size_t same = t == whole->breaks[of_whole] && of_whole > 0 && t == b ? of_whole - 1 : of_whole;
      quad3 exact = quad_piece(whole, same, t);
      if (placed) exact = moved(&pose, exact);
      const double apart = quad_distance(quad_piece(part, piece, t), exact);
      const double added = part->error[piece] - whole->error[same];
      assert_true(apart <= added * (1.0 + 1e-6) + 1e-16 * whole->error[same]);
      if (added > 0.0) largest = fmax(largest, apart / added);
    }
    cprox_curve_free(part);
    cprox_curve_free(whole);
  }
  assert_true(largest > 0.02);
}

/* seed 1913, each kind 20 times, 30 points in 113 bits: no point of a part is farther from its two ends, summed, than
 * the axis; the axis is no shorter than a polyline through the points, and at most twice as long over a short part. */
CASE(the_ellipsoid_of_a_part_holds_its_points) {
  rng r = rng_seed(1913);
  cprox_workspace *ws = cprox_workspace_create();
  size_t tight = 0;
  const size_t cases = test_cases(20 * KINDS);
  for (size_t i = 0; i < cases; i++) {
    cprox_curve *whole = make_kind((int)(i % KINDS), &r);
    const cprox_curve_info info = cprox_curve_get_info(whole);
    const double a = rng_uniform(&r, info.t0, 0.5 * (info.t0 + info.t1)), b = rng_uniform(&r, a + 1e-3, info.t1);
    cprox_curve_ellipsoid e;
    assert_int_equal(cprox_curve_get_ellipsoid(whole, a, b, ws, &e), CPROX_OK);
    double path = 0.0;
    quad3 last = {{0, 0, 0}};
    for (int k = 0; k <= 30; k++) {
      const double t = a + (b - a) * k / 30.0;
      const quad3 x = quad_piece(whole, quad_piece_at(whole, t), t);
      double sum = 0.0;
      for (int focus = 0; focus < 2; focus++)
        sum += quad_distance(x, (quad3){{e.foci[focus].x, e.foci[focus].y, e.foci[focus].z}});
      assert_true(sum <= e.axis);
      if (k > 0) path += quad_distance(x, last);
      last = x;
    }
    assert_true(path <= e.axis && e.radius <= 0.5 * e.axis * (1.0 + 1e-12));
    tight += e.axis <= 2.0 * path;
    assert_int_equal(cprox_curve_get_ellipsoid(whole, b, a, ws, &e), CPROX_INVALID);
    assert_int_equal(cprox_curve_get_ellipsoid(whole, a, info.t1 + 1.0, ws, &e), CPROX_INVALID);
    cprox_curve_free(whole);
  }
  assert_true(tight > cases / 2);

  /* of a curve that is known by its arc length: by what its function says */
  const cprox_rectifiable_curve functions = {.point = line_point, .length = line_length, .error = 1e-15};
  cprox_curve *line = NULL;
  cprox_curve_ellipsoid e;
  assert_int_equal(curve_from(describe_rectifiable(&functions, 0, 10), ws, &line), CPROX_OK);
  assert_int_equal(cprox_curve_get_ellipsoid(line, 2.0, 5.0, ws, &e), CPROX_OK);
  assert_true(e.foci[0].x == 2.0 && e.foci[1].x == 5.0 && e.axis >= 3.0 && e.axis < 3.0 + 1e-11);
  assert_true(e.radius >= 0.0 && e.radius < 1e-5);
  cprox_curve_free(line);
  cprox_workspace_free(ws);
}

/* Whole pieces are copied to the last bit, and so is a whole curve. */
CASE(a_part_that_is_all_of_it_adds_no_error) {
  rng r = rng_seed(1912);
  for (int kind = 0; kind < KINDS; kind++) {
    cprox_curve *whole = make_kind(kind, &r), *part;
    const cprox_curve_info info = cprox_curve_get_info(whole);
    assert_int_equal(curve_from(describe_part((const cprox_curve *[]){whole}, info.t0, info.t1, NULL), NULL, &part),
                     CPROX_OK);
    assert_int_equal(part->n_pieces, whole->n_pieces);
    assert_memory_equal(part->points, whole->points, whole->n_pieces * (whole->degree + 1) * sizeof(vec3));
    assert_memory_equal(part->error, whole->error, whole->n_pieces * sizeof(double));
    cprox_curve_free(part);
    cprox_curve_free(whole);
  }
}

/* The least distance of a part is that over its own parameters: a line past a point, left out and left in. */
CASE(queries_of_a_part_are_about_the_part) {
  cprox_workspace *ws = cprox_workspace_create();
  const cprox_vec3 points[2] = {{0, 0, 0}, {10, 0, 0}};
  const cprox_rectifiable_curve functions = {.point = line_point, .length = line_length, .error = 1e-15};
  cprox_curve *lines[2];
  assert_int_equal(curve_from(describe_bezier(points, 2, 0, 10), ws, &lines[0]), CPROX_OK);
  assert_int_equal(curve_from(describe_rectifiable(&functions, 0, 10), ws, &lines[1]), CPROX_OK);
  cprox_body *point;
  assert_int_equal(cprox_body_create_point((cprox_vec3){2, 3, 0}, ws, &point), CPROX_OK);
  const cprox_pose identity = {{0, 0, 0}, {1, 0, 0, 0}};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  for (int i = 0; i < 2; i++) {
    cprox_curve *far, *near;
    const cprox_curve *whole = lines[i];
    assert_int_equal(curve_from(describe_part(&whole, 6, 9, NULL), ws, &far), CPROX_OK);
    assert_int_equal(curve_from(describe_part(&whole, 1, 9, NULL), ws, &near), CPROX_OK);
    cprox_result result;
    assert_int_equal(cprox_distance(cprox_point_along(far), cprox_obstacle_at(point, identity), &options, ws, &result),
                     CPROX_OK);
    assert_true(result.lower <= 5.0 && 5.0 <= result.upper && fabs(result.t - 6.0) <= 1e-6);
    assert_int_equal(cprox_distance(cprox_point_along(near), cprox_obstacle_at(point, identity), &options, ws, &result),
                     CPROX_OK);
    assert_true(result.lower <= 3.0 && 3.0 <= result.upper);
    assert_true(fabs(result.t - 2.0) <= 0.01);
    cprox_curve_free(far);
    cprox_curve_free(near);
    cprox_curve_free(lines[i]);
  }
  cprox_body_free(point);
  cprox_workspace_free(ws);
}

CASE(parts_that_do_not_exist_are_refused) {
  const cprox_vec3 points[2] = {{0, 0, 0}, {10, 0, 0}};
  const cprox_rectifiable_curve functions = {.point = line_point, .length = line_length, .error = 1e-15};
  const cprox_pose identity = {{0, 0, 0}, {1, 0, 0, 0}}, bad = {{0, 0, 0}, {0, 0, 0, 0}};
  cprox_curve *line, *arcs;
  assert_int_equal(curve_from(describe_bezier(points, 2, 0, 10), NULL, &line), CPROX_OK);
  assert_int_equal(curve_from(describe_rectifiable(&functions, 0, 10), NULL, &arcs), CPROX_OK);
  const cprox_curve *whole = line, *by_length = arcs, *none = NULL;
  refuses_curve(describe_part(&none, 0, 1, NULL), "one curve");
  refuses_curve(describe_part(&whole, -1, 1, NULL), "leaves the curve's range [0, 10]");
  refuses_curve(describe_part(&whole, 9, 11, NULL), "leaves the curve's range [0, 10]");
  refuses_curve(describe_part(&whole, 2, 2, NULL), "not below");
  refuses_curve(describe_part(&whole, NAN, 2, NULL), "not finite");
  refuses_curve(describe_part(&whole, 1, 2, &bad), "norm is 0");
  refuses_curve(describe_part(&by_length, 1, 2, &identity), "cannot have a pose");
  cprox_curve_free(line);
  cprox_curve_free(arcs);
}

int main(void) {
  return cases_run(NULL, NULL);
}
