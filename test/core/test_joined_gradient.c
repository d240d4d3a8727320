/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients between two robots on one clock, by the points, the start and the duration of either motion, against
 * central differences of the certified distance. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robots.h"

enum { ROBOTS = 2, MOST_ROWS = ROBOTS * TEST_WAYPOINTS * TEST_MAX_VARIABLES };

/* Of 1 + |derivative|: what a derivative may differ from a difference. */
static const double TOLERANCE = 1e-6;

typedef struct two_robots {
  test_robot robot[ROBOTS];
  cprox_pose base[ROBOTS];
  double start[ROBOTS];
  cprox_robot_pair pairs[TEST_MAX_LINKS * TEST_MAX_LINKS];
  size_t n_pairs;
} two_robots;

typedef struct answer {
  cprox_result result;
  cprox_motion_gradient gradient;
  double rows[3][MOST_ROWS], starts[ROBOTS], durations[ROBOTS];
} answer;

/* One direction in the space of all parameters. */
typedef struct step {
  double rows[3][ROBOTS][TEST_WAYPOINTS][TEST_MAX_VARIABLES];
  double starts[ROBOTS], durations[ROBOTS];
} step;

static double begin_of(const test_robot *t) {
  return t->times[t->spline ? TEST_SPLINE_DEGREE : 0];
}

static double end_of(const test_robot *t) {
  return t->times[t->spline ? t->n_points : t->n_points - 1];
}

static void make(rng *r, two_robots *p) {
  for (int i = 0; i < ROBOTS; i++) {
    test_robot *t = &p->robot[i];
    const double speed = rng_log_uniform(r, 0.1, 1.5);
    if (i == 1 && rng_index(r, 3) == 0)
      robot_make_turning(r, speed, (cprox_turning)rng_index(r, 3), 2 + rng_index(r, TEST_WAYPOINTS - 1), t);
    else
      robot_make(r, speed, t);
    p->base[i] = rng_pose(r, 1.0);
    p->start[i] = rng_uniform(r, -0.2, 0.2) - begin_of(t);
  }
  p->n_pairs = 0;
  for (size_t a = 0; a < p->robot[0].n_links; a++)
    for (size_t b = 0; b < p->robot[1].n_links; b++)
      p->pairs[p->n_pairs++] = (cprox_robot_pair){(int32_t)a, (int32_t)(p->robot[0].n_links + b)};
}

/* The middle of the distance's interval, as narrow as arithmetic allows; with an answer its gradient. */
static double ask(const two_robots *p, answer *a, double *width) {
  const cprox_robot *robots[ROBOTS] = {p->robot[0].robot, p->robot[1].robot};
  cprox_joined_motion parts[ROBOTS];
  for (int i = 0; i < ROBOTS; i++) parts[i] = (cprox_joined_motion){.motion = p->robot[i].motion, .start = p->start[i]};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = parts, .n_joined = ROBOTS};
  cprox_robot *joined = NULL;
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_robot_join(robots, p->base, ROBOTS, ws, &joined), CPROX_OK);
  if (cprox_motion_create(joined, &d, ws, &motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  const cprox_mover mover = cprox_robot_self(motion, p->pairs, p->n_pairs);
  const cprox_options options = accurate(1e-13);
  cprox_result r;
  cprox_status status;
  if (a) {
    a->gradient = (cprox_motion_gradient){.positions = a->rows[0],
                                          .velocities = a->rows[1],
                                          .accelerations = a->rows[2],
                                          .starts = a->starts,
                                          .durations = a->durations};
    status = cprox_robot_distance_gradient(NULL, mover, NULL, ws, &a->result, &a->gradient);
    r = a->result;
  } else {
    status = cprox_obstacles_distance(NULL, mover, &options, ws, &r, NULL);
  }
  if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
  cprox_motion_free(motion);
  cprox_robot_free(joined);
  if (width) *width = r.upper - r.lower;
  return 0.5 * (r.lower + r.upper);
}

static bool has_rows(const test_robot *t) {
  return t->turning == CPROX_TURNING_POLYNOMIAL;
}

static step random_step(rng *r, const two_robots *p) {
  step d = {0};
  for (int i = 0; i < ROBOTS; i++) {
    for (int order = 0; order < 3; order++)
      for (size_t k = 0; k < p->robot[i].n_points; k++)
        for (size_t v = 0; v < p->robot[i].n_variables && has_rows(&p->robot[i]); v++)
          d.rows[order][i][k][v] = rng_uniform(r, -1, 1);
    d.starts[i] = rng_uniform(r, -1, 1), d.durations[i] = rng_uniform(r, -1, 1);
  }
  return d;
}

/* Of the robots, those rows one after the other. */
static double derivative(const two_robots *p, const answer *a, const step *d) {
  double sum = 0.0;
  for (int order = 0; order < 3; order++) {
    const double *row = a->rows[order];
    for (int i = 0; i < ROBOTS; i++)
      for (size_t k = 0; k < p->robot[i].n_points && has_rows(&p->robot[i]); k++)
        for (size_t v = 0; v < p->robot[i].n_variables; v++) sum += *row++ * d->rows[order][i][k][v];
  }
  for (int i = 0; i < ROBOTS; i++) sum += a->starts[i] * d->starts[i] + a->durations[i] * d->durations[i];
  return sum;
}

/* The distance h along the step. */
static double ask_along(const two_robots *p, const step *d, double h, double *width) {
  two_robots *moved = malloc(sizeof *moved);
  assert_non_null(moved);
  *moved = *p;
  for (int i = 0; i < ROBOTS; i++) {
    test_robot *t = &moved->robot[i];
    double(*const rows[3])[TEST_MAX_VARIABLES] = {t->positions, t->velocities, t->accelerations};
    for (int order = 0; order < 3; order++)
      for (size_t k = 0; k < t->n_points; k++)
        for (size_t v = 0; v < t->n_variables; v++) rows[order][k][v] += h * d->rows[order][i][k][v];
    const double begin = begin_of(t), grown = 1.0 + h * d->durations[i] / (end_of(t) - begin);
    for (size_t k = 0; k < t->n_points + TEST_SPLINE_DEGREE + 1; k++)
      t->times[k] = begin + grown * (t->times[k] - begin);
    moved->start[i] += h * d->starts[i];
    t->robot = NULL, t->motion = NULL;
    robot_rebuild(t);
  }
  const double distance = ask(moved, NULL, width);
  for (int i = 0; i < ROBOTS; i++) {
    cprox_motion_free(moved->robot[i].motion);
    cprox_robot_free(moved->robot[i].robot);
  }
  free(moved);
  return distance;
}

/* How far the derivative is from the nearest of four extrapolated central differences, and from one-sided ones. */
static void compare(const two_robots *p, const step *d, double expected, double *off, double *one_sided) {
  static const double WIDTHS[] = {1e-4, 1e-5, 1e-6, 1e-3};
  double width = 0.0;
  const double here = ask(p, NULL, &width);
  *off = *one_sided = INFINITY;
  for (int k = 0; k < 4 && *off > 0.1 * TOLERANCE; k++) {
    double slope[2];
    for (int m = 0; m < 2; m++) {
      const double h = WIDTHS[k] / (m + 1), ahead = ask_along(p, d, h, &width), behind = ask_along(p, d, -h, &width);
      slope[m] = (ahead - behind) / (2.0 * h);
      *one_sided = fmin(fmin(fabs((ahead - here) / h - expected), fabs((here - behind) / h - expected)), *one_sided);
    }
    const double noise = 1.5 * width / WIDTHS[k];
    if (noise > 3.0 * TOLERANCE) continue;
    *off =
        fmin(*off,
             fmax(fmin(fabs((4.0 * slope[1] - slope[0]) / 3.0 - expected), fabs(2.0 * slope[1] - slope[0] - expected)) -
                      noise,
                  0.0));
  }
}

/* 60 pairs of robots (seed 8201) on waypoints, splines, slerp and screws, with starts of their own: within 1e-6
 * (1 + |derivative|). Beside a tie that is nearer than the differences reach it is that of one side: 2 % at most. */
CASE(gradients_between_two_motions_are_the_limits_of_differences) {
  rng r = rng_seed(8201);
  size_t valid = 0, asked = 0, beside = 0, kinks = 0;
  double worst = 0.0;
  two_robots *p = malloc(sizeof *p);
  answer *a = malloc(sizeof *a);
  assert_true(p && a);
  for (size_t i = 0; i < test_cases(60); i++) {
    make(&r, p);
    const double distance = ask(p, a, NULL);
    const step d = random_step(&r, p);
    asked += distance > 0.01;
    if (distance > 0.01 && a->gradient.valid) {
      valid++;
      const bool kink = isnan(a->starts[0] + a->starts[1]);
      kinks += kink;
      const double expected = kink ? 0.0 : derivative(p, a, &d);
      double off = 0.0, one_sided = 0.0;
      if (!kink) compare(p, &d, expected, &off, &one_sided);
      const double allowed = TOLERANCE * (1.0 + fabs(expected));
      if (off <= allowed)
        worst = fmax(worst, off / (1.0 + fabs(expected)));
      else if (one_sided < 1e-4 * (1.0 + fabs(expected)))
        beside++;
      else
        fail_msg("pair %zu, t %.17g, distance %.12g: %.12g, differences are off by %g", i, a->gradient.t, distance,
                 expected, off);
    }
    for (int k = 0; k < ROBOTS; k++) robot_free(&p->robot[k]);
  }
  free(p);
  free(a);
  print_message("%zu of %zu have a gradient, off by %g at most; %zu stand beside a tie, %zu at a kink of both\n", valid,
                asked, worst, beside, kinks);
  assert_true(10 * valid >= 9 * asked && 50 * (beside + kinks) <= valid + 50);
}

/* A ball goes along x past another one that comes down and stops at the height of .5 before the first has passed: the
 * distance is least where it has stopped. Later starts of the second one move that place. */
CASE(a_kink_goes_with_the_motion_that_has_it) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {1, 0, 0}, .multiplier = 1.0};
  const cprox_link_geometry on = {.body = ball, .pose = CPROX_POSE_IDENTITY};
  cprox_robot *one = NULL, *joined = NULL;
  assert_int_equal(cprox_robot_create(&link, 1, &on, 1, 1, ws, &one), CPROX_OK);
  /* the second one's x is the height: turned by a quarter about y, down to up */
  const double s = sqrt(0.5);
  const cprox_pose bases[2] = {CPROX_POSE_IDENTITY, {.orientation = {s, 0, -s, 0}}};
  const cprox_robot *robots[2] = {one, one};
  assert_int_equal(cprox_robot_join(robots, bases, 2, ws, &joined), CPROX_OK);
  const int32_t variable = 0;
  const double along[2] = {0.2, 4.2}, down[2] = {1.5, 0.5};
  cprox_motion *motions[2] = {NULL, NULL}, *both = NULL;
  for (int i = 0; i < 2; i++) {
    const double *values = i ? down : along;
    const cprox_waypoint points[2] = {{.time = 0.0, .positions = &values[0]},
                                      {.time = i ? 0.1 : 4.0, .positions = &values[1]}};
    const cprox_motion_description d = {
        .variables = &variable, .n_variables = 1, .waypoints = points, .n_waypoints = 2};
    assert_int_equal(cprox_motion_create(one, &d, ws, &motions[i]), CPROX_OK);
  }
  const cprox_joined_motion parts[2] = {{.motion = motions[0]}, {.motion = motions[1], .start = 0.2}};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = parts, .n_joined = 2};
  assert_int_equal(cprox_motion_create(joined, &d, ws, &both), CPROX_OK);
  double positions[4], starts[2], durations[2];
  cprox_motion_gradient g = {.positions = positions, .starts = starts, .durations = durations};
  cprox_result r;
  const cprox_robot_pair pair = {0, 1};
  assert_int_equal(cprox_robot_distance_gradient(NULL, cprox_robot_self(both, &pair, 1), NULL, ws, &r, &g), CPROX_OK);
  assert_true(g.valid);
  /* at .3 s the first one is at .5 and moves at 1 m/s; the way is (.5, 0, -.5) */
  assert_true(fabs(g.t - 0.3) < 1e-9 && fabs(r.upper - (sqrt(0.5) - 0.2)) < 1e-6);
  const double n = sqrt(0.5);
  assert_true(fabs(starts[1] - n) < 1e-9 && fabs(starts[0] + n) < 1e-9 && fabs(durations[1] - n) < 1e-9);
  assert_true(fabs(durations[0] + n * 0.3 / 4.0) < 1e-9);
  assert_true(fabs(positions[0] - n * (1.0 - 0.3 / 4.0)) < 1e-9 && fabs(positions[1] - n * 0.3 / 4.0) < 1e-9);
  assert_true(positions[2] == 0.0 && fabs(positions[3] - n) < 1e-9);
  cprox_motion_free(both);
  for (int i = 0; i < 2; i++) cprox_motion_free(motions[i]);
  cprox_robot_free(joined);
  cprox_robot_free(one);
  cprox_body_free(ball);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
