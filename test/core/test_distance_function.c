/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets known by their distance function alone: intervals against dense samples of the distance in long double, with
 * values that are off by what was stated; grids of distances, height fields; and what must be refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/reference.h"

/* ---- sets ---- */

enum { MOST_BALLS = 6 };

/* A union of balls, which is not convex. The values are off by up to `error`, and are those of a hash: they jump. */
typedef struct balls {
  size_t n;
  vec3 centre[MOST_BALLS];
  double radius[MOST_BALLS], error;
  bool jumps;
} balls;

static balls balls_random(rng *r) {
  balls set = {.n = 1 + rng_index(r, MOST_BALLS)};
  for (size_t i = 0; i < set.n; i++) {
    set.centre[i] = rng_in_cube(r, 0.5);
    set.radius[i] = rng_log_uniform(r, 1e-3, 0.1);
  }
  return set;
}

/* Negative inside one ball. */
static long double balls_exact(const balls *set, vec3l x) {
  long double least = INFINITY;
  for (size_t i = 0; i < set->n; i++)
    least = fminl(least, ref_norm(ref_sub(x, ref_vec(set->centre[i]))) - set->radius[i]);
  return least;
}

static double balls_value(const void *shape, const double point[3]) {
  const balls *set = shape;
  const vec3 x = vec(point[0], point[1], point[2]);
  double off = set->error * sin(20.0 * (x.x + 2.0 * x.y + 3.0 * x.z));
  if (set->jumps) off = fmod(fabs(point[0]) * 1e9, 1.0) > 0.5 ? set->error : -set->error;
  return (double)balls_exact(set, ref_vec(x)) + off;
}

static cprox_body *balls_body(const balls *set) {
  cprox_body *body = NULL;
  const double lipschitz = set->jumps ? INFINITY : 1.0 + 80.0 * set->error;
  const cprox_status status =
      cprox_body_create_distance(balls_value, set, vec(0, 0, 0), 1.0, lipschitz, set->error * (1.0 + 1e-9), ws, &body);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return body;
}

/* ---- the truth ---- */

enum { SAMPLES = 400 };

typedef struct course {
  vec3 points[6];
  size_t n;
  cprox_curve *curve;
} course;

static course course_random(rng *r) {
  course c = {.n = 2 + rng_index(r, 5)};
  for (size_t i = 0; i < c.n; i++) c.points[i] = rng_in_cube(r, 1.0);
  c.curve = bezier(c.points, c.n);
  return c;
}

static vec3l course_at(const course *c, const cprox_pose *pose, long double t) {
  return ref_to_local(pose, ref_bezier(c->points, c->n - 1, t, 0));
}

static long double least_sampled(const balls *set, const course *c, const cprox_pose *pose) {
  long double least = INFINITY;
  for (int k = 0; k <= SAMPLES; k++)
    least = fminl(least, balls_exact(set, course_at(c, pose, (long double)k / SAMPLES)));
  return least;
}

/* seed 41, 300 unions (scale 100: 30,000): the interval holds the distance by samples and at the place it names, and is
 * no wider than epsilon and four times the stated error. */
CASE(intervals_hold_the_distance_and_are_as_wide_as_the_stated_error) {
  rng r = rng_seed(41);
  const size_t cases = test_cases(300);
  size_t exact = 0;
  for (size_t i = 0; i < cases; i++) {
    balls set = balls_random(&r);
    set.error = i % 3 == 0 ? 0.0 : rng_log_uniform(&r, 1e-6, 1e-2);
    set.jumps = i % 3 == 2;
    cprox_body *body = balls_body(&set);
    const course c = course_random(&r);
    const cprox_pose pose = i % 2 ? rng_pose(&r, 0.3) : CPROX_POSE_IDENTITY;
    const double radius = i % 4 ? 0.0 : 0.05;
    cprox_obstacle target = cprox_obstacle_at(body, pose);
    target.margin = i % 5 ? 0.0 : 0.01;
    const double offset = radius + target.margin;
    cprox_result got;
    const cprox_options options = accurate(1e-6);
    const cprox_status status = cprox_distance(cprox_tube_along(c.curve, radius), target, &options, ws, &got);
    assert_true(status == CPROX_OK || status == CPROX_INEXACT);
    const long double least = fmaxl(least_sampled(&set, &c, &pose) - offset, 0.0L);
    const long double there = fmaxl(balls_exact(&set, course_at(&c, &pose, got.t)) - offset, 0.0L);
    assert_true(got.lower <= least + 1e-15L && there <= got.upper + 1e-15L);
    assert_true(got.upper - got.lower <= 1e-6 + 4.0 * set.error);
    assert_true(got.nodes < 20000);
    if (set.error == 0.0) {
      assert_int_equal(status, CPROX_OK);
      exact++;
      /* the witness lies on the set */
      const vec3l on = ref_to_local(&pose, ref_vec(got.witness_obstacle));
      if (got.upper > 1e-6) assert_true(fabsl(balls_exact(&set, on) - target.margin) < 1e-6L);
    }
    cprox_curve_free(c.curve);
    cprox_body_free(body);
  }
  assert_true(exact >= cases / 4);
}

/* seed 42, 300 unions: no verdict contradicts the samples, and with exact values few are left open. */
CASE(verdicts_are_those_of_the_distance) {
  rng r = rng_seed(42);
  size_t open = 0;
  const size_t cases = test_cases(300);
  for (size_t i = 0; i < cases; i++) {
    balls set = balls_random(&r);
    set.error = i % 2 ? 1e-3 : 0.0;
    cprox_body *body = balls_body(&set);
    const course c = course_random(&r);
    const cprox_pose pose = CPROX_POSE_IDENTITY;
    const double delta = i % 3 ? rng_uniform(&r, 0.0, 0.6) : 0.0;
    cprox_result got;
    const cprox_options options = accurate(1e-9);
    assert_true(
        cprox_tolerance(cprox_tube_along(c.curve, 0.0), cprox_obstacle_at(body, pose), delta, &options, ws, &got) >= 0);
    if (got.verdict == CPROX_VERDICT_CLEAR) assert_true(least_sampled(&set, &c, &pose) > delta);
    if (got.verdict == CPROX_VERDICT_VIOLATED)
      assert_true(balls_exact(&set, course_at(&c, &pose, got.t)) <= delta + 1e-15L);
    open += got.verdict == CPROX_VERDICT_UNDECIDED && set.error == 0.0;
    cprox_curve_free(c.curve);
    cprox_body_free(body);
  }
  assert_true(open <= cases / 100);
}

/* seed 43, 300 unions: before the bound nothing touches, and a contact that is named is one. */
CASE(time_of_contact_is_never_late) {
  rng r = rng_seed(43);
  size_t met = 0;
  const size_t cases = test_cases(300);
  for (size_t i = 0; i < cases; i++) {
    balls set = balls_random(&r);
    set.error = i % 2 ? 1e-4 : 0.0;
    cprox_body *body = balls_body(&set);
    const course c = course_random(&r);
    const cprox_pose pose = CPROX_POSE_IDENTITY;
    cprox_result got;
    assert_true(cprox_time_of_contact(cprox_tube_along(c.curve, 0.2), cprox_obstacle_at(body, pose), NULL, ws, &got) >=
                0);
    if (least_sampled(&set, &c, &pose) < 0.2L - 1e-3L) assert_int_equal(got.verdict, CPROX_VERDICT_VIOLATED);
    for (int k = 0; k <= SAMPLES; k++) {
      const long double t = (long double)k / SAMPLES;
      if (t < got.t_contact_lower) assert_true(balls_exact(&set, course_at(&c, &pose, t)) > 0.2L - 1e-15L);
    }
    if (got.verdict == CPROX_VERDICT_VIOLATED) {
      met++;
      assert_true(balls_exact(&set, course_at(&c, &pose, got.t)) <= 0.2L + 1e-15L);
      if (set.error == 0.0) assert_true(got.t - got.t_contact_lower < 1e-3);
    }
    cprox_curve_free(c.curve);
    cprox_body_free(body);
  }
  assert_true(met > cases / 20);
}

/* ---- splines, sets, the clock ---- */

/* seed 44: a spline of many pieces, alone, in a set of obstacles, and against a body on the clock. */
CASE(splines_sets_and_moving_bodies_are_answered_alike) {
  rng r = rng_seed(44);
  for (int i = 0; i < 30; i++) {
    const balls set = balls_random(&r);
    cprox_body *body = balls_body(&set);
    vec3 p[40];
    double knots[44];
    for (int k = 0; k < 40; k++) p[k] = rng_in_cube(&r, 1.0);
    for (int k = 0; k < 44; k++) knots[k] = k < 4 ? 0 : k > 39 ? 37 : k - 3;
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bspline(p, 40, 3, knots, 44, 0, 37), ws, &curve), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    cprox_result alone, again;
    assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &alone), CPROX_OK);
    long double least = INFINITY;
    for (int k = 0; k < 4000; k++) {
      const double t = 37.0 * k / 4000;
      least = fminl(least, balls_exact(&set, ref_bspline(p, 3, knots, 3 + (size_t)t, t, 0)));
    }
    assert_true(alone.lower <= fmaxl(least, 0.0L) + 1e-12L);
    assert_true(alone.upper - alone.lower <= 1e-6);

    /* the same from a set, with a far obstacle beside it */
    const cprox_obstacle both[2] = {target, cprox_obstacle_at(body, (cprox_pose){{9, 0, 0}, {1, 0, 0, 0}})};
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(both, 2, CPROX_INDEX_BVH, ws, &all), CPROX_OK);
    assert_int_equal(cprox_obstacles_distance(all, cprox_tube_along(curve, 0.0), NULL, ws, &again, NULL), CPROX_OK);
    assert_true(again.lower <= alone.upper && alone.lower <= again.upper);
    cprox_obstacles_free(all);

    /* a body that moves with the curve keeps its distance */
    const cprox_obstacle moving = cprox_synchronized(cprox_body_along(body, curve));
    assert_true(cprox_distance(cprox_tube_along(curve, 0.0), moving, NULL, ws, &again) >= 0);
    const long double still = fmaxl(balls_exact(&set, ref_vec(vec(0, 0, 0))), 0.0L);
    assert_true(again.lower <= still + 1e-9L && still <= again.upper + 1e-9L);
    cprox_curve_free(curve);
    cprox_body_free(body);
  }
}

/* ---- what must be refused ---- */

static double lies(const void *shape, const double x[3]) {
  const double d = fmax(sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) - 0.5, 0.0);
  switch (*(const int *)shape) {
    case 0: return 2.0 * d;                  /* steeper than a distance */
    case 1: return NAN;                      /* never a number */
    case 2: return 0.5 * d;                  /* too flat: far away it contradicts the ball */
    case 3: return d + 0.5 * (x[0] > 0.0);   /* jumps */
    case 4: return x[0] > 0.7 ? NAN : d;     /* sometimes a number */
    case 5: return x[1] > 0.9 ? d + 5.0 : d; /* far beyond the ball */
    default: return d;
  }
}

static void refuses_distance(int lie, double radius, double lipschitz, double error, const char *words) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_distance(lies, &lie, vec(0, 0, 0), radius, lipschitz, error, ws, &body),
                   CPROX_INVALID);
  assert_null(body);
  if (!strstr(cprox_workspace_error(ws), words)) fail_msg("'%s' lacks '%s'", cprox_workspace_error(ws), words);
}

CASE(callbacks_that_lie_are_refused) {
  refuses_distance(0, 0.6, 1.0, 0.0, "than a Lipschitz constant of 1");
  refuses_distance(1, 0.6, 1.0, 0.0, "answered nan at");
  refuses_distance(2, 0.6, 1.0, 0.0, "but the set lies within");
  refuses_distance(3, 0.6, 1.0, 0.01, "than a Lipschitz constant of 1");
  refuses_distance(4, 0.6, 1.0, 0.0, "answered nan at");
  refuses_distance(5, 0.6, 1.0, 0.0, "but the set lies within");
  refuses_distance(6, 0.0, 1.0, 0.0, "radius is 0");
  refuses_distance(6, 0.6, 0.0, 0.0, "lipschitz is 0");
  refuses_distance(6, 0.6, NAN, 0.0, "lipschitz is nan");
  refuses_distance(6, 0.6, 1.0, -1.0, "error is -1");
  refuses_distance(6, 0.4, 1.0, 0.0, "but the set lies within 0.4");
}

/* It behaves while the body is made, and lies later. */
static double turns(const void *shape, const double x[3]) {
  const double d = fmax(sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) - 0.5, 0.0);
  return *(const int *)shape == 1 ? NAN : *(const int *)shape == 2 ? d * (1.0 + 0.5 * sin(9.0 * x[0])) : d;
}

CASE(callbacks_that_lie_later_are_refused_by_the_query) {
  int lie = 0;
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_distance(turns, &lie, vec(0, 0, 0), 0.5, 1.0, 0.0, ws, &body), CPROX_OK);
  const vec3 p[2] = {vec(-2, 1, 0), vec(2, 1, 0)};
  cprox_curve *curve = bezier(p, 2);
  cprox_result got;
  const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_OK);
  assert_true(got.lower <= 0.5 && 0.5 <= got.upper && got.upper - got.lower <= 1e-6);
  for (lie = 1; lie <= 2; lie++) {
    assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_INVALID);
    const char *words = lie == 1 ? "answered nan" : "says";
    assert_non_null(strstr(cprox_workspace_error(ws), words));
    assert_true(cprox_time_of_contact(cprox_tube_along(curve, 0.6), target, NULL, ws, &got) < 0);
  }
  cprox_curve_free(curve);
  cprox_body_free(body);
}

CASE(what_cannot_be_asked_is_refused_in_one_line) {
  const balls set = {.n = 1, .radius = {0.3}};
  cprox_body *body = balls_body(&set), *sphere = NULL, *other = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &sphere), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  const cprox_pose pose = CPROX_POSE_IDENTITY;
  const vec3 p[2] = {vec(-2, 1, 0), vec(2, 1, 0)};
  cprox_curve *curve = bezier(p, 2);
  cprox_result got;
  assert_int_equal(cprox_pair(target, cprox_obstacle_at(sphere, pose), NULL, ws, &got), CPROX_INVALID);
  assert_int_equal(cprox_body_create_compound((const cprox_body *[]){body}, &pose, 1, ws, &other), CPROX_INVALID);
  assert_int_equal(cprox_body_create_lod(body, 0.0, sphere, ws, &other), CPROX_INVALID);
  assert_int_equal(cprox_distance(cprox_body_along(body, curve), target, NULL, ws, &got), CPROX_INVALID);
  assert_int_equal(cprox_distance(cprox_body_along(sphere, curve), target, NULL, ws, &got), CPROX_INVALID);
  assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_OK);
  cprox_gradient gradient;
  assert_int_equal(cprox_distance_gradient(cprox_tube_along(curve, 0.0), target, NULL, &got, ws, &gradient),
                   CPROX_INVALID);
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_BVH, ws, &all), CPROX_OK);
  assert_int_equal(cprox_obstacles_distance(all, cprox_body_along(sphere, curve), NULL, ws, &got, NULL), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "known by its distance alone"));
  cprox_obstacles_free(all);
  cprox_curve_free(curve);
  cprox_body_free(body);
  cprox_body_free(sphere);
}

/* ---- grids of distances ---- */

enum { GRID = 21 };

static cprox_distance_grid grid_of(const balls *set, rng *r, double error, double truncated_at, double *values) {
  cprox_distance_grid grid = {.n = {GRID, GRID - 4, GRID + 3},
                              .origin = vec(-1.0, -0.9, -1.1),
                              .cell = 0.1,
                              .values = values,
                              .error = error,
                              .truncated_at = truncated_at};
  size_t index = 0;
  for (size_t k = 0; k < grid.n[2]; k++)
    for (size_t j = 0; j < grid.n[1]; j++)
      for (size_t i = 0; i < grid.n[0]; i++, index++) {
        const vec3 x = vec_axpy(grid.origin, grid.cell, vec((double)i, (double)j, (double)k));
        values[index] = (double)balls_exact(set, ref_vec(x)) + error * rng_uniform(r, -1.0, 1.0);
        values[index] = fmin(values[index], truncated_at);
      }
  return grid;
}

/* seed 45, 120 unions of balls in grids with a cell of .1: the truth lies in the interval, which is no wider than the
 * stated error and the interpolation's allow; of values that are truncated, too. */
CASE(grids_of_distances_hold_the_distance) {
  rng r = rng_seed(45);
  double *values = malloc(sizeof *values * GRID * (GRID - 4) * (GRID + 3));
  const size_t cases = test_cases(120);
  double widest = 0.0;
  for (size_t i = 0; i < cases; i++) {
    const balls set = balls_random(&r);
    const bool truncated = i % 3 == 0;
    const double error = i % 2 ? 0.01 : 0.0;
    const cprox_distance_grid grid = grid_of(&set, &r, error, truncated ? 0.3 : INFINITY, values);
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_OK);
    course c = course_random(&r);
    const cprox_pose pose = CPROX_POSE_IDENTITY;
    cprox_result got;
    const cprox_status status =
        cprox_distance(cprox_tube_along(c.curve, 0.0), cprox_obstacle_at(body, pose), NULL, ws, &got);
    const long double least = fmaxl(least_sampled(&set, &c, &pose), 0.0L);
    const long double there = fmaxl(balls_exact(&set, course_at(&c, &pose, got.t)), 0.0L);
    /* not double arithmetic is what keeps the interval wide */
    assert_int_equal(status, got.upper - got.lower <= 1e-6 ? CPROX_OK : CPROX_INEXACT);
    if (status == CPROX_INEXACT) assert_non_null(strstr(cprox_workspace_error(ws), "of their interpolation"));
    assert_true(got.lower <= least + 1e-14L && there <= got.upper + 1e-14L);
    if (!truncated) widest = fmax(widest, got.upper - got.lower);
    for (int k = 0; k < 20; k++) { /* single points, outside the box as well */
      const vec3 x = rng_in_cube(&r, 1.5);
      const double d = cprox_body_nearest(body, x, NULL);
      if (!truncated) assert_true(fabsl(d - balls_exact(&set, ref_vec(x))) <= 2.0 * error + 0.5);
    }
    cprox_curve_free(c.curve);
    cprox_body_free(body);
  }
  assert_true(widest > 0.01 && widest <= 4.0 * (0.01 + 0.0867) + 1e-6);
  free(values);
}

/* seed 49: a curve whose points are all the same, before a grid, whose Lipschitz constant is not known. */
CASE(a_point_at_rest_before_a_grid_has_its_distance) {
  rng r = rng_seed(49);
  double *values = malloc(sizeof *values * GRID * (GRID - 4) * (GRID + 3));
  for (size_t i = 0; i < 40; i++) {
    const balls set = balls_random(&r);
    const cprox_distance_grid grid = grid_of(&set, &r, 0.0, INFINITY, values);
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_OK);
    const vec3 place = rng_in_cube(&r, 1.0), points[3] = {place, place, place};
    cprox_curve *curve = bezier(points, 2 + i % 2);
    const long double distance = fmaxl(balls_exact(&set, ref_vec(place)), 0.0L);
    const cprox_options options = accurate(0.5);
    for (int query = 0; query < 3; query++) {
      const cprox_mover mover = cprox_point_along(curve);
      const cprox_obstacle at = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
      cprox_result got = {.lower = NAN};
      const cprox_status status = query == 0   ? cprox_distance(mover, at, &options, ws, &got)
                                  : query == 1 ? cprox_tolerance(mover, at, 0.1, &options, ws, &got)
                                               : cprox_time_of_contact(mover, at, &options, ws, &got);
      if (query == 0) assert_int_equal(status, CPROX_OK);
      assert_true(status >= CPROX_OK && got.lower <= distance && distance <= got.upper + 0.5);
      if (query == 0) assert_true(got.lower >= distance - 0.5L);
      if (query == 1 && distance > 0.6L) assert_int_equal(got.verdict, CPROX_VERDICT_CLEAR);
      assert_true(got.nodes <= 8);
    }
    cprox_curve_free(curve);
    cprox_body_free(body);
  }
  free(values);
}

CASE(grids_that_hold_no_distances_are_refused) {
  double values[8] = {1, 1, 1, 1, 1, 1, 1, 1};
  cprox_distance_grid grid = {.n = {2, 2, 2}, .cell = 0.1, .values = values, .truncated_at = INFINITY};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_distance_grid(NULL, ws, &body), CPROX_INVALID);
  values[5] = 1.2;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "grid point (1, 0, 1) and its neighbour in x"));
  values[5] = NAN;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "grid point (1, 0, 1) is nan"));
  values[5] = 1;
  grid.n[1] = 1;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  grid.n[1] = SIZE_MAX / 2;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  grid.n[1] = 2, grid.cell = 0.0;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  grid.cell = 0.1, grid.truncated_at = NAN;
  assert_int_equal(cprox_body_create_distance_grid(&grid, ws, &body), CPROX_INVALID);
  assert_null(body);
}

/* ---- height fields ---- */

/* seed 46, 60 random fields: intervals against all triangles by brute force along the curve. */
CASE(height_fields_are_as_far_as_their_triangles) {
  enum { NX = 9, NY = 7 };
  rng r = rng_seed(46);
  const size_t cases = test_cases(60);
  for (size_t i = 0; i < cases; i++) {
    double heights[NX * NY];
    for (int k = 0; k < NX * NY; k++) heights[k] = rng_uniform(&r, -0.2, 0.2);
    const cprox_height_field field = {
        .n = {NX, NY}, .origin = {-0.8, -0.6}, .cell = {0.2, 0.21}, .heights = heights, .floor = i % 2 ? -1.0 : NAN};
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_OK);
    assert_int_equal(cprox_body_get_info(body).is_solid, i % 2);
    course c = course_random(&r);
    for (size_t k = 0; k < c.n; k++) c.points[k].z = 0.25 + fabs(c.points[k].z);
    cprox_curve_free(c.curve);
    c.curve = bezier(c.points, c.n);
    const cprox_pose pose = CPROX_POSE_IDENTITY;
    cprox_result got;
    assert_int_equal(cprox_distance(cprox_tube_along(c.curve, 0.0), cprox_obstacle_at(body, pose), NULL, ws, &got),
                     CPROX_OK);
    long double least = INFINITY, there = INFINITY;
    for (int k = -1; k <= 60; k++) {
      const vec3l x = course_at(&c, &pose, k < 0 ? (long double)got.t : k / 60.0L);
      long double d = INFINITY;
      for (int cell = 0; cell < (NX - 1) * (NY - 1); cell++) {
        vec3l v[4];
        for (int corner = 0; corner < 4; corner++) {
          const int col = cell % (NX - 1) + corner % 2, row = cell / (NX - 1) + corner / 2;
          v[corner] = ref_vec(vec(-0.8 + 0.2 * col, -0.6 + 0.21 * row, heights[row * NX + col]));
        }
        d = fminl(d, fminl(ref_point_triangle(x, v[0], v[1], v[3]), ref_point_triangle(x, v[0], v[3], v[2])));
      }
      if (k < 0) there = d;
      least = fminl(least, d);
    }
    /* a wall may be nearer than the surface, never by more than the surface's own rim allows: above the heights not */
    assert_true(got.lower <= least + 1e-12L && there <= got.upper + 1e-12L);
    cprox_curve_free(c.curve);
    cprox_body_free(body);
  }
}

CASE(ground_is_solid_down_to_its_floor) {
  const double heights[6] = {0, 0, 0, 0.1, 0.1, 0.1};
  cprox_height_field field = {.n = {3, 2}, .cell = {1, 1}, .heights = heights, .floor = -2.0};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_OK);
  assert_true(cprox_body_nearest(body, vec(1.0, 0.5, -1.0), NULL) < 0.0);
  assert_true(fabs(cprox_body_nearest(body, vec(1.0, 0.5, -2.5), NULL) - 0.5) < 1e-12);
  assert_true(fabs(cprox_body_nearest(body, vec(2.25, 0.5, -1.0), NULL) - 0.25) < 1e-12);
  cprox_body_free(body);
  body = NULL;
  field.floor = 0.0;
  assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_INVALID);
  field.floor = NAN;
  field.n[0] = 1;
  assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_INVALID);
  field.n[0] = 3, field.cell[1] = -1.0;
  assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_INVALID);
  const double hole[6] = {0, 0, 0, 0, NAN, 0};
  field.cell[1] = 1.0, field.heights = hole;
  assert_int_equal(cprox_body_create_height_field(&field, SIZE_MAX, ws, &body), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the height at (1, 1) is nan, must be finite");
  assert_null(body);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
