/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions cut into intervals over each of which a geometry moves no farther than asked: held against long double
 * kinematics. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/robots.h"

enum { MOST_POSES = 20000 };

/* A vertex of a geometry where a pose has it. */
static vec3l vertex_at(const test_robot *t, const cprox_swept_pose *pose, size_t vertex) {
  const vec3 v = t->vertices[pose->geometry][vertex];
  const cprox_quat q = pose->pose.orientation;
  const long double norm =
      sqrtl((long double)q.w * q.w + (long double)q.x * q.x + (long double)q.y * q.y + (long double)q.z * q.z);
  const ref_pose placed = {{pose->pose.position.x, pose->pose.position.y, pose->pose.position.z},
                           {q.x / norm, q.y / norm, q.z / norm, q.w / norm}};
  return ref_pose_apply(&placed, (vec3l){v.x, v.y, v.z});
}

/* 200 robots (seed 4602), each on its motion: the intervals follow one another from the first time to the last one, and
 * at 8 times in each no vertex is farther from where the pose has it than `displacement`. Tolerance: 1e-12 of a robot of
 * a few metres, for the time at which the reference is asked. */
CASE(no_point_leaves_the_grown_body_of_its_interval) {
  rng r = rng_seed(4602);
  static cprox_swept_pose poses[MOST_POSES];
  size_t many = 0;
  for (size_t i = 0; i < test_cases(200); i++) {
    test_robot t;
    robot_make(&r, 0.5, &t);
    const size_t geometry = rng_index(&r, t.n_links);
    const double most = rng_log_uniform(&r, 0.01, 0.5);
    size_t n = 0, again = 0;
    assert_int_equal(cprox_motion_sweep(t.motion, (int32_t)geometry, most, ws, 0, NULL, &n), CPROX_OK);
    assert_true(n > 0 && n <= MOST_POSES);
    assert_int_equal(cprox_motion_sweep(t.motion, (int32_t)geometry, most, ws, MOST_POSES, poses, &again), CPROX_OK);
    assert_int_equal(again, n);
    many += n > 10;
    const cprox_motion_info info = cprox_motion_get_info(t.motion);
    assert_true(poses[0].t0 == info.t0 && poses[n - 1].t1 == info.t1);
    for (size_t k = 0; k < n; k++) {
      assert_true(poses[k].t0 < poses[k].t1 && (k == 0 || poses[k].t0 == poses[k - 1].t1));
      assert_true(poses[k].displacement <= most * 1.000001 + 1e-9);
      for (int j = 0; j < 8; j++) {
        const double time = rng_uniform(&r, poses[k].t0, poses[k].t1);
        long double values[TEST_MAX_VARIABLES];
        robot_ref_values(&t, (long double)time, values);
        ref_pose links[TEST_MAX_LINKS];
        robot_ref_links(&t, values, links);
        vec3l there[TEST_VERTICES];
        robot_ref_vertices(&t, links, geometry, there);
        for (size_t v = 0; v < TEST_VERTICES; v++) {
          const vec3l away = ref_sub(there[v], vertex_at(&t, &poses[k], v));
          assert_true(sqrtl(away.x * away.x + away.y * away.y + away.z * away.z) <=
                      (long double)poses[k].displacement + 1e-12L);
        }
      }
    }
    robot_free(&t);
  }
  assert_true(many > test_cases(50));
}

/* Two balls on a joint, that far from its axis first: its chord counts. */
CASE(all_parts_of_a_geometry_stay_in_the_grown_body) {
  static const double ARM = 1.5, TURN = 2.0;
  enum { PARTS = 2 };
  cprox_body *ball = NULL, *both = NULL;
  assert_int_equal(cprox_body_create_sphere(0.05, ws, &ball), CPROX_OK);
  const cprox_body *parts[PARTS] = {ball, ball};
  const cprox_pose places[PARTS] = {{{ARM, 0, 0}, {1, 0, 0, 0}}, {{0.1, 0, 0}, {1, 0, 0, 0}}};
  assert_int_equal(cprox_body_create_compound(parts, places, PARTS, ws, &both), CPROX_OK);
  const cprox_link links[2] = {
      {.parent = -1, .type = CPROX_JOINT_FIXED, .origin = CPROX_POSE_IDENTITY},
      {.parent = 0, .type = CPROX_JOINT_REVOLUTE, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0}};
  const cprox_link_geometry geometry = {.body = both, .pose = CPROX_POSE_IDENTITY, .link = 1};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, 2, &geometry, 1, 1, ws, &robot), CPROX_OK);
  const double ends[2] = {0.0, TURN};
  const int32_t variable = 0;
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = &ends[0]}, {.time = 1.0, .positions = &ends[1]}};
  const cprox_motion_description along = {.kind = CPROX_MOTION_WAYPOINTS,
                                          .variables = &variable,
                                          .n_variables = 1,
                                          .waypoints = points,
                                          .n_waypoints = 2,
                                          .interpolation = CPROX_INTERPOLATION_LINEAR};
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_motion_create(robot, &along, ws, &motion), CPROX_OK);
  static cprox_swept_pose poses[MOST_POSES];
  size_t n = 0;
  assert_int_equal(cprox_motion_sweep(motion, 0, 0.01, ws, MOST_POSES, poses, &n), CPROX_OK);
  for (size_t i = 0; i < n; i++)
    assert_true(poses[i].displacement >= 2.0 * ARM * sin(0.25 * TURN * (poses[i].t1 - poses[i].t0)));
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(both);
  cprox_body_free(ball);
}

CASE(a_sweep_that_cannot_be_is_refused) {
  rng r = rng_seed(4603);
  test_robot t;
  robot_make(&r, 0.5, &t);
  size_t n = 7;
  assert_int_equal(cprox_motion_sweep(t.motion, (int32_t)t.n_links, 0.1, ws, 0, NULL, &n), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "no geometry"));
  const double bad[] = {0.0, -1.0, NAN, INFINITY};
  for (size_t i = 0; i < 4; i++) {
    assert_int_equal(cprox_motion_sweep(t.motion, 0, bad[i], ws, 0, NULL, &n), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "displacement"));
  }
  assert_int_equal(cprox_motion_sweep(t.motion, 0, 1e-17, ws, 0, NULL, &n), CPROX_PRECISION);
  assert_int_equal(cprox_motion_sweep(t.motion, 0, 0.1, ws, 3, NULL, &n), CPROX_INVALID);
  assert_int_equal(n, 7);
  robot_free(&t);
}

static bool ends(void *asked) {
  return ++*(int *)asked > 3;
}

CASE(a_sweep_ends_when_its_workspace_wants_an_end) {
  rng r = rng_seed(4604);
  test_robot t;
  robot_make(&r, 0.5, &t);
  size_t n = 7;
  int asked = 0;
  cprox_workspace_set_stop(ws, ends, &asked);
  assert_int_equal(cprox_motion_sweep(t.motion, (int32_t)t.n_links - 1, 1e-8, ws, 0, NULL, &n), CPROX_INVALID);
  cprox_workspace_set_stop(ws, NULL, NULL);
  assert_non_null(strstr(cprox_workspace_error(ws), "stopped"));
  assert_int_equal(asked, 4);
  assert_int_equal(n, 7);
  robot_free(&t);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
