/* SPDX-License-Identifier: BSD-3-Clause */
/* Time of contact along the parameter: never late, as close as asked, proven where it is said to be. */
#include <stdio.h>
#include <stdlib.h>

#include "base/frame.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

/* ---- builders ---- */

static void ask(cprox_mover mover, cprox_obstacle target, double epsilon, cprox_result *r) {
  const cprox_options options = accurate(epsilon);
  const cprox_status status = cprox_time_of_contact(mover, target, &options, ws, r);
  if (status != CPROX_OK) fail_msg("%s: %s", cprox_status_name(status), cprox_workspace_error(ws));
  assert_int_equal(r->status, status);
}

/* A body of a random kind, its distance from a point in long double, and where it stands. */
typedef struct obstacle {
  int kind; /* sphere, box, polytope */
  double radius;
  vec3 half, vertex[8];
  cprox_pose pose;
  cprox_body *body;
} obstacle;

static void obstacle_make(rng *r, double thinness, obstacle *o) {
  o->kind = (int)rng_index(r, 3);
  o->pose = rng_pose(r, 0.5);
  o->body = NULL;
  o->radius = rng_uniform(r, 0.05, 0.6);
  o->half = vec(rng_uniform(r, 0.1, 0.7), rng_uniform(r, 0.1, 0.7), thinness * rng_uniform(r, 0.1, 0.7));
  for (int i = 0; i < 8; i++) {
    o->vertex[i] = rng_in_cube(r, 0.7);
    o->vertex[i].z *= thinness;
  }
  cprox_status status = CPROX_INVALID;
  if (o->kind == 0) status = cprox_body_create_sphere(o->radius, ws, &o->body);
  if (o->kind == 1) status = cprox_body_create_box(vec_scale(2.0, o->half), ws, &o->body);
  if (o->kind == 2) status = cprox_body_create_polytope(o->vertex, 8, ws, &o->body);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static long double obstacle_distance(const obstacle *o, vec3l world) {
  const vec3l p = ref_to_local(&o->pose, world);
  if (o->kind == 0) return fmaxl(ref_norm(p) - (long double)o->radius, 0.0L);
  if (o->kind == 1) return ref_point_box(p, o->half);
  return ref_point_hull(p, o->vertex, 8);
}

/* ---- random curves and bodies ---- */

/* 3000 random pairs, seed 1, degrees 1 to 9, points and tubes. Distances by long double at 60 parameters before
 * t_contact_lower and at t_contact_lower and t themselves; both sides of a comparison are within 1e-14 at this scale.
 * */
CASE(nothing_touches_before_t_contact_lower_and_it_is_within_epsilon_of_contact) {
  const double doubt = 1e-14;
  const size_t cases = test_cases(3000);
  rng r = rng_seed(1);
  size_t hits = 0, free_ones = 0, undecided = 0;
  double nodes = 0.0, distance_queries = 0.0;
  for (size_t i = 0; i < cases; i++) {
    obstacle o;
    obstacle_make(&r, rng_index(&r, 3) == 0 ? 1e-3 : 1.0, &o);
    const size_t degree = 1 + rng_index(&r, 9);
    vec3 p[10];
    for (size_t k = 0; k <= degree; k++) p[k] = rng_in_cube(&r, 2.0);
    cprox_curve *curve = bezier(p, degree + 1);
    const double radius = rng_index(&r, 2) ? rng_uniform(&r, 0.0, 0.2) : 0.0;
    const double epsilon = rng_log_uniform(&r, 1e-12, 1e-3);
    cprox_result c;
    ask(cprox_tube_along(curve, radius), cprox_obstacle_at(o.body, o.pose), epsilon, &c);

    for (int k = 0; k < 60 && c.t_contact_lower > 0.0; k++) {
      const long double t = (long double)c.t_contact_lower * k / 60.0L;
      const long double d = obstacle_distance(&o, ref_bezier(p, degree, t, 0)) - (long double)radius;
      if (d < -(long double)doubt)
        fail_msg("case %zu: contact at %.17Lg, t_contact_lower %.17g", i, t, c.t_contact_lower);
    }
    const long double at_free =
        obstacle_distance(&o, ref_bezier(p, degree, (long double)c.t_contact_lower, 0)) - (long double)radius;
    if (c.verdict == CPROX_VERDICT_CLEAR) {
      assert_true(c.t_contact_lower == 1.0 && c.lower > 0.0);
      assert_true(at_free > -(long double)doubt);
      free_ones++;
    } else {
      if (at_free > (long double)(epsilon + doubt))
        fail_msg("case %zu: at t_contact_lower the distance is %.3Lg", i, at_free);
      assert_true(c.t_contact_lower <= c.t);
      const long double at_hit =
          obstacle_distance(&o, ref_bezier(p, degree, (long double)c.t, 0)) - (long double)radius;
      if (c.verdict == CPROX_VERDICT_VIOLATED && at_hit > (long double)doubt)
        fail_msg("case %zu: no contact at t: %.3Lg", i, at_hit);
      hits += c.verdict == CPROX_VERDICT_VIOLATED, undecided += c.verdict == CPROX_VERDICT_UNDECIDED;
    }
    nodes += c.nodes, distance_queries += c.distance_queries;
    cprox_curve_free(curve);
    cprox_body_free(o.body);
  }
  printf("%zu hits, %zu free, %zu undecided; nodes and distance queries a query: %.1f, %.1f\n", hits, free_ones,
         undecided, nodes / (double)cases, distance_queries / (double)cases);
  assert_true(hits * 5 > cases && free_ones * 10 > cases && undecided * 50 < cases);
}

/* ---- thin plates and grazes: contact known in closed form ---- */

/* The first s at which the descending ordinate of the curve is at most `height`, by bisection in long double. */
static long double descends_to(const vec3 *p, size_t degree, long double height) {
  long double low = 0.0L, high = 1.0L;
  for (int k = 0; k < 200; k++) {
    const long double middle = 0.5L * (low + high);
    *(ref_bezier(p, degree, middle, 0).z > height ? &low : &high) = middle;
  }
  return high;
}

/* 1200 curves that go down through a plate of 1e-9 to 1e-3, seed 2, the plate turned anyhow. Where the curve meets the
 * upper side is found by bisection: t_contact_lower is no later, and no earlier than where the curve is still epsilon
 * above.
 * */
CASE(a_plate_is_neither_missed_nor_met_late) {
  const size_t cases = test_cases(1200);
  rng r = rng_seed(2);
  for (size_t i = 0; i < cases; i++) {
    const double half = rng_log_uniform(&r, 5e-10, 5e-4), radius = rng_index(&r, 2) ? rng_uniform(&r, 0.0, 0.1) : 0.0;
    const double epsilon = rng_log_uniform(&r, 1e-11, 1e-4);
    const size_t degree = 1 + rng_index(&r, 7);
    vec3 p[8];
    for (size_t k = 0; k <= degree; k++) {
      const double height = degree == 1 ? 1.0 - 2.0 * (double)k : 1.0 - 2.0 * (double)k / (double)degree;
      p[k] = vec(rng_uniform(&r, -1, 1), rng_uniform(&r, -1, 1),
                 height + (k > 0 && k < degree ? rng_uniform(&r, -0.1, 0.1) : 0.0));
    }
    cprox_curve *curve = bezier(p, degree + 1);
    cprox_body *plate = NULL;
    assert_int_equal(cprox_body_create_box(vec(6, 6, 2 * half), ws, &plate), CPROX_OK);
    const double turn = rng_uniform(&r, -3, 3);
    const cprox_pose pose = {.orientation = {cos(turn), 0, 0, sin(turn)}};
    cprox_result c;
    ask(cprox_tube_along(curve, radius), cprox_obstacle_at(plate, pose), epsilon, &c);
    assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
    const long double top = (long double)half + (long double)radius;
    const long double contact = descends_to(p, degree, top), early = descends_to(p, degree, top + (long double)epsilon);
    if ((long double)c.t_contact_lower > contact + 1e-14L)
      fail_msg("case %zu: late by %.3Lg", i, (long double)c.t_contact_lower - contact);
    if ((long double)c.t_contact_lower < early - 1e-14L)
      fail_msg("case %zu: early by %.3Lg", i, early - (long double)c.t_contact_lower);
    assert_true((long double)c.t >= contact - 1e-14L);
    cprox_curve_free(curve);
    cprox_body_free(plate);
  }
}

/* 1200 parabolas over a ball whose top they pass at a height of -1e-3 … 1e-3, seed 3. The least height decides, except
 * within epsilon and rounding of 0. */
CASE(grazes_are_told_from_misses) {
  const size_t cases = test_cases(1200);
  rng r = rng_seed(3);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &ball), CPROX_OK);
  for (size_t i = 0; i < cases; i++) {
    const double height = (rng_index(&r, 2) ? 1.0 : -1.0) * rng_log_uniform(&r, 1e-9, 1e-3), epsilon = 1e-10;
    const double drift = rng_uniform(&r, -0.2, 0.2);
    /* z = 0.5 + height + u², u = 2s - 1, y = drift u² keeps the top of the ball nearest */
    const double top = 0.5 + height;
    const vec3 p[3] = {{-1, drift, top + 1}, {0, -drift, top - 1}, {1, drift, top + 1}};
    cprox_curve *curve = bezier(p, 3);
    cprox_result c;
    ask(cprox_point_along(curve), cprox_obstacle_at(ball, CPROX_POSE_IDENTITY), epsilon, &c);
    if (c.verdict != (height > 0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED))
      fail_msg("case %zu: height %.3g answered %s", i, height, cprox_verdict_name(c.verdict));
    if (height < 0) assert_true(c.t_contact_lower <= c.t && c.t_contact_lower < 0.5 && c.t <= 0.5 + 1e-9);
    cprox_curve_free(curve);
  }
  cprox_body_free(ball);
}

/* ---- splines, several targets, curves as targets ---- */

CASE(the_earliest_of_many_targets_is_met) {
  const vec3 p[2] = {{0, 0, 0}, {10, 0, 0}};
  cprox_curve *curve = bezier(p, 2);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &ball), CPROX_OK);
  cprox_obstacle targets[4];
  const double x[4] = {8, 4, 6, 20};
  for (int i = 0; i < 4; i++)
    targets[i] = cprox_obstacle_at(ball, (cprox_pose){.position = {x[i], 0.1, 0}, .orientation = {1, 0, 0, 0}});
  const cprox_options options = accurate(1e-10);
  cprox_result c;
  assert_int_equal(time_of_contact_of_list(cprox_point_along(curve), targets, 4, &options, ws, &c), CPROX_OK);
  assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
  assert_int_equal(c.obstacle_index, 1);
  const double contact = (4.0 - sqrt(0.25 - 0.01)) / 10.0;
  assert_true(c.t_contact_lower <= contact && contact <= c.t && c.t - c.t_contact_lower < 1e-9);
  assert_int_equal(time_of_contact_of_list(cprox_point_along(curve), NULL, 0, &options, ws, &c), CPROX_OK);
  assert_int_equal(c.verdict, CPROX_VERDICT_CLEAR);
  assert_float_equal(c.t_contact_lower, 1.0, 0.0);
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

CASE(contact_on_a_late_piece_of_a_long_spline_is_found_there) {
  enum { N = 400 };
  static vec3 p[N];
  static double knots[N + 4];
  for (int i = 0; i < N; i++) p[i] = vec(0.1 * i, 0.05 * sin(0.3 * i), 0.0);
  for (int i = 0; i < N + 4; i++) knots[i] = i;
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(p, N, 3, knots, N + 4, 3, N), ws, &curve), CPROX_OK);
  cprox_body *wall = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.02, 4, 4), ws, &wall), CPROX_OK);
  cprox_result c;
  ask(cprox_point_along(curve),
      cprox_obstacle_at(wall, (cprox_pose){.position = {30.01, 0, 0}, .orientation = {1, 0, 0, 0}}), 1e-10, &c);
  assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
  /* x(t) = 0.1 (t - 2) on a uniform cubic spline whose x are equally spaced */
  assert_true(c.t_contact_lower <= 302.0 + 1e-11 && c.t_contact_lower > 302.0 - 1e-8 && c.t >= 302.0 - 1e-11 &&
              c.t < 302.0 + 1e-7);
  assert_true(c.nodes < 100);
  cprox_body_free(wall);
  cprox_curve_free(curve);
}

/* Two tubes, 300 pairs of cubics, seed 4, against the brute minimum over 400 parameters of the other curve. */
CASE(tubes_meet_no_later_than_they_touch) {
  const size_t cases = test_cases(300);
  rng r = rng_seed(4);
  size_t hits = 0;
  for (size_t i = 0; i < cases; i++) {
    vec3 p[4], q[4];
    for (int k = 0; k < 4; k++) p[k] = rng_in_cube(&r, 1.0), q[k] = rng_in_cube(&r, 1.0);
    cprox_curve *first = bezier(p, 4), *second = bezier(q, 4);
    const double epsilon = 1e-8;
    cprox_result c;
    ask(cprox_tube_along(first, 0.1), cprox_obstacle_curve(second, 0.15), epsilon, &c);
    const double last = c.verdict == CPROX_VERDICT_CLEAR ? 1.0 : c.t_contact_lower;
    for (int k = 0; k <= 50 && last > 0.0; k++) {
      const vec3l x = ref_bezier(p, 3, (long double)last * k / 51.0L, 0);
      for (int m = 0; m <= 400; m++) {
        const long double d = ref_norm(ref_sub(x, ref_bezier(q, 3, m / 400.0L, 0)));
        if (d < 0.25L - 1e-13L) fail_msg("case %zu: touches before t_contact_lower %.17g", i, c.t_contact_lower);
      }
    }
    if (c.verdict == CPROX_VERDICT_VIOLATED) {
      const long double d = ref_norm(ref_sub(ref_bezier(p, 3, c.t, 0), ref_bezier(q, 3, c.t_obstacle, 0)));
      assert_true(d <= 0.25L + 1e-13L);
      if (c.t - c.t_contact_lower > 1e-5)
        fail_msg("case %zu: contact only at %.17g, free until %.17g", i, c.t, c.t_contact_lower);
      hits++;
    }
    cprox_curve_free(first);
    cprox_curve_free(second);
  }
  assert_true(hits * 4 > cases);
}

CASE(a_start_inside_is_contact_at_the_start) {
  const vec3 p[3] = {{0.1, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  cprox_curve *curve = bezier(p, 3);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &ball), CPROX_OK);
  cprox_result c;
  ask(cprox_point_along(curve), cprox_obstacle_at(ball, CPROX_POSE_IDENTITY), 1e-9, &c);
  assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(c.t_contact_lower == 0.0 && c.t == 0.0 && c.lower == 0.0 && c.upper == 0.0);
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

/* A line that slides along a face at distance 0 from its start on, and one that ends on the face. */
CASE(resting_contact_ends_within_the_budget) {
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(2, 2, 2), ws, &box), CPROX_OK);
  const vec3 slide[3] = {{-3, 0, 1}, {0, 0.5, 1}, {3, 0, 1}}, land[3] = {{0, 0, 2}, {0.5, 0, 2}, {0, 0.5, 1}};
  for (int k = 0; k < 2; k++) {
    cprox_curve *curve = bezier(k == 0 ? slide : land, 3);
    cprox_result c;
    ask(cprox_point_along(curve), cprox_obstacle_at(box, CPROX_POSE_IDENTITY), 1e-9, &c);
    assert_true(c.verdict != CPROX_VERDICT_CLEAR);
    const double contact = k == 0 ? 1.0 / 3.0 : 1.0;
    assert_true(c.t_contact_lower <= contact && c.t_contact_lower > contact - 1e-4 && c.nodes < 300);
    cprox_curve_free(curve);
  }
  cprox_body_free(box);
}

CASE(out_of_budget_t_contact_lower_is_still_true) {
  const vec3 p[4] = {{-2, 0.1, 0}, {3, 2, 0}, {-3, -2, 0.5}, {2, 0.5, 0}};
  cprox_curve *curve = bezier(p, 4);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.2, ws, &ball), CPROX_OK);
  const cprox_obstacle target =
      cprox_obstacle_at(ball, (cprox_pose){.position = {0.1, 0, 0.2}, .orientation = {1, 0, 0, 0}});
  cprox_options options = accurate(1e-12);
  cprox_result whole, c;
  assert_int_equal(cprox_time_of_contact(cprox_point_along(curve), target, &options, ws, &whole), CPROX_OK);
  for (uint32_t n = 1; n < whole.nodes; n++) {
    options.max_nodes = n;
    assert_int_equal(cprox_time_of_contact(cprox_point_along(curve), target, &options, ws, &c), CPROX_BUDGET);
    assert_true(c.t_contact_lower <= whole.t);
    assert_true(cprox_workspace_error(ws)[0] != '\0');
  }
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

/* ---- advancing ---- */

enum { CARRIED_KINDS = 6 };

static cprox_body *carried_body(rng *r, size_t kind) {
  cprox_body *body = NULL;
  vec3 v[20];
  for (size_t i = 0; i < 20; i++) v[i] = vec_scale(0.3, rng_unit(r));
  const double a = rng_uniform(r, 0.1, 0.4), b = rng_uniform(r, 0.05, 0.3), c = rng_uniform(r, 0.05, 0.3);
  const cprox_status status = kind == 0   ? cprox_body_create_box(vec(a, b, c), ws, &body)
                              : kind == 1 ? cprox_body_create_capsule(2.0 * a, b, ws, &body)
                              : kind == 2 ? cprox_body_create_sphere(b, ws, &body)
                              : kind == 3 ? cprox_body_create_cylinder(2.0 * a, b, ws, &body)
                              : kind == 4 ? cprox_body_create_polytope(v, 20, ws, &body)
                                          : cprox_body_create_ellipsoid(vec(a, b, c), ws, &body);
  assert_int_equal(status, CPROX_OK);
  return body;
}

/* The part of the curve before t is asked for a collision, which another search answers. */
static void assert_free_before(cprox_mover mover, cprox_obstacle target, double t, size_t i) {
  static const double ROOM = 1e-12;
  if (!(t > ROOM)) return;
  const cprox_curve *whole = mover.curve;
  const cprox_curve_description d = {.kind = CPROX_CURVE_PART, .curves = &whole, .n = 1, .t1 = t - ROOM};
  const cprox_options options = accurate(1e-13);
  cprox_curve *part = NULL;
  cprox_result before;
  assert_int_equal(cprox_curve_create(&d, ws, &part), CPROX_OK);
  mover.curve = part;
  assert_true(cprox_collision(mover, target, &options, ws, &before) >= 0);
  if (before.verdict == CPROX_VERDICT_VIOLATED) fail_msg("case %zu: contact at %.17g before %.17g", i, before.t, t);
  cprox_curve_free(part);
}

/* 3000 bodies carried along lines, cubics and quintics past one that stands, with and without a margin, a fifth of them
 * lifted until they graze (seed 44): nothing touches before, contact is where it is said to be, and one point of both
 * is shown. A node is a step as far as the plane at its beginning allows: they are few, for hits as well. Rounding of
 * points and distances is below 1e-11 here. */
CASE(a_carried_body_is_met_in_few_steps_and_never_late) {
  static const double NOISE = 1e-11;
  rng r = rng_seed(44);
  const size_t cases = test_cases(3000);
  size_t hits = 0;
  uint64_t nodes = 0, of_hits = 0;
  for (size_t i = 0; i < cases; i++) {
    cprox_body *carried = carried_body(&r, rng_index(&r, CARRIED_KINDS)),
               *standing = carried_body(&r, rng_index(&r, CARRIED_KINDS));
    vec3 points[6];
    const size_t n = 2 + 2 * rng_index(&r, 3);
    for (size_t k = 0; k < n; k++) points[k] = rng_in_cube(&r, 1.2);
    cprox_obstacle target = cprox_obstacle_at(standing, rng_pose(&r, 0.3));
    if (i % 4 == 0) target.pose.orientation = (cprox_quat){.w = 1.0};
    if (i % 6 == 0) target.margin = 0.05;
    cprox_curve *curve = bezier(points, n);
    cprox_result found;
    assert_true(cprox_distance(cprox_body_along(carried, curve), target, NULL, ws, &found) >= 0);
    if (i % 5 == 0 && found.lower > 0.0) {
      for (size_t k = 0; k < n; k++) points[k] = vec_axpy(points[k], -found.upper, found.normal);
      cprox_curve_free(curve);
      curve = bezier(points, n);
    }
    const cprox_mover mover = cprox_body_along(carried, curve);
    const cprox_options options = accurate(rng_log_uniform(&r, 1e-10, 1e-4));
    const cprox_status status = cprox_time_of_contact(mover, target, &options, ws, &found);
    assert_true(status >= 0);
    assert_free_before(mover, target, found.t_contact_lower, i);
    nodes += found.nodes;
    if (found.verdict == CPROX_VERDICT_CLEAR) { /* by how much, and between which points */
      assert_true(found.lower >= 0.49 * options.epsilon || found.upper <= options.epsilon);
      const double apart = vec_norm(vec_sub(found.witness_mover, found.witness_obstacle));
      assert_true(isinf(found.upper) || fabs(apart - found.upper) <= NOISE);
    }
    if (found.verdict == CPROX_VERDICT_VIOLATED) {
      hits++, of_hits += found.nodes;
      assert_true(found.t >= found.t_contact_lower && found.lower == 0.0 && found.upper == 0.0);
      assert_true(vec_norm(vec_sub(found.witness_mover, found.witness_obstacle)) <= NOISE);
      cprox_body *point = NULL;
      vec3 at;
      cprox_result gap;
      assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
      cprox_curve_evaluate(curve, found.t, ws, &at, NULL, NULL);
      const cprox_pose seen = {found.witness_obstacle, {.w = 1.0}}, there = {at, {.w = 1.0}};
      assert_true(cprox_pair(cprox_obstacle_at(point, seen), target, NULL, ws, &gap) >= 0 && gap.lower <= NOISE);
      assert_true(cprox_pair(cprox_obstacle_at(point, seen), cprox_obstacle_at(carried, there), NULL, ws, &gap) >= 0 &&
                  gap.lower <= NOISE);
      cprox_body_free(point);
    }
    cprox_curve_free(curve);
    cprox_body_free(carried);
    cprox_body_free(standing);
  }
  if (nodes > 7 * cases || of_hits > 7 * hits + 50)
    fail_msg("%zu questions took %zu nodes, %zu hits %zu", cases, (size_t)nodes, hits, (size_t)of_hits);
  assert_true(hits > cases / 5);
}

/* Convex bodies that graze within epsilon: what another search proves apart is clear, not undecided. */
CASE(a_graze_that_is_proven_apart_is_clear) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &ball), CPROX_OK);
  const vec3 points[2] = {{-1.0, 0.5 + 1e-7, 0.0}, {1.0, 0.5 + 1e-7, 0.0}};
  cprox_curve *line = bezier(points, 2);
  const cprox_options options = accurate(1e-6);
  cprox_result found;
  assert_int_equal(cprox_time_of_contact(cprox_point_along(line), cprox_obstacle_at(ball, CPROX_POSE_IDENTITY),
                                         &options, ws, &found),
                   CPROX_OK);
  assert_int_equal(found.verdict, CPROX_VERDICT_CLEAR);
  assert_true(found.lower > 0.0 && found.lower <= 1e-7 && found.t_contact_lower == 1.0);
  cprox_curve_free(line);
  cprox_body_free(ball);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
