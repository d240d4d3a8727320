/* SPDX-License-Identifier: BSD-3-Clause */
/* States of a robot: held against its kinematics in long double and against motions that go nowhere. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "kinematics/motion.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robot_case.h"
#include "support/robots.h"

enum { MOST_STATES = 8 };

/* A geometry of the robot in the world, as a polytope. */
static cprox_body *placed(const test_robot *t, const ref_pose *links, size_t geometry) {
  vec3l exact[TEST_VERTICES];
  vec3 v[TEST_VERTICES];
  robot_ref_vertices(t, links, geometry, exact);
  for (size_t i = 0; i < TEST_VERTICES; i++) v[i] = vec((double)exact[i].x, (double)exact[i].y, (double)exact[i].z);
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polytope(v, TEST_VERTICES, ws, &body), CPROX_OK);
  return body;
}

/* The distance of two bodies in the world, margins of the robot included; 0 where they overlap. */
static cprox_result between(const cprox_body *a, const cprox_body *b, double margins) {
  cprox_result r;
  const cprox_obstacle x = cprox_obstacle_at(a, CPROX_POSE_IDENTITY),
                       y = cprox_with_margin(cprox_obstacle_at(b, CPROX_POSE_IDENTITY), margins);
  assert_true(cprox_pair(x, y, NULL, ws, &r) >= 0);
  r.lower = fmax(r.lower, 0.0), r.upper = fmax(r.upper, 0.0);
  return r;
}

static void random_state(rng *r, const test_robot *t, double *values, long double *exact) {
  for (size_t i = 0; i < t->n_variables; i++) values[i] = rng_uniform(r, -2.0, 2.0);
  for (size_t i = 0; i < t->n_variables; i++) exact[i] = (long double)values[i];
}

/* 400 robots (seed 301), each at 8 states, all by one call: the interval holds the distance that the long double
 * kinematics gives, to the obstacle and of all pairs of links with two joints between them. Tolerance: 1e-9 of a robot
 * of a few metres, for the rounding of the reference's vertices and cprox_pair()'s epsilon of 1e-6 on either side. */
CASE(a_state_is_where_forward_kinematics_puts_it) {
  rng r = rng_seed(301);
  size_t near = 0;
  for (size_t i = 0; i < test_cases(400); i++) {
    test_robot t;
    robot_make(&r, 0.5, &t);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec(0.3, 0.4, 0.5), ws, &box), CPROX_OK);
    cprox_obstacle target = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
    target.pose.position = rng_in_cube(&r, 1.5);
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, i % 2 ? CPROX_INDEX_BVH : CPROX_INDEX_NONE, ws, &set),
                     CPROX_OK);

    double states[MOST_STATES][TEST_MAX_VARIABLES], packed[MOST_STATES * TEST_MAX_VARIABLES];
    long double exact[MOST_STATES][TEST_MAX_VARIABLES];
    for (size_t k = 0; k < MOST_STATES; k++) {
      random_state(&r, &t, states[k], exact[k]);
      memcpy(packed + k * t.n_variables, states[k], t.n_variables * sizeof(double));
    }
    cprox_robot_pair all[TEST_MAX_LINKS * TEST_MAX_LINKS], scene[TEST_MAX_LINKS];
    size_t n_all = 0;
    for (size_t a = 0; a < t.n_links; a++) {
      scene[a] = (cprox_robot_pair){(int32_t)a, 0};
      for (size_t b = 0; b < a; b++) all[n_all++] = (cprox_robot_pair){(int32_t)a, (int32_t)b};
    }
    cprox_result results[MOST_STATES], selves[MOST_STATES], both[MOST_STATES];
    cprox_state_query q = {
        .obstacles = set, .pairs = scene, .n_pairs = t.n_links, .without_self = true, .distance = true};
    assert_true(cprox_robot_ask_states(t.robot, &q, packed, MOST_STATES, ws, results, NULL) >= 0);
    q = (cprox_state_query){.self_pairs = all, .n_self_pairs = n_all, .distance = true};
    assert_true(cprox_robot_ask_states(t.robot, &q, packed, MOST_STATES, ws, selves, NULL) >= 0);
    q.obstacles = set, q.pairs = scene, q.n_pairs = t.n_links;
    bool about_self[MOST_STATES];
    assert_true(cprox_robot_ask_states(t.robot, &q, packed, MOST_STATES, ws, both, about_self) >= 0);

    for (size_t k = 0; k < MOST_STATES; k++) {
      ref_pose links[TEST_MAX_LINKS];
      robot_ref_links(&t, exact[k], links);
      cprox_body *bodies[TEST_MAX_LINKS];
      cprox_result to_scene = {.lower = INFINITY, .upper = INFINITY}, to_self = to_scene;
      for (size_t a = 0; a < t.n_links; a++) bodies[a] = placed(&t, links, a);
      for (size_t a = 0; a < t.n_links; a++) {
        cprox_result one;
        assert_true(
            cprox_pair(cprox_with_margin(cprox_obstacle_at(bodies[a], CPROX_POSE_IDENTITY), t.geometries[a].margin),
                       target, NULL, ws, &one) >= 0);
        to_scene.lower = fmin(to_scene.lower, fmax(one.lower, 0.0));
        to_scene.upper = fmin(to_scene.upper, fmax(one.upper, 0.0));
        for (size_t b = 0; b < a; b++) {
          one = between(bodies[a], bodies[b], t.geometries[a].margin + t.geometries[b].margin);
          to_self.lower = fmin(to_self.lower, one.lower), to_self.upper = fmin(to_self.upper, one.upper);
        }
      }
      const double room = 1e-9;
      assert_true(results[k].lower <= to_scene.upper + room && to_scene.lower <= results[k].upper + room);
      assert_true(results[k].upper - results[k].lower <= 2e-6);
      if (n_all > 0) assert_true(selves[k].lower <= to_self.upper + room && to_self.lower <= selves[k].upper + room);
      assert_true(both[k].lower == fmin(results[k].lower, selves[k].lower));
      assert_true(both[k].upper == fmin(results[k].upper, selves[k].upper));
      assert_int_equal(about_self[k], selves[k].upper < results[k].upper);
      near += results[k].lower < 0.3;
      for (size_t a = 0; a < t.n_links; a++) cprox_body_free(bodies[a]);
    }

    /* verdicts on either side of the distance */
    for (int side = 0; side < 2; side++) {
      const double least = both[0].upper;
      if (!(least > 1e-3) || isinf(least)) continue;
      q.distance = false, q.delta = least * (side ? 1.01 : 0.99);
      assert_int_equal(cprox_robot_ask_states(t.robot, &q, packed, 1, ws, results, NULL), CPROX_OK);
      assert_int_equal(results[0].verdict, side ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      assert_true(results[0].lower <= both[0].upper && both[0].lower <= results[0].upper);
      assert_true(side ? results[0].upper <= q.delta : results[0].lower > q.delta);

      /* many in one call, which share what does not change, are those of one call each */
      cprox_result alone;
      assert_true(cprox_robot_ask_states(t.robot, &q, packed, MOST_STATES, ws, results, NULL) >= 0);
      for (size_t k = 0; k < MOST_STATES; k++) {
        assert_true(cprox_robot_ask_states(t.robot, &q, packed + k * t.n_variables, 1, ws, &alone, NULL) >= 0);
        assert_int_equal(results[k].verdict, alone.verdict);
        assert_true(results[k].lower <= both[k].upper && both[k].lower <= results[k].upper);
      }

      /* and the next call is about its own obstacles */
      cprox_obstacle aside = target;
      aside.pose.position.x -= 0.7;
      cprox_obstacles *others = NULL;
      assert_int_equal(cprox_obstacles_create(&aside, 1, CPROX_INDEX_NONE, ws, &others), CPROX_OK);
      cprox_state_query next = {.obstacles = others, .pairs = scene, .n_pairs = t.n_links, .without_self = true};
      q.without_self = true;
      for (size_t k = 0; k < MOST_STATES; k++) {
        cprox_result apart;
        next.distance = true;
        assert_true(cprox_robot_ask_states(t.robot, &next, packed + k * t.n_variables, 1, ws, &apart, NULL) >= 0);
        next.distance = false, next.delta = q.delta;
        assert_true(cprox_robot_ask_states(t.robot, &q, packed, MOST_STATES, ws, results, NULL) >= 0);
        assert_true(cprox_robot_ask_states(t.robot, &next, packed + k * t.n_variables, 1, ws, &alone, NULL) >= 0);
        assert_true(alone.lower <= apart.upper && apart.lower <= alone.upper);
        if (alone.verdict == CPROX_VERDICT_CLEAR) assert_true(apart.upper > q.delta);
      }
      q.without_self = false;
      cprox_obstacles_free(others);
    }
    cprox_obstacles_free(set);
    cprox_body_free(box);
    robot_free(&t);
  }
  assert_true(near > test_cases(100));
}

/* 300 robots (seed 302): a state changed by motion_set_state() answers as one that was made so, and as a motion through
 * the same waypoint twice; both intervals hold the same distance. */
CASE(a_state_answers_as_a_motion_of_no_length) {
  rng r = rng_seed(302);
  for (size_t i = 0; i < test_cases(300); i++) {
    test_robot t;
    robot_make(&r, 0.5, &t);
    double values[TEST_MAX_VARIABLES];
    long double exact[TEST_MAX_VARIABLES];
    int32_t variables[TEST_MAX_VARIABLES];
    random_state(&r, &t, values, exact);
    for (int32_t v = 0; v < TEST_MAX_VARIABLES; v++) variables[v] = v;
    const cprox_waypoint twice[2] = {{.time = 0.0, .positions = values}, {.time = 1.0, .positions = values}};
    const cprox_motion_description still = {
        .variables = variables, .n_variables = t.n_variables, .waypoints = twice, .n_waypoints = 2};
    const cprox_motion_description posture = {.kind = CPROX_MOTION_STATE, .rest = values},
                                   rest = {.kind = CPROX_MOTION_STATE, .rest = t.rest};
    cprox_motion *motion = NULL, *made = NULL, *changed = NULL;
    assert_int_equal(cprox_motion_create(t.robot, &still, ws, &motion), CPROX_OK);
    assert_int_equal(cprox_motion_create(t.robot, &posture, ws, &made), CPROX_OK);
    assert_int_equal(cprox_motion_create(t.robot, &rest, ws, &changed), CPROX_OK);
    assert_int_equal(cprox_motion_get_info(made).kind, CPROX_MOTION_STATE);
    assert_int_equal(motion_set_state(changed, values, ws), CPROX_OK);
    cprox_robot_pair pairs[TEST_MAX_LINKS * TEST_MAX_LINKS];
    size_t n = 0;
    for (int32_t a = 0; a < (int32_t)t.n_links; a++)
      for (int32_t b = 0; b < a; b++) pairs[n++] = (cprox_robot_pair){a, b};
    const cprox_motion *const motions[3] = {motion, made, changed};
    cprox_result results[3];
    for (int k = 0; k < 3; k++)
      assert_true(cprox_obstacles_distance(NULL, cprox_robot_self(motions[k], pairs, n), NULL, ws, &results[k], NULL) >=
                  0);
    assert_true(results[1].lower == results[2].lower && results[1].upper == results[2].upper);
    assert_true(results[0].lower <= results[1].upper && results[1].lower <= results[0].upper);
    for (size_t v = 0; v < t.n_variables; v++) {
      assert_true(cprox_motion_get_variable_info(changed, v).lowest == values[v]);
      assert_true(cprox_motion_get_variable_info(changed, v).highest == values[v]);
    }
    cprox_motion_free(motion);
    cprox_motion_free(made);
    cprox_motion_free(changed);
    robot_free(&t);
  }
}

/* A refused state leaves the one before; the message says what is wrong. */
CASE(a_state_that_is_refused_changes_nothing) {
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  cprox_link links[2] = {{.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = CPROX_POSE_IDENTITY, .variable = 0},
                         {.parent = 0,
                          .type = CPROX_JOINT_PRISMATIC,
                          .origin = CPROX_POSE_IDENTITY,
                          .axis = vec(0, 0, 1),
                          .variable = 7,
                          .multiplier = 1.0}};
  const cprox_link_geometry geometry = {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 1};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, 2, &geometry, 1, 8, ws, &robot), CPROX_OK);
  const double good[8] = {1, 2, 3, 0, 0, 0, 1, 0.5}, zero[8] = {0}, nan[8] = {0, 0, 0, 0, 0, 0, 1, NAN},
               far[8] = {0, 0, 0, 0, 0, 0, 1, 1e90};
  const cprox_motion_description posture = {.kind = CPROX_MOTION_STATE, .rest = good};
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_motion_create(robot, &posture, ws, &motion), CPROX_OK);
  const double *const bad[3] = {zero, nan, far};
  const char *const why[3] = {"quaternion", "variable 7", "at most"};
  const cprox_obstacle target = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);
  cprox_result before, after;
  assert_int_equal(cprox_distance(cprox_robot_along(motion, NULL, 0), target, NULL, ws, &before), CPROX_OK);
  for (int k = 0; k < 3; k++) {
    assert_int_equal(motion_set_state(motion, bad[k], ws), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), why[k]));
    assert_int_equal(cprox_distance(cprox_robot_along(motion, NULL, 0), target, NULL, ws, &after), CPROX_OK);
    assert_true(before.lower == after.lower && before.upper == after.upper);
    cprox_state_query q = {.without_self = true};
    assert_int_equal(cprox_robot_ask_states(robot, &q, bad[k], 1, ws, &after, NULL), CPROX_INVALID);
  }
  assert_int_equal(motion_set_state(motion, NULL, ws), CPROX_INVALID);
  cprox_motion_free(motion);

  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = good}, {.time = 1.0, .positions = good}};
  const int32_t variables[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const cprox_motion_description moving = {
      .variables = variables, .n_variables = 8, .waypoints = ends, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(robot, &moving, ws, &motion), CPROX_OK);
  assert_int_equal(motion_set_state(motion, good, ws), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "is no state"));
  cprox_motion_free(motion);
  cprox_state_query q = {.delta = 0.0};
  assert_int_equal(cprox_robot_ask_states(robot, &q, NULL, 1, ws, &after, NULL), CPROX_INVALID);
  assert_int_equal(cprox_robot_ask_states(NULL, &q, good, 1, ws, &after, NULL), CPROX_INVALID);
  assert_int_equal(cprox_robot_ask_states(robot, &q, NULL, 0, ws, NULL, NULL), CPROX_OK);
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* A UR5 by its own meshes: of surfaces that cross, the first two triangles that do end the search for a contact. */
CASE(a_state_in_contact_measures_few_distances) {
  static robot_case c;
  assert_true(robot_case_read_robot(TEST_DATA_DIR "/motion", "ur5", &c));
  rng r = rng_seed(93);
  const cprox_state_query asked = {.self_pairs = c.self_pairs, .n_self_pairs = c.n_self_pairs};
  uint32_t all = 0, most = 0;
  size_t violated = 0;
  for (int i = 0; i < 200; i++) {
    double values[CASE_MAX_VARIABLES] = {0};
    for (size_t k = 0; k < c.n_variables; k++) values[k] = rng_uniform(&r, -3.14159, 3.14159);
    cprox_result found;
    assert_int_equal(cprox_robot_ask_states(c.mesh_robot, &asked, values, 1, ws, &found, NULL), CPROX_OK);
    violated += found.verdict == CPROX_VERDICT_VIOLATED;
    all += found.distance_queries;
    most = found.distance_queries > most ? found.distance_queries : most;
  }
  print_message("%zu of 200 states in contact: %u distances, %u of one\n", violated, all, most);
  assert_true(violated > 20 && violated < 180);
  assert_true(all < 1500 && most < 300);
  robot_case_free(&c);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
