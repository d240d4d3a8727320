/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets: the same answers as of all targets one by one, from what is near alone. */
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/meshes.h"
#include "support/of_list.h"

/* ---- scenes ---- */

enum { KINDS = 9 };

typedef struct scene {
  size_t n;
  cprox_obstacle *targets;
  cprox_body *body[KINDS];
  cprox_curve *curve;
  test_mesh mesh;
} scene;

/* n targets of every kind in a cube of the half width: convex bodies, a mesh, a level-of-detail body, points, a
 * compound, a curve, now and then padded; with `all` a halfspace below, too. */
static scene scene_make(rng *r, size_t n, double half, bool all) {
  scene s = {.n = n, .targets = malloc(n * sizeof(cprox_obstacle)), .mesh = mesh_torus(8, 6, 0.2, 0.05, 0.1)};
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &s.body[0]), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(0.05, 0.4, 0.1), ws, &s.body[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_capsule(0.3, 0.05, ws, &s.body[2]), CPROX_OK);
  s.body[3] = mesh_body(&s.mesh, CPROX_MESH_FILL_SURFACE, ws);
  assert_int_equal(cprox_body_create_polytope(s.mesh.vertices, s.mesh.n, ws, &s.body[4]), CPROX_OK);
  assert_int_equal(cprox_body_create_lod(s.body[4], 0.0, s.body[3], ws, &s.body[5]), CPROX_OK);
  vec3 points[20];
  for (int k = 0; k < 20; k++) points[k] = rng_in_cube(r, 0.2);
  assert_int_equal(cprox_body_create_points(points, 20, 0.01, SIZE_MAX, ws, &s.body[6]), CPROX_OK);
  const cprox_body *parts[2] = {s.body[1], s.body[0]};
  const cprox_pose poses[2] = {rng_pose(r, 0.2), rng_pose(r, 0.2)};
  assert_int_equal(cprox_body_create_compound(parts, poses, 2, ws, &s.body[7]), CPROX_OK);
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 2.0 * half, ws, &s.body[8]), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(points, 4, 0.0, 1.0), ws, &s.curve), CPROX_OK);
  for (size_t i = 0; i < n; i++) {
    const size_t kind = i % 9;
    s.targets[i] = kind == 8 ? cprox_obstacle_curve(s.curve, 0.02) : cprox_obstacle_at(s.body[kind], rng_pose(r, half));
    if (kind == 8) s.targets[i].pose = rng_pose(r, half);
    if (i % 4 == 0) s.targets[i].margin = 0.03;
  }
  if (all) s.targets[n / 2] = cprox_obstacle_at(s.body[8], CPROX_POSE_IDENTITY);
  return s;
}

static void scene_free(scene *s) {
  free(s->targets);
  cprox_body_free(s->body[7]);
  cprox_body_free(s->body[5]);
  for (int k = 0; k < KINDS; k++)
    if (k != 7 && k != 5) cprox_body_free(s->body[k]);
  cprox_curve_free(s->curve);
  mesh_free(&s->mesh);
}

static cprox_obstacles *set_make(const scene *s) {
  cprox_obstacles *set = NULL;
  if (cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_BVH, ws, &set) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  assert_int_equal(cprox_obstacles_get_info(set).n, s->n);
  return set;
}

/* One piece or a spline of many, from somewhere to somewhere. */
static cprox_curve *way(rng *r, size_t n, double half) {
  cprox_curve *curve = NULL;
  vec3 points[40];
  double knots[48];
  points[0] = rng_in_cube(r, half);
  for (size_t k = 1; k < n; k++) points[k] = vec_add(points[k - 1], rng_in_cube(r, 0.3 * half));
  if (n <= 5) {
    assert_int_equal(curve_from(describe_bezier(points, n, 0.0, 1.0), ws, &curve), CPROX_OK);
    return curve;
  }
  for (size_t k = 0; k < n + 4; k++) knots[k] = (double)k;
  assert_int_equal(curve_from(describe_bspline(points, n, 3, knots, n + 4, 3.0, (double)n), ws, &curve), CPROX_OK);
  return curve;
}

/* ---- the same answers ---- */

static void expect_overlap(const char *what, size_t i, const cprox_result *a, const cprox_result *b) {
  if (a->lower > b->upper || b->lower > a->upper)
    fail_msg("%s, case %zu: [%.9g, %.9g] of the set, [%.9g, %.9g] of all", what, i, a->lower, a->upper, b->lower,
             b->upper);
}

/* 300 movers (seed 91) through scenes of 1 to 120 targets of every kind: points, tubes, splines; signed and not.
 * Verdicts are equal, distances, k nearest and times of contact the same to epsilon. */
CASE(sets_answer_as_all_their_targets_do) {
  rng r = rng_seed(91);
  size_t hits = 0;
  const size_t cases = test_cases(300);
  for (size_t i = 0; i < cases; i++) {
    scene s = scene_make(&r, 1 + rng_index(&r, 120), 2.0, i % 3 == 0);
    cprox_obstacles *set = set_make(&s);
    cprox_curve *curve = way(&r, i % 2 ? 4 : 6 + rng_index(&r, 30), 1.5);
    const cprox_mover mover = cprox_tube_along(curve, i % 3 ? 0.0 : 0.04);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.signed_distance = i % 5 == 4;
    cprox_result a, b;
    const cprox_status status = cprox_obstacles_distance(set, mover, &options, ws, &a, NULL);
    assert_true(status >= 0 && distance_of_list(mover, s.targets, s.n, &options, ws, &b, NULL) >= 0);
    expect_overlap("distance", i, &a, &b);
    if (status == CPROX_OK) assert_true(a.upper - a.lower <= 1e-6);
    options.signed_distance = false;
    assert_true(cprox_obstacles_collision(set, mover, NULL, ws, &a, NULL) >= 0);
    assert_true(collision_of_list(mover, s.targets, s.n, NULL, ws, &b, NULL) >= 0);
    assert_int_equal(a.verdict, b.verdict);
    hits += a.verdict == CPROX_VERDICT_VIOLATED;
    const double delta = rng_uniform(&r, 0.0, 0.3);
    assert_true(cprox_obstacles_tolerance(set, mover, delta, NULL, ws, &a, NULL) >= 0);
    assert_true(tolerance_of_list(mover, s.targets, s.n, delta, NULL, ws, &b, NULL) >= 0);
    assert_int_equal(a.verdict, b.verdict);
    assert_true(cprox_obstacles_time_of_contact(set, mover, NULL, ws, &a) >= 0);
    assert_true(time_of_contact_of_list(mover, s.targets, s.n, NULL, ws, &b) >= 0);
    assert_int_equal(a.verdict, b.verdict);
    assert_true(fabs(a.t_contact_lower - b.t_contact_lower) < 1e-3);
    expect_overlap("time of contact", i, &a, &b);
    cprox_result near[3], all[3];
    cprox_listed listed;
    size_t m;
    assert_true(cprox_obstacles_nearest(set, mover, 3, NULL, ws, near, &listed) >= 0);
    const size_t n = listed.count;
    assert_true(nearest_of_list(mover, s.targets, s.n, 3, NULL, ws, all, &m) >= 0);
    assert_int_equal(n, m);
    for (size_t k = 0; k < n; k++) assert_true(fabs(near[k].upper - all[k].upper) <= 2e-6);
    cprox_curve_free(curve);
    cprox_obstacles_free(set);
    scene_free(&s);
  }
  assert_true(hits > cases / 10 && hits < cases);
}

/* A carried box past 60 boxes, balls and capsules (seed 93); meshes are refused, as without a set. By coarser models,
 * too. */
CASE(carried_bodies_and_coarser_models_are_answered_as_without_a_set) {
  rng r = rng_seed(93);
  scene s = scene_make(&r, 180, 2.0, true);
  cprox_obstacle convex[60];
  for (size_t k = 0; k < 60; k++) convex[k] = cprox_obstacle_at(s.body[k % 3], rng_pose(&r, 2.0));
  cprox_obstacles *set = NULL, *mixed = set_make(&s);
  assert_int_equal(cprox_obstacles_create(convex, 60, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  for (size_t i = 0; i < 40; i++) {
    cprox_curve *curve = way(&r, i % 2 ? 4 : 12, 1.5);
    cprox_result a, b;
    assert_int_equal(cprox_obstacles_distance(set, cprox_body_along(s.body[1], curve), NULL, ws, &a, NULL), CPROX_OK);
    assert_int_equal(distance_of_list(cprox_body_along(s.body[1], curve), convex, 60, NULL, ws, &b, NULL), CPROX_OK);
    expect_overlap("carried", i, &a, &b);
    assert_int_equal(cprox_obstacles_distance(mixed, cprox_body_along(s.body[1], curve), NULL, ws, &a, NULL),
                     CPROX_INVALID);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.max_lod = i % 2 ? CPROX_LOD_SPHERE : CPROX_LOD_HULL;
    assert_true(cprox_obstacles_distance(mixed, cprox_point_along(curve), &options, ws, &a, NULL) >= 0);
    assert_true(distance_of_list(cprox_point_along(curve), s.targets, s.n, &options, ws, &b, NULL) >= 0);
    expect_overlap("coarse", i, &a, &b);
    cprox_curve_free(curve);
  }
  cprox_obstacles_free(set);
  cprox_obstacles_free(mixed);
  scene_free(&s);
}

/* ---- what they cost ---- */

/* The same density of targets, 100 to 6,400 of them, one short curve: what is searched does not grow with them. 64
 * times the targets may cost twice the intervals. */
CASE(what_is_searched_does_not_grow_with_the_set) {
  rng r = rng_seed(97);
  uint32_t nodes[2] = {0};
  for (int k = 0; k < 2; k++) {
    scene s = scene_make(&r, k ? 6400 : 100, k ? 8.0 : 2.0, false);
    cprox_obstacles *set = set_make(&s);
    for (int i = 0; i < 50; i++) {
      cprox_curve *curve = way(&r, 4, 1.0);
      cprox_result a;
      assert_int_equal(cprox_obstacles_distance(set, cprox_point_along(curve), NULL, ws, &a, NULL), CPROX_OK);
      nodes[k] += a.nodes;
      cprox_curve_free(curve);
    }
    cprox_obstacles_free(set);
    scene_free(&s);
  }
  if (nodes[1] > 2 * nodes[0]) fail_msg("%u intervals with 100 targets, %u with 6400", nodes[0], nodes[1]);
}

CASE(queries_do_not_allocate_once_the_workspace_has_grown) {
  rng r = rng_seed(99);
  scene s = scene_make(&r, 300, 2.0, true);
  cprox_obstacles *set = set_make(&s);
  cprox_curve *curve = way(&r, 4, 1.5);
  size_t before = 0;
  for (int i = 0; i < 2; i++) {
    before = allocations_made();
    cprox_result a, near[5];
    cprox_listed listed;
    cprox_obstacles_distance(set, cprox_point_along(curve), NULL, ws, &a, NULL);
    cprox_obstacles_time_of_contact(set, cprox_point_along(curve), NULL, ws, &a);
    cprox_obstacles_nearest(set, cprox_point_along(curve), 5, NULL, ws, near, &listed);
  }
  assert_int_equal(allocations_made(), before);
  cprox_curve_free(curve);
  cprox_obstacles_free(set);
  scene_free(&s);
}

/* ---- bad input ---- */

CASE(bad_input_is_refused_and_nothing_is_far) {
  rng r = rng_seed(101);
  cprox_obstacles *set = NULL;
  cprox_curve *curve = way(&r, 4, 1.0);
  cprox_obstacle nothing = {.pose = CPROX_POSE_IDENTITY};
  assert_int_equal(cprox_obstacles_create(&nothing, 1, CPROX_INDEX_BVH, ws, &set), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "obstacle 0"));
  assert_int_equal(cprox_obstacles_create(NULL, 3, CPROX_INDEX_BVH, ws, &set), CPROX_INVALID);
  assert_null(set);
  cprox_result a;
  assert_int_equal(cprox_obstacles_create(NULL, 0, (cprox_obstacle_index)7, ws, &set), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "7 is no kind of index"));
  assert_int_equal(cprox_obstacles_distance(NULL, cprox_point_along(curve), NULL, ws, &a, NULL), CPROX_OK);
  assert_true(isinf(a.lower) && a.obstacle_index == -1 && cprox_obstacles_get_info(NULL).n == 0);
  assert_int_equal(cprox_obstacles_create(NULL, 0, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  assert_int_equal(cprox_obstacles_distance(set, cprox_point_along(curve), NULL, ws, &a, NULL), CPROX_OK);
  assert_true(isinf(a.lower) && a.obstacle_index == -1);
  assert_int_equal(cprox_obstacles_distance(set, cprox_point_along(NULL), NULL, ws, &a, NULL), CPROX_INVALID);
  cprox_obstacles_free(set);
  cprox_curve_free(curve);
}

/* ---- stopped ---- */

static size_t looks_left;

static bool stop_at_a_look(void *user) {
  (void)user;
  if (looks_left == 0) return true;
  looks_left--;
  return false;
}

/* Stopped at any of its looks, from a list or a BVH: each row names an obstacle, none twice, and holds its distance. */
CASE(a_stopped_list_of_the_nearest_names_an_obstacle_in_each_row_and_bounds_the_others) {
  rng r = rng_seed(92);
  scene s = scene_make(&r, 12, 1.0, false);
  cprox_curve *curve = way(&r, 4, 1.0);
  const cprox_mover mover = cprox_point_along(curve);
  for (int index = CPROX_INDEX_NONE; index <= CPROX_INDEX_BVH; index++) {
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(s.targets, s.n, (cprox_obstacle_index)index, ws, &set), CPROX_OK);
    cprox_result whole[12], near[12];
    cprox_listed listed = {0, 0.0};
    assert_int_equal(cprox_obstacles_distance(set, mover, NULL, ws, near, whole), CPROX_OK);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.stop = stop_at_a_look;
    cprox_status status = CPROX_STOPPED;
    const size_t most = s.n - (index == CPROX_INDEX_BVH ? 4 : 0); /* some are left out */
    for (size_t look = 0; status == CPROX_STOPPED && look < 400; look++) {
      looks_left = look;
      status = cprox_obstacles_nearest(set, mover, most, &options, ws, near, &listed);
      assert_true(status == CPROX_OK || status == CPROX_STOPPED);
      unsigned seen = 0;
      for (size_t i = 0; i < listed.count; i++) {
        const int32_t k = near[i].obstacle_index;
        assert_true(k >= 0 && k < 12 && !(seen >> k & 1u));
        seen |= 1u << k;
        assert_true(near[i].lower <= whole[k].upper && near[i].upper >= whole[k].lower);
      }
      for (int32_t k = 0; k < 12; k++)
        if (!(seen >> k & 1u)) assert_true(listed.others <= whole[k].upper);
    }
    assert_int_equal(status, CPROX_OK);
    assert_int_equal(listed.count, most);
    assert_true(most == s.n ? isinf(listed.others) : listed.others >= near[most - 1].lower);
    cprox_obstacles_free(set);
  }
  cprox_curve_free(curve);
  scene_free(&s);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
