/* SPDX-License-Identifier: BSD-3-Clause */
/* Standing meshes, clouds and boxes against each other: as all pairs of their elements say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

#include "base/frame.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
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
      cprox_pair(cprox_at(one, *at), cprox_at(two, *there), options, ws, &r);
      least = fmin(least, r.upper);
      cprox_body_free(two);
    }
    cprox_body_free(one);
  }
  return least;
}

/* 60 pairs (seed 141) of soups and tori of 10 to 60 triangles, apart or not; epsilon 1e-9, so that two answers that are apart differ by
 * twice that. The witnesses are as far apart as is said, and the normal is theirs. */
static void meshes_are_as_far_apart_as_their_nearest_triangles(void **state) {
  (void)state;
  rng r = rng_seed(141);
  cprox_options options = cprox_options_default();
  options.epsilon = 1e-9;
  size_t touching = 0, apart = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    test_mesh a = i % 2 ? mesh_soup(&r, 10 + rng_index(&r, 30), 1.0, 0.3) : mesh_torus(6, 5, 1.0, 0.3, 0.2);
    test_mesh b = i % 3 ? mesh_soup(&r, 10 + rng_index(&r, 30), 1.0, 0.3) : mesh_torus(5, 4, 1.0, 0.2, 0.1);
    cprox_body *x = mesh_body(&a, CPROX_MESH_SURFACE, ws), *y = mesh_body(&b, CPROX_MESH_SURFACE, ws);
    const cprox_pose at = rng_pose(&r, 1.0);
    cprox_pose there = rng_pose(&r, 1.0);
    there.position = vec_add(there.position, vec(i % 4 ? 2.0 : 0.5, 0, 0));
    cprox_result result;
    const cprox_status status = cprox_pair(cprox_at(x, at), cprox_at(y, there), &options, ws, &result);
    if (status < 0) fail_msg("case %zu: %s", i, cprox_workspace_reason(ws));
    const double wanted = by_triangles(&a, &at, &b, &there, &options);
    if (wanted > 1e-8) {
      apart++;
      assert_int_equal(status, CPROX_OK);
      if (fabs(result.upper - wanted) > 2e-9 || result.lower > wanted || result.upper - result.lower > 1e-9)
        fail_msg("case %zu: [%.12g, %.12g], but %.12g", i, result.lower, result.upper, wanted);
      const vec3 way = vec_sub(result.on_mover, result.on_target);
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

/* Tori of 2,000 triangles (seed 143), clouds and boxes against each other: the same both ways round, with padding, and no farther than at any
 * of 200 vertices. */
static void large_meshes_clouds_and_boxes_too(void **state) {
  (void)state;
  rng r = rng_seed(143);
  test_mesh torus = mesh_torus(40, 25, 1.0, 0.3, 0.1);
  vec3 low[300], high[300];
  for (int k = 0; k < 300; k++) low[k] = rng_in_cube(&r, 1.0), high[k] = vec_add(low[k], vec(0.05, 0.1, 0.02));
  cprox_body *bodies[3] = {mesh_body(&torus, CPROX_MESH_SURFACE, ws)};
  assert_int_equal(cprox_body_create_points(low, 300, 0.01, SIZE_MAX, ws, &bodies[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_boxes(low, high, 300, SIZE_MAX, ws, &bodies[2]), CPROX_OK);
  for (int i = 0; i < 60; i++) {
    const cprox_pose at = rng_pose(&r, 0.5);
    cprox_pose there = rng_pose(&r, 0.5);
    there.position.x += 4.5;
    const cprox_target a = cprox_padded(cprox_at(bodies[i % 3], at), i % 2 ? 0.0 : 0.02),
                       b = cprox_at(bodies[i / 3 % 3], there);
    cprox_result one, two;
    assert_int_equal(cprox_pair(a, b, NULL, ws, &one), CPROX_OK);
    assert_int_equal(cprox_pair(b, a, NULL, ws, &two), CPROX_OK);
    assert_true(one.lower <= two.upper && two.lower <= one.upper && one.upper > 0.0);
    assert_int_equal(one.rung, CPROX_RUNG_MESH);
    const frame f = frame_create(&there, vec(0, 0, 0)), g = frame_create(&at, vec(0, 0, 0));
    for (int k = 0; k < 200; k++) {
      const vec3 v = i / 3 % 3 ? low[k] : torus.vertices[k];
      double unused = 0.0;
      const double d = cprox_body_nearest(a.body, frame_to_local(&g, frame_to_world(&f, v), &unused), NULL);
      assert_true(one.lower <= d - a.padding + 1e-12);
    }
  }
  for (int k = 0; k < 3; k++) cprox_body_free(bodies[k]);
  mesh_free(&torus);
}

/* A small box inside a hollow one: clear of the surface, inside of the solid. */
static void one_inside_a_solid_overlaps_it(void **state) {
  (void)state;
  test_mesh large = mesh_box(vec(1, 1, 1)), small = mesh_box(vec(0.1, 0.1, 0.1));
  cprox_body *solid = mesh_body(&large, CPROX_MESH_SOLID, ws), *surface = mesh_body(&large, CPROX_MESH_SURFACE, ws);
  cprox_body *inner = mesh_body(&small, CPROX_MESH_SURFACE, ws);
  const cprox_pose here = cprox_pose_identity();
  cprox_result r;
  for (int swapped = 0; swapped < 2; swapped++) {
    const cprox_target a = cprox_at(swapped ? inner : solid, here), b = cprox_at(swapped ? solid : inner, here);
    assert_int_equal(cprox_pair(a, b, NULL, ws, &r), CPROX_OVERLAP);
    assert_true(r.upper <= 0.0);
  }
  assert_int_equal(cprox_pair(cprox_at(surface, here), cprox_at(inner, here), NULL, ws, &r), CPROX_OK);
  assert_true(r.lower <= 0.9 && 0.9 <= r.upper);
  cprox_body_free(solid);
  cprox_body_free(surface);
  cprox_body_free(inner);
  mesh_free(&large);
  mesh_free(&small);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(meshes_are_as_far_apart_as_their_nearest_triangles),
      cmocka_unit_test(large_meshes_clouds_and_boxes_too),
      cmocka_unit_test(one_inside_a_solid_overlaps_it),
  };
  return cmocka_run_group_tests(tests, workspace_setup, workspace_teardown);
}
