/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries as a caller meets them: intervals, verdicts, budgets, many targets, unusable arguments, memory, cost. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/vec.h"
#include "curve_proximity/cprox.h"
#include "problem/problem.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

/* ---- builders ---- */

static cprox_curve *segment(vec3 a, vec3 b) {
  return bezier((vec3[]){a, b}, 2);
}

static cprox_body *usable(cprox_status status, cprox_body *body) {
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return body;
}

static cprox_body *box(double x, double y, double z) {
  cprox_body *body = NULL;
  const cprox_status status = cprox_body_create_box(vec(x, y, z), ws, &body);
  return usable(status, body);
}

static cprox_body *sphere(double radius) {
  cprox_body *body = NULL;
  const cprox_status status = cprox_body_create_sphere(radius, ws, &body);
  return usable(status, body);
}

static cprox_obstacle at(const cprox_body *body, double x, double y, double z) {
  return cprox_obstacle_at(body, (cprox_pose){.position = {x, y, z}, .orientation = {1, 0, 0, 0}});
}

static void assert_contains(const cprox_result *r, double truth, double doubt) {
  if (r->lower > truth + doubt || r->upper < truth - doubt || !(r->lower <= r->upper))
    fail_msg("[%.17g, %.17g] does not contain %.17g", r->lower, r->upper, truth);
}

/* ---- one curve, one body ---- */

CASE(a_segment_past_a_box_has_the_distance_of_its_nearest_end) {
  cprox_curve *curve = segment(vec(2, -1, 0), vec(2, 1, 0));
  cprox_body *body = box(1, 1, 1);
  const cprox_options options = accurate(1e-9);
  cprox_result r;
  assert_int_equal(
      cprox_distance(cprox_tube_along(curve, 0.25), cprox_with_margin(at(body, 0, 0, 0), 0.125), &options, ws, &r),
      CPROX_OK);
  assert_contains(&r, 1.5 - 0.25 - 0.125, 0.0);
  assert_true(r.upper - r.lower <= 1e-9);
  assert_float_equal(r.witness_obstacle.x, 0.625, 1e-12);
  assert_float_equal(r.witness_mover.x, 1.75, 1e-12);
  assert_float_equal(r.normal.x, 1.0, 1e-12);
  assert_string_equal(cprox_workspace_error(ws), "");
  cprox_body_free(body);
  cprox_curve_free(curve);
}

CASE(a_turned_and_moved_body_is_measured_where_it_stands) {
  cprox_curve *curve = segment(vec(10, 20, 33), vec(10, 20, 35));
  cprox_body *body = box(2, 4, 6);
  /* a quarter turn about x, by a quaternion of norm 3 */
  const cprox_pose pose = {.position = {10, 20, 30},
                           .orientation = {3 * 0.7071067811865476, 3 * 0.7071067811865476, 0, 0}};
  const cprox_options options = accurate(1e-9);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, pose), &options, ws, &r), CPROX_OK);
  assert_contains(&r, 1.0, 1e-14);
  assert_float_equal(r.t, 0.0, 1e-12);
  cprox_body_free(body);
  cprox_curve_free(curve);
}

CASE(a_curve_through_a_body_is_at_distance_0_and_collides) {
  const vec3 points[] = {{-2, 0.1, 0}, {0, 0.3, 0.1}, {0, -0.3, 0}, {2, 0.5, 0}};
  cprox_curve *curve = bezier(points, 4);
  cprox_body *bodies[4] = {box(1, 1, 1), sphere(0.5), NULL, NULL};
  usable(cprox_body_create_cylinder(1.0, 0.5, ws, &bodies[2]), NULL);
  usable(cprox_body_create_polytope((vec3[]){{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}}, 4, ws, &bodies[3]),
         NULL);
  for (int i = 0; i < 4; i++) {
    cprox_result r;
    assert_int_equal(cprox_distance(cprox_point_along(curve), at(bodies[i], 0, 0, 0), NULL, ws, &r), CPROX_OK);
    assert_contains(&r, 0.0, 0.0);
    assert_int_equal(cprox_collision(cprox_point_along(curve), at(bodies[i], 0, 0, 0), NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    assert_true(vec_equal(r.witness_mover, r.witness_obstacle));
    assert_int_equal(cprox_tolerance(cprox_point_along(curve), at(bodies[i], 0, 0, 0), 0.0, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    cprox_body_free(bodies[i]);
  }
  cprox_curve_free(curve);
}

CASE(a_planar_curve_through_a_polygon_collides) {
  cprox_curve *curve = segment(vec(-3, 0.2, 0), vec(3, 0.1, 0));
  cprox_body *polygon = NULL;
  const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  usable(cprox_body_create_polygon(square, 4, ws, &polygon), NULL);
  cprox_result r;
  assert_int_equal(cprox_collision(cprox_point_along(curve), at(polygon, 0.5, 0, 0), NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  assert_int_equal(cprox_collision(cprox_point_along(curve), at(polygon, 0, 0, 1e-3), NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_int_equal(cprox_distance(cprox_point_along(curve), at(polygon, 0, 0, 1e-3), NULL, ws, &r), CPROX_OK);
  assert_contains(&r, 1e-3, 1e-18);
  cprox_body_free(polygon);
  cprox_curve_free(curve);
}

CASE(touching_is_never_called_free) {
  /* a parabola that touches the box's face, a tube that rests on it, an end point on its corner */
  const vec3 parabola[] = {{-1, 1.5, 0}, {0, -0.5, 0}, {1, 1.5, 0}};
  cprox_curve *curves[] = {bezier(parabola, 3), segment(vec(-2, 0.75, 0), vec(2, 0.75, 0)),
                           segment(vec(0.5, 0.5, 0.5), vec(2, 2, 2))};
  const double radii[] = {0.0, 0.25, 0.0};
  cprox_body *body = box(1, 1, 1);
  for (int i = 0; i < 3; i++) {
    const cprox_mover mover = cprox_tube_along(curves[i], radii[i]);
    cprox_result r;
    assert_true(cprox_collision(mover, at(body, 0, 0, 0), NULL, ws, &r) >= 0);
    assert_int_not_equal(r.verdict, CPROX_VERDICT_CLEAR);
    assert_contains(&r, 0.0, 0.0);
    assert_true(cprox_tolerance(mover, at(body, 0, 0, 0), 0.0, NULL, ws, &r) >= 0);
    assert_int_not_equal(r.verdict, CPROX_VERDICT_CLEAR);
    cprox_curve_free(curves[i]);
  }
  cprox_body_free(body);
}

CASE(a_curve_that_stands_still_is_answered_as_a_point) {
  const vec3 points[] = {{3, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 0, 0}};
  cprox_curve *curve = bezier(points, 4);
  cprox_body *body = sphere(1.0);
  const cprox_options options = accurate(1e-12);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), at(body, 0, 0, 0), &options, ws, &r), CPROX_OK);
  assert_contains(&r, 2.0, 0.0);
  cprox_body_free(body);
  cprox_curve_free(curve);
}

/* In every role: as the way, as the obstacle, both, with a body that is carried, and on one clock. */
CASE(curves_that_stand_still_are_points_in_every_role) {
  const vec3 here[] = {{3, 0, 0}, {3, 0, 0}, {3, 0, 0}}, there[] = {{0, 4, 0}, {0, 4, 0}, {0, 4, 0}, {0, 4, 0}};
  cprox_curve *a = bezier(here, 3), *b = bezier(there, 4);
  cprox_body *ball = sphere(0.5);
  const cprox_options options = accurate(1e-12);
  cprox_obstacle clocked = cprox_obstacle_curve(b, 1.0);
  clocked.synchronized = true;
  const cprox_obstacle obstacle[] = {cprox_obstacle_curve(b, 1.0), clocked};
  const cprox_mover mover[] = {cprox_point_along(a), cprox_tube_along(a, 0.5)};
  for (int i = 0; i < 4; i++) {
    cprox_result r;
    const double distance = 4.0 - (i % 2 ? 0.5 : 0.0);
    assert_int_equal(cprox_distance(mover[i % 2], obstacle[i / 2], &options, ws, &r), CPROX_OK);
    assert_contains(&r, distance, 0.0);
    assert_int_equal(cprox_tolerance(mover[i % 2], obstacle[i / 2], distance - 0.01, &options, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
    assert_int_equal(cprox_collision(mover[i % 2], obstacle[i / 2], &options, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  }
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_body_along(ball, a), at(ball, 0, 4, 0), &options, ws, &r), CPROX_OK);
  assert_contains(&r, 4.0, 0.0);
  cprox_curve_ellipsoid e;
  assert_int_equal(cprox_curve_get_ellipsoid(a, 0.0, 1.0, ws, &e), CPROX_OK);
  assert_true(vec_equal(e.foci[0], here[0]) && vec_equal(e.foci[1], here[0]) && e.axis <= 1e-12 && e.radius <= 1e-6);
  cprox_body_free(ball);
  cprox_curve_free(a);
  cprox_curve_free(b);
}

CASE(a_long_spline_is_searched_by_its_tree) {
  /* a helix of 100,000 control points round the z axis, radius 2; a ball on the axis */
  enum { N = 100000 };
  vec3 *points = malloc(N * sizeof *points);
  double *knots = malloc((N + 4) * sizeof *knots);
  for (int i = 0; i < N; i++) {
    const double a = 1e-2 * i;
    points[i] = vec(2.0 * cos(a), (2.0 + 0.5 * cos(1e-4 * i)) * sin(a), 1e-3 * i);
  }
  for (int i = 0; i < N + 4; i++) knots[i] = i;
  cprox_curve *curve = NULL;
  if (curve_from(describe_bspline(points, N, 3, knots, N + 4, knots[3], knots[N]), ws, &curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  cprox_body *body = box(0.02, 0.02, 0.02);
  const cprox_options options = accurate(1e-6);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), at(body, 2.5, 0.1, 31.4), &options, ws, &r), CPROX_OK);

  /* no sampled point is nearer, and one is as near */
  double least = INFINITY;
  for (int i = 0; i <= 2 * N; i++) {
    vec3 p;
    const double t = knots[3] + (knots[N] - knots[3]) * i / (2.0 * N);
    assert_int_equal(cprox_curve_evaluate(curve, t, ws, &p, NULL, NULL), CPROX_OK);
    least = fmin(least, cprox_body_nearest(body, vec_sub(p, vec(2.5, 0.1, 31.4)), NULL));
  }
  assert_true(r.lower <= least);
  assert_true(r.upper <= least + 1e-6);
  assert_true(r.nodes < 400); /* of 99,997 pieces */
  cprox_body_free(body);
  cprox_curve_free(curve);
  free(points);
  free(knots);
}

/* ---- accuracy, budget, stop ---- */

CASE(epsilon_of_any_size_ends_with_a_true_interval) {
  const vec3 points[] = {{-2, 1, 0.3}, {-1, 3, 0.1}, {1, -1, 0}, {2, 2, 0.7}};
  cprox_curve *curve = bezier(points, 4);
  cprox_body *body = box(1, 1, 1);
  const cprox_options fine = accurate(1e-13);
  cprox_result reference;
  assert_true(cprox_distance(cprox_point_along(curve), at(body, 0, -0.5, 0), &fine, ws, &reference) >= 0);
  const double epsilons[] = {0.0, 1e-300, 1e-16, 1e-6, 1e3, 1e60};
  for (size_t i = 0; i < sizeof epsilons / sizeof *epsilons; i++) {
    const cprox_options options = accurate(epsilons[i]);
    cprox_result r;
    const cprox_status status = cprox_distance(cprox_point_along(curve), at(body, 0, -0.5, 0), &options, ws, &r);
    assert_int_equal(status, epsilons[i] < 1e-15 ? CPROX_PRECISION : CPROX_OK);
    assert_true(r.lower <= reference.upper && reference.lower <= r.upper);
    if (epsilons[i] < 1e-6) assert_true(r.upper - r.lower < 1e-13);
    if (status == CPROX_PRECISION) assert_non_null(strstr(cprox_workspace_error(ws), "epsilon"));
  }
  cprox_body_free(body);
  cprox_curve_free(curve);
}

/* Seed 3: a quarter circle round a ball of 200 facets' corners, so that many minima are nearly equal. */
typedef struct hard_case {
  cprox_curve *curve;
  cprox_body *body;
  cprox_result answer; /* to 1e-12 */
} hard_case;

static hard_case hard_case_create(void) {
  const double k = 0.5522847498;
  rng r = rng_seed(3);
  vec3 cloud[200];
  for (int i = 0; i < 200; i++) cloud[i] = vec_scale(0.5, rng_unit(&r));
  hard_case c = {.curve = bezier((vec3[]){{1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}}, 4)};
  usable(cprox_body_create_polytope(cloud, 200, ws, &c.body), NULL);
  const cprox_options options = accurate(1e-12);
  assert_int_equal(cprox_distance(cprox_point_along(c.curve), at(c.body, 0, 0, 0), &options, ws, &c.answer), CPROX_OK);
  return c;
}

static void hard_case_free(hard_case *c) {
  cprox_body_free(c->body);
  cprox_curve_free(c->curve);
}

CASE(a_spent_budget_leaves_a_true_interval) {
  hard_case c = hard_case_create();
  cprox_options options = accurate(1e-12);
  double width = INFINITY;
  assert_true(c.answer.nodes > 16);
  for (uint32_t budget = 1; budget < c.answer.nodes; budget++) {
    options.max_nodes = budget;
    cprox_result r;
    assert_int_equal(cprox_distance(cprox_point_along(c.curve), at(c.body, 0, 0, 0), &options, ws, &r), CPROX_BUDGET);
    assert_non_null(strstr(cprox_workspace_error(ws), "max_nodes"));
    assert_true(r.nodes <= budget && r.nodes + r.distance_queries >= budget);
    assert_true(r.lower <= c.answer.upper && r.upper >= c.answer.lower);
    assert_true(r.upper - r.lower <= width);
    width = r.upper - r.lower;
  }
  hard_case_free(&c);
}

static bool stop_after(void *user) {
  return --*(int *)user < 0;
}

CASE(a_stop_function_ends_the_search_with_a_true_interval) {
  hard_case c = hard_case_create();
  cprox_options options = accurate(1e-12);
  int polls = 1;
  options.stop = stop_after, options.stop_user = &polls;
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(c.curve), at(c.body, 0, 0, 0), &options, ws, &r), CPROX_STOPPED);
  assert_true(r.lower <= c.answer.upper && r.upper >= c.answer.lower && r.nodes <= 16);
  polls = 0;
  assert_int_equal(cprox_distance(cprox_point_along(c.curve), at(c.body, 0, 0, 0), &options, ws, &r), CPROX_STOPPED);
  assert_true(r.lower <= c.answer.upper && r.upper == INFINITY && r.obstacle_index == -1);
  hard_case_free(&c);
}

static bool count_calls(void *user) {
  ++*(size_t *)user;
  return false;
}

/* A ring about a ball: all pieces are at the same distance but for 1e-11, so that none is pruned, and each leaves when
 * rounding allows no more. */
static cprox_curve *ring(size_t n, cprox_workspace *workspace) {
  cprox_vec3 *points = calloc(n, sizeof *points);
  double *knots = calloc(n + 4, sizeof *knots);
  assert_true(points && knots);
  const double turn = 2.0 * acos(-1.0) / (double)n;
  for (size_t i = 0; i < n; i++) points[i] = vec(cos(turn * (double)i), sin(turn * (double)i), 0.0);
  for (size_t i = 0; i < n + 4; i++) knots[i] = i < 3 ? 0.0 : i > n ? (double)(n - 3) : (double)(i - 3);
  const cprox_curve_description spline = {.kind = CPROX_CURVE_BSPLINE,
                                          .points = points,
                                          .n = n,
                                          .degree = 3,
                                          .knots = knots,
                                          .n_knots = n + 4,
                                          .t1 = (double)(n - 3)};
  cprox_curve *curve = NULL;
  cprox_curve_create(&spline, workspace, &curve);
  free(points);
  free(knots);
  return curve;
}

/* One call for 16 nodes that are looked at, whether they are split or leave. */
CASE(stop_is_also_asked_while_nodes_leave) {
  cprox_curve *curve = ring(20000, ws);
  assert_non_null(curve);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  cprox_options options = accurate(1e-13);
  size_t calls = 0;
  options.stop = count_calls, options.stop_user = &calls, options.max_nodes = UINT32_MAX;
  cprox_result r;
  assert_true(cprox_distance(cprox_point_along(curve), at(ball, 0, 0, 0), &options, ws, &r) >= 0);
  assert_true(calls > (r.nodes + 15000) / 16);
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

CASE(the_making_of_a_long_curve_can_be_stopped) {
  cprox_workspace *own = cprox_workspace_create();
  size_t calls = 0;
  cprox_workspace_set_stop(own, count_calls, &calls);
  cprox_curve *curve = ring(20000, own);
  assert_non_null(curve);
  assert_true(calls >= 3 * (20000 / 1024)); /* spans, their capsules, the tree above them */
  cprox_curve_free(curve);
  for (int polls = 0; polls < 60; polls += 7) {
    int left = polls;
    cprox_workspace_set_stop(own, stop_after, &left);
    curve = ring(20000, own);
    if ((size_t)polls >= calls) {
      assert_non_null(curve);
      cprox_curve_free(curve);
    } else {
      assert_null(curve);
      assert_non_null(strstr(cprox_workspace_error(own), "stopped while a curve of 19997 pieces was being made"));
    }
  }
  cprox_workspace_free(own);
}

/* ---- many targets ---- */

/* Seed 5, 300 scenes of 30 targets, among them padded ones and compounds: the union's answer is the least of the
 * answers one by one, and verdicts agree with it. */
static bool stop_at_once(void *user) {
  (void)user;
  return true;
}

/* The segment lies at x = 0, the box within half the root of 3 of (10, 0, 0). */
CASE(what_is_stopped_before_it_began_knows_what_the_balls_say) {
  cprox_curve *curve = segment(vec(0, -1, 0), vec(0, 1, 0));
  cprox_body *body = box(1, 1, 1);
  cprox_options options = accurate(1e-9);
  options.stop = stop_at_once;
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), at(body, 10, 0, 0), &options, ws, &r), CPROX_STOPPED);
  assert_true(r.lower > 9.0 && r.lower <= 9.5 && r.nodes == 0);
  cprox_body_free(body);
  cprox_curve_free(curve);
}

CASE(many_targets_are_answered_like_the_nearest_of_them) {
  rng r = rng_seed(5);
  enum { N = 30 };
  cprox_body *ball = sphere(0.05), *brick = box(0.1, 0.2, 0.3), *pair = NULL;
  const cprox_body *parts[] = {ball, brick};
  const cprox_pose poses[] = {{.position = {0.2, 0, 0}, .orientation = {1, 0, 0, 0}},
                              {.position = {-0.2, 0, 0}, .orientation = {1, 1, 0, 0}}};
  usable(cprox_body_create_compound(parts, poses, 2, ws, &pair), NULL);
  const cprox_body *kinds[] = {ball, brick, pair};
  const cprox_options options = accurate(1e-9);
  for (size_t scene = 0; scene < test_cases(300); scene++) {
    cprox_obstacle targets[N];
    for (int i = 0; i < N; i++) {
      targets[i] = cprox_with_margin(cprox_obstacle_at(kinds[rng_index(&r, 3)], rng_pose(&r, 2.0)),
                                     rng_index(&r, 2) ? 0.0 : 0.02);
    }
    vec3 points[6];
    for (int i = 0; i < 6; i++) points[i] = rng_in_cube(&r, 2.0);
    cprox_curve *curve = bezier(points, 6);
    const cprox_mover mover = cprox_tube_along(curve, 0.01);

    cprox_result each[N], nearest, all;
    assert_int_equal(distance_of_list(mover, targets, N, &options, ws, &nearest, NULL), CPROX_OK);
    assert_int_equal(distance_of_list(mover, targets, N, &options, ws, &all, each), CPROX_OK);
    double least = INFINITY;
    for (int i = 0; i < N; i++) {
      cprox_result one;
      assert_int_equal(cprox_distance(mover, targets[i], &options, ws, &one), CPROX_OK);
      assert_true(one.lower == each[i].lower && one.upper == each[i].upper && each[i].obstacle_index == i);
      least = fmin(least, one.upper);
    }
    assert_true(all.upper == least);
    assert_true(nearest.lower <= all.upper && all.lower <= nearest.upper && nearest.upper - nearest.lower <= 1e-9);
    assert_true(each[nearest.obstacle_index].lower <= nearest.upper);

    cprox_result verdict;
    assert_int_equal(collision_of_list(mover, targets, N, &options, ws, &verdict, NULL), CPROX_OK);
    assert_int_equal(verdict.verdict, least > 0.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
    if (least > 1e-6) {
      assert_int_equal(tolerance_of_list(mover, targets, N, 0.999 * least, &options, ws, &verdict, NULL), CPROX_OK);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      assert_int_equal(tolerance_of_list(mover, targets, N, 1.001 * least, &options, ws, &verdict, NULL), CPROX_OK);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_VIOLATED);
      /* a verdict that ends the search early still bounds the targets it did not look at */
      assert_int_equal(tolerance_of_list(mover, targets, N, 4.0 * least + 1.0, &options, ws, &verdict, NULL), CPROX_OK);
      assert_true(verdict.verdict == CPROX_VERDICT_VIOLATED && verdict.lower <= least);
    }
    cprox_curve_free(curve);
  }
  cprox_body_free(pair);
  cprox_body_free(ball);
  cprox_body_free(brick);
}

CASE(nothing_to_measure_is_infinitely_far) {
  cprox_curve *curve = segment(vec(0, 0, 0), vec(1, 0, 0));
  cprox_result r;
  assert_int_equal(distance_of_list(cprox_point_along(curve), NULL, 0, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(r.lower == INFINITY && r.upper == INFINITY && r.obstacle_index == -1);
  assert_int_equal(tolerance_of_list(cprox_point_along(curve), NULL, 0, 1.0, NULL, ws, &r, NULL), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_int_equal(collision_of_list(cprox_point_along(curve), NULL, 0, NULL, ws, &r, NULL), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  cprox_curve_free(curve);
}

/* ---- unusable arguments ---- */

static void expect_refusal(cprox_status status, const char *word, const cprox_result *r) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), word)) fail_msg("'%s' does not say '%s'", cprox_workspace_error(ws), word);
  assert_true(r->lower == -7.0); /* untouched */
}

CASE(unusable_arguments_are_refused_by_name) {
  cprox_curve *curve = segment(vec(0, 0, 0), vec(1, 0, 0));
  cprox_body *body = sphere(1.0);
  const cprox_mover mover = cprox_point_along(curve);
  const cprox_obstacle target = at(body, 5, 0, 0);
  cprox_result r = {.lower = -7.0};
  cprox_options o = accurate(-1e-9);
  expect_refusal(cprox_distance(mover, target, &o, ws, &r), "epsilon", &r);
  o = accurate(NAN);
  expect_refusal(cprox_collision(mover, target, &o, ws, &r), "epsilon", &r);
  o = accurate(1e-6), o.relative_epsilon = NAN;
  expect_refusal(cprox_distance(mover, target, &o, ws, &r), "relative_epsilon", &r);
  o = accurate(1e-6), o.max_nodes = 0;
  expect_refusal(cprox_distance(mover, target, &o, ws, &r), "max_nodes", &r);
  expect_refusal(cprox_tolerance(mover, target, -0.1, NULL, ws, &r), "delta", &r);
  expect_refusal(cprox_tolerance(mover, target, NAN, NULL, ws, &r), "delta", &r);
  expect_refusal(cprox_distance(cprox_tube_along(curve, -1.0), target, NULL, ws, &r), "radius", &r);
  expect_refusal(cprox_distance(cprox_tube_along(curve, INFINITY), target, NULL, ws, &r), "radius", &r);
  expect_refusal(cprox_distance(cprox_point_along(NULL), target, NULL, ws, &r), "curve", &r);
  expect_refusal(cprox_distance(mover, cprox_obstacle_at(NULL, target.pose), NULL, ws, &r), "body", &r);
  expect_refusal(cprox_distance(mover, cprox_with_margin(target, -1.0), NULL, ws, &r), "margin", &r);
  cprox_obstacle bad = target;
  bad.pose.orientation = (cprox_quat){0, 0, 0, 0};
  expect_refusal(cprox_distance(mover, bad, NULL, ws, &r), "norm is 0", &r);
  bad = target, bad.pose.position.y = NAN;
  expect_refusal(distance_of_list(mover, (cprox_obstacle[]){target, bad}, 2, NULL, ws, &r, NULL), "obstacle 1", &r);
  cprox_body_free(body);
  cprox_curve_free(curve);
}

static void stray_support(const void *shape, const double direction[3], double p[3]) {
  (void)direction;
  const double *answer = shape;
  p[0] = p[1] = p[2] = *answer;
}

CASE(a_support_callback_that_leaves_its_body_is_refused) {
  cprox_curve *curve = segment(vec(5, 0, 0), vec(6, 0, 0));
  const double answers[] = {NAN, 100.0};
  for (int i = 0; i < 2; i++) {
    cprox_body *body = NULL;
    usable(cprox_body_create_support(stray_support, &answers[i], vec(0, 0, 0), 1.0, 0.0, 0.0, ws, &body), NULL);
    cprox_result r = {.lower = -7.0};
    expect_refusal(cprox_distance(cprox_point_along(curve), at(body, 0, 0, 0), NULL, ws, &r), "callback", &r);
    cprox_body_free(body);
  }
  cprox_curve_free(curve);
}

/* ---- memory and cost ---- */

CASE(a_second_query_of_a_size_allocates_nothing) {
  rng r = rng_seed(9);
  vec3 points[16], cloud[64];
  for (int i = 0; i < 16; i++) points[i] = rng_in_cube(&r, 1.0);
  for (int i = 0; i < 64; i++) cloud[i] = vec_scale(0.3, rng_unit(&r));
  cprox_curve *curve = bezier(points, 16);
  cprox_body *body = NULL;
  usable(cprox_body_create_polytope(cloud, 64, ws, &body), NULL);
  cprox_obstacle targets[30];
  for (int i = 0; i < 30; i++) targets[i] = cprox_obstacle_at(body, rng_pose(&r, 2.0));
  cprox_obstacles *all = NULL;
  usable(cprox_obstacles_create(targets, 30, CPROX_INDEX_NONE, ws, &all), NULL);
  size_t before = 0;
  for (int round = 0; round < 3; round++) {
    if (round == 1) before = allocations_made();
    cprox_result one;
    const cprox_options options = accurate(1e-12);
    assert_true(cprox_obstacles_distance(all, cprox_point_along(curve), &options, ws, &one, NULL) >= 0);
    assert_true(cprox_obstacles_tolerance(all, cprox_point_along(curve), 0.1, &options, ws, &one, NULL) >= 0);
    assert_true(cprox_obstacles_collision(all, cprox_point_along(curve), &options, ws, &one, NULL) >= 0);
  }
  assert_int_equal(allocations_made(), before);
  cprox_obstacles_free(all);
  cprox_body_free(body);
  cprox_curve_free(curve);
}

CASE(a_failed_allocation_is_a_status_and_the_next_query_answers) {
  cprox_curve *curve = segment(vec(2, -1, 0), vec(2, 1, 0));
  cprox_body *body = box(1, 1, 1);
  for (size_t successes = 0; successes < 4; successes++) {
    cprox_workspace *fresh = cprox_workspace_create();
    cprox_result r = {.lower = -7.0};
    allocations_fail_after(successes);
    const cprox_status status = cprox_distance(cprox_point_along(curve), at(body, 0, 0, 0), NULL, fresh, &r);
    allocations_allow();
    if (status != CPROX_OK) {
      assert_int_equal(status, CPROX_MEMORY);
      assert_true(r.lower == -7.0);
      assert_string_not_equal(cprox_workspace_error(fresh), "");
    }
    assert_int_equal(cprox_distance(cprox_point_along(curve), at(body, 0, 0, 0), NULL, fresh, &r), CPROX_OK);
    assert_contains(&r, 1.5, 0.0);
    cprox_workspace_free(fresh);
  }
  cprox_body_free(body);
  cprox_curve_free(curve);
}

static int by_count(const void *a, const void *b) {
  return *(const uint32_t *)a < *(const uint32_t *)b ? -1 : *(const uint32_t *)a > *(const uint32_t *)b;
}

/* Seed 11, 400 problems a group, curves in the unit cube, epsilon 1e-10. */
CASE(medians_stay_within_6_nodes_and_10_probes) {
  enum { PROBLEMS = 400 };
  rng r = rng_seed(11);
  const size_t orders[] = {5, 10, 15};
  for (int kind = 0; kind < 3; kind++) {
    for (int k = 0; k < 3; k++) {
      uint32_t nodes[PROBLEMS], distance_queries[PROBLEMS];
      for (int i = 0; i < PROBLEMS; i++) {
        vec3 points[16], cloud[64];
        for (size_t j = 0; j <= orders[k]; j++) {
          points[j] = rng_in_cube(&r, 1.0);
          if (kind == 1) points[j].z = 0.0;
        }
        cprox_body *body = NULL;
        if (kind == 0) {
          body = box(rng_uniform(&r, 0.1, 0.5), rng_uniform(&r, 0.1, 0.5), rng_uniform(&r, 0.1, 0.5));
        } else if (kind == 1) {
          double polygon[20][2];
          for (int j = 0; j < 20; j++) {
            const double a = 6.283185307179586 * (j + rng_uniform(&r, 0.0, 0.7)) / 20.0;
            polygon[j][0] = 0.25 * cos(a), polygon[j][1] = 0.15 * sin(a);
          }
          usable(cprox_body_create_polygon((const double(*)[2])polygon, 20, ws, &body), NULL);
        } else {
          for (int j = 0; j < 64; j++) cloud[j] = vec_scale(0.25, rng_unit(&r));
          usable(cprox_body_create_polytope(cloud, 64, ws, &body), NULL);
        }
        cprox_pose pose = rng_pose(&r, 1.0);
        if (kind == 1) pose.position.z = 0.0, pose.orientation.x = pose.orientation.y = 0.0;
        cprox_curve *curve = bezier(points, orders[k] + 1);
        const cprox_options options = accurate(1e-10);
        cprox_result result;
        assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, pose), &options, ws, &result),
                         CPROX_OK);
        nodes[i] = result.nodes, distance_queries[i] = result.distance_queries;
        cprox_curve_free(curve);
        cprox_body_free(body);
      }
      qsort(nodes, PROBLEMS, sizeof *nodes, by_count);
      qsort(distance_queries, PROBLEMS, sizeof *distance_queries, by_count);
      print_message("%s, order %zu: median %u nodes, %u distance queries; 95 %%: %u, %u; most: %u, %u\n",
                    kind == 0   ? "box"
                    : kind == 1 ? "20-gon"
                                : "64-vertex polytope",
                    orders[k], nodes[PROBLEMS / 2], distance_queries[PROBLEMS / 2], nodes[PROBLEMS * 19 / 20],
                    distance_queries[PROBLEMS * 19 / 20], nodes[PROBLEMS - 1], distance_queries[PROBLEMS - 1]);
      assert_true(nodes[PROBLEMS / 2] <= 6 && distance_queries[PROBLEMS / 2] <= 10);
    }
  }
}

/* However early a search stops, its two points are those that attain upper: as far apart as it says, the one within the
 * radius of the curve's point, the other within the margin of the hull. 2^-44 of the sizes: roundings of points in
 * double. */
CASE(witness_points_attain_upper_however_loose_epsilon_is) {
  rng r = rng_seed(29);
  const size_t cases = test_cases(2000);
  for (size_t i = 0; i < cases; i++) {
    vec3 points[4], vertices[9];
    for (int k = 0; k < 4; k++) points[k] = vec_add(vec(2.5, 0.0, 0.0), rng_in_cube(&r, 2.0));
    for (int k = 0; k < 9; k++) vertices[k] = rng_unit(&r);
    cprox_curve *curve = bezier(points, 4);
    cprox_body *hull = NULL;
    assert_int_equal(cprox_body_create_polytope(vertices, 9, ws, &hull), CPROX_OK);
    const double radius = rng_uniform(&r, 0.0, 0.5), margin = rng_uniform(&r, 0.0, 0.5);
    const cprox_options options = accurate(rng_log_uniform(&r, 1e-3, 1e3));
    cprox_result result;
    const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(hull, CPROX_POSE_IDENTITY), margin);
    assert_int_equal(cprox_distance(cprox_tube_along(curve, radius), target, &options, ws, &result), CPROX_OK);

    vec3 at;
    cprox_curve_evaluate(curve, result.t, ws, &at, NULL, NULL);
    const double room = 0x1p-44 * 8.0;
    const vec3 witness_obstacle = result.witness_obstacle;
    assert_true(vec_norm(vec_sub(result.witness_mover, witness_obstacle)) <= result.upper + room);
    assert_true(vec_norm(vec_sub(result.witness_mover, at)) <= radius + room);
    const vec3l p = {witness_obstacle.x, witness_obstacle.y, witness_obstacle.z};
    assert_true((double)ref_point_hull(p, vertices, 9) <= margin + room);
    cprox_curve_free(curve);
    cprox_body_free(hull);
  }
}

/* Bounds that contradict each other end the program where CPROX_CHECKED is on, as in what tests of the core link; bounds
 * that do not, pass. */
CASE(bounds_that_contradict_each_other_are_not_hidden) {
  const query q = {.limit = -1.0, .options = CPROX_OPTIONS_DEFAULT, .workspace = ws};
  for (int contradict = 0; contradict < 2; contradict++) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
      signal(SIGABRT, SIG_DFL);
      cprox_result r = {.lower = contradict ? 1.5 : 0.5, .upper = 1.0};
      if (!freopen("/dev/null", "w", stderr)) _exit(2);
      query_conclude(&q, INFINITY, CPROX_OK, &r);
      _exit(0);
    }
    int ended = 0;
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(contradict ? WIFSIGNALED(ended) && WTERMSIG(ended) == SIGABRT
                           : WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
