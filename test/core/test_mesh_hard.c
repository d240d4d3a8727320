/* SPDX-License-Identifier: BSD-3-Clause */
/* The cases that are hard for curves against meshes, by name: parallel, concentric, touching, far away, too accurate.
 * Whatever they cost, the interval is true and the budget kept; what they may cost is written down, about half as much
 * again as was counted. */
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/meshes.h"

/* The distance at epsilon, which must hold `truth` (itself within `doubt`) and take at most so many intervals;
 * converged, unless the budget is what is asked about. */
static cprox_result expect_distance(const char *name, const cprox_curve *curve, const cprox_body *body, cprox_pose pose,
                                    double epsilon, double truth, double doubt, uint32_t most) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result r;
  const cprox_status status = cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, pose), &options, ws, &r);
  if (status < 0) fail_msg("%s: %s", name, cprox_workspace_error(ws));
  if (!(r.lower <= truth + doubt && truth - doubt <= r.upper))
    fail_msg("%s: [%.17g, %.17g] without %.17g", name, r.lower, r.upper, truth);
  if (r.nodes > most) fail_msg("%s: %u intervals", name, r.nodes);
  if (status == CPROX_OK) assert_true(r.upper - r.lower <= epsilon);
  return r;
}

/* ---- plates ---- */

/* A plate of 2 * 40² triangles in z = 0, one unit wide each way; straight lines along an axis. */
CASE(lines_along_a_plate_take_one_interval) {
  test_mesh mesh = mesh_plate(40, 1.0);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  const cprox_pose here = CPROX_POSE_IDENTITY;
  const vec3 above[2] = {{-0.7, 0.013, 0.25}, {0.7, 0.013, 0.25}};
  const vec3 on[2] = {{-0.7, 0.013, 0.0}, {0.7, 0.013, 0.0}};
  const vec3 touching[3] = {{-0.7, 0.013, 0.3}, {0.0, 0.013, -0.3}, {0.7, 0.013, 0.3}};
  const vec3 vertex[2] = {{0.05, 0.05, 0.5}, {0.05, 0.05, -0.5}};
  const vec3 ridge[2] = {{-0.7, 0.05, 0.2}, {0.7, 0.05, 0.2}};
  cprox_curve *curves[5] = {bezier(above, 2), bezier(on, 2), bezier(touching, 3), bezier(vertex, 2), bezier(ridge, 2)};
  expect_distance("parallel", curves[0], body, here, 1e-9, 0.25, 0.0, 3);
  expect_distance("on the surface", curves[1], body, here, 1e-9, 0.0, 0.0, 3);
  expect_distance("touching", curves[2], body, here, 1e-9, 0.0, 0.0, 3);
  expect_distance("through a vertex", curves[3], body, here, 1e-9, 0.0, 0.0, 3);
  expect_distance("along an edge", curves[4], body, here, 1e-9, 0.2, 0.0, 3);
  for (int i = 0; i < 5; i++) cprox_curve_free(curves[i]);
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* The same plate turned by 0.3 about (1, 2, 3), the line parallel to it but for the pose's rounding. */
CASE(a_line_parallel_to_an_oblique_plate_converges) {
  test_mesh mesh = mesh_plate(40, 1.0);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  const double s = sin(0.15) / sqrt(14.0);
  const cprox_pose pose = {.position = {0.1, -0.2, 0.3}, .orientation = {cos(0.15), s, 2.0 * s, 3.0 * s}};
  const frame f = frame_create(&pose, vec(0, 0, 0));
  const vec3 line[2] = {frame_to_world(&f, vec(-0.7, 0.013, 0.25)), frame_to_world(&f, vec(0.7, 0.21, 0.25))};
  cprox_curve *curve = bezier(line, 2);
  expect_distance("oblique", curve, body, pose, 1e-9, 0.25, 1e-15, 3);
  expect_distance("oblique, 1e-12", curve, body, pose, 1e-12, 0.25, 1e-15, 3);
  cprox_curve_free(curve);
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* ---- what ties ---- */

/* The mantle of a cylinder about z with n vertices a ring: 2 n k triangles. */
static test_mesh mesh_mantle(size_t n, size_t k, double radius, double half) {
  test_mesh mesh = {.n = n * (k + 1), .m = 2 * n * k};
  mesh.vertices = malloc(mesh.n * sizeof *mesh.vertices);
  mesh.triangles = malloc(mesh.m * sizeof *mesh.triangles);
  size_t m = 0;
  for (size_t j = 0; j <= k; j++) {
    for (size_t i = 0; i < n; i++) {
      const double a = 6.283185307179586 * (double)i / (double)n;
      mesh.vertices[j * n + i] = vec(radius * cos(a), radius * sin(a), half * (2.0 * (double)j / (double)k - 1.0));
    }
  }
  for (size_t j = 0; j < k; j++) {
    for (size_t i = 0; i < n; i++) {
      const uint32_t a = (uint32_t)(j * n + i), b = (uint32_t)(j * n + (i + 1) % n);
      const uint32_t quad[2][3] = {{a, b, b + (uint32_t)n}, {a, b + (uint32_t)n, a + (uint32_t)n}};
      memcpy(mesh.triangles[m], quad, sizeof quad);
      m += 2;
    }
  }
  return mesh;
}

/* Along the axis every triangle is as near as any other, up to the chords of the rings: radius * cos(pi/n). An arc
 * outside, concentric, is nearest to every edge: the gap between a vertex and an arc at twice the radius is the radius.
 */
CASE(concentric_curves_end_within_the_budget) {
  enum { N = 64 };
  test_mesh mesh = mesh_mantle(N, 16, 0.5, 1.0);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  const vec3 axis[2] = {{0, 0, -0.8}, {0, 0, 0.8}};
  cprox_curve *along = bezier(axis, 2);
  expect_distance("axis", along, body, CPROX_POSE_IDENTITY, 1e-6, 0.5 * cos(3.141592653589793 / N), 1e-14, 120);

  const cprox_vec3 terms[3] = {{0, 0, 0.01}, {1, 0, 0}, {0, 1, 0}};
  cprox_curve *arc = NULL;
  assert_int_equal(curve_from(describe_trigonometric(terms, 3, 0.0, 3.0), ws, &arc), CPROX_OK);
  expect_distance("arc", arc, body, CPROX_POSE_IDENTITY, 1e-6, 0.5, 1e-9, 1300);
  cprox_curve_free(along);
  cprox_curve_free(arc);
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* Two plates that meet at a right angle in the y axis; the line runs in the plane between them, 0.2 from both. */
CASE(the_bisector_of_a_groove_converges) {
  test_mesh one = mesh_plate(30, 1.0), mesh = {.n = 2 * one.n, .m = 2 * one.m};
  mesh.vertices = malloc(mesh.n * sizeof *mesh.vertices);
  mesh.triangles = malloc(mesh.m * sizeof *mesh.triangles);
  for (size_t i = 0; i < one.n; i++) {
    const vec3 v = one.vertices[i];
    mesh.vertices[i] = vec(v.x + 1.0, v.y, 0.0);
    mesh.vertices[one.n + i] = vec(0.0, v.y, v.x + 1.0);
  }
  for (size_t i = 0; i < one.m; i++)
    for (int c = 0; c < 3; c++) {
      mesh.triangles[i][c] = one.triangles[i][c];
      mesh.triangles[one.m + i][c] = one.triangles[i][c] + (uint32_t)one.n;
    }
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  const vec3 line[2] = {{0.2, -0.8, 0.2}, {0.2, 0.8, 0.2}};
  cprox_curve *curve = bezier(line, 2);
  expect_distance("groove", curve, body, CPROX_POSE_IDENTITY, 1e-6, 0.2, 1e-15, 40);
  cprox_curve_free(curve);
  cprox_body_free(body);
  mesh_free(&one);
  mesh_free(&mesh);
}

/* ---- long, far and fine ---- */

/* A cubic spline of 1000 pieces that winds ten times round a torus; nowhere nearer than what it is at 20,000 of its
 * points. */
CASE(a_spline_of_a_thousand_pieces_is_answered) {
  enum { PIECES = 1000, POINTS = PIECES + 3 };
  test_mesh mesh = mesh_torus(60, 30, 1.0, 0.3, 0.1);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  static vec3 points[POINTS];
  static double knots[POINTS + 4];
  for (int k = 0; k < POINTS; k++) {
    const double a = 62.83185307179586 * k / POINTS, b = 7.3 * a;
    points[k] = vec((1.0 + 0.6 * cos(b)) * cos(a), (1.0 + 0.6 * cos(b)) * sin(a), 0.6 * sin(b));
  }
  for (int k = 0; k < POINTS + 4; k++) knots[k] = k;
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(points, POINTS, 3, knots, POINTS + 4, 3.0, POINTS), ws, &curve),
                   CPROX_OK);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), NULL, ws, &r),
                   CPROX_OK);
  double least = INFINITY;
  for (int k = 0; k <= 20000; k++) {
    vec3 x;
    cprox_curve_evaluate(curve, 3.0 + (POINTS - 3.0) * k / 20000.0, ws, &x, NULL, NULL);
    least = fmin(least, cprox_body_nearest(body, x, NULL));
  }
  assert_true(r.lower <= least + 1e-12);
  if (r.nodes > 6000) fail_msg("%u intervals", r.nodes);
  cprox_curve_free(curve);
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* 1e6 m from the origin the curve's own rounding is 1e-10: the interval is true and wider than 1e-12, and says why. */
CASE(far_away_the_interval_is_as_wide_as_it_must_be) {
  rng r = rng_seed(121);
  for (int i = 0; i < 40; i++) {
    test_mesh mesh = mesh_torus(12, 8, 1.0, 0.3, 0.1);
    cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
    const vec3 offset = rng_in_cube(&r, 1e6);
    cprox_pose pose = rng_pose(&r, 1.0);
    pose.position = vec_add(pose.position, offset);
    vec3 points[4];
    for (int k = 0; k < 4; k++) points[k] = vec_add(rng_in_cube(&r, 2.0), offset);
    cprox_curve *curve = bezier(points, 4);
    for (int fine = 0; fine < 2; fine++) {
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = fine ? 1e-12 : 1e-6;
      cprox_result a;
      const cprox_status status =
          cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, pose), &options, ws, &a);
      assert_true(status == CPROX_OK || (fine && status == CPROX_PRECISION));
      assert_true(a.upper - a.lower <= 1e-6);
      const long double there = mesh_distance(&mesh, ref_to_local(&pose, ref_bezier(points, 3, (long double)a.t, 0)));
      assert_true(there <= (long double)a.upper + 1e-9L && a.nodes < 20000);
    }
    cprox_curve_free(curve);
    cprox_body_free(body);
    mesh_free(&mesh);
  }
}

/* Epsilon 0 and 1e-15 on a torus of size 1: the narrowest interval, a few 1e-15 wide, long before the budget. */
CASE(tiny_epsilons_end_with_the_narrowest_interval) {
  rng r = rng_seed(123);
  test_mesh mesh = mesh_torus(24, 16, 1.0, 0.3, 0.1);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  for (int i = 0; i < 60; i++) {
    vec3 points[5];
    for (int k = 0; k < 5; k++) points[k] = rng_in_cube(&r, 2.0);
    cprox_curve *curve = bezier(points, 5);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = i % 2 ? 0.0 : 1e-15;
    cprox_result a;
    const cprox_status status =
        cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &a);
    assert_true(status == CPROX_OK || status == CPROX_PRECISION);
    if (a.nodes > 400 || a.upper - a.lower > 1e-12)
      fail_msg("case %d: %u intervals, %g wide", i, a.nodes, a.upper - a.lower);
    cprox_curve_free(curve);
  }
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* A budget of 10 intervals for what needs hundreds: the interval is true. */
CASE(a_budget_is_kept) {
  test_mesh mesh = mesh_mantle(64, 16, 0.5, 1.0);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  const vec3 axis[2] = {{0.001, 0, -0.8}, {0, 0.001, 0.8}};
  cprox_curve *curve = bezier(axis, 2);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  cprox_result fine, coarse;
  options.max_nodes = 200000;
  assert_true(
      cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &fine) >= 0);
  options.max_nodes = 10;
  const cprox_status status =
      cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &coarse);
  assert_true(coarse.nodes <= 10 && coarse.lower <= fine.upper && fine.lower <= coarse.upper);
  assert_true(status == CPROX_BUDGET || coarse.upper - coarse.lower <= 1e-9);
  cprox_curve_free(curve);
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* ---- time of contact ---- */

/* 40 quintics of a tube of 0.05 into a torus of 2 * 60 * 30 triangles (seed 47), to 1e-9: halving would need 30
 * intervals for the last digits alone, cuts aimed at the contact need 12 on average. Never late: at t_contact_lower,
 * nine tenths and half of it the tube is clear of every triangle. */
CASE(time_of_contact_takes_few_intervals) {
  test_mesh mesh = mesh_torus(60, 30, 1.0, 0.3, 0.02);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  rng r = rng_seed(47);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  const double radius = 0.05;
  uint32_t nodes = 0, hits = 0;
  for (int tries = 0; tries < 400 && hits < 40; tries++) {
    vec3 points[6];
    points[0] = vec_scale(2.0, rng_unit(&r));
    for (int k = 1; k < 6; k++) points[k] = vec_add(vec_scale(1.0 - 0.25 * k, points[0]), rng_in_cube(&r, 0.2));
    cprox_curve *curve = bezier(points, 6);
    cprox_result result;
    cprox_time_of_contact(cprox_tube_along(curve, radius), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws,
                          &result);
    if (result.verdict == CPROX_VERDICT_VIOLATED && result.t_contact_lower > 0.0) {
      hits++;
      nodes += result.nodes;
      for (int k = 0; k < 3; k++) {
        vec3 at;
        cprox_curve_evaluate(curve,
                             result.t_contact_lower * (k == 0   ? 1.0
                                                       : k == 1 ? 0.9
                                                                : 0.5),
                             NULL, &at, NULL, NULL);
        const long double distance = mesh_distance(&mesh, (vec3l){at.x, at.y, at.z});
        if (!(distance > radius - 1e-13)) fail_msg("late: %.17Lg", distance);
      }
    }
    cprox_curve_free(curve);
  }
  assert_int_equal(hits, 40);
  if (nodes > 40 * 16) fail_msg("%u intervals", nodes);
  cprox_body_free(body);
  mesh_free(&mesh);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
