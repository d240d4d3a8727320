/* SPDX-License-Identifier: BSD-3-Clause */
/* What a motion does not move counts: every link against obstacles, and pairs of the robot between which joints can
 * move. Against the same question of one state, and against each pair by itself. */
#include <math.h>

#include "kinematics/motion.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

/* ---- an arm: two links of 1 m, a joint before each; both hang down the x axis at 0 ---- */

enum { JOINTS = 2 };

typedef struct arm {
  cprox_body *rod, *ball;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_obstacle target;
} arm;

/* The ball stands round the middle of the first link, or `away` from it. */
static arm make_arm(const double from[JOINTS], const double to[JOINTS], double away) {
  arm a = {0};
  const cprox_vec3 axis = {0, 0, 1};
  const cprox_link links[JOINTS] = {{.parent = -1,
                                     .type = CPROX_JOINT_REVOLUTE,
                                     .origin = CPROX_POSE_IDENTITY,
                                     .axis = axis,
                                     .variable = 0,
                                     .multiplier = 1.0},
                                    {.parent = 0,
                                     .type = CPROX_JOINT_REVOLUTE,
                                     .origin = {{1, 0, 0}, {.w = 1.0}},
                                     .axis = axis,
                                     .variable = 1,
                                     .multiplier = 1.0}};
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.9, 0.1, 0.1}, ws, &a.rod), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &a.ball), CPROX_OK);
  const cprox_pose middle = {{0.5, 0, 0}, {.w = 1.0}};
  const cprox_link_geometry geometries[JOINTS] = {{.body = a.rod, .pose = middle, .link = 0},
                                                  {.body = a.rod, .pose = middle, .link = 1}};
  assert_int_equal(cprox_robot_create(links, JOINTS, geometries, JOINTS, JOINTS, ws, &a.robot), CPROX_OK);
  const int32_t variables[JOINTS] = {0, 1};
  const cprox_waypoint points[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = variables,
                                      .n_variables = JOINTS,
                                      .waypoints = points,
                                      .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(a.robot, &d, ws, &a.motion), CPROX_OK);
  a.target = cprox_obstacle_at(a.ball, (cprox_pose){{0.5, away, 0}, {.w = 1.0}});
  return a;
}

static void free_arm(arm *a) {
  cprox_motion_free(a->motion);
  cprox_robot_free(a->robot);
  cprox_body_free(a->rod);
  cprox_body_free(a->ball);
}

static void is_in_contact_all_the_time(const arm *a) {
  const cprox_mover mover = cprox_robot_along(a->motion, NULL, 0);
  cprox_result r;
  size_t count = 0;
  assert_int_equal(distance_of_list(mover, &a->target, 1, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(r.upper == 0.0 && r.mover_part == 0 && r.obstacle_index == 0);
  assert_int_equal(collision_of_list(mover, &a->target, 1, NULL, ws, &r, NULL), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
  assert_int_equal(time_of_contact_of_list(mover, &a->target, 1, NULL, ws, &r), CPROX_OK);
  assert_true(r.verdict == CPROX_VERDICT_VIOLATED && r.t == 0.0);
  cprox_result near[2];
  assert_int_equal(nearest_pairs_of_list(mover, &a->target, 1, 2, INFINITY, NULL, ws, near, &count), CPROX_OK);
  assert_true(count == 2 && near[0].upper == 0.0 && near[0].mover_part == 0);

  const double breaks[4] = {0.0, 0.25, 0.5, 1.0};
  cprox_profile_interval intervals[3];
  assert_int_equal(profile_of_list(mover, &a->target, 1, breaks, 3, NULL, ws, intervals), CPROX_OK);
  for (int i = 0; i < 3; i++) assert_true(intervals[i].upper == 0.0 && intervals[i].mover_part == 0);
  cprox_violation list[4];
  cprox_violations violations = {.list = list, .room = 4};
  assert_int_equal(violations_of_list(mover, &a->target, 1, 0.0, 1e-3, NULL, ws, &violations), CPROX_OK);
  assert_true(violations.count == 1 && list[0].verdict == CPROX_VERDICT_VIOLATED);
  assert_true(list[0].enter_upper == 0.0 && list[0].leave_lower == 1.0);
}

CASE(a_ball_round_a_link_that_stands_is_in_contact_while_others_move) {
  arm a = make_arm((const double[]){0, 0}, (const double[]){0, 1}, 0.0);
  is_in_contact_all_the_time(&a);
  free_arm(&a);
}

CASE(the_same_posture_twice_is_as_far_as_that_posture) {
  arm a = make_arm((const double[]){0, 0}, (const double[]){0, 0}, 0.0);
  is_in_contact_all_the_time(&a);
  free_arm(&a);
  a = make_arm((const double[]){0, 0.2}, (const double[]){0, 0.2}, 0.4);
  cprox_result r;
  const cprox_mover mover = cprox_robot_along(a.motion, NULL, 0);
  assert_int_equal(distance_of_list(mover, &a.target, 1, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(fabs(r.upper - 0.25) <= 1e-6 && r.upper - r.lower <= 1e-6 && r.nodes == 1);
  assert_int_equal(tolerance_of_list(mover, &a.target, 1, 0.24, NULL, ws, &r, NULL), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  assert_int_equal(time_of_contact_of_list(mover, &a.target, 1, NULL, ws, &r), CPROX_OK);
  assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  free_arm(&a);
}

/* The first link could turn and does not: a step of a waypoint lets it come nearer at one time of many. */
CASE(what_stands_has_no_gradient_where_the_motion_could_move_it) {
  arm a = make_arm((const double[]){0, 0}, (const double[]){0, 1}, 0.2);
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(&a.target, 1, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  double positions[2 * JOINTS];
  cprox_motion_gradient gradient = {.positions = positions};
  cprox_result r;
  assert_true(cprox_robot_distance_gradient(all, cprox_robot_along(a.motion, NULL, 0), NULL, ws, &r, &gradient) >= 0);
  assert_true(!gradient.valid && fabs(r.upper - 0.05) <= 1e-6);
  cprox_obstacles_free(all);
  free_arm(&a);
}

/* ---- random robots ---- */

enum { TARGETS = 3, MOST_PAIRS = TEST_MAX_LINKS * (TEST_MAX_LINKS + TARGETS) };

/* Some of the variables stand. */
static void stop_some(rng *r, test_robot *t) {
  for (size_t v = 0; v < t->n_variables; v++) {
    if (rng_index(r, 2)) continue;
    for (size_t i = 1; i < t->n_points; i++) {
      t->positions[i][v] = t->positions[0][v];
      t->velocities[i][v] = t->accelerations[i][v] = 0.0;
    }
    t->velocities[0][v] = t->accelerations[0][v] = 0.0;
  }
  robot_rebuild(t);
}

/* A robot that stands in part, among balls; false: it moves along a spline, which cannot. */
static bool make_scene(rng *r, test_robot *t, cprox_obstacle targets[TARGETS]) {
  robot_make(r, 1.0, t);
  if (t->spline) {
    robot_free(t);
    return false;
  }
  stop_some(r, t);
  for (int k = 0; k < TARGETS; k++) {
    cprox_body *ball;
    assert_int_equal(cprox_body_create_sphere(rng_uniform(r, 0.01, 0.2), ws, &ball), CPROX_OK);
    targets[k] = cprox_obstacle_at(ball, (cprox_pose){rng_in_cube(r, 2.0), {.w = 1.0}});
  }
  return true;
}

static void free_scene(test_robot *t, const cprox_obstacle targets[TARGETS]) {
  for (int k = 0; k < TARGETS; k++) cprox_body_free((cprox_body *)targets[k].body);
  robot_free(t);
}

static double least_of_pairs(const test_robot *t, bool self, const cprox_obstacle *targets, const cprox_options *o,
                             size_t *standing) {
  double least = INFINITY;
  for (int32_t g = 0; g < (int32_t)t->n_links; g++)
    for (int32_t k = 0; k < (self ? g : TARGETS); k++) {
      const cprox_robot_pair pair = {g, k};
      const cprox_link_info info = cprox_motion_get_link_info(t->motion, g, self ? k : -1);
      if (self && info.n_joints < 2) continue;
      *standing += info.n_moved == 0;
      cprox_result r;
      const cprox_mover mover = self ? cprox_robot_self(t->motion, &pair, 1) : cprox_robot_along(t->motion, &pair, 1);
      assert_true(distance_of_list(mover, self ? NULL : targets, self ? 0 : TARGETS, o, ws, &r, NULL) >= 0);
      least = fmin(least, r.upper);
    }
  return least;
}

CASE(all_pairs_at_once_are_as_far_as_the_nearest_alone) {
  rng r = rng_seed(4471);
  size_t standing = 0, answered = 0;
  for (size_t i = 0; i < test_cases(150); i++) {
    test_robot t;
    cprox_obstacle targets[TARGETS];
    if (!make_scene(&r, &t, targets)) continue;
    const cprox_options o = accurate(1e-6);
    for (int self = 0; self < 2; self++) {
      const double least = least_of_pairs(&t, self, targets, &o, &standing);
      const cprox_mover mover = self ? cprox_robot_self(t.motion, NULL, 0) : cprox_robot_along(t.motion, NULL, 0);
      for (int index = 0; index < 2; index++) {
        cprox_obstacles *all = NULL;
        if (!self)
          assert_int_equal(
              cprox_obstacles_create(targets, TARGETS, index ? CPROX_INDEX_BVH : CPROX_INDEX_NONE, ws, &all), CPROX_OK);
        cprox_result d, v;
        assert_true(cprox_obstacles_distance(all, mover, &o, ws, &d, NULL) >= 0);
        if (isinf(least)) {
          assert_true(isinf(d.lower));
        } else {
          if (!(d.lower <= least && least <= d.upper + 2e-6))
            fail_msg("robot %zu: [%.9g, %.9g], the pairs say %.9g", i, d.lower, d.upper, least);
          for (int side = 0; side < 2 && least > 1e-3; side++) {
            assert_true(cprox_obstacles_tolerance(all, mover, (side ? 1.01 : 0.99) * least, &o, ws, &v, NULL) >= 0);
            assert_int_equal(v.verdict, side ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
          }
          assert_true(cprox_obstacles_time_of_contact(all, mover, &o, ws, &v) >= 0);
          if (least > 1e-5) assert_int_equal(v.verdict, CPROX_VERDICT_CLEAR);
          const cprox_motion_info info = cprox_motion_get_info(t.motion);
          const double breaks[3] = {info.t0, 0.5 * (info.t0 + info.t1), info.t1};
          cprox_profile_interval two[2];
          if (all || self) {
            assert_true(cprox_obstacles_profile(all, mover, breaks, 2, INFINITY, &o, ws, two) >= 0);
            assert_true(fabs(fmin(two[0].upper, two[1].upper) - least) <= 4e-6);
          }
          answered++;
        }
        cprox_obstacles_free(all);
        if (self) break;
      }
    }
    free_scene(&t, targets);
  }
  print_message("%zu answers, %zu pairs stand\n", answered, standing);
  assert_true(answered > test_cases(150) / 2 && standing > test_cases(150) / 2);
}

/* ---- some pairs of all ---- */

enum { MOST_VIOLATIONS = 64 };

/* Whether t may be in one of the intervals. */
static bool contains(const cprox_violations *v, double t) {
  for (size_t i = 0; i < v->count; i++)
    if (v->list[i].enter_lower <= t && t <= v->list[i].leave_upper) return true;
  return false;
}

static double least_of_profile(const test_robot *t, const cprox_obstacle *targets, const cprox_robot_pair *pairs,
                               size_t n, const cprox_options *o) {
  const cprox_motion_info info = cprox_motion_get_info(t->motion);
  const double breaks[3] = {info.t0, info.t0 + 0.3 * (info.t1 - info.t0), info.t1};
  cprox_profile_interval two[2];
  assert_true(profile_of_list(cprox_robot_along(t->motion, pairs, n), targets, TARGETS, breaks, 2, o, ws, two) >= 0);
  return fmin(two[0].upper, two[1].upper);
}

/* A list has moving pairs alone, standing pairs alone, or both: each is taken for what it is. */
CASE(a_list_of_pairs_is_violated_when_one_of_its_pairs_is) {
  rng r = rng_seed(90210);
  size_t lists[3] = {0}, violated = 0;
  for (size_t i = 0; i < test_cases(400); i++) {
    test_robot t;
    cprox_obstacle targets[TARGETS];
    if (!make_scene(&r, &t, targets)) continue;
    cprox_robot_pair pairs[MOST_PAIRS];
    size_t n = 0, moving = 0;
    const size_t wanted = rng_index(&r, 3); /* what moves, what stands, any */
    for (int32_t g = 0; g < (int32_t)t.n_links; g++) {
      const bool moves = cprox_motion_get_link_info(t.motion, g, -1).n_moved > 0;
      for (int32_t k = 0; k < TARGETS; k++)
        if ((wanted == 2 || moves == (wanted == 0)) && rng_index(&r, 2)) {
          pairs[n++] = (cprox_robot_pair){g, k};
          moving += moves;
        }
    }
    if (n > 0) {
      lists[moving == n ? 0 : moving == 0 ? 1 : 2]++;
      const cprox_options o = accurate(1e-6);
      double least = INFINITY, profile = INFINITY;
      cprox_result d;
      for (size_t k = 0; k < n; k++) {
        const cprox_mover alone = cprox_robot_along(t.motion, &pairs[k], 1);
        assert_true(distance_of_list(alone, targets, TARGETS, &o, ws, &d, NULL) >= 0);
        least = fmin(least, d.upper);
        profile = fmin(profile, least_of_profile(&t, targets, &pairs[k], 1, &o));
      }
      assert_true(fabs(profile - least) <= 4e-6);
      assert_true(fabs(least_of_profile(&t, targets, pairs, n, &o) - least) <= 4e-6);

      const double delta = least + rng_uniform(&r, -0.5, 1.0) * fmax(least, 0.05);
      cprox_violation listed[MOST_VIOLATIONS], single[MOST_VIOLATIONS];
      cprox_violations all = {.list = listed, .room = MOST_VIOLATIONS};
      if (delta >= 0.0) {
        const cprox_mover mover = cprox_robot_along(t.motion, pairs, n);
        assert_int_equal(violations_of_list(mover, targets, TARGETS, delta, 1e-4, &o, ws, &all), CPROX_OK);
        violated += all.count > 0;
        if (delta < least - 1e-5) assert_int_equal(all.count, 0);
        if (delta > least + 1e-5) assert_true(all.count > 0);
        bool met[MOST_VIOLATIONS] = {false};
        for (size_t k = 0; k < n; k++) {
          cprox_violations one = {.list = single, .room = MOST_VIOLATIONS};
          const cprox_mover alone = cprox_robot_along(t.motion, &pairs[k], 1);
          assert_int_equal(violations_of_list(alone, targets, TARGETS, delta, 1e-4, &o, ws, &one), CPROX_OK);
          for (size_t v = 0; v < one.count; v++)
            if (one.list[v].verdict == CPROX_VERDICT_VIOLATED)
              assert_true(contains(&all, 0.5 * (one.list[v].enter_upper + one.list[v].leave_lower)));
          for (size_t v = 0; v < all.count; v++)
            met[v] = met[v] || contains(&one, 0.5 * (listed[v].enter_upper + listed[v].leave_lower));
        }
        for (size_t v = 0; v < all.count; v++) assert_true(met[v] || listed[v].verdict != CPROX_VERDICT_VIOLATED);
      }
    }
    free_scene(&t, targets);
  }
  print_message("lists that move, stand, both: %zu, %zu, %zu; %zu violated\n", lists[0], lists[1], lists[2], violated);
  for (int k = 0; k < 3; k++) assert_true(lists[k] > test_cases(400) / 40);
  assert_true(violated > test_cases(400) / 10);
}

/* A crowd of obstacles round a link that stands adds distance queries once, and no node. */
CASE(what_stands_costs_no_work_on_intervals) {
  enum { CROWD = 40 };
  arm a = make_arm((const double[]){0, -1}, (const double[]){0, 1}, 0.5);
  cprox_obstacle crowd[CROWD + 1];
  crowd[0] = cprox_obstacle_at(a.ball, (cprox_pose){{2.2, 0.2, 0.0}, {.w = 1.0}}); /* 0.15 from the moving link */
  for (int i = 0; i < CROWD; i++) {
    const double angle = 0.15 * i;
    crowd[i + 1] =
        cprox_obstacle_at(a.ball, (cprox_pose){{0.3 + 0.005 * i, 0.4 * cos(angle), 0.4 * sin(angle)}, {.w = 1.0}});
  }
  const cprox_robot_pair moving[1] = {{1, 0}};
  cprox_result without, with;
  assert_int_equal(distance_of_list(cprox_robot_along(a.motion, moving, 1), crowd, 1, NULL, ws, &without, NULL),
                   CPROX_OK);
  cprox_robot_pair pairs[CROWD + 2] = {{1, 0}, {0, 0}};
  for (int i = 0; i < CROWD; i++) pairs[i + 2] = (cprox_robot_pair){0, i + 1};
  const cprox_mover mover = cprox_robot_along(a.motion, pairs, CROWD + 2);
  assert_int_equal(distance_of_list(mover, crowd, CROWD + 1, NULL, ws, &with, NULL), CPROX_OK);
  assert_true(with.lower <= without.upper && without.lower <= with.upper);
  print_message("nodes %u and %u, distance queries %u and %u\n", without.nodes, with.nodes, without.distance_queries,
                with.distance_queries);
  assert_true(with.nodes <= without.nodes);
  assert_true(with.distance_queries <= without.distance_queries + CROWD + 2);
  free_arm(&a);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
