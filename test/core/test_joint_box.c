/* SPDX-License-Identifier: BSD-3-Clause */
/* Collision over a box of joint values: held against states drawn from the box, whose links stand where long double
 * kinematics puts them, and against a closed form. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robots.h"

/* The distance of two geometries at a state; 0 where they overlap. */
static cprox_result reference(const test_robot *t, const double *state, cprox_robot_pair pair) {
  long double exact[TEST_MAX_VARIABLES];
  for (size_t i = 0; i < t->n_variables; i++) exact[i] = (long double)state[i];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_links(t, exact, links);
  const int32_t which[2] = {pair.geometry, pair.other};
  cprox_body *bodies[2] = {NULL, NULL};
  for (int k = 0; k < 2; k++) {
    vec3l corner[TEST_VERTICES];
    vec3 v[TEST_VERTICES];
    robot_ref_vertices(t, links, (size_t)which[k], corner);
    for (size_t i = 0; i < TEST_VERTICES; i++)
      v[i] = vec((double)corner[i].x, (double)corner[i].y, (double)corner[i].z);
    assert_int_equal(cprox_body_create_polytope(v, TEST_VERTICES, ws, &bodies[k]), CPROX_OK);
  }
  const double margins = t->geometries[which[0]].margin + t->geometries[which[1]].margin;
  cprox_result r;
  assert_true(cprox_pair(cprox_obstacle_at(bodies[0], CPROX_POSE_IDENTITY),
                         cprox_with_margin(cprox_obstacle_at(bodies[1], CPROX_POSE_IDENTITY), margins), NULL, ws,
                         &r) >= 0);
  r.lower = fmax(r.lower, 0.0), r.upper = fmax(r.upper, 0.0);
  for (int k = 0; k < 2; k++) cprox_body_free(bodies[k]);
  return r;
}

/* 1000 robots (seed 4601), one pair each, in boxes of up to 1.2 rad or m a side: no state of 100 drawn from the box, its
 * corners among them, is nearer than `lower`, and the state of a contact is one. Tolerance: 1e-9 of a robot of a few
 * metres, for the rounding of the reference's vertices, and cprox_pair()'s epsilon of 1e-6. */
CASE(no_state_of_the_box_contradicts_the_answer) {
  rng r = rng_seed(4601);
  size_t seen[3] = {0, 0, 0};
  for (size_t i = 0; i < test_cases(1000); i++) {
    test_robot t;
    robot_make(&r, 0.5, &t);
    const int32_t a = (int32_t)rng_index(&r, t.n_links), b = (int32_t)rng_index(&r, t.n_links);
    const cprox_robot_pair pair = {a, b};
    double low[TEST_MAX_VARIABLES], high[TEST_MAX_VARIABLES], where[TEST_MAX_VARIABLES];
    const double side = rng_log_uniform(&r, 0.02, 1.2);
    for (size_t k = 0; k < t.n_variables; k++) {
      low[k] = rng_uniform(&r, -2.0, 2.0);
      high[k] = low[k] + (rng_index(&r, 5) ? rng_uniform(&r, 0.0, side) : 0.0);
    }
    const cprox_joint_box box = {low, high, t.n_variables};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.max_nodes = 4000;
    cprox_result found;
    const cprox_status status = cprox_robot_box_collision(t.robot, &pair, 1, &box, &options, ws, &found, where);
    if (a == b || status == CPROX_INVALID) {
      assert_true(a == b || strstr(cprox_workspace_error(ws), "floating"));
      robot_free(&t);
      continue;
    }
    assert_true(status >= 0);
    seen[found.verdict]++;
    assert_true((found.verdict == CPROX_VERDICT_CLEAR) == (found.lower > 0.0));
    for (size_t k = 0; k < t.n_variables; k++) assert_true(low[k] <= where[k] && where[k] <= high[k]);
    const cprox_result there = reference(&t, where, pair);
    assert_true(there.lower <= found.upper + 1e-9);
    if (found.verdict == CPROX_VERDICT_VIOLATED) assert_true(there.lower <= 1e-9);
    for (int k = 0; k < 100; k++) {
      double drawn[TEST_MAX_VARIABLES];
      for (size_t v = 0; v < t.n_variables; v++)
        drawn[v] = k % 4 == 0 ? (rng_index(&r, 2) ? low[v] : high[v]) : rng_uniform(&r, low[v], high[v]);
      assert_true(reference(&t, drawn, pair).upper >= found.lower - 1e-9);
    }
    robot_free(&t);
  }
  assert_true(seen[CPROX_VERDICT_CLEAR] > test_cases(50) && seen[CPROX_VERDICT_VIOLATED] > test_cases(30));
}

/* Two arms of 1 m and .6 m in a plane with balls at the base and at the tip: their distance depends on the second joint
 * alone, by the law of cosines. */
static cprox_robot *make_arm(const cprox_body *ball) {
  const cprox_pose along = {{1.0, 0, 0}, {1, 0, 0, 0}}, tip = {{0.6, 0, 0}, {1, 0, 0, 0}};
  const cprox_link links[3] = {
      {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY},
      {.parent = 0, .type = CPROX_JOINT_REVOLUTE, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0},
      {.parent = 1,
       .type = CPROX_JOINT_REVOLUTE,
       .origin = along,
       .axis = {0, 0, 1},
       .variable = 1,
       .multiplier = 1.0}};
  const cprox_link_geometry geometries[2] = {{.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 0},
                                             {.body = ball, .pose = tip, .link = 2}};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, 3, geometries, 2, 2, ws, &robot), CPROX_OK);
  return robot;
}

CASE(the_verdict_changes_where_the_law_of_cosines_says) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.25, ws, &ball), CPROX_OK);
  cprox_robot *robot = make_arm(ball);
  const cprox_robot_pair pair = {0, 1};
  for (double most = 0.5; most < 3.1; most += 0.1) {
    const double low[2] = {-3, -0.3}, high[2] = {3, most}, least = sqrt(1.36 + 1.2 * cos(most)) - 0.5;
    const cprox_joint_box box = {low, high, 2};
    cprox_result found;
    double where[2];
    assert_true(cprox_robot_box_collision(robot, &pair, 1, &box, NULL, ws, &found, where) >= 0);
    assert_int_equal(found.verdict, least > 0.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
    assert_true(found.lower <= fmax(least, 0.0) + 1e-12 && found.upper >= fmax(least, 0.0) - 1e-12);
    if (least <= 0.0) assert_true(sqrt(1.36 + 1.2 * cos(where[1])) <= 0.5 + 1e-9);
  }
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* A joint carries two balls, .1 and 1.5 m from its axis, or a rod of twice 1.5 m. The outer ball, or the rod's end, turns
 * straight towards a ball that it touches at the end of the box alone, with the budget of one box: nothing looks for
 * contact, and the bound of the whole box must not call it clear. The joint is the variable, or goes twice as far. */
CASE(the_bound_of_a_box_reaches_to_its_end) {
  enum { PARTS = 2 };
  static const double RADIUS = 0.05, INNER = 0.1, ARM = 1.5, THICK = 0.02;
  cprox_body *ball = NULL, *both = NULL, *rod = NULL;
  assert_int_equal(cprox_body_create_sphere(RADIUS, ws, &ball), CPROX_OK);
  const cprox_body *parts[PARTS] = {ball, ball};
  const cprox_pose places[PARTS] = {{{INNER, 0, 0}, {1, 0, 0, 0}}, {{ARM, 0, 0}, {1, 0, 0, 0}}};
  assert_int_equal(cprox_body_create_compound(parts, places, PARTS, ws, &both), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(2.0 * ARM, THICK, THICK), ws, &rod), CPROX_OK);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_nodes = 1;
  size_t clear = 0;
  for (int k = 0; k < 160; k++) {
    const double end = 0.05 * (1 + k / 8), multiplier = 1 + k % 2, low = 0.0, high = end / multiplier;
    const bool is_rod = k / 2 % 2, touches = k / 4 % 2;
    const double beyond = touches ? 0.0 : 2.0; /* so far away a whole box is clear */
    const cprox_link links[2] = {{.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY},
                                 {.parent = 0,
                                  .type = CPROX_JOINT_REVOLUTE,
                                  .origin = CPROX_POSE_IDENTITY,
                                  .axis = {0, 0, 1},
                                  .multiplier = multiplier}};
    const cprox_link_geometry geometries[2] = {
        {.body = ball, .pose = {{ARM * cos(end + beyond), ARM * sin(end + beyond), 0}, {1, 0, 0, 0}}, .link = 0},
        {.body = is_rod ? rod : both, .pose = CPROX_POSE_IDENTITY, .link = 1}};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(links, 2, geometries, 2, 1, ws, &robot), CPROX_OK);
    const cprox_joint_box box = {&low, &high, 1};
    for (int turned = 0; turned < 2; turned++) { /* either may be the first of the pair */
      const cprox_robot_pair pair = {turned, 1 - turned};
      cprox_result found;
      assert_true(cprox_robot_box_collision(robot, &pair, 1, &box, &options, ws, &found, NULL) >= 0);
      if (touches) assert_int_not_equal(found.verdict, CPROX_VERDICT_CLEAR);
      clear += found.verdict == CPROX_VERDICT_CLEAR;
    }
    cprox_robot_free(robot);
  }
  assert_true(clear > 40);
  cprox_body_free(rod);
  cprox_body_free(both);
  cprox_body_free(ball);
}

/* A ball on an arm passes another one by a small gap in the second half of its box, and only there. */
CASE(both_halves_of_a_box_that_is_cut_count) {
  static const double RADIUS = 0.05, ARM = 1.0, GAP = 1e-3, END = 2.0;
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(RADIUS, ws, &ball), CPROX_OK);
  for (int k = 0; k < 20; k++) {
    const double at = k % 2 ? 0.3 + 0.02 * k : 1.3 + 0.02 * k, beyond = ARM + 2.0 * RADIUS + GAP, low = 0.0;
    const cprox_link links[2] = {{.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY},
                                 {.parent = 0,
                                  .type = CPROX_JOINT_REVOLUTE,
                                  .origin = CPROX_POSE_IDENTITY,
                                  .axis = {0, 0, 1},
                                  .multiplier = 1.0}};
    const cprox_link_geometry geometries[2] = {
        {.body = ball, .pose = {{beyond * cos(at), beyond * sin(at), 0}, {1, 0, 0, 0}}, .link = 0},
        {.body = ball, .pose = {{ARM, 0, 0}, {1, 0, 0, 0}}, .link = 1}};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(links, 2, geometries, 2, 1, ws, &robot), CPROX_OK);
    const cprox_joint_box box = {&low, &END, 1};
    const cprox_robot_pair pair = {0, 1};
    cprox_result found;
    assert_int_equal(cprox_robot_box_collision(robot, &pair, 1, &box, NULL, ws, &found, NULL), CPROX_OK);
    assert_int_equal(found.verdict, CPROX_VERDICT_CLEAR);
    assert_true(found.lower <= GAP + 1e-9);
    cprox_robot_free(robot);
  }
  cprox_body_free(ball);
}

CASE(a_budget_that_is_used_up_leaves_the_verdict_open) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.2, ws, &ball), CPROX_OK); /* they come to 0 m of each other, not nearer */
  cprox_robot *robot = make_arm(ball);
  const cprox_robot_pair pair = {0, 1};
  const double low[2] = {-3, -3.2}, high[2] = {3, 3.2};
  const cprox_joint_box box = {low, high, 2};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_nodes = 20;
  cprox_result found;
  assert_int_equal(cprox_robot_box_collision(robot, &pair, 1, &box, &options, ws, &found, NULL), CPROX_BUDGET);
  assert_int_equal(found.verdict, CPROX_VERDICT_UNDECIDED);
  assert_true(found.lower == 0.0 && found.upper > 0.0);
  assert_true(strlen(cprox_workspace_error(ws)) > 0);
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

CASE(a_box_that_is_none_is_refused) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.2, ws, &ball), CPROX_OK);
  cprox_robot *robot = make_arm(ball);
  const double low[2] = {0, 1}, high[2] = {1, 0}, nan[2] = {0, NAN};
  const cprox_joint_box upside_down = {low, high, 2}, narrow = {low, low, 1}, none = {low, nan, 2},
                        good = {low, low, 2};
  const cprox_robot_pair pair = {0, 1}, same = {1, 1}, missing = {0, 7};
  const struct {
    const cprox_joint_box *box;
    cprox_robot_pair pair;
    const char *why;
  } cases[] = {{&upside_down, pair, "variable 1"}, {&narrow, pair, "1 variables"},
               {&none, pair, "variable 1"},        {&good, same, "pair 0"},
               {&good, missing, "pair 0"},         {NULL, pair, "box"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    cprox_result found = {.nodes = 7};
    assert_int_equal(cprox_robot_box_collision(robot, &cases[i].pair, 1, cases[i].box, NULL, ws, &found, NULL),
                     CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), cases[i].why));
    assert_int_equal(found.nodes, 7);
  }
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.relative_epsilon = 0.1;
  cprox_result found;
  assert_int_equal(cprox_robot_box_collision(robot, &pair, 1, &good, &options, ws, &found, NULL), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "relative_epsilon"));
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
