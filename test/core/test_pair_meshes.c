/* SPDX-License-Identifier: BSD-3-Clause */
/* Standing meshes, clouds and boxes against each other: as all pairs of their elements say. */
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"

/* The least of all pairs of triangles, each by its own pair of polytopes. */
static double by_triangles(const test_mesh *a, const cprox_pose *at, const test_mesh *b, const cprox_pose *there,
                           const cprox_options *options) {
  double least = INFINITY;
  for (size_t i = 0; i < a->m; i++) {
    vec3 v[3];
    cprox_body *one = NULL;
    for (int c = 0; c < 3; c++) v[c] = a->vertices[a->triangles[i][c]];
    assert_int_equal(cprox_body_create_polytope(v, 3, ws, &one), CPROX_OK);
    for (size_t k = 0; k < b->m; k++) {
      cprox_body *two = NULL;
      cprox_result r;
      for (int c = 0; c < 3; c++) v[c] = b->vertices[b->triangles[k][c]];
      assert_int_equal(cprox_body_create_polytope(v, 3, ws, &two), CPROX_OK);
      cprox_pair(cprox_obstacle_at(one, *at), cprox_obstacle_at(two, *there), options, ws, &r);
      least = fmin(least, r.upper);
      cprox_body_free(two);
    }
    cprox_body_free(one);
  }
  return least;
}

/* 60 pairs (seed 141) of soups and tori of 10 to 60 triangles, apart or not; epsilon 1e-9, so that two answers that are
 * apart differ by twice that. The witnesses are as far apart as is said, and the normal is theirs. */
CASE(meshes_are_as_far_apart_as_their_nearest_triangles) {
  rng r = rng_seed(141);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  size_t touching = 0, apart = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    test_mesh a = i % 2 ? mesh_soup(&r, 10 + rng_index(&r, 30), 1.0, 0.3) : mesh_torus(6, 5, 1.0, 0.3, 0.2);
    test_mesh b = i % 3 ? mesh_soup(&r, 10 + rng_index(&r, 30), 1.0, 0.3) : mesh_torus(5, 4, 1.0, 0.2, 0.1);
    cprox_body *x = mesh_body(&a, CPROX_MESH_FILL_SURFACE, ws), *y = mesh_body(&b, CPROX_MESH_FILL_SURFACE, ws);
    const cprox_pose at = rng_pose(&r, 1.0);
    cprox_pose there = rng_pose(&r, 1.0);
    there.position = vec_add(there.position, vec(i % 4 ? 2.0 : 0.5, 0, 0));
    cprox_result result;
    const cprox_status status =
        cprox_pair(cprox_obstacle_at(x, at), cprox_obstacle_at(y, there), &options, ws, &result);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
    const double wanted = by_triangles(&a, &at, &b, &there, &options);
    if (wanted > 1e-8) {
      apart++;
      assert_int_equal(status, CPROX_OK);
      if (fabs(result.upper - wanted) > 2e-9 || result.lower > wanted || result.upper - result.lower > 1e-9)
        fail_msg("case %zu: [%.12g, %.12g], but %.12g", i, result.lower, result.upper, wanted);
      const vec3 way = vec_sub(result.witness_mover, result.witness_obstacle);
      assert_true(fabs(vec_norm(way) - result.upper) < 1e-8);
      assert_true(vec_dot(way, result.normal) > 0.999 * vec_norm(way));
    } else {
      touching++;
      assert_true(result.upper <= 1e-9 && result.lower <= 0.0);
    }
    cprox_body_free(x);
    cprox_body_free(y);
    mesh_free(&a);
    mesh_free(&b);
  }
  assert_true(touching > 5 && apart > 5);
}

/* Tori of 2,000 triangles (seed 143), clouds and boxes against each other: the same both ways round, with margin, and
 * no farther than at any of 200 vertices. */
CASE(large_meshes_clouds_and_boxes_too) {
  rng r = rng_seed(143);
  test_mesh torus = mesh_torus(40, 25, 1.0, 0.3, 0.1);
  vec3 low[300], high[300];
  for (int k = 0; k < 300; k++) low[k] = rng_in_cube(&r, 1.0), high[k] = vec_add(low[k], vec(0.05, 0.1, 0.02));
  cprox_body *bodies[3] = {mesh_body(&torus, CPROX_MESH_FILL_SURFACE, ws)};
  assert_int_equal(cprox_body_create_points(low, 300, 0.01, SIZE_MAX, ws, &bodies[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_boxes(low, high, 300, SIZE_MAX, ws, &bodies[2]), CPROX_OK);
  for (int i = 0; i < 60; i++) {
    const cprox_pose at = rng_pose(&r, 0.5);
    cprox_pose there = rng_pose(&r, 0.5);
    there.position.x += 4.5;
    const cprox_obstacle a = cprox_with_margin(cprox_obstacle_at(bodies[i % 3], at), i % 2 ? 0.0 : 0.02),
                         b = cprox_obstacle_at(bodies[i / 3 % 3], there);
    cprox_result one, two;
    assert_int_equal(cprox_pair(a, b, NULL, ws, &one), CPROX_OK);
    assert_int_equal(cprox_pair(b, a, NULL, ws, &two), CPROX_OK);
    assert_true(one.lower <= two.upper && two.lower <= one.upper && one.upper > 0.0);
    assert_int_equal(one.lod, CPROX_LOD_MESH);
    const frame f = frame_create(&there, vec(0, 0, 0)), g = frame_create(&at, vec(0, 0, 0));
    for (int k = 0; k < 200; k++) {
      const vec3 v = i / 3 % 3 ? low[k] : torus.vertices[k];
      double unused = 0.0;
      const double d = cprox_body_nearest(a.body, frame_to_local(&g, frame_to_world(&f, v), &unused), NULL);
      assert_true(one.lower <= d - a.margin + 1e-12);
    }
  }
  for (int k = 0; k < 3; k++) cprox_body_free(bodies[k]);
  mesh_free(&torus);
}

/* A small box inside a hollow one: clear of the surface, inside of the solid. */
CASE(one_inside_a_solid_overlaps_it) {
  test_mesh large = mesh_box(vec(1, 1, 1)), small = mesh_box(vec(0.1, 0.1, 0.1));
  cprox_body *solid = mesh_body(&large, CPROX_MESH_FILL_SOLID, ws),
             *surface = mesh_body(&large, CPROX_MESH_FILL_SURFACE, ws);
  cprox_body *inner = mesh_body(&small, CPROX_MESH_FILL_SURFACE, ws);
  const cprox_pose here = CPROX_POSE_IDENTITY;
  cprox_result r;
  for (int swapped = 0; swapped < 2; swapped++) {
    const cprox_obstacle a = cprox_obstacle_at(swapped ? inner : solid, here),
                         b = cprox_obstacle_at(swapped ? solid : inner, here);
    assert_int_equal(cprox_pair(a, b, NULL, ws, &r), CPROX_OVERLAP);
    assert_true(r.upper <= 0.0);
  }
  assert_int_equal(cprox_pair(cprox_obstacle_at(surface, here), cprox_obstacle_at(inner, here), NULL, ws, &r),
                   CPROX_OK);
  assert_true(r.lower <= 0.9 && 0.9 <= r.upper);
  cprox_body_free(solid);
  cprox_body_free(surface);
  cprox_body_free(inner);
  mesh_free(&large);
  mesh_free(&small);
}

/* ---- what it costs ---- */

/* A tube along z of `around` times `along` pairs of triangles, open at both ends: few along it make them long and thin.
 */
static test_mesh open_tube(rng *r, size_t around, size_t along, double radius, double length) {
  test_mesh tube = {.n = around * (along + 1), .m = 0};
  tube.vertices = malloc(tube.n * sizeof *tube.vertices);
  tube.triangles = malloc(2 * around * along * sizeof *tube.triangles);
  for (size_t k = 0; k <= along; k++) {
    for (size_t i = 0; i < around; i++) {
      const double a = 6.283185307179586 * (double)i / (double)around, z = length * ((double)k / (double)along - 0.5);
      const double wide = radius * (1.0 + 0.1 * sin(3.0 * a) + rng_uniform(r, 0.0, 0.01));
      tube.vertices[k * around + i] = vec(wide * cos(a), wide * sin(a), z);
    }
  }
  for (size_t k = 0; k < along; k++) {
    for (size_t i = 0; i < around; i++) {
      const uint32_t a = (uint32_t)(k * around + i), b = (uint32_t)(k * around + (i + 1) % around);
      const uint32_t c = a + (uint32_t)around, d = b + (uint32_t)around;
      memcpy(tube.triangles[tube.m++], (uint32_t[3]){a, b, d}, sizeof *tube.triangles);
      memcpy(tube.triangles[tube.m++], (uint32_t[3]){a, d, c}, sizeof *tube.triangles);
    }
  }
  return tube;
}

static test_mesh any_mesh(rng *r, size_t kind) {
  switch (kind % 4) {
    case 0: return mesh_soup(r, 20 + rng_index(r, 400), 1.0, 0.3);
    case 1: return mesh_torus(6 + rng_index(r, 20), 5 + rng_index(r, 15), 1.0, 0.3, 0.2);
    case 2: return open_tube(r, 20 + rng_index(r, 60), 1 + rng_index(r, 2), 0.3, 2.0);
    default: return open_tube(r, 20 + rng_index(r, 60), 10 + rng_index(r, 30), 0.3, 2.0);
  }
}

/* 150 pairs (seed 147) of soups, tori and tubes of long and of small triangles, apart, close and crossing, with margin
 * and without: both ways round the same interval and the same cost, and the cost never rises with epsilon, absolute or
 * relative. */
CASE(neither_order_nor_a_looser_epsilon_costs_more) {
  rng r = rng_seed(147);
  static const double EPSILON[][2] = {{0, 0},      {1e-9, 0},     {1e-6, 0}, {1e-6, 1e-3}, {1e-6, 0.1},
                                      {1e-6, 0.5}, {1e-6, 0.999}, {1e-4, 0}, {1e-2, 0},    {1.0, 0}};
  size_t worst = 0;
  for (size_t i = 0; i < test_cases(150); i++) {
    test_mesh a = any_mesh(&r, i), b = any_mesh(&r, i / 4);
    cprox_body *x = mesh_body(&a, CPROX_MESH_FILL_SURFACE, ws), *y = mesh_body(&b, CPROX_MESH_FILL_SURFACE, ws);
    const cprox_pose at = rng_pose(&r, 0.2);
    cprox_pose there = rng_pose(&r, 0.2);
    there.position = vec_axpy(there.position, rng_uniform(&r, 0.5, 3.5), rng_unit(&r));
    const cprox_obstacle one = cprox_with_margin(cprox_obstacle_at(x, at), i % 5 ? 0.0 : 0.01),
                         two = cprox_obstacle_at(y, there);
    uint32_t nodes[sizeof EPSILON / sizeof *EPSILON];
    for (size_t e = 0; e < sizeof EPSILON / sizeof *EPSILON; e++) {
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = EPSILON[e][0], options.relative_epsilon = EPSILON[e][1], options.max_nodes = 1000000;
      cprox_result p, q;
      const cprox_status status = cprox_pair(one, two, &options, ws, &p);
      assert_int_equal(cprox_pair(two, one, &options, ws, &q), status);
      if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_error(ws));
      if (a.m != b.m &&
          (p.nodes != q.nodes || p.distance_queries != q.distance_queries || p.lower != q.lower || p.upper != q.upper))
        fail_msg("case %zu: %u nodes and %u the other way round", i, p.nodes, q.nodes);
      nodes[e] = p.nodes;
      if (p.nodes > worst) worst = p.nodes;
      const size_t looser_than = e == 0 ? 0 : e < 7 ? e - 1 : e == 7 ? 2 : e - 1;
      if (nodes[e] > nodes[looser_than])
        fail_msg("case %zu: epsilon %g, %g takes %u nodes, epsilon %g, %g takes %u", i, EPSILON[e][0], EPSILON[e][1],
                 nodes[e], EPSILON[looser_than][0], EPSILON[looser_than][1], nodes[looser_than]);
      /* an epsilon as wide as the answer is had for the first look at either */
      const double allowed = fmax(options.epsilon, options.relative_epsilon * fabs(p.upper));
      if (status == CPROX_OK && p.upper - p.lower > allowed) fail_msg("case %zu: [%g, %g]", i, p.lower, p.upper);
    }
    cprox_body_free(x);
    cprox_body_free(y);
    mesh_free(&a);
    mesh_free(&b);
  }
  assert_true(worst < 20000);
}

/* A forearm of 1,000 long triangles and a sensor of 43,000 small ones, open, .12 m apart (seed 149): within the default
 * budget, whichever is named first; with a budget of 40 the distance of surfaces is at least 0. */
CASE(a_coarse_mesh_and_a_fine_one_take_the_same_either_way) {
  rng r = rng_seed(149);
  for (int shape = 0; shape < 2; shape++) {
    test_mesh a = shape ? open_tube(&r, 25, 20, 0.055, 0.4) : open_tube(&r, 500, 1, 0.055, 0.4);
    test_mesh b = open_tube(&r, 215, 100, 0.03, 0.12);
    cprox_body *arm = mesh_body(&a, CPROX_MESH_FILL_SURFACE, ws), *sensor = mesh_body(&b, CPROX_MESH_FILL_SURFACE, ws);
    for (int i = 0; i < 10; i++) {
      const cprox_pose at = CPROX_POSE_IDENTITY;
      cprox_pose there = rng_pose(&r, 0.0);
      const double turned = rng_uniform(&r, 0.0, 6.3), away = i % 2 ? 0.25 : 0.35;
      there.position = vec(away * cos(turned), away * sin(turned), rng_uniform(&r, -0.2, 0.2));
      const cprox_obstacle one = cprox_obstacle_at(arm, at), two = cprox_obstacle_at(sensor, there);
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      cprox_result p, q;
      assert_int_equal(cprox_pair(one, two, &options, ws, &p), CPROX_OK);
      assert_int_equal(cprox_pair(two, one, &options, ws, &q), CPROX_OK);
      assert_true(p.nodes == q.nodes && p.distance_queries < 1000 && p.nodes < 10000);
      options.max_nodes = 40;
      if (cprox_pair(one, two, &options, ws, &q) == CPROX_BUDGET)
        assert_true(q.lower >= 0.0 && q.lower <= p.upper && q.upper >= p.lower);
      options.max_nodes = 20000, options.relative_epsilon = 0.999;
      assert_int_equal(cprox_pair(one, two, &options, ws, &q), CPROX_OK);
      assert_true(q.nodes <= p.nodes && q.lower <= p.upper && q.upper >= p.lower);
    }
    cprox_body_free(arm);
    cprox_body_free(sensor);
    mesh_free(&a);
    mesh_free(&b);
  }
}

/* Crossing, or nested, and ended by the budget before that is known: the bounds hold, and of surfaces lower is not
 * below 0 (seed 151). */
CASE(what_a_budget_leaves_open_is_bounded_by_what_is_meant) {
  rng r = rng_seed(151);
  size_t ended = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    test_mesh a = mesh_torus(20, 12, 1.0, 0.3, 0.1), b = mesh_torus(18, 11, 0.5, 0.1, 0.05);
    const bool solid = i % 2;
    cprox_body *x = mesh_body(&a, solid ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
    cprox_body *y = mesh_body(&b, CPROX_MESH_FILL_SURFACE, ws);
    const cprox_obstacle one = cprox_obstacle_at(x, rng_pose(&r, 0.5)), two = cprox_obstacle_at(y, rng_pose(&r, 0.5));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.max_nodes = 5 + (uint32_t)rng_index(&r, 60);
    cprox_result p, all;
    const cprox_status status = cprox_pair(one, two, &options, ws, &p);
    assert_true(cprox_pair(one, two, NULL, ws, &all) >= 0);
    assert_true(p.lower <= all.upper && p.upper >= all.lower);
    if (status == CPROX_BUDGET) {
      ended++;
      if (!solid) assert_true(p.lower >= 0.0);
    }
    cprox_body_free(x);
    cprox_body_free(y);
    mesh_free(&a);
    mesh_free(&b);
  }
  assert_true(ended > test_cases(300) / 15);
}

/* Meshes whose hulls are apart (seed 152) are clear at once, few nodes and supports for any number of triangles; one
 * through the hole of another, whose hulls overlap, is clear by its triangles. */
CASE(hulls_that_are_apart_settle_a_verdict_at_once) {
  rng r = rng_seed(152);
  for (size_t i = 0; i < test_cases(100); i++) {
    test_mesh a = mesh_torus(60, 40, 1.0, 0.3, 0.05), b = mesh_torus(60, 40, 0.3, 0.1, 0.02);
    cprox_body *x = mesh_body(&a, CPROX_MESH_FILL_SOLID, ws), *y = mesh_body(&b, CPROX_MESH_FILL_SURFACE, ws);
    const cprox_pose at = rng_pose(&r, 10.0);
    cprox_pose there = {.position = at.position, .orientation = rng_quat(&r)};
    cprox_result t;
    assert_int_equal(cprox_pair_tolerance(cprox_obstacle_at(x, at), cprox_obstacle_at(y, there), 0.0, NULL, ws, &t),
                     CPROX_OK);
    assert_int_equal(t.verdict, CPROX_VERDICT_CLEAR); /* 0.42 at most in a hole of 0.65 */
    there.position = vec_axpy(at.position, rng_uniform(&r, 1.9, 2.0), rng_unit(&r));
    assert_int_equal(cprox_pair_tolerance(cprox_obstacle_at(x, at), cprox_obstacle_at(y, there), 0.0, NULL, ws, &t),
                     CPROX_OK);
    assert_int_equal(t.verdict, CPROX_VERDICT_CLEAR);
    assert_true(t.nodes + t.distance_queries <= 24);
    cprox_body_free(x);
    cprox_body_free(y);
    mesh_free(&a);
    mesh_free(&b);
  }
}

static bool at_once(void *user) {
  (void)user;
  return true;
}

/* The stop function ends a search through two meshes: what it says is true. */
CASE(a_search_through_meshes_can_be_stopped) {
  test_mesh a = mesh_torus(40, 25, 1.0, 0.3, 0.1);
  cprox_body *x = mesh_body(&a, CPROX_MESH_FILL_SURFACE, ws);
  const cprox_pose there = {.position = {2.8, 0.3, 0.2}, .orientation = {1.0, 0.3, 0.2, 0.1}}; /* not at once */
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  cprox_result p, q;
  assert_int_equal(cprox_pair(cprox_obstacle_at(x, CPROX_POSE_IDENTITY), cprox_obstacle_at(x, there), &options, ws, &p),
                   CPROX_OK);
  options.stop = at_once;
  assert_int_equal(cprox_pair(cprox_obstacle_at(x, CPROX_POSE_IDENTITY), cprox_obstacle_at(x, there), &options, ws, &q),
                   CPROX_STOPPED);
  assert_true(q.lower >= 0.0 && q.lower <= p.upper && q.upper >= p.lower && q.nodes < p.nodes);
  cprox_body_free(x);
  mesh_free(&a);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
