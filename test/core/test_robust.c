/* SPDX-License-Identifier: BSD-3-Clause */
/* Executions of a motion within bounds of their errors, against closed forms. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"

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

/* A ball moves away from a joint, or from the base, along a wall, and back: its lever arm is the longest on the way. */
CASE(what_moves_away_from_what_is_off_loses_by_its_longest_lever_arm) {
  static const double E = 2e-3, NEAR = 0.5, OUT = 8.0, BACK = 1.0;
  const double off[2] = {E, 0}, ends[2] = {0, NEAR}, out[2] = {0, OUT}, back[2] = {0, BACK};
  double far = 0.0;
  for (double u = 0.0; u < 1.0; u += 1e-4)
    far = fmax(NEAR + u * (1.0 - u) * (1.0 - u) * OUT - u * u * (1.0 - u) * BACK, far);
  const int32_t variables[2] = {0, 1};
  const cprox_link links[2] = {{.parent = -1,
                                .type = CPROX_JOINT_REVOLUTE,
                                .origin = CPROX_POSE_IDENTITY,
                                .axis = {0, 0, 1},
                                .variable = 0,
                                .multiplier = 1.0},
                               {.parent = 0,
                                .type = CPROX_JOINT_PRISMATIC,
                                .origin = CPROX_POSE_IDENTITY,
                                .axis = {1, 0, 0},
                                .variable = 1,
                                .multiplier = 1.0}};
  arm a;
  assert_int_equal(cprox_body_create_sphere(BALL, ws, &a.ball), CPROX_OK);
  const cprox_link_geometry geometry = {.body = a.ball, .pose = CPROX_POSE_IDENTITY, .link = 1};
  assert_int_equal(cprox_robot_create(links, 2, &geometry, 1, 2, ws, &a.robot), CPROX_OK);
  cprox_body *wall = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(0, -1, 0), GAP + BALL, ws, &wall), CPROX_OK);
  const cprox_obstacle one = cprox_obstacle_at(wall, CPROX_POSE_IDENTITY);
  assert_int_equal(cprox_obstacles_create(&one, 1, CPROX_INDEX_BVH, ws, &a.obstacles), CPROX_OK);
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = ends, .velocities = out},
                                    {.time = 1.0, .positions = ends, .velocities = back}};
  const cprox_motion_description way = {
      .kind = CPROX_MOTION_WAYPOINTS, .variables = variables, .n_variables = 2, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(a.robot, &way, ws, &a.motion), CPROX_OK);
  const cprox_error_bounds bounds[2] = {{.tracking = off, .n_variables = 2}, {.base_rotation = E}};
  for (int k = 0; k < 2; k++) {
    const cprox_result r = robust(&a, &bounds[k], NULL);
    /* where it is far, the ball is turned towards the wall */
    assert_true(r.lower <= GAP - far * sin(E) + 1e-9 && r.lower >= GAP - far * E * (1.0 + 2.0 * E) - 1e-6);
    cprox_result verdict;
    const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
    assert_true(cprox_robust_tolerance(a.obstacles, mover, GAP - far * sin(E) + 1e-6, &bounds[k], NULL, ws, &verdict) >=
                0);
    assert_int_not_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
  }
  cprox_body_free(wall);
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

/* The ball slides along a wall, away from the joint and from the base's origin. Without errors the distance stays as it
 * is; a turn by e of either takes FAR sin e where the ball is farthest. */
CASE(errors_cost_what_the_farthest_of_the_way_is_away) {
  static const double FAR = 2.0, TURN = 1e-3;
  const double e[ARM_VARIABLES] = {0.0, TURN}, ends[2] = {0.0, FAR};
  const int32_t slide = 0;
  arm a;
  make_arm(CPROX_JOINT_REVOLUTE, 1, 1.0, beside_tip(), &a);
  put_slide_on_joint(vec(0, 0, 0), 0.0, &a);
  cprox_body *wall = put_wall_behind(0.0, &a);
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = &ends[0]}, {.time = 1.0, .positions = &ends[1]}};
  const cprox_motion_description along = {.kind = CPROX_MOTION_WAYPOINTS,
                                          .variables = &slide,
                                          .n_variables = 1,
                                          .waypoints = points,
                                          .n_waypoints = 2,
                                          .interpolation = CPROX_INTERPOLATION_LINEAR};
  assert_int_equal(cprox_motion_create(a.robot, &along, ws, &a.motion), CPROX_OK);
  const cprox_error_bounds bounds[] = {{.base_rotation = TURN}, {.tracking = e, .n_variables = ARM_VARIABLES}};
  for (size_t i = 0; i < 2; i++) {
    const cprox_result r = robust(&a, &bounds[i], NULL);
    assert_true(r.lower <= GAP - FAR * sin(TURN) + 1e-9);
    assert_true(r.lower >= GAP - FAR * TURN - FAR * TURN * TURN - 1e-7);
  }
  free_arm(&a);
  cprox_body_free(wall);
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
