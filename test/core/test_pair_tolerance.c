/* SPDX-License-Identifier: BSD-3-Clause */
/* Verdicts about static pairs, against the signed distance of the same pairs. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/random.h"

enum { KINDS = 11 };

static cprox_body *any_body(rng *r, size_t kind) {
  cprox_body *body = NULL;
  const double a = rng_uniform(r, 0.02, 0.4), b = rng_uniform(r, 0.05, 0.6), c = rng_uniform(r, 0.02, 0.4);
  vec3 v[24];
  double flat[4][2];
  switch (kind) {
    case 0: cprox_body_create_sphere(a, ws, &body); break;
    case 1: cprox_body_create_box(vec(a, b, c), ws, &body); break;
    case 2: cprox_body_create_capsule(b, a, ws, &body); break;
    case 3: cprox_body_create_cylinder(b, a, ws, &body); break;
    case 4: cprox_body_create_cone(b, a, ws, &body); break;
    case 5: cprox_body_create_ellipsoid(vec(a, b, c), ws, &body); break;
    case 6:
    case 7:
      for (size_t i = 0; i < 24; i++) v[i] = vec_axpy(vec(0.2, 0, 0), b, rng_in_cube(r, 1.0));
      cprox_body_create_polytope(v, 24, ws, &body);
      break;
    case 8:
      for (size_t i = 0; i < 4; i++) flat[i][0] = cos(1.5 * (double)i) * b, flat[i][1] = sin(1.5 * (double)i) * b;
      cprox_body_create_polygon((const double(*)[2])flat, 4, ws, &body);
      break;
    default: {
      test_mesh mesh = kind == 9 ? mesh_box(vec(a, b, c)) : mesh_torus(16, 8, a + 0.1, 0.3 * a, 0.01);
      body = mesh_body(&mesh, rng_index(r, 2) ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
      mesh_free(&mesh);
    }
  }
  assert_non_null(body);
  return body;
}

static uint64_t work_of(const cprox_result *r) {
  return (uint64_t)r->nodes + r->distance_queries;
}

typedef struct tally {
  size_t clear, violated, undecided;
  uint64_t distances, verdicts;
} tally;

static void compare(size_t number, cprox_obstacle a, cprox_obstacle b, double delta, const cprox_result *d,
                    tally *all) {
  cprox_result t;
  const cprox_status status = cprox_pair_tolerance(a, b, delta, NULL, ws, &t);
  assert_true(status == CPROX_OK || status == CPROX_PRECISION);
  const bool wrong = (t.verdict == CPROX_VERDICT_CLEAR && !(d->upper > delta)) ||
                     (t.verdict == CPROX_VERDICT_VIOLATED && d->lower > delta) ||
                     (t.verdict == CPROX_VERDICT_UNDECIDED && fabs(d->upper - delta) > 3e-6) || t.lower > d->upper ||
                     t.upper < d->lower;
  if (wrong)
    fail_msg("case %zu: %s [%.17g, %.17g] at %.17g, but [%.17g, %.17g]", number, cprox_verdict_name(t.verdict), t.lower,
             t.upper, delta, d->lower, d->upper);
  if (t.verdict == CPROX_VERDICT_CLEAR) assert_true(t.lower > delta);
  if (t.verdict == CPROX_VERDICT_VIOLATED) {
    assert_true(t.upper <= delta);
    assert_true(vec_norm(vec_sub(t.witness_mover, t.witness_obstacle)) <= t.upper + 1e-12);
  }
  all->clear += t.verdict == CPROX_VERDICT_CLEAR, all->violated += t.verdict == CPROX_VERDICT_VIOLATED;
  all->undecided += t.verdict == CPROX_VERDICT_UNDECIDED;
  all->distances += work_of(d), all->verdicts += work_of(&t);
}

/* 20,000 pairs of every kind, flat ones, surfaces and solids among them (seed 421), apart and overlapping: whether they
 * touch, and a limit that is between 1e-6 of the distance and all of it away. */
CASE(a_verdict_of_a_pair_never_contradicts_its_distance) {
  rng r = rng_seed(421);
  const size_t cases = test_cases(20000);
  tally all = {0};
  for (size_t i = 0; i < cases; i++) {
    cprox_body *x = any_body(&r, rng_index(&r, KINDS)), *y = any_body(&r, rng_index(&r, KINDS));
    const cprox_obstacle a = cprox_obstacle_at(x, rng_pose(&r, 0.6)), b = cprox_obstacle_at(y, rng_pose(&r, 0.6));
    cprox_result d;
    assert_true(cprox_pair(a, b, NULL, ws, &d) >= 0);
    compare(i, a, b, 0.0, &d, &all);
    const double by = rng_log_uniform(&r, 1e-6, 1.0), distance = fmax(d.upper, 0.0);
    compare(i, a, b, rng_index(&r, 2) ? distance * (1.0 - by) : distance * (1.0 + by) + 1e-3 * by, &d, &all);
    cprox_body_free(x);
    cprox_body_free(y);
  }
  assert_true(all.clear > cases / 3 && all.violated > cases / 3 && all.undecided < cases / 20);
  assert_true(all.verdicts < all.distances);
}

/* 10,000 pairs of convex bodies (seed 425) moved along their normal to between 1e-17 and 1e-2 before and beyond contact. */
CASE(a_verdict_near_contact_never_contradicts_the_distance) {
  rng r = rng_seed(425);
  size_t clear = 0, violated = 0;
  const size_t cases = test_cases(10000);
  for (size_t i = 0; i < cases; i++) {
    cprox_body *x = any_body(&r, rng_index(&r, 9)), *y = any_body(&r, rng_index(&r, 9));
    const cprox_obstacle a = cprox_obstacle_at(x, rng_pose(&r, 0.6));
    cprox_obstacle b = cprox_obstacle_at(y, rng_pose(&r, 0.6));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 0.0;
    cprox_result d, t;
    assert_true(cprox_pair(a, b, &options, ws, &d) >= 0);
    const double beyond = (rng_index(&r, 2) ? 1.0 : -1.0) * rng_log_uniform(&r, 1e-17, 1e-2);
    b.pose.position = vec_axpy(b.pose.position, d.upper - beyond, d.normal);
    assert_true(cprox_pair(a, b, &options, ws, &d) >= 0);
    assert_true(cprox_pair_tolerance(a, b, 0.0, &options, ws, &t) >= 0);
    if ((t.verdict == CPROX_VERDICT_CLEAR && d.upper <= 0.0) || (t.verdict == CPROX_VERDICT_VIOLATED && d.lower > 0.0))
      fail_msg("case %zu: %s, but [%.17g, %.17g]", i, cprox_verdict_name(t.verdict), d.lower, d.upper);
    assert_true(t.lower <= d.upper && d.lower <= t.upper);
    clear += t.verdict == CPROX_VERDICT_CLEAR, violated += t.verdict == CPROX_VERDICT_VIOLATED;
    cprox_body_free(x);
    cprox_body_free(y);
  }
  assert_true(clear > cases / 4 && violated > cases / 4);
}

CASE(bodies_far_apart_take_one_look_at_their_balls) {
  rng r = rng_seed(422);
  for (size_t i = 0; i < KINDS; i++) {
    cprox_body *x = any_body(&r, i), *y = any_body(&r, (i + 3) % KINDS);
    const cprox_pose here = rng_pose(&r, 0.1);
    cprox_pose there = rng_pose(&r, 0.1);
    there.position.x += 10.0;
    cprox_result t;
    assert_int_equal(cprox_pair_tolerance(cprox_obstacle_at(x, here), cprox_obstacle_at(y, there), 0.1, NULL, ws, &t),
                     CPROX_OK);
    assert_int_equal(t.verdict, CPROX_VERDICT_CLEAR);
    assert_true(t.nodes == 0 && t.distance_queries == 0 && t.lower > 5.0 && isinf(t.upper));
    cprox_body_free(x);
    cprox_body_free(y);
  }
}

/* 4,000 pairs (seed 424) of bodies of three balls each: of the parts that a verdict does not
 * come to nothing is known. */
CASE(a_verdict_of_compounds_never_contradicts_their_distance) {
  rng r = rng_seed(424);
  tally all = {0};
  const size_t cases = test_cases(4000);
  for (size_t i = 0; i < cases; i++) {
    cprox_body *parts[2][3], *bodies[2];
    for (int side = 0; side < 2; side++) {
      cprox_pose poses[3];
      for (int k = 0; k < 3; k++) {
        assert_int_equal(cprox_body_create_sphere(rng_uniform(&r, 0.05, 0.2), ws, &parts[side][k]), CPROX_OK);
        poses[k] = rng_pose(&r, 0.6);
      }
      assert_int_equal(cprox_body_create_compound((const cprox_body *const *)parts[side], poses, 3, ws, &bodies[side]),
                       CPROX_OK);
    }
    const cprox_obstacle a = cprox_obstacle_at(bodies[0], rng_pose(&r, 0.8));
    const cprox_obstacle b = cprox_obstacle_at(bodies[1], rng_pose(&r, 0.8));
    cprox_result d;
    assert_int_equal(cprox_pair(a, b, NULL, ws, &d), CPROX_OK);
    compare(i, a, b, fmax(d.upper + rng_uniform(&r, -0.2, 0.4), 0.0), &d, &all);
    compare(i, a, b, rng_uniform(&r, 0.0, 1.0), &d, &all);
    for (int side = 0; side < 2; side++) {
      cprox_body_free(bodies[side]);
      for (int k = 0; k < 3; k++) cprox_body_free(parts[side][k]);
    }
  }
  assert_true(all.clear > cases / 10 && all.violated > cases / 10);
}

/* Boxes whose faces touch exactly, and nearly; a square in the plane of a face; a body with itself. */
CASE(what_touches_is_never_clear) {
  rng r = rng_seed(423);
  cprox_body *box = NULL, *square = NULL;
  static const double corners[4][2] = {{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}};
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_polygon(corners, 4, ws, &square), CPROX_OK);
  for (int i = 0; i < 200; i++) {
    const cprox_body *other = i % 2 ? box : square;
    const double along = i % 2 ? 1.0 : 0.5;
    cprox_pose at = CPROX_POSE_IDENTITY;
    at.position = vec(rng_uniform(&r, -0.9, 0.9), rng_uniform(&r, -0.9, 0.9), along);
    cprox_result t;
    const cprox_obstacle a = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
    assert_true(cprox_pair_tolerance(a, cprox_obstacle_at(other, at), 0.0, NULL, ws, &t) >= 0);
    assert_true(t.verdict != CPROX_VERDICT_CLEAR && t.lower <= 0.0 && t.upper <= 1e-6);
    at.position.z = along + 1e-5;
    assert_int_equal(cprox_pair_tolerance(a, cprox_obstacle_at(other, at), 0.0, NULL, ws, &t), CPROX_OK);
    assert_int_equal(t.verdict, CPROX_VERDICT_CLEAR);
    at.position.z = along - 1e-5;
    assert_int_equal(cprox_pair_tolerance(a, cprox_obstacle_at(other, at), 0.0, NULL, ws, &t), CPROX_OK);
    assert_int_equal(t.verdict, CPROX_VERDICT_VIOLATED);
  }
  cprox_result t;
  const cprox_obstacle same = cprox_obstacle_at(box, rng_pose(&r, 1.0));
  assert_int_equal(cprox_pair_tolerance(same, same, 0.0, NULL, ws, &t), CPROX_OK);
  assert_int_equal(t.verdict, CPROX_VERDICT_VIOLATED);
  cprox_body_free(box);
  cprox_body_free(square);
}

CASE(a_limit_that_is_none_gets_a_message) {
  static const double BAD[4] = {-1e-9, NAN, INFINITY, -INFINITY};
  cprox_body *box = NULL, *plane = NULL;
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0.0, ws, &plane), CPROX_OK);
  const cprox_obstacle a = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
  cprox_result t = {.lower = 42.0};
  for (int i = 0; i < 4; i++) {
    assert_int_equal(cprox_pair_tolerance(a, a, BAD[i], NULL, ws, &t), CPROX_INVALID);
    assert_true(t.lower == 42.0 && cprox_workspace_error(ws)[0] != '\0');
  }
  const cprox_obstacle h = cprox_obstacle_at(plane, CPROX_POSE_IDENTITY);
  assert_int_equal(cprox_pair_tolerance(h, h, 0.0, NULL, ws, &t), CPROX_INVALID);
  cprox_pair_start start = {.usable = false};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.start = &start;
  assert_int_equal(cprox_pair_tolerance(a, h, 0.0, &options, ws, &t), CPROX_INVALID);
  assert_int_equal(cprox_pair_tolerance(a, h, 0.0, NULL, ws, NULL), CPROX_INVALID);
  assert_int_equal(cprox_pair_tolerance(a, h, 0.0, NULL, ws, &t), CPROX_OK);
  assert_int_equal(t.verdict, CPROX_VERDICT_VIOLATED);
  cprox_body_free(box);
  cprox_body_free(plane);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
