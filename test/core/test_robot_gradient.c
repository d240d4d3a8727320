/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients of a robot's clearance against central differences of the certified distance; what they cost; and where
 * none is to be had. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/gradient_case.h"
#include "support/robot_case.h"
#include "support/robots.h"

/* ---- differences ---- */

/* 80 problems: 1e-6 (1 + |derivative|). Where there is no gradient, the slopes to either side differ by 1e-4 of one, or
 * it counts as missing: at most most_missing percent. attack_gradients asks about 100,000. */
static void hold_against_differences(uint64_t seed, bool is_signed, size_t most_missing) {
  rng r = rng_seed(seed);
  size_t count[GRADIENT_WRONG + 1] = {0}, asked = 0;
  double worst = 0.0;
  for (size_t i = 0; i < test_cases(80); i++) {
    gradient_case p;
    gradient_judgement j;
    gradient_case_make(&r, is_signed, &p);
    const gradient_verdict verdict = gradient_case_judge(&r, &p, &j);
    count[verdict]++;
    worst = fmax(verdict == GRADIENT_FITS ? j.off : 0.0, worst);
    if (verdict == GRADIENT_WRONG)
      fail_msg("problem %zu, kind %d, t %.17g, distance %.12g: %.12g, differences are off by %g", i, (int)p.kind,
               j.answer.gradient.t, j.answer.result.upper, j.expected, j.fit.off);
    if (verdict == GRADIENT_MISSING && getenv("CPROX_TEST_SCALE")) print_message("%zu: %s\n", i, j.why);
    gradient_case_free(&p);
  }
  for (int k = GRADIENT_FITS; k <= GRADIENT_WRONG; k++) asked += count[k];
  print_message(
      "%zu have a gradient, off by %g at most; %zu stand beside a tie, %zu are tied, %zu have none for another "
      "reason, of %zu differences do not tell\n",
      count[GRADIENT_FITS], worst, count[GRADIENT_BESIDE_TIE], count[GRADIENT_TIED], count[GRADIENT_MISSING],
      count[GRADIENT_UNKNOWN]);
  assert_true(100 * count[GRADIENT_MISSING] <= most_missing * asked + 100);
  assert_true(100 * count[GRADIENT_UNKNOWN] <= asked + 100);
}

CASE(gradients_are_the_limits_of_differences) {
  hold_against_differences(4701, false, 1);
}

/* The same of the deepest overlap, for all problems that overlap by 0.01: often two ways out cross there. */
CASE(gradients_of_depths_are_the_limits_of_differences) {
  hold_against_differences(4711, true, 2);
}

/* ---- rows ---- */

enum { MOST_ROWS = 300, MOST_PAIRS = TEST_MAX_LINKS * TEST_MAX_LINKS };

typedef struct rows_answer {
  cprox_motion_row rows[MOST_ROWS];
  double positions[MOST_ROWS][TEST_WAYPOINTS * TEST_MAX_VARIABLES];
  size_t count;
} rows_answer;

static const cprox_motion_row *row_of(const rows_answer *a, const cprox_robot_pair *pair, size_t interval) {
  for (size_t i = 0; i < a->count; i++)
    if (a->rows[i].result.mover_part == pair->geometry && a->rows[i].result.obstacle_index == pair->other &&
        a->rows[i].interval == interval)
      return &a->rows[i];
  return NULL;
}

/* Whether a pair that comes as near as `upper` on an interval may have no row for it. */
static bool may_miss(const rows_answer *a, const cprox_robot_pair *pair, size_t interval, double upper, double horizon,
                     size_t per_pair) {
  if (upper >= horizon) return true;
  size_t nearer = 0;
  for (size_t i = 0; i < a->count; i++)
    nearer += a->rows[i].result.mover_part == pair->geometry && a->rows[i].result.obstacle_index == pair->other &&
              a->rows[i].result.lower <= upper;
  if (nearer >= per_pair) return true;
  /* nearest at a break: the row of another interval stands for it */
  for (int side = -1; side <= 1; side += 2)
    for (size_t k = interval + (size_t)side; k < MOST_ROWS; k += (size_t)side) {
      const cprox_motion_row *row = row_of(a, pair, k);
      if (row && row->result.lower <= upper) return true;
    }
  return false;
}

/* Seed 4704, 40 problems: rows against the profile of each pair alone, and one row's gradient against differences of
 * it. */
CASE(rows_say_what_each_pair_does_on_each_interval) {
  rng r = rng_seed(4704);
  rows_answer *a = calloc(1, sizeof *a);
  assert_non_null(a);
  size_t found = 0, missing = 0, compared = 0;
  for (size_t i = 0; i < test_cases(40); i++) {
    gradient_case p;
    gradient_case_make(&r, false, &p);
    if (p.kind == CPROX_MOVER_ROBOT_WHOLE) p.kind = CPROX_MOVER_ROBOT;
    const test_robot *t = &p.robot;
    const bool self = p.kind == CPROX_MOVER_ROBOT_SELF, by_points = t->turning == CPROX_TURNING_POLYNOMIAL;
    cprox_mover mover = self ? cprox_robot_self(t->motion, NULL, 0) : cprox_robot_along(t->motion, NULL, 0);
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(p.targets, self ? 0 : GRADIENT_TARGETS, CPROX_INDEX_NONE, ws, &all),
                     CPROX_OK);

    /* the rows, on equal intervals */
    const cprox_motion_info info = cprox_motion_get_info(t->motion);
    const size_t n = 1 + rng_index(&r, 6);
    double breaks[8];
    for (size_t k = 0; k <= n; k++)
      breaks[k] = k == n ? info.t1 : info.t0 + (info.t1 - info.t0) * (double)k / (double)n;
    const cprox_rows_query asked = {
        .breaks = breaks, .n_intervals = n, .horizon = 0.5, .per_pair = 1 + rng_index(&r, 3)};
    for (size_t k = 0; k < MOST_ROWS; k++)
      a->rows[k] = (cprox_motion_row){.gradient = {.positions = by_points ? a->positions[k] : NULL}};
    const cprox_status status = cprox_robot_rows(all, mover, &asked, NULL, ws, a->rows, MOST_ROWS, &a->count);
    if (status != CPROX_OK) fail_msg("%zu: %s", i, cprox_workspace_error(ws));

    /* every pair on every interval */
    cprox_result pairs[MOST_PAIRS * GRADIENT_TARGETS];
    cprox_listed listed;
    assert_true(cprox_obstacles_nearest_pairs(all, mover, MOST_PAIRS, INFINITY, NULL, ws, pairs, &listed) >= 0);
    const size_t n_pairs = listed.count;
    for (size_t k = 0; k < n_pairs; k++) {
      const cprox_robot_pair pair = {pairs[k].mover_part, pairs[k].obstacle_index};
      cprox_profile_interval profile[8];
      mover.pairs = &pair, mover.n_pairs = 1;
      assert_true(cprox_obstacles_profile(all, mover, breaks, n, INFINITY, NULL, ws, profile) >= 0);
      for (size_t j = 0; j < n; j++) {
        const cprox_motion_row *row = row_of(a, &pair, j);
        if (!row) {
          missing++;
          assert_true(may_miss(a, &pair, j, profile[j].upper, asked.horizon, asked.per_pair));
          continue;
        }
        found++;
        assert_true(row->result.lower <= profile[j].upper && profile[j].lower <= row->result.upper);
        assert_true(row->result.upper - row->result.lower <= 1e-6 && row->result.lower <= asked.horizon);
        assert_true(row->result.t >= breaks[j] && row->result.t <= breaks[j + 1]);
      }
    }

    /* one gradient */
    if (a->count > 0 && a->rows[0].gradient.valid && a->rows[0].result.upper > 0.01 && by_points) {
      const cprox_motion_row *row = &a->rows[rng_index(&r, 1)];
      const cprox_robot_pair pair = {row->result.mover_part, row->result.obstacle_index};
      p.pair = &pair, p.breaks[0] = breaks[row->interval], p.breaks[1] = breaks[row->interval + 1];
      gradient_step d = gradient_step_random(&r, &p);
      memset(d.rows[1], 0, sizeof d.rows[1]), memset(d.rows[2], 0, sizeof d.rows[2]);
      d.stretch = d.margin = 0.0, d.base = d.base_turn = d.position = d.turn = vec(0, 0, 0);
      double expected = 0.0;
      for (size_t k = 0; k < t->n_points; k++)
        for (size_t v = 0; v < t->n_variables; v++)
          expected += row->gradient.positions[k * t->n_variables + v] * d.rows[0][k][v];
      gradient_answer of_row = {.result = row->result, .gradient = row->gradient};
      const gradient_fit fit = gradient_compare(&p, &of_row, &d, expected);
      compared++;
      if (!(fit.off <= GRADIENT_TOLERANCE * (1.0 + fabs(expected))) && !(fit.kink > 1e-4 && fit.one_sided < 1e-5))
        fail_msg("problem %zu: %.12g, differences are off by %g", i, expected, fit.off);
    }
    cprox_obstacles_free(all);
    gradient_case_free(&p);
  }
  free(a);
  print_message("%zu rows, %zu left out, %zu gradients compared\n", found, missing, compared);
  assert_true(found > 0 && missing > 0 && compared > 0);
}

/* ---- where there is none ---- */

/* A ball of 0.1, or a box, on two prismatic joints along x and y, from one waypoint to the next. */
typedef struct slider {
  cprox_body *body;
  cprox_robot *robot;
  cprox_motion *motion;
} slider;

static void slider_make(slider *s, vec3 size, const double (*rows)[2], size_t n) {
  static const int32_t VARIABLES[2] = {0, 1};
  cprox_waypoint points[4] = {{0}};
  for (size_t i = 0; i < n; i++) points[i] = (cprox_waypoint){.time = (double)i, .positions = rows[i]};
  const cprox_status made =
      vec_norm2(size) > 0.0 ? cprox_body_create_box(size, ws, &s->body) : cprox_body_create_sphere(0.1, ws, &s->body);
  assert_int_equal(made, CPROX_OK);
  cprox_link links[2] = {
      {.parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {1, 0, 0}},
      {.type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {0, 1, 0}}};
  links[0].multiplier = links[1].multiplier = 1.0, links[1].variable = 1;
  const cprox_link_geometry on = {.body = s->body, .pose = CPROX_POSE_IDENTITY, .link = 1};
  assert_int_equal(cprox_robot_create(links, 2, &on, 1, 2, ws, &s->robot), CPROX_OK);
  const cprox_motion_description d = {.variables = VARIABLES, .n_variables = 2, .waypoints = points, .n_waypoints = n};
  assert_int_equal(cprox_motion_create(s->robot, &d, ws, &s->motion), CPROX_OK);
}

static void slider_free(slider *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  cprox_body_free(s->body);
}

/* A box along the waypoints past the obstacles, or a ball where it has no size. */
static cprox_motion_gradient slide(vec3 size, const double (*rows)[2], size_t n, const cprox_obstacle *targets,
                                   size_t n_targets, double *positions, const char *why) {
  slider s;
  slider_make(&s, size, rows, n);
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(targets, n_targets, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  cprox_motion_gradient g = {.positions = positions};
  cprox_result r;
  assert_true(cprox_robot_distance_gradient(all, cprox_robot_along(s.motion, NULL, 0), NULL, ws, &r, &g) >= 0);
  assert_string_equal(cprox_workspace_error(ws), why);
  assert_int_equal(g.valid, why[0] == 0);
  cprox_obstacles_free(all);
  slider_free(&s);
  return g;
}

/* Two waypoints alike: a step of either would move the ball. */
CASE(a_robot_that_stands_still_has_rows) {
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &box), CPROX_OK);
  const cprox_obstacle at = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
  for (size_t i = 0; i < 3; i++) {
    const double y = (const double[]){0.0, 0.7, 0.9}[i], least = y < 0.6 ? 0.0 : y - 0.6;
    slider s;
    slider_make(&s, vec(0, 0, 0), (const double[][2]){{0.2, y}, {0.2, y}}, 2);
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(&at, 1, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    double positions[2][4];
    cprox_motion_row rows[2] = {{.gradient = {.positions = positions[0]}}, {.gradient = {.positions = positions[1]}}};
    const cprox_rows_query asked = {.horizon = 0.2, .per_pair = 1};
    size_t count = 0;
    assert_int_equal(cprox_robot_rows(all, cprox_robot_along(s.motion, NULL, 0), &asked, NULL, ws, rows, 2, &count),
                     CPROX_OK);
    assert_int_equal(count, least < 0.2);
    if (count > 0) assert_true(rows[0].result.lower <= least && fabs(rows[0].result.upper - least) < 1e-9);
    cprox_obstacles_free(all);
    slider_free(&s);
  }
  cprox_body_free(box);
}

CASE(the_reason_says_why_there_is_no_gradient) {
  const char *elsewhere = "no gradient: the distance is as small elsewhere along the motion, or of another pair",
             *interval = "no gradient: the distance is as small on an interval of the motion",
             *points = "no gradient: the nearest points are not the only ones";
  const vec3 ball = vec(0, 0, 0), block = vec(0.2, 0.3, 0.4);
  cprox_body *box = NULL, *sphere = NULL;
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.5, ws, &sphere), CPROX_OK);
  const cprox_obstacle one = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
  const cprox_obstacle pair[2] = {cprox_obstacle_at(sphere, (cprox_pose){{-2, 0, 0}, {1, 0, 0, 0}}),
                                  cprox_obstacle_at(sphere, (cprox_pose){{2, 0, 0}, {1, 0, 0, 0}})};
  const cprox_obstacle twin[2] = {pair[0], pair[0]};
  double p[8];

  /* along a face, past two balls that stand to either side, past two that stand in one place, through the box, with a
   * face along a face */
  slide(ball, (const double[][2]){{-0.4, 1}, {0.4, 1}}, 2, &one, 1, p, interval);
  slide(ball, (const double[][2]){{-3, 1}, {3, 1}}, 2, pair, 2, p, elsewhere);
  slide(ball, (const double[][2]){{-3, 1}, {-2, 1}, {0, 2}}, 3, twin, 2, p, elsewhere);
  slide(ball, (const double[][2]){{-3, 0}, {3, 0}}, 2, &one, 1, p, "no gradient: the distance is 0");
  slide(block, (const double[][2]){{-0.3, 1}, {0, 0.8}, {0.4, 1}}, 3, &one, 1, p, points);
  slide(ball, (const double[][2]){{-3, 1}, {3, 1}}, 2, NULL, 0, p, "no gradient: there is nothing to be near");

  /* at a waypoint where the motion has a kink, all of it belongs to that waypoint; at a vertex; at an end */
  cprox_motion_gradient g = slide(ball, (const double[][2]){{-0.3, 2}, {0.1, 0.8}, {0.4, 2}}, 3, &one, 1, p, "");
  assert_true(g.t == 1.0 && p[3] == 1.0 && p[0] == 0.0 && p[1] == 0.0 && p[4] == 0.0 && p[5] == 0.0);
  g = slide(ball, (const double[][2]){{0.7, 3}, {0.7, 0.9}, {3, 3}}, 3, &one, 1, p, "");
  assert_true(g.t == 1.0 && fabs(p[2] - sqrt(0.2)) < 1e-12 && fabs(p[3] - sqrt(0.8)) < 1e-12);
  g = slide(ball, (const double[][2]){{0, 3}, {0.1, 0.9}}, 2, &one, 1, p, "");
  assert_true(g.t == 1.0 && p[3] == 1.0 && g.position.y == -1.0 && g.base_position.y == 1.0 && g.duration == 0.0);
  cprox_body_free(box);
  cprox_body_free(sphere);
}

/* ---- motions that end at rest ---- */

/* A planar arm of two bars from rest to rest; `orders`: velocities, or accelerations as well, are 0 at its ends. */
typedef struct arm {
  cprox_body *bar, *ball;
  cprox_robot *robot;
  cprox_motion *motion;
} arm;

static void arm_move(arm *a, const double from[2], const double to[2], int orders) {
  static const double still[2] = {0.0, 0.0};
  const double *rate = orders > 0 ? still : NULL, *bend = orders > 1 ? still : NULL;
  const cprox_waypoint points[2] = {{0.0, from, rate, bend}, {2.0, to, rate, bend}};
  cprox_motion_free(a->motion);
  assert_int_equal(cprox_motion_create(a->robot,
                                       &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                                   .variables = (const int32_t[]){0, 1},
                                                                   .n_variables = 2,
                                                                   .waypoints = points,
                                                                   .n_waypoints = 2},
                                       ws, &a->motion),
                   CPROX_OK);
}

static arm arm_make(void) {
  arm a = {.motion = NULL};
  const cprox_pose along = {.position = {0.25, 0, 0}, .orientation = {1, 0, 0, 0}};
  cprox_link links[2];
  cprox_link_geometry geometries[2];
  assert_int_equal(cprox_body_create_box(vec(0.5, 0.08, 0.06), ws, &a.bar), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &a.ball), CPROX_OK);
  for (int32_t i = 0; i < 2; i++) {
    links[i] = (cprox_link){.parent = i - 1,
                            .type = CPROX_JOINT_REVOLUTE,
                            .origin = {.position = {i ? 0.5 : 0.0, 0, 0}, .orientation = {1, 0, 0, 0}},
                            .axis = {0, 0, 1},
                            .variable = i,
                            .multiplier = 1.0};
    geometries[i] = (cprox_link_geometry){.body = a.bar, .pose = along, .link = i};
  }
  assert_int_equal(cprox_robot_create(links, 2, geometries, 2, 2, ws, &a.robot), CPROX_OK);
  return a;
}

/* Seed 4705, 300 motions towards or away from a ball: where the least distance is at an end of the motion, alone, the
 * gradient is that of the posture there, whether or not the motion rests there. */
CASE(a_least_distance_at_an_end_at_rest_has_a_gradient) {
  rng r = rng_seed(4705);
  arm a = arm_make();
  size_t at_end = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    const double near[2] = {rng_uniform(&r, -3, 3), rng_uniform(&r, -2, 2)};
    const double far[2] = {near[0] + rng_uniform(&r, -1, 1), near[1] + rng_uniform(&r, -1, 1)};
    const cprox_obstacle ball = cprox_obstacle_at(
        a.ball, (cprox_pose){{rng_uniform(&r, -1.3, 1.3), rng_uniform(&r, -1.3, 1.3), 0.02}, {1, 0, 0, 0}});
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(&ball, 1, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    const bool backwards = i % 2;
    bool valid[3];
    double rows[3][4];
    const char *why = "";
    for (int orders = 0; orders < 3; orders++) {
      arm_move(&a, backwards ? near : far, backwards ? far : near, orders);
      cprox_result result;
      cprox_motion_gradient g = {.positions = rows[orders]};
      const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
      assert_int_equal(cprox_robot_distance_gradient(all, mover, NULL, ws, &result, &g), CPROX_OK);
      valid[orders] = g.valid && g.t == (backwards ? 0.0 : 2.0);
      if (orders > 0 && valid[0] && !valid[orders]) why = cprox_workspace_error(ws);
    }
    /* a motion at constant rates says whether the posture at the end is nearest, alone */
    for (int orders = 1; orders < 3 && valid[0]; orders++) {
      if (!valid[orders]) fail_msg("case %zu, %d orders: %s", i, orders, why);
      for (int k = 0; k < 4; k++) assert_true(fabs(rows[orders][k] - rows[0][k]) < 1e-9);
    }
    at_end += valid[0];
    cprox_obstacles_free(all);
  }
  print_message("%zu are nearest at an end\n", at_end);
  assert_true(at_end > test_cases(300) / 5);
  cprox_motion_free(a.motion);
  cprox_robot_free(a.robot);
  cprox_body_free(a.bar);
  cprox_body_free(a.ball);
}

/* Of one state the gradient is by its variables: what they are at rest. */
CASE(states_have_gradients_by_their_variables) {
  rng r = rng_seed(4702);
  size_t valid = 0, all = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    gradient_case p;
    gradient_case_make(&r, false, &p);
    test_robot *t = &p.robot;
    double slope = 0.0, expected = 0.0, by[TEST_MAX_VARIABLES] = {0}, d[TEST_MAX_VARIABLES] = {0}, far = 0.0;
    for (size_t k = 0; k < t->n_variables; k++) d[k] = rng_uniform(&r, -1, 1);
    bool is_valid = false;
    const double h = 1e-5;
    for (int side = -1; side <= 1; side++) {
      double rest[TEST_MAX_VARIABLES + 1];
      for (size_t k = 0; k < t->n_variables; k++) rest[k] = t->rest[k] + h * side * d[k];
      cprox_motion_free(t->motion);
      const cprox_motion_description still = {.kind = CPROX_MOTION_STATE, .rest = rest};
      assert_int_equal(cprox_motion_create(t->robot, &still, ws, &t->motion), CPROX_OK);
      if (side != 0) {
        far = gradient_case_ask(&p, NULL);
        slope += side * far / (2.0 * h);
        continue;
      }
      gradient_answer a;
      gradient_case_ask(&p, &a);
      is_valid = a.gradient.valid && a.result.upper > 0.01;
      memcpy(by, a.variables, sizeof by);
    }
    for (size_t k = 0; k < t->n_variables; k++) expected += by[k] * d[k];
    /* the truncation of the difference: h² and the curvature of bodies of 0.01 */
    if (is_valid && fabs(slope - expected) > 1e-6 * (1.0 + fabs(expected)))
      fail_msg("state %zu: %.12g, the difference is %.12g", i, expected, slope);
    all += far > 0.01 && isfinite(far), valid += is_valid;
    gradient_case_free(&p);
  }
  print_message("%zu of %zu states have a gradient\n", valid, all);
  assert_true(10 * valid > 9 * all);
}

CASE(what_has_no_gradient_is_refused) {
  cprox_curve *curve = bezier((vec3[]){{-1, 0, 2}, {1, 0, 2}}, 2);
  cprox_result r;
  cprox_motion_gradient g = {0};
  assert_int_equal(cprox_robot_distance_gradient(NULL, cprox_point_along(curve), NULL, ws, &r, &g), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "the mover is no robot"));
  rng random = rng_seed(4703);
  gradient_case p;
  gradient_case_make(&random, false, &p);
  const cprox_mover mover = cprox_robot_along(p.robot.motion, NULL, 0);
  assert_int_equal(cprox_robot_distance_gradient(NULL, mover, NULL, ws, &r, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "gradient is NULL");
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.certificate = cprox_certificate_create();
  assert_int_equal(cprox_robot_distance_gradient(NULL, mover, &options, ws, &r, &g), CPROX_INVALID);
  cprox_certificate_free(options.certificate);

  /* rows */
  cprox_motion_row row = {0};
  cprox_rows_query rows = {.horizon = 0.1, .per_pair = 1};
  size_t count = 7;
  assert_int_equal(cprox_robot_rows(NULL, cprox_point_along(curve), &rows, NULL, ws, &row, 1, &count), CPROX_INVALID);
  assert_int_equal(cprox_robot_rows(NULL, mover, NULL, NULL, ws, &row, 1, &count), CPROX_INVALID);
  rows.horizon = INFINITY;
  assert_int_equal(cprox_robot_rows(NULL, mover, &rows, NULL, ws, &row, 1, &count), CPROX_INVALID);
  rows = (cprox_rows_query){.horizon = 0.1};
  assert_int_equal(cprox_robot_rows(NULL, mover, &rows, NULL, ws, &row, 1, &count), CPROX_INVALID);
  rows = (cprox_rows_query){.breaks = (double[]){-100.0, 0.0}, .n_intervals = 1, .horizon = 0.1, .per_pair = 1};
  assert_int_equal(cprox_robot_rows(NULL, mover, &rows, NULL, ws, &row, 1, &count), CPROX_INVALID);
  assert_int_equal(count, 7);
  gradient_case_free(&p);
  cprox_curve_free(curve);
}

/* ---- real robots ---- */

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

enum { MOST_ASKED = 128 };

/* Real robots on real trajectories in real scenes: the gradient says what the distance says. Its distances are few
 * beside what the nodes cost: value and gradient take 1.49 times the instructions of the value over all cases. */
CASE(value_and_gradient_cost_little_more_than_the_value) {
  size_t n, valid = 0, asked = 0;
  double sums[2] = {0.0, 0.0}, nodes[MOST_ASKED], queries[MOST_ASKED];
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  for (size_t i = 0; i < n; i++) {
    robot_case c;
    assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &c));
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(c.targets, c.n_targets, CPROX_INDEX_BVH, ws, &all), CPROX_OK);
    const cprox_mover movers[2] = {cprox_robot_along(c.motion, NULL, 0),
                                   cprox_robot_self(c.motion, c.self_pairs, c.n_self_pairs)};
    for (int k = 0; k < 2; k++) {
      cprox_result distance, result;
      cprox_motion_gradient g = {0};
      const cprox_obstacles *against = k ? NULL : all;
      assert_true(cprox_obstacles_distance(against, movers[k], NULL, ws, &distance, NULL) >= 0);
      assert_true(cprox_robot_distance_gradient(against, movers[k], NULL, ws, &result, &g) >= 0);
      if (getenv("CPROX_TEST_SCALE"))
        print_message("%s %d: [%g, %g] nodes %u, %u, queries %u, %u %s\n", c.name, k, distance.lower, distance.upper,
                      distance.nodes, result.nodes, distance.distance_queries, result.distance_queries,
                      cprox_workspace_error(ws));
      assert_true(result.lower <= distance.upper && distance.lower <= result.upper);
      assert_true(!isfinite(result.upper) || result.upper - result.lower <= 1e-6);
      if (!(distance.upper > 0.0) || asked == MOST_ASKED) continue;
      valid += g.valid;
      sums[0] += distance.distance_queries, sums[1] += result.distance_queries;
      nodes[asked] = (double)result.nodes / distance.nodes;
      queries[asked++] = (double)result.distance_queries / distance.distance_queries;
    }
    cprox_obstacles_free(all);
    robot_case_free(&c);
  }
  fclose(f);
  qsort(nodes, asked, sizeof *nodes, ascending);
  qsort(queries, asked, sizeof *queries, ascending);
  print_message(
      "%zu of %zu have a gradient; nodes %.3g times those of the distance in the median, distances %.3g, %.3g "
      "of all\n",
      valid, asked, nodes[asked / 2], queries[asked / 2], sums[1] / sums[0]);
  assert_true(10 * valid > 9 * asked && nodes[asked / 2] <= 1.25 && queries[asked / 2] <= 1.8);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
