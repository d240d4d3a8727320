/* SPDX-License-Identifier: BSD-3-Clause */
/* Executions of a motion within bounds of their errors: against closed forms, against random executions in long double,
 * and how much the certified bounds give away on real robots. */
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

/* ---- closed forms: an arm of two links along x, with a ball at its tip, and a ball beside the tip ---- */

enum { ARM_LINKS = 3, ARM_VARIABLES = 2 };

static const double FIRST_LENGTH = 0.5, SECOND_LENGTH = 0.3, BALL = 0.02, GAP = 0.2;

typedef struct arm {
  cprox_body *ball;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_obstacles *obstacles;
} arm;

/* type: of the first joint, whose axis is y if it is prismatic and z otherwise. The other one turns about z and carries
 * the ball. `second`: the variable of the second joint; `multiplier`: of it. */
static void make_arm(cprox_joint_type type, int32_t second, double multiplier, cprox_vec3 obstacle, arm *a) {
  const bool slides = type == CPROX_JOINT_PRISMATIC;
  const cprox_link links[ARM_LINKS] = {
      {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY, .multiplier = 1.0},
      {.parent = 0,
       .type = type,
       .origin = CPROX_POSE_IDENTITY,
       .axis = {0, slides, !slides},
       .variable = 0,
       .multiplier = 1.0},
      {.parent = 1,
       .type = CPROX_JOINT_REVOLUTE,
       .origin = {.position = {FIRST_LENGTH, 0, 0}, .orientation = {.w = 1.0}},
       .axis = {0, 0, 1},
       .variable = second,
       .multiplier = multiplier}};
  assert_int_equal(cprox_body_create_sphere(BALL, ws, &a->ball), CPROX_OK);
  const cprox_link_geometry geometry = {
      .body = a->ball, .pose = {.position = {SECOND_LENGTH, 0, 0}, .orientation = {.w = 1.0}}, .link = 2};
  assert_int_equal(cprox_robot_create(links, ARM_LINKS, &geometry, 1, ARM_VARIABLES, ws, &a->robot), CPROX_OK);
  const cprox_obstacle one = cprox_obstacle_at(a->ball, (cprox_pose){.position = obstacle, .orientation = {.w = 1.0}});
  assert_int_equal(cprox_obstacles_create(&one, 1, CPROX_INDEX_BVH, ws, &a->obstacles), CPROX_OK);
  a->motion = NULL;
}

/* One state, in which all variables are 0. */
static void rest_arm(arm *a) {
  const cprox_motion_description state = {.kind = CPROX_MOTION_STATE};
  assert_int_equal(cprox_motion_create(a->robot, &state, ws, &a->motion), CPROX_OK);
}

static void free_arm(arm *a) {
  cprox_obstacles_free(a->obstacles);
  cprox_motion_free(a->motion);
  cprox_robot_free(a->robot);
  cprox_body_free(a->ball);
}

static cprox_result robust(const arm *a, const cprox_error_bounds *bounds, const double *interval) {
  cprox_result r;
  cprox_options options = accurate(1e-9);
  options.interval = interval;
  const cprox_mover mover = cprox_robot_along(a->motion, NULL, 0);
  const cprox_status status = cprox_robust_distance(a->obstacles, mover, bounds, &options, ws, &r);
  if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
  return r;
}

/* The certified clearance is the gap less `expected`; what is of second order in the errors is below `second`. */
static void expect_loss(const arm *a, const cprox_error_bounds *bounds, double expected) {
  const cprox_result r = robust(a, bounds, NULL);
  if (fabs(GAP - r.lower - expected) > 1e-7) fail_msg("lost %.10g, expected %.10g", GAP - r.lower, expected);
  assert_true(r.upper - r.lower <= 2e-9);
}

static cprox_vec3 beside_tip(void) {
  return vec(FIRST_LENGTH + SECOND_LENGTH, GAP + 2.0 * BALL, 0);
}

CASE(joints_that_are_off_cost_their_lever_arms) {
  const double e[ARM_VARIABLES] = {1e-3, 4e-3};
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  cprox_error_bounds bounds = {.tracking = e, .n_variables = ARM_VARIABLES};
  expect_loss(&a, &bounds, e[0] * (FIRST_LENGTH + SECOND_LENGTH) + e[1] * SECOND_LENGTH);
  bounds.speed = bounds.acceleration = e; /* it stands */
  expect_loss(&a, &bounds, e[0] * (FIRST_LENGTH + SECOND_LENGTH) + e[1] * SECOND_LENGTH);
  free_arm(&a);

  /* what mimics a joint is off by a multiple of its error */
  make_arm(CPROX_JOINT_REVOLUTE, 0, -2.0, beside_tip(), &a);
  rest_arm(&a);
  expect_loss(&a, &(cprox_error_bounds){.tracking = e, .n_variables = ARM_VARIABLES},
              e[0] * (FIRST_LENGTH + SECOND_LENGTH + 2.0 * SECOND_LENGTH));
  free_arm(&a);

  /* a slide is off by as much as its joint, towards the obstacle */
  make_arm(CPROX_JOINT_PRISMATIC, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  expect_loss(&a, &(cprox_error_bounds){.tracking = e, .n_variables = ARM_VARIABLES}, e[0] + e[1] * SECOND_LENGTH);
  free_arm(&a);
}

CASE(errors_of_places_cost_what_they_say) {
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  expect_loss(&a, &(cprox_error_bounds){.base_position = 1e-3}, 1e-3);
  expect_loss(&a, &(cprox_error_bounds){.object_position = 2e-3}, 2e-3);
  expect_loss(&a, &(cprox_error_bounds){.sensor = 3e-3}, 3e-3);
  expect_loss(&a, &(cprox_error_bounds){.flex = 4e-3}, 4e-3);
  const double tip = FIRST_LENGTH + SECOND_LENGTH;
  expect_loss(&a, &(cprox_error_bounds){.base_rotation = 1e-3}, 1e-3 * tip);
  expect_loss(&a, &(cprox_error_bounds){.base_rotation = 1e-3, .base_origin = {tip, -2, 0}}, 2e-3);
  expect_loss(&a, &(cprox_error_bounds){.timing = 10.0}, 0.0);
  /* the obstacle is a ball about its pose: a turn leaves it where it was, but for what its own radius says */
  expect_loss(&a, &(cprox_error_bounds){.object_rotation = 1e-3}, 1e-3 * BALL);
  free_arm(&a);
}

/* A halfspace turns about its pose's position: the robot is off by as much as it is away from there. */
CASE(an_obstacle_without_end_turns_against_the_link) {
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  cprox_body *wall = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(0, -1, 0), 0.0, ws, &wall), CPROX_OK);
  const double away = 0.7;
  const cprox_obstacle one = cprox_obstacle_at(
      wall, (cprox_pose){.position = {FIRST_LENGTH + SECOND_LENGTH, away, 0}, .orientation = {.w = 1.0}});
  cprox_obstacles_free(a.obstacles);
  for (int index = 0; index < 2; index++) {
    cprox_result plain, r;
    assert_int_equal(cprox_obstacles_create(&one, 1, (cprox_obstacle_index)index, ws, &a.obstacles), CPROX_OK);
    const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
    assert_int_equal(cprox_obstacles_distance(a.obstacles, mover, NULL, ws, &plain, NULL), CPROX_OK);
    r = robust(&a, &(cprox_error_bounds){.object_rotation = 1e-3}, NULL);
    assert_true(fabs(plain.lower - r.lower - 1e-3 * away) < 1e-5);
    if (index == 0) cprox_obstacles_free(a.obstacles);
  }
  free_arm(&a);
  cprox_body_free(wall);
}

/* The slide begins at rest and speeds up towards the obstacle, which it comes closest to at the end. */
CASE(errors_grow_with_speed_and_acceleration) {
  const double speed = 0.4, acceleration = 0.8, end = 0.5 * speed;
  arm a;
  make_arm(CPROX_JOINT_PRISMATIC, 1, 1.0, vec(FIRST_LENGTH + SECOND_LENGTH, end / 2 + GAP + 2 * BALL, 0), &a);
  const double from = 0.0, to = 0.5 * end, fast = speed, rest = 0.0;
  const cprox_waypoint points[2] = {{.time = 0, .positions = &from, .velocities = &rest},
                                    {.time = speed / acceleration, .positions = &to, .velocities = &fast}};
  const int32_t moved = 0;
  const cprox_motion_description description = {
      .kind = CPROX_MOTION_WAYPOINTS, .variables = &moved, .n_variables = 1, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(a.robot, &description, ws, &a.motion), CPROX_OK);
  const double e[ARM_VARIABLES] = {0.01, 0.0};
  cprox_error_bounds bounds = {.tracking = e, .n_variables = ARM_VARIABLES};
  expect_loss(&a, &bounds, e[0]);
  bounds.tracking = NULL, bounds.speed = e;
  expect_loss(&a, &bounds, e[0] * speed);
  bounds.speed = NULL, bounds.acceleration = e;
  expect_loss(&a, &bounds, e[0] * acceleration);
  bounds.tracking = bounds.speed = e;
  expect_loss(&a, &bounds, e[0] * (1 + speed + acceleration));

  /* of an interval, a motion that is late may be in what comes before, and one that is early in what comes behind */
  const double interval[2] = {0.1, 0.3}, longer[2] = {0.1, 0.35};
  const cprox_result late = robust(&a, &(cprox_error_bounds){.timing = 0.05}, interval),
                     whole = robust(&a, &(cprox_error_bounds){0}, longer);
  assert_true(fabs(late.lower - whole.lower) < 1e-8);
  free_arm(&a);
}

/* The slide moves to the obstacle from rest to rest and is off by e times its speed: the worst is on the way, at no time
 * that halves of the interval begin or end at. 100 intervals (seed 4606), the worst of 20001 times: within 1e-9. */
CASE(errors_that_grow_on_the_way_are_not_missed_between_what_is_measured) {
  const double way = 0.02, e[ARM_VARIABLES] = {1.0, 0.0}, from = 0.0, rest = 0.0;
  const int32_t moved = 0;
  rng r = rng_seed(4606);
  arm a;
  make_arm(CPROX_JOINT_PRISMATIC, 1, 1.0, beside_tip(), &a);
  const cprox_waypoint points[2] = {{.time = 0, .positions = &from, .velocities = &rest},
                                    {.time = 1, .positions = &way, .velocities = &rest}};
  const cprox_motion_description description = {
      .kind = CPROX_MOTION_WAYPOINTS, .variables = &moved, .n_variables = 1, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(a.robot, &description, ws, &a.motion), CPROX_OK);
  const cprox_error_bounds bounds = {.speed = e, .n_variables = ARM_VARIABLES};
  for (int i = 0; i < 100; i++) {
    const double interval[2] = {rng_uniform(&r, 0, 0.5), rng_uniform(&r, 0.5, 1)};
    double worst = INFINITY;
    for (int k = 0; k <= 20000; k++) {
      const double t = interval[0] + (interval[1] - interval[0]) * k / 20000.0;
      worst = fmin(GAP - way * t * t * (3.0 - 2.0 * t) - e[0] * way * 6.0 * t * (1.0 - t), worst);
    }
    const cprox_result d = robust(&a, &bounds, interval);
    if (d.lower > worst + 1e-12 || d.lower < worst - 1e-8)
      fail_msg("%g to %g: certified %.12g, worst %.12g", interval[0], interval[1], d.lower, worst);
  }
  free_arm(&a);
}

/* A variable goes from one value to a second and on to a third, at constant speeds. The second one is reached at no time
 * that halves of the motion begin or end at. */
enum { PLACES = 3 };

static void draw_places(rng *r, double most, double *places) {
  for (int k = 0; k < PLACES; k++) places[k] = rng_uniform(r, -most, most);
}

static void move_arm(rng *r, int32_t variable, const double *places, arm *a) {
  cprox_waypoint points[PLACES];
  const double between = rng_uniform(r, 0.2, 0.8);
  for (int k = 0; k < PLACES; k++)
    points[k] = (cprox_waypoint){.time = k == 0 ? 0.0 : k == 1 ? between : 1.0, .positions = &places[k]};
  const cprox_motion_description along = {.kind = CPROX_MOTION_WAYPOINTS,
                                          .variables = &variable,
                                          .n_variables = 1,
                                          .waypoints = points,
                                          .n_waypoints = PLACES,
                                          .interpolation = CPROX_INTERPOLATION_LINEAR};
  assert_int_equal(cprox_motion_create(a->robot, &along, ws, &a->motion), CPROX_OK);
}

/* Another robot: a joint about z at a place turns a slide along y, which carries the ball ahead of it. Variable 0 is the
 * slide's. */
static void put_slide_on_joint(cprox_vec3 place, double ahead, arm *a) {
  const cprox_link links[ARM_LINKS] = {
      {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY, .multiplier = 1.0},
      {.parent = 0,
       .type = CPROX_JOINT_REVOLUTE,
       .origin = {.position = place, .orientation = {.w = 1.0}},
       .axis = {0, 0, 1},
       .variable = 1,
       .multiplier = 1.0},
      {.parent = 1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {0, 1, 0}, .multiplier = 1}};
  const cprox_link_geometry geometry = {
      .body = a->ball, .pose = {.position = {ahead, 0, 0}, .orientation = {.w = 1.0}}, .link = 2};
  cprox_robot_free(a->robot);
  assert_int_equal(cprox_robot_create(links, ARM_LINKS, &geometry, 1, ARM_VARIABLES, ws, &a->robot), CPROX_OK);
}

/* A wall across x behind the ball takes the place of the obstacle. */
static cprox_body *put_wall_behind(double ball_at, arm *a) {
  cprox_body *wall = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(1, 0, 0), GAP + BALL - ball_at, ws, &wall), CPROX_OK);
  const cprox_obstacle one = cprox_obstacle_at(wall, CPROX_POSE_IDENTITY);
  cprox_obstacles_free(a->obstacles);
  assert_int_equal(cprox_obstacles_create(&one, 1, CPROX_INDEX_BVH, ws, &a->obstacles), CPROX_OK);
  return wall;
}

/* A slide that is off by up to e stands, and a joint turns what it carries round the obstacle; or the joint turns the
 * slide, and on it a ball that is on the joint's axis. Without errors the distance stays as it is. With them it is less
 * by e |sin|, which is 0 where the slide is across the normal: that changes with the joint, although both sides look the
 * same from it. 4 x 100 motions (seed 4605), of large errors and of small ones: the certified clearance is at most that of
 * the worst execution, and within the square of e of it. */
CASE(errors_are_seen_from_a_joint_that_turns_round_sides) {
  const double away = 0.3;
  rng r = rng_seed(4605);
  for (int i = 0; i < 400; i++) {
    const double e[ARM_VARIABLES] = {i % 4 < 2 ? 0.02 : 1e-4, 0.0};
    arm a;
    make_arm(CPROX_JOINT_PRISMATIC, 1, 1.0, vec(FIRST_LENGTH, 0, 0), &a);
    if (i % 2) put_slide_on_joint(vec(FIRST_LENGTH + away, 0, 0), 0.0, &a);
    double angles[PLACES];
    draw_places(&r, 1.8, angles);
    move_arm(&r, 1, angles, &a);
    const cprox_result d = robust(&a, &(cprox_error_bounds){.tracking = e, .n_variables = ARM_VARIABLES}, NULL);
    const double low = fmin(fmin(angles[0], angles[1]), angles[2]), high = fmax(fmax(angles[0], angles[1]), angles[2]);
    const double most = low <= -M_PI_2 || high >= M_PI_2 ? 1.0 : fmax(fabs(sin(low)), fabs(sin(high)));
    const double worst = hypot(away * sqrt(1.0 - most * most), away * most - e[0]) - 2.0 * BALL;
    if (d.lower > worst + 1e-12) fail_msg("motion %d: certified %.12g, worst %.12g", i, d.lower, worst);
    if (d.lower < worst - 2.0 * e[0] * e[0] / away - 2e-9) fail_msg("motion %d: %.12g, not %.12g", i, d.lower, worst);
    free_arm(&a);
  }
}

/* The arm lies straight along the wall's normal: each joint alone moves its tip along the wall, and nearer to it only by
 * what is of second order in the errors. 200 pairs of errors (seed 4607): at most the clearance of the execution in which
 * both turn to one side, and below it by fourth powers alone. */
CASE(errors_bend_what_moves_along_a_wall_towards_it) {
  rng r = rng_seed(4607);
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  cprox_body *wall = put_wall_behind(FIRST_LENGTH + SECOND_LENGTH, &a);
  for (int i = 0; i < 200; i++) {
    const double e[ARM_VARIABLES] = {i % 3 ? rng_uniform(&r, 0, 0.1) : 0.0, i % 3 == 1 ? 0.0 : rng_uniform(&r, 0, 0.1)};
    const double both = e[0] + e[1];
    const double worst = GAP - FIRST_LENGTH * (1.0 - cos(e[0])) - SECOND_LENGTH * (1.0 - cos(both));
    const cprox_result d = robust(&a, &(cprox_error_bounds){.tracking = e, .n_variables = ARM_VARIABLES}, NULL);
    if (d.lower > worst + 1e-12 || d.lower < worst - pow(both, 4) / 24 - 1e-8)
      fail_msg("%g and %g: certified %.12g, worst %.12g", e[0], e[1], d.lower, worst);
  }
  free_arm(&a);
  cprox_body_free(wall);
}

/* A slide moves the ball along a wall, and the joint that carries the slide stands, but is off by up to e: what that costs
 * is the more the farther the slide is from its middle, while the distance stays as it is. 200 motions (seed 4608): at
 * most the clearance of the worst execution, and below it by what is of second order in e. */
CASE(errors_cost_more_where_another_joint_moves_the_link) {
  const double e[ARM_VARIABLES] = {0.0, 0.02};
  const cprox_error_bounds bounds = {.tracking = e, .n_variables = ARM_VARIABLES};
  rng r = rng_seed(4608);
  for (int i = 0; i < 200; i++) {
    arm a;
    make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
    put_slide_on_joint(vec(0, 0, 0), FIRST_LENGTH, &a);
    cprox_body *wall = put_wall_behind(FIRST_LENGTH, &a);
    double places[PLACES];
    draw_places(&r, 0.3, places);
    move_arm(&r, 0, places, &a);
    const double most = fmax(fmax(fabs(places[0]), fabs(places[1])), fabs(places[2]));
    const double worst = GAP - FIRST_LENGTH * (1.0 - cos(e[1])) - most * sin(e[1]);
    const cprox_result d = robust(&a, &bounds, NULL);
    if (d.lower > worst + 1e-12 || d.lower < worst - e[1] * e[1] * most - 2e-9)
      fail_msg("motion %d: certified %.12g, worst %.12g", i, d.lower, worst);
    cprox_result verdict;
    const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
    assert_int_equal(cprox_robust_tolerance(a.obstacles, mover, 0.999 * d.lower, &bounds, NULL, ws, &verdict),
                     CPROX_OK);
    assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
    free_arm(&a);
    cprox_body_free(wall);
  }
}

/* ---- random executions ---- */

enum { TARGETS = 3, EXECUTIONS = 400 };

typedef struct world {
  test_robot t;
  vec3 points[TARGETS]; /* in the frames of their poses */
  cprox_obstacle targets[TARGETS];
  double tracking[TEST_MAX_VARIABLES], speed[TEST_MAX_VARIABLES], acceleration[TEST_MAX_VARIABLES];
  cprox_error_bounds bounds;
} world;

static bool is_free_of_errors(const test_robot *t, size_t variable) {
  for (size_t i = 0; i < t->n_links; i++) {
    const size_t first = (size_t)t->links[i].variable;
    if (t->links[i].type == CPROX_JOINT_FLOATING && variable >= first && variable < first + 7) return true;
  }
  return false;
}

static double some(rng *r, double most) {
  return rng_index(r, 3) ? rng_log_uniform(r, 1e-5, most) : 0.0;
}

static void make_world(rng *r, world *w) {
  robot_make(r, rng_log_uniform(r, 0.1, 2), &w->t);
  for (size_t i = 0; i < TARGETS; i++) {
    cprox_body *body;
    w->points[i] = rng_in_cube(r, 0.5);
    assert_int_equal(cprox_body_create_point(w->points[i], ws, &body), CPROX_OK);
    w->targets[i] = cprox_obstacle_at(body, rng_pose(r, 2.0));
  }
  const double most = rng_log_uniform(r, 1e-4, 0.2);
  for (size_t v = 0; v < w->t.n_variables; v++) {
    const bool none = is_free_of_errors(&w->t, v);
    w->tracking[v] = none ? 0.0 : some(r, most), w->speed[v] = none ? 0.0 : some(r, most);
    w->acceleration[v] = none ? 0.0 : some(r, most);
  }
  w->bounds = (cprox_error_bounds){.tracking = w->tracking,
                                   .speed = w->speed,
                                   .acceleration = w->acceleration,
                                   .n_variables = w->t.n_variables,
                                   .timing = some(r, 0.3),
                                   .base_position = some(r, most),
                                   .base_rotation = some(r, most),
                                   .base_origin = rng_in_cube(r, 1.0),
                                   .object_position = some(r, most),
                                   .object_rotation = some(r, most),
                                   .sensor = some(r, most),
                                   .flex = some(r, most)};
}

static void free_world(world *w) {
  for (size_t i = 0; i < TARGETS; i++) cprox_body_free((cprox_body *)w->targets[i].body);
  robot_free(&w->t);
}

/* -1, 1, or between: the ends are what bounds are about. */
static double part(rng *r) {
  return rng_index(r, 4) ? (rng_index(r, 2) ? 1.0 : -1.0) : rng_uniform(r, -1, 1);
}

static vec3l turned(rng *r, double angle, vec3l about, vec3l x) {
  const vec3 axis = rng_unit(r);
  const double half = 0.5 * angle * part(r);
  const long double q[4] = {axis.x * sin(half), axis.y * sin(half), axis.z * sin(half), cos(half)};
  return ref_add(ref_turn(q, ref_sub(x, about)), about);
}

static vec3l shifted(rng *r, double by, vec3l x) {
  return ref_add(x, ref_scale(by * fabs(part(r)), ref_vec(rng_unit(r))));
}

/* The variables at a time, and how far each may be off, by difference quotients of the reference. */
static void draw_values(rng *r, const world *w, double from, double to, long double *values) {
  const cprox_error_bounds *b = &w->bounds;
  double time = from + (to - from) * (rng_index(r, 8) ? rng_uniform(r, 0, 1) : (double)rng_index(r, 2));
  time = fmin(fmax(time + b->timing * part(r), w->t.spline ? w->t.times[TEST_SPLINE_DEGREE] : w->t.times[0]),
              w->t.spline ? w->t.times[w->t.n_points] : w->t.times[w->t.n_points - 1]);
  robot_ref_values(&w->t, time, values);
  const long double h = 1e-5L;
  long double before[TEST_MAX_VARIABLES + 1], after[TEST_MAX_VARIABLES + 1];
  robot_ref_values(&w->t, (long double)time - h, before);
  robot_ref_values(&w->t, (long double)time + h, after);
  for (size_t v = 0; v < w->t.n_variables; v++) {
    /* both sides of a waypoint are polynomials of their own: there the quotients are not taken */
    bool smooth = true;
    for (size_t k = 0; k < w->t.n_points + (w->t.spline ? TEST_SPLINE_DEGREE + 1 : 0); k++)
      smooth = smooth && fabs(time - w->t.times[k]) > 2e-5;
    const double rate = smooth ? (double)fabsl((after[v] - before[v]) / (2 * h)) * (1 - 1e-6) : 0.0;
    const double second = smooth ? (double)fabsl((after[v] - 2 * values[v] + before[v]) / (h * h)) * (1 - 1e-3) : 0.0;
    const double most =
        b->tracking[v] + b->speed[v] * fmax(rate - 1e-6, 0.0) + b->acceleration[v] * fmax(second - 1e-3, 0.0);
    values[v] += most * part(r);
  }
}

static size_t first_moving_link(const test_robot *t, size_t link) {
  for (int32_t i = (int32_t)link; i >= 0; i = t->links[i].parent)
    if (t->links[i].type != CPROX_JOINT_FIXED) return 1;
  return 0;
}

/* The least distance of one execution from all points, at one time. Flex is left to the sum of all shifts: it moves a
 * link as a whole. */
static long double execution(rng *r, const world *w, double from, double to) {
  const cprox_error_bounds *b = &w->bounds;
  long double values[TEST_MAX_VARIABLES + 1], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  draw_values(r, w, from, to, values);
  robot_ref_links(&w->t, values, links);
  const vec3l nowhere = {0, 0, 0};
  const rng base = *r;
  for (size_t g = 0; g < w->t.n_links; g++) {
    vec3l exact[TEST_VERTICES];
    vec3 v[TEST_VERTICES];
    robot_ref_vertices(&w->t, links, g, exact);
    const vec3l bent = first_moving_link(&w->t, g) ? shifted(r, b->flex, nowhere) : nowhere;
    for (size_t k = 0; k < TEST_VERTICES; k++) {
      rng same = base; /* the base is where it is for all links */
      const vec3l at = shifted(&same, b->base_position,
                               turned(&same, b->base_rotation, ref_vec(b->base_origin), ref_add(exact[k], bent)));
      v[k] = vec((double)at.x, (double)at.y, (double)at.z);
    }
    for (size_t i = 0; i < TARGETS; i++) {
      const cprox_pose *pose = &w->targets[i].pose;
      vec3l point = ref_to_world(pose, shifted(r, b->sensor, ref_vec(w->points[i])));
      point = shifted(r, b->object_position, turned(r, b->object_rotation, ref_vec(pose->position), point));
      least = fminl(least, fmaxl(ref_point_hull(point, v, TEST_VERTICES) - w->t.margin, 0.0L));
    }
  }
  return least;
}

CASE(no_execution_comes_nearer_than_is_certified) {
  rng r = rng_seed(4601);
  size_t executions = 0, tight = 0, worlds = 0;
  for (size_t i = 0; i < test_cases(250); i++) {
    world w;
    make_world(&r, &w);
    cprox_obstacles *obstacles = NULL;
    const cprox_obstacle_index index = rng_index(&r, 2) ? CPROX_INDEX_BVH : CPROX_INDEX_NONE;
    assert_int_equal(cprox_obstacles_create(w.targets, TARGETS, index, ws, &obstacles), CPROX_OK);
    const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
    const double length = info.t1 - info.t0;
    const double interval[2] = {info.t0 + rng_uniform(&r, 0, 0.4) * length, info.t1 - rng_uniform(&r, 0, 0.4) * length};
    const bool all = rng_index(&r, 2);
    cprox_options options = accurate(1e-5);
    if (!all) options.interval = interval;
    cprox_result d, verdict;
    const cprox_mover mover = cprox_robot_along(w.t.motion, NULL, 0);
    const cprox_status status = cprox_robust_distance(obstacles, mover, &w.bounds, &options, ws, &d);
    if (status != CPROX_OK) fail_msg("world %zu: %s", i, cprox_workspace_error(ws));
    if (d.lower > 0.0) {
      const double delta = 0.9 * d.lower;
      assert_int_equal(cprox_robust_tolerance(obstacles, mover, delta, &w.bounds, &options, ws, &verdict), CPROX_OK);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      assert_true(verdict.lower > delta);
      worlds++;
      /* near where it is least, and anywhere */
      for (size_t k = 0; k < EXECUTIONS; k++) {
        const double at = fmin(fmax(d.t, all ? info.t0 : interval[0]), all ? info.t1 : interval[1]);
        const bool near = k % 2;
        const long double least = execution(&r, &w,
                                            near  ? at
                                            : all ? info.t0
                                                  : interval[0],
                                            near  ? at
                                            : all ? info.t1
                                                  : interval[1]);
        if (least < d.lower) fail_msg("world %zu: %.12Lg, certified %.12g", i, least, d.lower);
        tight += least < d.lower + 0.003;
        executions++;
      }
    }
    cprox_obstacles_free(obstacles);
    free_world(&w);
  }
  print_message("%zu executions of %zu motions, none nearer than certified; %zu within 3 mm of it\n", executions,
                worlds, tight);
  if (worlds >= 50) assert_true(worlds > test_cases(50) && tight > 0);
}

/* The robot with itself: links are drawn from the same values, and bent each by itself. */
CASE(no_execution_brings_two_links_nearer_than_is_certified) {
  rng r = rng_seed(4602);
  size_t asked = 0;
  for (size_t i = 0; i < test_cases(120); i++) {
    world w;
    make_world(&r, &w);
    for (int32_t a = 1; a < (int32_t)w.t.n_links; a++) {
      const cprox_robot_pair pair = {a, (int32_t)rng_index(&r, (size_t)a)};
      if (cprox_motion_get_link_info(w.t.motion, pair.geometry, pair.other).n_joints < 2) continue;
      cprox_options options = accurate(1e-5);
      cprox_result d;
      const cprox_mover self = cprox_robot_self(w.t.motion, &pair, 1);
      const cprox_status status = cprox_robust_distance(NULL, self, &w.bounds, &options, ws, &d);
      if (status != CPROX_OK) fail_msg("world %zu: %s", i, cprox_workspace_error(ws));
      if (!(d.lower > 0.0)) continue;
      asked++;
      const cprox_motion_info info = cprox_motion_get_info(w.t.motion);
      for (int k = 0; k < 40; k++) {
        long double values[TEST_MAX_VARIABLES + 1];
        ref_pose links[TEST_MAX_LINKS];
        draw_values(&r, &w, k % 2 ? d.t : info.t0, k % 2 ? d.t : info.t1, values);
        robot_ref_links(&w.t, values, links);
        cprox_obstacle side[2];
        for (int s = 0; s < 2; s++) {
          const int32_t geometry = s ? pair.other : pair.geometry;
          const cprox_link_geometry *g = &w.t.geometries[geometry];
          const ref_pose *l = &links[g->link];
          vec3l p = l->p;
          if (first_moving_link(&w.t, (size_t)g->link)) p = shifted(&r, w.bounds.flex, p);
          const cprox_pose link = {.position = {(double)p.x, (double)p.y, (double)p.z},
                                   .orientation = {(double)l->q[3], (double)l->q[0], (double)l->q[1], (double)l->q[2]}};
          side[s] = cprox_with_margin(cprox_obstacle_at(g->body, frame_compose(&link, &g->pose)), g->margin);
        }
        cprox_result at;
        assert_true(cprox_pair(side[0], side[1], NULL, ws, &at) >= 0);
        if (at.upper < d.lower - 1e-12) fail_msg("world %zu: %.12g, certified %.12g", i, at.upper, d.lower);
      }
    }
    free_world(&w);
  }
  print_message("%zu pairs of links\n", asked);
  if (test_cases(120) >= 60) assert_true(asked > test_cases(60));
}

/* ---- real robots ---- */

enum { MOST_CASES = 64, MOST_TIMES = 20 };

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

/* Of the same search: plain verdicts may be decided in lanes before it, which no count tells. */
CASE(errors_cost_the_search_at_most_as_much_again) {
  size_t n, counted = 0;
  FILE *f = open_cases(&n);
  double times[2 * MOST_CASES];
  for (size_t i = 0; i < n; i++) {
    real_case r;
    read_case(f, &r);
    const cprox_mover mover = cprox_robot_along(r.c.motion, NULL, 0);
    cprox_result d, plain, at;
    assert_true(cprox_robust_distance(r.obstacles, mover, &r.bounds, NULL, ws, &d) >= 0);
    for (int k = 0; k < 2; k++) {
      const double delta = (k ? 0.5 : 0.9) * d.lower;
      assert_true(cprox_robust_tolerance(r.obstacles, mover, delta, &r.bounds, NULL, ws, &at) >= 0);
      assert_true(cprox_robust_tolerance(r.obstacles, mover, delta, &(cprox_error_bounds){0}, NULL, ws, &plain) >= 0);
      if (!(d.lower > 0.0)) continue;
      times[counted++] = ((double)at.nodes + at.distance_queries) / ((double)plain.nodes + plain.distance_queries);
    }
    free_case(&r);
  }
  fclose(f);
  const double middle = median(times, counted);
  print_message("%zu verdicts: nodes and distance queries %.2f times those without errors in the median\n", counted,
                middle);
  assert_true(counted > 20 && middle <= 2.0);
}

/* ---- verdicts, and what is refused ---- */

CASE(verdicts_tell_the_motion_from_its_errors) {
  const double e[ARM_VARIABLES] = {0.05, 0.05}, none[ARM_VARIABLES] = {0, 0};
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
  const cprox_error_bounds bounds = {.tracking = e, .n_variables = ARM_VARIABLES},
                           zero = {.tracking = none, .n_variables = ARM_VARIABLES};
  cprox_result r;
  assert_int_equal(cprox_robust_tolerance(a.obstacles, mover, 0.1, &bounds, NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_int_equal(cprox_robust_tolerance(a.obstacles, mover, GAP - 0.01, &bounds, NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_UNDECIDED);
  assert_int_equal(cprox_robust_tolerance(a.obstacles, mover, GAP + 0.01, &bounds, NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(fabs(r.upper - GAP) < 0.02); /* that of the motion, as far as a verdict needs it */

  cprox_robust_scale s;
  assert_int_equal(cprox_robust_find_scale(a.obstacles, mover, 0.1, &bounds, NULL, ws, &s), CPROX_OK);
  const double exact = 0.1 / (e[0] * (FIRST_LENGTH + 2.0 * SECOND_LENGTH));
  assert_true(s.certified <= exact * 1.001 && s.refused >= exact * 0.999 && s.certified >= 0.99 * s.refused);
  assert_int_equal(cprox_robust_find_scale(a.obstacles, mover, 0.1, &zero, NULL, ws, &s), CPROX_OK);
  assert_true(isinf(s.certified) && s.verdict == CPROX_VERDICT_CLEAR);
  assert_int_equal(cprox_robust_find_scale(a.obstacles, mover, GAP + 0.1, &bounds, NULL, ws, &s), CPROX_OK);
  assert_true(s.certified == 0.0 && s.refused == 0.0 && s.verdict == CPROX_VERDICT_VIOLATED);
  free_arm(&a);
}

static void expect_refused(const arm *a, const cprox_error_bounds *bounds, const char *part) {
  cprox_result r;
  const cprox_mover mover = cprox_robot_along(a->motion, NULL, 0);
  assert_int_equal(cprox_robust_distance(a->obstacles, mover, bounds, NULL, ws, &r), CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), part)) fail_msg("%s", cprox_workspace_error(ws));
}

CASE(bounds_that_are_none_are_refused) {
  const double negative[ARM_VARIABLES] = {0, -1e-3}, endless[ARM_VARIABLES] = {INFINITY, 0};
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  rest_arm(&a);
  expect_refused(&a, NULL, "bounds is NULL");
  expect_refused(&a, &(cprox_error_bounds){.tracking = negative, .n_variables = 2}, "tracking error of variable 1");
  expect_refused(&a, &(cprox_error_bounds){.speed = endless, .n_variables = 2}, "speed error of variable 0");
  expect_refused(&a, &(cprox_error_bounds){.tracking = negative, .n_variables = 3}, "3 variables");
  expect_refused(&a, &(cprox_error_bounds){.flex = -1}, "flex");
  expect_refused(&a, &(cprox_error_bounds){.timing = NAN}, "timing");
  expect_refused(&a, &(cprox_error_bounds){.base_origin = {NAN, 0, 0}}, "base_origin");
  cprox_result r;
  const vec3 way[2] = {{0, 0, 0}, {1, 0, 0}};
  cprox_curve *curve = bezier(way, 2);
  assert_int_equal(cprox_robust_distance(a.obstacles, cprox_point_along(curve), &(cprox_error_bounds){0}, NULL, ws, &r),
                   CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "no robot"));
  cprox_curve_free(curve);
  free_arm(&a);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
