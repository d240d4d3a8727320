/* SPDX-License-Identifier: BSD-3-Clause */
/* How much bounds of errors give away on real robots: certified scales beside the smallest ones at which a sampled
 * execution touches, and what a robust verdict costs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robot_case.h"
#include "support/robots.h"

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *values, size_t n) {
  qsort(values, n, sizeof *values, ascending);
  return values[n / 2];
}

enum { MOST_CASES = 64, MOST_TIMES = 20, TARGETS = 3 };

/* Pairs that are farther apart than this are not sampled. */
static const double FAR = 0.15;

typedef struct real_case {
  robot_case c;
  double tracking[CASE_MAX_VARIABLES], speed[CASE_MAX_VARIABLES];
  cprox_error_bounds bounds;
  cprox_obstacles *obstacles;
} real_case;

static FILE *open_cases(size_t *n) {
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  assert_int_equal(fscanf(f, "%zu", n), 1);
  return f;
}

static void read_case(FILE *f, real_case *to) {
  assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &to->c));
  for (size_t i = 0; i < to->c.n_variables; i++) to->tracking[i] = 2e-3, to->speed[i] = 5e-3;
  to->bounds = (cprox_error_bounds){.tracking = to->tracking, .speed = to->speed, .n_variables = to->c.n_variables};
  assert_int_equal(cprox_obstacles_create(to->c.targets, to->c.n_targets, CPROX_INDEX_BVH, ws, &to->obstacles),
                   CPROX_OK);
}

static void free_case(real_case *r) {
  cprox_obstacles_free(r->obstacles);
  robot_case_free(&r->c);
}

/* How far a pair is apart when the variables are off by `scale` times the bounds at a time, each to its own side. */
static double deviated_distance(const real_case *r, const cprox_robot_pair *pair, double t, const double *sign,
                                double scale) {
  double here[CASE_MAX_VARIABLES], before[CASE_MAX_VARIABLES], after[CASE_MAX_VARIABLES];
  const cprox_motion_info info = cprox_motion_get_info(r->c.motion);
  const double h = 1e-6 * (info.t1 - info.t0), from = fmax(t - h, info.t0), to = fmin(t + h, info.t1);
  cprox_motion_evaluate(r->c.motion, t, here);
  cprox_motion_evaluate(r->c.motion, from, before);
  cprox_motion_evaluate(r->c.motion, to, after);
  for (size_t v = 0; v < r->c.n_variables; v++)
    here[v] += sign[v] * scale * (r->tracking[v] + r->speed[v] * fabs(after[v] - before[v]) / (to - from));
  const cprox_state_query asked = {
      .obstacles = r->obstacles, .pairs = pair, .n_pairs = 1, .without_self = true, .distance = true};
  cprox_result at;
  assert_true(cprox_robot_ask_states(r->c.robot, &asked, here, 1, ws, &at, NULL) >= 0);
  return at.upper;
}

/* The least scale at which an execution was found that touches at this time: the joints' sides are chosen one by one,
 * each so that the distance becomes less. */
static double touching_scale(const real_case *r, const cprox_robot_pair *pair, double t, double near) {
  double sign[CASE_MAX_VARIABLES];
  for (size_t v = 0; v < r->c.n_variables; v++) sign[v] = 0.0;
  if (deviated_distance(r, pair, t, sign, 0.0) > FAR) return INFINITY;
  for (int round = 0; round < 2; round++)
    for (size_t v = 0; v < r->c.n_variables; v++) {
      double distance[2];
      for (int k = 0; k < 2; k++)
        sign[v] = k ? 1.0 : -1.0, distance[k] = deviated_distance(r, pair, t, sign, 0.7 * near);
      sign[v] = distance[0] < distance[1] ? -1.0 : 1.0;
    }
  double low = 0.0, high = 4.0 * near;
  if (deviated_distance(r, pair, t, sign, high) > 0.0) return INFINITY;
  for (int k = 0; k < 20; k++) {
    const double middle = 0.5 * (low + high);
    *(deviated_distance(r, pair, t, sign, middle) > 0.0 ? &low : &high) = middle;
  }
  return high;
}

static double touching_scale_of_all(const real_case *r, double t, double near) {
  double least = INFINITY;
  for (size_t i = 0; i < r->c.n_geometries * r->c.n_targets; i++) {
    const cprox_robot_pair pair = {(int32_t)(i / r->c.n_targets), (int32_t)(i % r->c.n_targets)};
    least = fmin(least, touching_scale(r, &pair, t, near));
  }
  return least;
}

/* Certified over sampled scale; 0 where the motion itself is not clear. Asserts that the one is not above the other. */
static double certified_over_sampled(const real_case *r, int *most_verdicts) {
  cprox_robust_scale s;
  const cprox_mover mover = cprox_robot_along(r->c.motion, NULL, 0);
  assert_true(cprox_robust_find_scale(r->obstacles, mover, 0.0, &r->bounds, NULL, ws, &s) >= 0);
  if (s.verdict != CPROX_VERDICT_CLEAR) return 0.0;
  assert_true(s.certified > 0.0 && s.certified <= s.refused);
  const cprox_motion_info info = cprox_motion_get_info(r->c.motion);
  /* at times all over the motion, then on both sides of the best one */
  double best = s.limit.t, least = touching_scale_of_all(r, best, s.certified), step = (info.t1 - info.t0) / MOST_TIMES;
  for (int k = 0; k < MOST_TIMES; k++) {
    const double t = info.t0 + (k + 0.5) * step, at = touching_scale_of_all(r, t, s.certified);
    if (at < least) least = at, best = t;
  }
  for (int k = 0; k < 12; k++) {
    const double t = fmin(fmax(best + (k % 2 ? -step : step), info.t0), info.t1);
    const double at = touching_scale_of_all(r, t, s.certified);
    if (at < least) least = at, best = t;
    if (k % 2) step *= 0.5;
  }
  if (s.certified > least) fail_msg("%s: certified %.6g, touches at %.6g", r->c.name, s.certified, least);
  *most_verdicts = s.n_verdicts > *most_verdicts ? s.n_verdicts : *most_verdicts;
  return s.certified / least;
}

static void expect_ratios(const char *what, double *ratio, size_t n, int verdicts) {
  const double middle = median(ratio, n);
  print_message("%s: certified over sampled scale %.3f in the median of %zu, %.3f at least; %d verdicts at most\n",
                what, middle, n, ratio[0], verdicts);
  assert_true(verdicts <= 8 && (n < 10 || middle >= 0.7)); /* of fewer the median says little */
}

CASE(the_certified_scale_is_near_the_sampled_one) {
  size_t n, counted = 0;
  int verdicts = 0;
  FILE *f = open_cases(&n);
  double ratio[MOST_CASES];
  for (size_t i = 0; i < n; i++) {
    real_case r;
    read_case(f, &r);
    ratio[counted] = certified_over_sampled(&r, &verdicts);
    counted += ratio[counted] > 0.0;
    free_case(&r);
  }
  fclose(f);
  assert_true(counted > 10);
  expect_ratios("saved motions", ratio, counted, verdicts);
}

/* A motion through three random states among three boxes that it passes at 2 to 30 mm, where errors of milliradians matter.
 * False: it does not. */
static bool draw_real_case(rng *r, const cprox_body *box, real_case *to) {
  enum { POINTS = 3 };
  robot_case *c = &to->c;
  double values[POINTS][CASE_MAX_VARIABLES];
  cprox_waypoint points[POINTS];
  int32_t variables[CASE_MAX_VARIABLES];
  for (size_t i = 0; i < POINTS; i++) {
    for (size_t v = 0; v < c->n_variables; v++) {
      variables[v] = (int32_t)v;
      values[i][v] = i == 0 ? rng_uniform(r, -1.5, 1.5) : values[i - 1][v] + rng_uniform(r, -0.6, 0.6);
    }
    points[i] = (cprox_waypoint){.time = (double)i, .positions = values[i]};
  }
  const cprox_motion_description through = {.kind = CPROX_MOTION_WAYPOINTS,
                                            .variables = variables,
                                            .n_variables = c->n_variables,
                                            .waypoints = points,
                                            .n_waypoints = POINTS};
  cprox_motion_free(c->motion);
  assert_int_equal(cprox_motion_create(c->robot, &through, ws, &c->motion), CPROX_OK);
  for (size_t i = 0; i < TARGETS; i++)
    c->targets[i] = cprox_obstacle_at(box, (cprox_pose){.position = rng_in_cube(r, 0.9), .orientation = rng_quat(r)});
  cprox_obstacles_free(to->obstacles);
  assert_int_equal(cprox_obstacles_create(c->targets, TARGETS, CPROX_INDEX_BVH, ws, &to->obstacles), CPROX_OK);
  cprox_result d;
  assert_true(cprox_obstacles_distance(to->obstacles, cprox_robot_along(c->motion, NULL, 0), NULL, ws, &d, NULL) >= 0);
  return d.lower > 0.002 && d.lower < 0.03;
}

CASE(the_certified_scale_of_random_motions_is_near_the_sampled_one) {
  static const char *const ROBOTS[] = {"panda", "ur5"};
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.2, 0.15, 0.1}, ws, &box), CPROX_OK);
  for (int robot = 0; robot < 2; robot++) {
    rng r = rng_seed(4603 + (uint64_t)robot);
    real_case one = {.obstacles = NULL};
    size_t counted = 0;
    int verdicts = 0;
    const size_t wanted = test_cases(10);
    double *ratio = calloc(wanted, sizeof *ratio);
    assert_non_null(ratio);
    assert_true(robot_case_read_robot(TEST_DATA_DIR "/motion", ROBOTS[robot], &one.c));
    for (size_t v = 0; v < one.c.n_variables; v++) one.tracking[v] = 2e-3, one.speed[v] = 5e-3;
    one.bounds = (cprox_error_bounds){.tracking = one.tracking, .speed = one.speed, .n_variables = one.c.n_variables};
    one.c.n_targets = TARGETS;
    while (counted < wanted) {
      if (!draw_real_case(&r, box, &one)) continue;
      ratio[counted] = certified_over_sampled(&one, &verdicts);
      counted += ratio[counted] > 0.0;
    }
    expect_ratios(ROBOTS[robot], ratio, counted, verdicts);
    free(ratio);
    cprox_obstacles_free(one.obstacles);
    one.c.n_targets = 0;
    robot_case_free(&one.c);
  }
  cprox_body_free(box);
}

/* Nodes and distance queries of robust verdicts beside those of plain ones, in the median. */
static double cost_of_errors(double tracking, double *ratio, size_t *counted) {
  size_t n;
  FILE *f = open_cases(&n);
  *counted = 0;
  for (size_t i = 0; i < n; i++) {
    real_case r;
    read_case(f, &r);
    const cprox_mover mover = cprox_robot_along(r.c.motion, NULL, 0);
    for (size_t v = 0; v < r.c.n_variables; v++) r.tracking[v] = tracking;
    const cprox_error_bounds bounds = {.tracking = r.tracking, .n_variables = r.c.n_variables};
    cprox_result d, plain, at;
    assert_true(cprox_robust_distance(r.obstacles, mover, &bounds, NULL, ws, &d) >= 0);
    if (d.lower > 0.0) {
      assert_true(cprox_robust_tolerance(r.obstacles, mover, 0.5 * d.lower, &bounds, NULL, ws, &at) >= 0);
      assert_true(cprox_obstacles_tolerance(r.obstacles, mover, 0.5 * d.lower, NULL, ws, &plain, NULL) >= 0);
      assert_int_equal(at.verdict, CPROX_VERDICT_CLEAR);
      ratio[(*counted)++] = ((double)at.nodes + at.distance_queries) / ((double)plain.nodes + plain.distance_queries);
    }
    free_case(&r);
  }
  fclose(f);
  return median(ratio, *counted);
}

/* Lanes prove a verdict with errors where they prove it without: then neither asks the search for intervals. */
CASE(half_of_the_certified_distance_takes_a_plain_verdict_and_no_more) {
  static const double TRACKING[] = {5e-4, 2e-3};
  for (int i = 0; i < 2; i++) {
    double ratio[MOST_CASES];
    size_t counted;
    const double middle = cost_of_errors(TRACKING[i], ratio, &counted);
    print_message("%zu verdicts, joints off by %g rad: nodes and distance queries %.2f times those of plain ones\n",
                  counted, TRACKING[i], middle);
    assert_true(counted > 10 && middle <= 1.5);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
