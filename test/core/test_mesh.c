/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves against meshes: sound, as narrow as asked, whatever the triangles look like. */
#include <stdio.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/meshes.h"

/* ---- builders ---- */

typedef struct test_bezier {
  size_t degree;
  vec3 points[12];
  cprox_curve *curve;
} test_bezier;

static test_bezier bezier_make(const vec3 *points, size_t degree) {
  test_bezier b = {.degree = degree};
  memcpy(b.points, points, (degree + 1) * sizeof *points);
  if (curve_from(describe_bezier(b.points, degree + 1, 0.0, 1.0), ws, &b.curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return b;
}

/* Of the curve's point at t from the posed mesh, exactly but for long double. */
static long double distance_at(const test_bezier *b, const test_mesh *mesh, const cprox_pose *pose, long double t) {
  return mesh_distance(mesh, ref_to_local(pose, ref_bezier(b->points, b->degree, t, 0)));
}

/* The least distance near t: the best of a few steps of golden section. */
static long double least_near(const test_bezier *b, const test_mesh *mesh, const cprox_pose *pose, long double t,
                              long double h) {
  long double low = fmaxl(t - h, 0.0L), high = fminl(t + h, 1.0L), least = distance_at(b, mesh, pose, t);
  for (int i = 0; i < 24; i++) {
    const long double p = low + 0.381966L * (high - low), q = low + 0.618034L * (high - low);
    const long double dp = distance_at(b, mesh, pose, p), dq = distance_at(b, mesh, pose, q);
    least = fminl(least, fminl(dp, dq));
    if (dp < dq)
      high = q;
    else
      low = p;
  }
  return least;
}

/* ---- distance ---- */

/* 2,000 random queries (seed 51; CPROX_TEST_SCALE=50 asks 100,000) against soups with needles, points and repeated
 * triangles, and closed tori, at any pose and margin, offsets up to 1e6 m of pose and curve together. epsilon is 1e-12
 * at unit scale, where double allows it. Wanted: lower <= the true distance anywhere on the curve, the true distance at
 * t <= upper. No tolerance: rounding is the interval's own affair; the reference's, some 40 roundings of 2^-64 of the
 * sizes, is given away. */
CASE(distance_holds_everywhere_and_at_its_witness) {
  rng r = rng_seed(51);
  const cprox_options options = accurate(1e-12);
  size_t unconverged = 0;
  const size_t cases = test_cases(2000);
  for (size_t i = 0; i < cases; i++) {
    const size_t m = 1 + rng_index(&r, 60);
    test_mesh mesh = i % 2 ? mesh_soup(&r, m, 1.0, rng_log_uniform(&r, 1e-2, 1.0))
                           : mesh_torus(4 + rng_index(&r, 5), 3 + rng_index(&r, 4), 1.0, 0.3, 0.2);
    cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
    cprox_pose pose = i % 3 ? rng_pose(&r, 1.0) : CPROX_POSE_IDENTITY;
    vec3 points[12];
    const size_t degree = 1 + rng_index(&r, 8);
    for (size_t k = 0; k <= degree; k++) points[k] = rng_in_cube(&r, i % 5 ? 1.5 : 4.0);
    if (i % 7 == 0) {
      const vec3 offset = rng_in_cube(&r, 1e6);
      pose.position = vec_add(pose.position, offset);
      for (size_t k = 0; k <= degree; k++) points[k] = vec_add(points[k], offset);
    }
    const test_bezier b = bezier_make(points, degree);
    const double radius = i % 4 ? 0.0 : rng_uniform(&r, 0.0, 0.3), margin = i % 6 ? 0.0 : 0.1;
    cprox_result result;
    const cprox_status status =
        cprox_distance(cprox_tube_along(b.curve, radius), cprox_with_margin(cprox_obstacle_at(body, pose), margin),
                       &options, ws, &result);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
    if (status != CPROX_OK) unconverged++;
    if (status == CPROX_OK && result.upper - result.lower > 1e-12) fail_msg("case %zu: too wide", i);

    const long double grown = (long double)radius + (long double)margin, give = i % 7 ? 1e-17L : 2e-12L;
    const long double at = fmaxl(distance_at(&b, &mesh, &pose, result.t) - grown, 0.0L);
    if (at > result.upper + give) fail_msg("case %zu: %Lg at t, above upper %g", i, at, result.upper);
    long double least = fmaxl(least_near(&b, &mesh, &pose, result.t, 1e-3L) - grown, 0.0L);
    for (int k = 0; k <= 8; k++)
      least = fminl(least, fmaxl(distance_at(&b, &mesh, &pose, (long double)rng_uniform(&r, 0.0, 1.0)) - grown, 0.0L));
    if (least < result.lower - give) fail_msg("case %zu: %Lg somewhere, below lower %g", i, least, result.lower);
    cprox_curve_free(b.curve);
    cprox_body_free(body);
    mesh_free(&mesh);
  }
  /* at unit scale 1e-12 is in reach; at 1e6 m the curve's own rounding is 1e-10, and needles cost more */
  if (unconverged > cases / 4) fail_msg("%zu of %zu did not converge", unconverged, cases);
}

/* ---- time of contact ---- */

/* 240 runs (seed 53; CPROX_TEST_SCALE=15 makes 3,600) of points and tubes through thin plates and past them so that
 * they graze, over a torus, and through it; epsilon 1e-9. Never late: at 60 parameters before t_contact_lower, the last
 * one 1e-9 before it, the distance in long double is above 0. Not missed: at t_contact_lower it is at most epsilon,
 * unless t_contact_lower is the end. Where contact is said to be proven, the distance at t is at most rounding, 1e-13,
 * or the curve has gone through. */
CASE(time_of_contact_is_never_late_and_never_missed) {
  rng r = rng_seed(53);
  const cprox_options options = accurate(1e-9);
  size_t hits = 0;
  const size_t cases = test_cases(240);
  for (size_t i = 0; i < cases; i++) {
    test_mesh mesh = i % 4 == 0   ? mesh_torus(12, 8, 0.5, 0.2, 0.1)
                     : i % 4 == 1 ? mesh_plate(1 + rng_index(&r, 6), 0.6)
                                  : mesh_box(vec(0.5, 0.5, rng_log_uniform(&r, 1e-6, 1e-2)));
    cprox_body *body = mesh_body(&mesh, i % 8 < 4 ? CPROX_MESH_FILL_SURFACE : CPROX_MESH_FILL_SOLID, ws);
    const cprox_pose pose = rng_pose(&r, 0.3);
    const double radius = i % 3 == 0 ? 0.0 : rng_log_uniform(&r, 1e-4, 0.2);
    vec3 points[4];
    for (size_t k = 0; k < 4; k++) points[k] = rng_in_cube(&r, 1.2);
    if (i % 5 == 0) { /* a parabola that comes within a hair of the plate's plane, or into it by a hair */
      const double depth = rng_uniform(&r, -1e-7, 1e-7);
      const frame f = frame_create(&pose, vec(0, 0, 0));
      const double height = radius + depth + (i % 4 >= 2 ? mesh.vertices[7].z : 0.0);
      points[0] = frame_to_world(&f, vec(-0.4, 0.1, height + 0.5));
      points[1] = frame_to_world(&f, vec(0.0, 0.1, height - 0.5));
      points[2] = frame_to_world(&f, vec(0.4, 0.1, height + 0.5));
    }
    const test_bezier b = bezier_make(points, i % 5 == 0 ? 2 : 3);
    cprox_result result;
    const cprox_status status =
        cprox_time_of_contact(cprox_tube_along(b.curve, radius), cprox_obstacle_at(body, pose), &options, ws, &result);
    if (status != CPROX_OK) fail_msg("case %zu: %s: %s", i, cprox_status_name(status), cprox_workspace_error(ws));
    const bool inside_first = cprox_body_get_info(body).is_solid && result.t_contact_lower == 0.0;
    if (result.verdict != CPROX_VERDICT_CLEAR) {
      hits++;
      const long double there = distance_at(&b, &mesh, &pose, result.t_contact_lower) - (long double)radius;
      if (there > 1e-9L && !inside_first) fail_msg("case %zu: %Lg away at t_contact_lower", i, there);
    } else if (result.t_contact_lower != 1.0 || !(result.lower > 0.0)) {
      fail_msg("case %zu: no contact, but free to %g and at least %g away", i, result.t_contact_lower, result.lower);
    }
    for (int k = 1; k <= 60; k++) {
      const long double t = k == 60 ? (long double)result.t_contact_lower - 1e-9L
                                    : (long double)result.t_contact_lower * (long double)rng_uniform(&r, 0.0, 1.0);
      if (t < 0.0L || t >= (long double)result.t_contact_lower) continue;
      const long double before = distance_at(&b, &mesh, &pose, t) - (long double)radius;
      if (before <= 0.0L)
        fail_msg("case %zu: late: %Lg at %.17Lg, free to %.17g", i, before, t, result.t_contact_lower);
    }
    if (result.verdict == CPROX_VERDICT_VIOLATED && result.t < result.t_contact_lower)
      fail_msg("case %zu: proven before it is free", i);
    cprox_curve_free(b.curve);
    cprox_body_free(body);
    mesh_free(&mesh);
  }
  assert_true(hits > cases / 4 && hits < cases);
}

/* A point that goes through a surface: the crossing itself is the proof. */
CASE(a_point_through_a_surface_is_a_proven_collision) {
  rng r = rng_seed(57);
  test_mesh mesh = mesh_torus(24, 16, 1.0, 0.3, 0.1);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  for (int i = 0; i < 100; i++) {
    const vec3 points[3] = {vec(rng_uniform(&r, -0.1, 0.1), 0.02, 0.0), rng_in_cube(&r, 1.0),
                            vec_scale(1.0, vec(1.0, rng_uniform(&r, -0.05, 0.05), 0.01))};
    const test_bezier b = bezier_make(points, 2);
    cprox_result result;
    assert_int_equal(
        cprox_collision(cprox_point_along(b.curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), NULL, ws, &result),
        CPROX_OK);
    if (result.verdict != CPROX_VERDICT_VIOLATED)
      fail_msg("case %d: %s, [%g, %g]", i, cprox_verdict_name(result.verdict), result.lower, result.upper);
    assert_int_equal(result.lod, CPROX_LOD_MESH);
    cprox_curve_free(b.curve);
  }
  cprox_body_free(body);
  mesh_free(&mesh);
}

/* ---- solids ---- */

/* 300 points (seed 59) against the winding number of all triangles in long double, where they are 1e-9 off the surface.
 */
CASE(a_closed_mesh_is_solid_inside) {
  rng r = rng_seed(59);
  test_mesh mesh = mesh_torus(30, 20, 1.0, 0.4, 0.2);
  cprox_body *solid = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws);
  assert_true(cprox_body_get_info(solid).is_solid);
  size_t inside = 0;
  for (int i = 0; i < 300; i++) {
    const vec3 p = rng_in_cube(&r, 1.4);
    if (mesh_distance(&mesh, ref_vec(p)) < 1e-9L) continue;
    const bool wanted = fabsl(mesh_winding(&mesh, ref_vec(p))) > 0.5L;
    inside += wanted;
    assert_true((cprox_body_nearest(solid, p, NULL) < 0.0) == wanted);
    const vec3 points[2] = {p, vec_add(p, rng_in_cube(&r, 1e-12))};
    const test_bezier b = bezier_make(points, 1);
    cprox_result result;
    cprox_collision(cprox_point_along(b.curve), cprox_obstacle_at(solid, CPROX_POSE_IDENTITY), NULL, ws, &result);
    if (wanted) assert_int_equal(result.verdict, CPROX_VERDICT_VIOLATED);
    if (mesh_distance(&mesh, ref_vec(p)) > 1e-5L && !wanted) assert_int_equal(result.verdict, CPROX_VERDICT_CLEAR);
    cprox_curve_free(b.curve);
  }
  assert_true(inside > 30);
  cprox_body_free(solid);

  /* one triangle less, and it is a surface */
  mesh.m--;
  solid = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws);
  assert_false(cprox_body_get_info(solid).is_solid);
  cprox_body_free(solid);
  mesh_free(&mesh);
}

/* Whether a point is inside is found by a ray in one of three directions. 100 tetrahedra (seed 60) whose corners lie on
 * all three rays from a point inside, and as many points from which a ray meets a corner of a torus. */
CASE(inside_is_found_where_rays_meet_corners) {
  static const vec3 RAYS[3] = {{0.5377, 0.7419, 0.4006}, {-0.3121, 0.6233, -0.7170}, {0.6011, -0.4127, 0.6843}};
  rng r = rng_seed(60);
  for (int i = 0; i < 100; i++) {
    const vec3 p = i % 2 ? rng_in_cube(&r, 1.0) : vec(0.0, 0.0, 0.0);
    vec3 corners[4] = {p, p, p, p};
    for (int k = 0; k < 3; k++) {
      const double far = i < 10 ? 1.0 : rng_uniform(&r, 0.5, 2.0);
      corners[k] = vec_axpy(p, far, RAYS[k]);
      corners[3] = vec_axpy(corners[3], -far, RAYS[k]);
    }
    const uint32_t triangles[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_mesh(corners, 4, triangles, 4, CPROX_MESH_FILL_SOLID, SIZE_MAX, ws, &body),
                     CPROX_OK);
    assert_true(cprox_body_get_info(body).is_solid);
    assert_true(cprox_body_nearest(body, p, NULL) < 0.0);
    assert_true(cprox_body_nearest(body, vec_axpy(p, 4.0, vec_sub(p, corners[3])), NULL) > 0.0);
    cprox_body_free(body);
  }

  test_mesh mesh = mesh_torus(30, 20, 1.0, 0.4, 0.2);
  cprox_body *solid = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws);
  size_t inside = 0;
  for (int i = 0; i < 100; i++) {
    const vec3 p = vec_axpy(mesh.vertices[rng_index(&r, (uint32_t)mesh.n)], -rng_uniform(&r, 0.01, 0.7), RAYS[i % 3]);
    if (mesh_distance(&mesh, ref_vec(p)) < 1e-9L) continue;
    const bool wanted = fabsl(mesh_winding(&mesh, ref_vec(p))) > 0.5L;
    inside += wanted;
    assert_true((cprox_body_nearest(solid, p, NULL) < 0.0) == wanted);
  }
  assert_in_range(inside, 10, 90);
  cprox_body_free(solid);
  mesh_free(&mesh);
}

/* 100 bodies (seed 62) of 1 to 3000 triangles, points and boxes, in 100 directions each, against all their corners.
 * Tolerance: 1e-14 of the sizes, about 20 roundings on either side. */
CASE(support_values_are_those_of_all_corners) {
  rng r = rng_seed(62);
  enum { MOST = 3000 };
  static vec3 low[MOST], high[MOST];
  static uint32_t triangles[MOST][3];
  for (int i = 0; i < 100; i++) {
    const size_t n = 1 + rng_index(&r, i % 5 ? 40 : MOST);
    const vec3 at = rng_in_cube(&r, 3.0);
    for (size_t k = 0; k < n; k++) {
      low[k] = vec_add(at, rng_in_cube(&r, 1.0));
      high[k] = vec_add(low[k], vec(rng_uniform(&r, 0, 0.2), rng_uniform(&r, 0, 0.2), k % 9 ? 0.1 : 0.0));
      for (int c = 0; c < 3; c++) triangles[k][c] = (uint32_t)rng_index(&r, (uint32_t)n);
    }
    cprox_body *body = NULL;
    const cprox_status made = i % 3 == 0   ? cprox_body_create_mesh(low, n, (const uint32_t(*)[3])triangles, n,
                                                                    CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &body)
                              : i % 3 == 1 ? cprox_body_create_points(low, n, 0.0, SIZE_MAX, ws, &body)
                                           : cprox_body_create_boxes(low, high, n, SIZE_MAX, ws, &body);
    assert_int_equal(made, CPROX_OK);
    for (int k = 0; k < 100; k++) {
      vec3 d = rng_in_cube(&r, 1.0), point;
      if (k < 6) d = vec(k / 2 == 0, k / 2 == 1, k / 2 == 2), d = k % 2 ? d : vec_neg(d);
      double most = -INFINITY;
      for (size_t e = 0; e < n; e++) {
        for (int c = 0; c < (i % 3 == 0 ? 3 : 1); c++) {
          const vec3 v = i % 3 == 0 ? low[triangles[e][c]] : low[e];
          most = fmax(most, vec_dot(d, v));
        }
        if (i % 3 == 2)
          most = fmax(most, vec_dot(d, vec(d.x > 0 ? high[e].x : low[e].x, d.y > 0 ? high[e].y : low[e].y,
                                           d.z > 0 ? high[e].z : low[e].z)));
      }
      const double h = cprox_body_support(body, d, &point);
      assert_true(fabs(h - most) <= 1e-14 * 10.0);
      assert_true(fabs(vec_dot(d, point) - h) <= 1e-14 * 10.0);
    }
    cprox_body_free(body);
  }
}

/* Two pyramids of 100 sides on one base, apexes first in the order of places: closed, and open without one triangle or
 * with one turned over. */
CASE(closedness_is_found_at_vertices_of_many_edges) {
  enum { SIDES = 100 };
  vec3 v[SIDES + 2];
  uint32_t t[2 * SIDES][3];
  v[0] = vec(-5, 0, 1), v[1] = vec(-5, 0, -1);
  for (uint32_t i = 0; i < SIDES; i++) {
    const double angle = 6.283185307179586 * i / SIDES;
    const uint32_t a = 2 + i, b = 2 + (i + 1) % SIDES;
    v[a] = vec(cos(angle), sin(angle), 0);
    t[2 * i][0] = 0, t[2 * i][1] = a, t[2 * i][2] = b;
    t[2 * i + 1][0] = 1, t[2 * i + 1][1] = b, t[2 * i + 1][2] = a;
  }
  for (size_t m = 2 * SIDES; m >= 2 * SIDES - 1; m--) {
    cprox_body *body = NULL;
    assert_int_equal(
        cprox_body_create_mesh(v, SIDES + 2, (const uint32_t(*)[3])t, m, CPROX_MESH_FILL_SOLID, SIZE_MAX, ws, &body),
        CPROX_OK);
    assert_int_equal(cprox_body_get_info(body).is_solid, m == 2 * SIDES);
    cprox_body_free(body);
  }
  const uint32_t swap = t[7][0];
  t[7][0] = t[7][1], t[7][1] = swap;
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_mesh(v, SIDES + 2, (const uint32_t(*)[3])t, 2 * SIDES, CPROX_MESH_FILL_SOLID,
                                          SIZE_MAX, ws, &body),
                   CPROX_OK);
  assert_false(cprox_body_get_info(body).is_solid);
  cprox_body_free(body);
}

/* Two lines, the first of them outside of a torus, the second one inside of its tube: the spline crosses no triangle. */
CASE(a_spline_that_jumps_into_a_solid_is_in_contact) {
  test_mesh mesh = mesh_torus(30, 20, 1.0, 0.4, 0.0);
  const vec3 points[4] = {{3, 0, 0}, {2.5, 0, 0}, {1, 0, 0}, {1, 0.01, 0}};
  const double knots[6] = {0, 0, 1, 1, 2, 2};
  cprox_curve_description d = describe_bspline(points, 4, 1, knots, 6, 0, 2);
  cprox_curve *curve = NULL;
  assert_int_equal(cprox_curve_create(&d, ws, &curve), CPROX_OK);
  for (int solid = 0; solid < 2; solid++) {
    cprox_body *body = mesh_body(&mesh, solid ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
    const cprox_obstacle torus = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    const cprox_mover mover = cprox_point_along(curve);
    cprox_result r;
    assert_int_equal(cprox_collision(mover, torus, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, solid ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
    assert_int_equal(cprox_distance(mover, torus, NULL, ws, &r), CPROX_OK);
    assert_true(solid ? r.upper == 0.0 && r.t == 1.0 : r.lower > 0.35);
    assert_int_equal(cprox_time_of_contact(mover, torus, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, solid ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
    if (solid) assert_true(r.t_contact_lower <= 1.0 && r.t_contact_lower > 0.99 && r.t == 1.0);
    cprox_body_free(body);
  }
  cprox_curve_free(curve);
  mesh_free(&mesh);
}

/* 200 points (seed 60): the surface of a solid is the mesh made as a surface, and outlives no part of it. */
CASE(a_solid_shares_its_triangles_with_its_surface) {
  rng r = rng_seed(60);
  test_mesh mesh = mesh_torus(30, 20, 1.0, 0.4, 0.2);
  cprox_body *solid = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws),
             *made = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  cprox_body *surface = NULL, *again = NULL;
  assert_int_equal(cprox_body_create_surface(solid, ws, &surface), CPROX_OK);
  assert_int_equal(cprox_body_create_surface(surface, ws, &again), CPROX_OK);
  assert_false(cprox_body_get_info(surface).is_solid);
  for (int i = 0; i < 200; i++) {
    const vec3 p = rng_in_cube(&r, 1.4);
    assert_true(cprox_body_nearest(surface, p, NULL) == cprox_body_nearest(made, p, NULL));
    assert_true(cprox_body_nearest(again, p, NULL) == cprox_body_nearest(made, p, NULL));
    assert_true(cprox_body_support(surface, p, NULL) == cprox_body_support(made, p, NULL));
  }
  cprox_body_free(again);
  cprox_body_free(surface);
  assert_true(cprox_body_nearest(solid, vec(0, 0, 0), NULL) > 0.0);
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_surface(box, ws, &again), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "must be a mesh"));
  assert_int_equal(cprox_body_create_surface(NULL, ws, &again), CPROX_INVALID);
  assert_int_equal(cprox_body_create_surface(solid, ws, NULL), CPROX_INVALID);
  cprox_body_free(box);
  cprox_body_free(made);
  cprox_body_free(solid);
  mesh_free(&mesh);
}

/* ---- points and boxes ---- */

/* 600 random queries (seed 61) against clouds and boxes, held against every element in long double; epsilon 1e-6. */
CASE(clouds_and_boxes_hold_too) {
  rng r = rng_seed(61);
  const cprox_options options = accurate(1e-6);
  for (size_t i = 0; i < test_cases(600); i++) {
    vec3 low[200], high[200];
    const size_t n = 1 + rng_index(&r, 200);
    const bool boxes = i % 2;
    const double radius = rng_uniform(&r, 0.0, 0.05);
    for (size_t k = 0; k < n; k++) {
      low[k] = rng_in_cube(&r, 1.0);
      high[k] = vec_add(low[k], vec(rng_uniform(&r, 0, 0.2), rng_uniform(&r, 0, 0.2), k % 9 ? 0.1 : 0.0));
    }
    cprox_body *body = NULL;
    assert_int_equal(boxes ? cprox_body_create_boxes(low, high, n, SIZE_MAX, ws, &body)
                           : cprox_body_create_points(low, n, radius, SIZE_MAX, ws, &body),
                     CPROX_OK);
    const cprox_pose pose = rng_pose(&r, 0.5);
    vec3 points[5];
    for (size_t k = 0; k < 5; k++) points[k] = rng_in_cube(&r, 1.5);
    const test_bezier b = bezier_make(points, 4);
    cprox_result result;
    const cprox_status status =
        cprox_distance(cprox_point_along(b.curve), cprox_obstacle_at(body, pose), &options, ws, &result);
    if (status != CPROX_OK)
      fail_msg("case %zu: %s, [%.12g, %.12g], %u nodes", i, cprox_status_name(status), result.lower, result.upper,
               result.nodes);
    for (int k = 0; k < 30; k++) {
      const long double t = k ? (long double)rng_uniform(&r, 0.0, 1.0) : (long double)result.t;
      const vec3l p = ref_to_local(&pose, ref_bezier(b.points, 4, t, 0));
      long double least = INFINITY;
      for (size_t e = 0; e < n; e++) {
        const vec3l middle = ref_scale(0.5L, ref_add(ref_vec(low[e]), ref_vec(high[e])));
        const vec3 half = vec_scale(0.5, vec_sub(high[e], low[e]));
        least = fminl(least, boxes ? ref_point_box(ref_sub(p, middle), half)
                                   : fmaxl(ref_norm(ref_sub(p, ref_vec(low[e]))) - (long double)radius, 0.0L));
      }
      if (least < result.lower - 1e-15L) fail_msg("case %zu: %Lg, below lower %g", i, least, result.lower);
      if (k == 0 && least > result.upper + 1e-15L) fail_msg("case %zu: %Lg, above upper %g", i, least, result.upper);
    }
    cprox_curve_free(b.curve);
    cprox_body_free(body);
  }
}

/* ---- static pairs ---- */

/* 400 pairs (seed 71) of a soup or torus with a ball, and with a box by every triangle's own pair; epsilon 1e-9, so
 * that two answers differ by twice that where they are apart. */
CASE(pairs_answer_as_their_triangles_do) {
  rng r = rng_seed(71);
  const cprox_options options = accurate(1e-9);
  for (size_t i = 0; i < test_cases(400); i++) {
    test_mesh mesh = i % 2 ? mesh_soup(&r, 1 + rng_index(&r, 40), 1.0, 0.2) : mesh_torus(9, 7, 1.0, 0.3, 0.2);
    cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws), *other = NULL;
    const double radius = rng_uniform(&r, 0.01, 0.2);
    const bool ball = i % 4 < 2;
    if (ball)
      assert_int_equal(cprox_body_create_sphere(radius, ws, &other), CPROX_OK);
    else
      assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &other), CPROX_OK);
    const cprox_pose at = rng_pose(&r, 1.0), there = rng_pose(&r, 1.5);
    cprox_result result;
    const cprox_status status =
        cprox_pair(cprox_obstacle_at(other, there), cprox_obstacle_at(body, at), &options, ws, &result);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
    if (ball) {
      const long double d = mesh_distance(&mesh, ref_to_local(&at, ref_vec(there.position))) - (long double)radius;
      if (!(result.lower - 1e-15 <= (double)d && (double)d <= result.upper + 1e-15))
        fail_msg("case %zu: %Lg, not in [%g, %g]", i, d, result.lower, result.upper);
    } else {
      double least = INFINITY;
      for (size_t k = 0; k < mesh.m; k++) {
        vec3 v[3];
        for (int c = 0; c < 3; c++) v[c] = mesh.vertices[mesh.triangles[k][c]];
        cprox_body *triangle = NULL;
        assert_int_equal(cprox_body_create_polytope(v, 3, ws, &triangle), CPROX_OK);
        cprox_result one;
        cprox_pair(cprox_obstacle_at(other, there), cprox_obstacle_at(triangle, at), &options, ws, &one);
        least = fmin(least, one.upper);
        cprox_body_free(triangle);
      }
      if (least > 1e-8 && fabs(result.upper - least) > 2e-9) fail_msg("case %zu: %g, but %g", i, result.upper, least);
      if (least > 1e-8 && !(result.upper - result.lower <= 1e-9))
        fail_msg("case %zu: [%g, %g]", i, result.lower, result.upper);
      if (least <= 0.0) assert_true(result.upper <= 1e-9);
    }
    cprox_body_free(other);
    cprox_body_free(body);
    mesh_free(&mesh);
  }
}

/* ---- bad input ---- */

static void expect_reason(cprox_status status, cprox_status wanted, const char *words) {
  assert_int_equal(status, wanted);
  if (!strstr(cprox_workspace_error(ws), words)) fail_msg("'%s' does not say '%s'", cprox_workspace_error(ws), words);
}

CASE(bad_input_is_refused_with_a_message) {
  cprox_body *body = NULL;
  vec3 v[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const uint32_t good[1][3] = {{0, 1, 2}}, bad[2][3] = {{0, 1, 2}, {0, 1, 3}};
  expect_reason(cprox_body_create_mesh(v, 3, bad, 2, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &body), CPROX_INVALID,
                "triangle 1 names vertex 3");
  expect_reason(cprox_body_create_mesh(v, 3, good, 0, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &body), CPROX_INVALID,
                "no triangles");
  expect_reason(cprox_body_create_mesh(v, 3, good, 1, CPROX_MESH_FILL_SURFACE, 100, ws, &body), CPROX_MEMORY, "bytes");
  expect_reason(cprox_body_create_points(v, 10000000, 0.0, 1000000, ws, &body), CPROX_MEMORY, "10000000 points need");
  expect_reason(cprox_body_create_points(v, 0, 0.0, SIZE_MAX, ws, &body), CPROX_INVALID, "no points");
  expect_reason(cprox_body_create_points(v, 3, -1.0, SIZE_MAX, ws, &body), CPROX_INVALID, "radius");
  const vec3 low[1] = {{0, 0, 0}}, high[1] = {{1, -1, 1}};
  expect_reason(cprox_body_create_boxes(low, high, 1, SIZE_MAX, ws, &body), CPROX_INVALID, "box 0");

  /* what these bodies cannot answer */
  const vec3 top[1] = {{1, 1, 1}}, way[2] = {{1, -1, 0}, {1, 1, 0}};
  const test_bezier path = bezier_make(way, 1);
  cprox_body *boxes = NULL, *ball = NULL;
  cprox_result unused;
  assert_int_equal(cprox_body_create_boxes(low, top, 1, SIZE_MAX, ws, &boxes), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(boxes, CPROX_POSE_IDENTITY);
  expect_reason(cprox_distance(cprox_body_along(ball, path.curve), target, NULL, ws, &unused), CPROX_INVALID,
                "carried");
  expect_reason(cprox_distance(cprox_body_along(boxes, path.curve), target, NULL, ws, &unused), CPROX_INVALID,
                "carried");
  cprox_body_free(boxes);
  cprox_body_free(ball);
  cprox_curve_free(path.curve);

  for (int k = 0; k < 2; k++) {
    v[1].y = k ? NAN : INFINITY;
    expect_reason(cprox_body_create_mesh(v, 3, good, 1, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &body), CPROX_INVALID,
                  "vertex 1");
    expect_reason(cprox_body_create_points(v, 3, 0.0, SIZE_MAX, ws, &body), CPROX_INVALID, "point 1");
  }
  assert_null(body);

  /* one triangle without area is a mesh */
  const vec3 flat[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  assert_int_equal(cprox_body_create_mesh(flat, 3, good, 1, CPROX_MESH_FILL_SOLID, SIZE_MAX, ws, &body), CPROX_OK);
  assert_false(cprox_body_get_info(body).is_solid);
  const vec3 line[2] = {{1, -1, 0}, {1, 1, 0}};
  const test_bezier b = bezier_make(line, 1);
  cprox_result result;
  assert_int_equal(
      cprox_distance(cprox_point_along(b.curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), NULL, ws, &result),
      CPROX_OK);
  assert_true(result.lower <= 1.0 && 1.0 <= result.upper);
  cprox_body_free(body);
  cprox_curve_free(b.curve);
}

/* A tube between two sheets, and after it a second query of the same kind: the second one allocates nothing. */
CASE(queries_do_not_allocate_once_the_workspace_has_grown) {
  rng r = rng_seed(67);
  test_mesh mesh = mesh_torus(40, 30, 1.0, 0.3, 0.1);
  cprox_body *body = mesh_body(&mesh, CPROX_MESH_FILL_SURFACE, ws);
  vec3 points[6];
  for (size_t k = 0; k < 6; k++) points[k] = rng_in_cube(&r, 1.0);
  const test_bezier b = bezier_make(points, 5);
  size_t before = 0;
  for (int i = 0; i < 2; i++) {
    before = allocations_made();
    cprox_result result;
    cprox_distance(cprox_tube_along(b.curve, 0.01), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), NULL, ws, &result);
    cprox_time_of_contact(cprox_tube_along(b.curve, 0.01), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), NULL, ws,
                          &result);
  }
  assert_int_equal(allocations_made(), before);
  cprox_curve_free(b.curve);
  cprox_body_free(body);
  mesh_free(&mesh);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
