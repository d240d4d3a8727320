/* SPDX-License-Identifier: BSD-3-Clause */
/* What a query about a robot in motion leaves behind is accepted by the checker, which reads the query itself, does its
 * own kinematics and shares no line with the search. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robot_case.h"
#include "support/robot_queries.h"

enum { MOST_ANSWERS = 4096 };

/* Figures of a campaign, printed at its end. */
typedef struct tally {
  size_t asked, apart, near, none, n;
  double bytes[MOST_ANSWERS], tries[MOST_ANSWERS], milliseconds[MOST_ANSWERS];
} tally;

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *x, size_t n) {
  qsort(x, n, sizeof *x, ascending);
  return n ? x[n / 2] : 0.0;
}

static void print_tally(const char *what, tally *t) {
  const double bytes = median(t->bytes, t->n), tries = median(t->tries, t->n), time = median(t->milliseconds, t->n);
  print_message("%s: %zu asked, %zu apart, %zu near, %zu without\n", what, t->asked, t->apart, t->near, t->none);
  if (t->n)
    print_message("  apart: bytes %g in the median, %g at most; directions tried %g, %g; milliseconds %.2g, %.2g\n",
                  bytes, t->bytes[t->n - 1], tries, t->tries[t->n - 1], time, t->milliseconds[t->n - 1]);
}

static double cpu_milliseconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* One query with the claim that its certificate makes. */
static void examine(const cprox_mover *along, const cprox_obstacle *targets, size_t n, const cprox_certificate *c,
                    const cprox_result *r, double delta, bool verdict, const char *name, tally *sum) {
  sum->asked++;
  if (cprox_certificate_get_info(c).size == 0) {
    sum->none++;
    /* not decided, or in touch: of flat bodies no point lies inside */
    const bool open = r->upper == 0.0 || (verdict && r->lower <= delta + 1e-9 && r->upper > delta - 1e-9);
    if (!open)
      fail_msg("%s: no certificate of lower %.17g over %.17g: %s", name, r->lower, delta, cprox_workspace_error(ws));
    return;
  }
  robot_text text = robot_text_of(along, targets, n, ws);
  const double begin = cpu_milliseconds();
  const finding found =
      robot_text_check(&text, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size);
  const double milliseconds = cpu_milliseconds() - begin;
  robot_text_free(&text);
  if (found.fault)
    fail_msg("%s: refused: %s (lower %.17g, delta %.17g)", name, found.fault, r->lower,
             cprox_certificate_get_info(c).delta);
  assert_int_equal(found.claim, cprox_certificate_get_info(c).claim);
  assert_true(found.delta == cprox_certificate_get_info(c).delta);
  sum->apart += found.claim == CLAIM_APART;
  sum->near += found.claim == CLAIM_NEAR;
  if (found.claim != CLAIM_APART || sum->n == MOST_ANSWERS) return;
  sum->bytes[sum->n] = (double)cprox_certificate_get_info(c).size;
  sum->tries[sum->n] = (double)found.leaves;
  sum->milliseconds[sum->n++] = milliseconds;
}

/* The distance, then verdicts about it. */
static void ask_thrice(const cprox_mover *along, const cprox_obstacle *targets, size_t n, double epsilon,
                       const char *name, cprox_certificate *c, tally sum[3]) {
  static const double SHARE[3] = {0.0, 0.9, 1.1};
  cprox_options options = accurate(epsilon);
  options.certificate = c;
  double distance = 0.0;
  for (int i = 0; i < 3; i++) {
    cprox_result r;
    const double delta = SHARE[i] * distance;
    const cprox_status status = i == 0 ? distance_of_list(*along, targets, n, &options, ws, &r, NULL)
                                       : tolerance_of_list(*along, targets, n, delta, &options, ws, &r, NULL);
    assert_true(status >= 0);
    if (i == 0) distance = r.lower;
    if (!isfinite(distance)) return;
    examine(along, targets, n, c, &r, i == 0 ? r.lower : delta, i > 0, name, &sum[i]);
  }
}

/* The saved trajectories of Panda, Fanuc and Husky: scene and self, links by their hulls. */
CASE(real_robots_leave_certificates_that_hold) {
  static tally sum[3];
  cprox_certificate *c = cprox_certificate_create();
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  size_t n;
  assert_non_null(f);
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  for (size_t i = 0; i < n; i++) {
    robot_case one;
    assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &one));
    for (size_t k = 0; k < one.n_answers; k++) {
      const bool self = one.answers[k].self;
      const cprox_mover whose = self ? cprox_robot_self(one.motion, one.self_pairs, one.n_self_pairs)
                                     : cprox_robot_along(one.motion, NULL, 0);
      ask_thrice(&whose, one.targets, self ? 0 : one.n_targets, 1e-4, one.name, c, sum);
    }
    robot_case_free(&one);
  }
  fclose(f);
  print_tally("real robots, distance to 1e-4", &sum[0]);
  print_tally("real robots, .9 of it", &sum[1]);
  print_tally("real robots, 1.1 of it", &sum[2]);
  assert_true(sum[0].apart + sum[0].near > 30);
  cprox_certificate_free(c);
}

static void print_thrice(const char *what, tally sum[3]) {
  static const char *const ASKED[3] = {"distance to 1e-5", ".9 of it", "1.1 of it"};
  for (int i = 0; i < 3; i++) {
    char line[80];
    snprintf(line, sizeof line, "%s, %s", what, ASKED[i]);
    print_tally(line, &sum[i]);
  }
}

/* Random robots; with `add`, which changes a query, some are asked about themselves, too. */
static void ask_random(size_t n, uint64_t seed, void (*add)(robot_query *q, rng *r, cprox_workspace *workspace),
                       const char *what, tally sum[3]) {
  cprox_certificate *c = cprox_certificate_create();
  rng r = rng_seed(seed);
  for (size_t i = 0; i < test_cases(n); i++) {
    robot_query q;
    robot_query_random(&q, &r, rng_log_uniform(&r, 0.02, 1.0), rng_uniform(&r, 0.5, 3.0), false, ws);
    if (add) {
      add(&q, &r, ws);
      robot_query_whole(&q, &r);
    }
    char name[40];
    snprintf(name, sizeof name, "robot %zu", i);
    ask_thrice(&q.mover, q.targets, q.n, 1e-5, name, c, sum);
    robot_query_free(&q);
  }
  print_thrice(what, sum);
  cprox_certificate_free(c);
}

/* Robots of all joint types, splines and waypoints, bodies of every kind. */
CASE(random_robots_leave_certificates_that_hold) {
  static tally sum[3];
  ask_random(100, 4, NULL, "random robots", sum);
  assert_true(sum[0].apart > 20);
}

/* Beside superquadrics and intersections of inequalities. */
CASE(robots_beside_bodies_by_inequalities_leave_certificates_that_hold) {
  static tally sum[3];
  ask_random(30, 8, robot_query_inequalities, "beside inequalities", sum);
  assert_true(sum[0].apart + sum[1].apart > test_cases(10));
}

/* With a body beside them that turns by slerp, on one clock; before a motion begins and after it has ended the robot or
 * the body stands. */
CASE(bodies_that_turn_by_slerp_beside_robots_leave_certificates_that_hold) {
  static tally sum[3];
  ask_random(60, 9, robot_query_fly, "robots and a body by slerp", sum);
  assert_true(sum[0].apart > test_cases(20));
}

/* A crank round a coaxial cylinder, and a wheel that turns about its own axis beside a box: the distance stays the same,
 * or nearly, however far they turn. */
CASE(turning_cranks_and_wheels_leave_certificates_that_hold) {
  static tally sum[3];
  cprox_certificate *c = cprox_certificate_create();
  const double angles[3] = {0.5, 6.3, 100.0};
  cprox_body *box = NULL, *cylinder = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.1, 0.05, 0.02), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_cylinder(0.5, 0.2, ws, &cylinder), CPROX_OK);
  const cprox_pose off = {{1, 0, 0}, {.w = 1.0}};
  for (int i = 0; i < 3; i++)
    for (int wheel = 0; wheel < 2; wheel++)
      for (int beside = 0; beside < 2; beside++) {
        const cprox_link link = {.parent = -1,
                                 .type = CPROX_JOINT_REVOLUTE,
                                 .origin = CPROX_POSE_IDENTITY,
                                 .axis = {0, 0, 1},
                                 .variable = 0,
                                 .multiplier = 1.0};
        const cprox_link_geometry geometry = {
            .body = wheel ? cylinder : box, .pose = wheel ? CPROX_POSE_IDENTITY : off, .link = 0};
        cprox_robot *robot = NULL;
        cprox_motion *motion = NULL;
        assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
        const int32_t variable = 0;
        const double from = 0.3, to = from + angles[i];
        const cprox_waypoint points[2] = {{.time = 0, .positions = &from}, {.time = 1, .positions = &to}};
        const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                            .variables = &variable,
                                            .n_variables = 1,
                                            .waypoints = points,
                                            .n_waypoints = 2};
        assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
        cprox_pose place = wheel ? off : CPROX_POSE_IDENTITY;
        place.position.y += beside ? 0.05 : 0.0;
        const cprox_obstacle obstacle = cprox_obstacle_at(wheel ? box : cylinder, place);
        const cprox_mover turning = cprox_robot_along(motion, NULL, 0);
        ask_thrice(&turning, &obstacle, 1, 1e-3, wheel ? "wheel" : "crank", c, sum);
        cprox_motion_free(motion);
        cprox_robot_free(robot);
      }
  print_tally("cranks and wheels, distance to 1e-3", &sum[0]);
  print_tally("cranks and wheels, .9 of it", &sum[1]);
  print_tally("cranks and wheels, 1.1 of it", &sum[2]);
  assert_true(sum[0].apart == 12 && sum[1].apart == 12 && sum[2].near == 12);
  cprox_body_free(box);
  cprox_body_free(cylinder);
  cprox_certificate_free(c);
}

/* ---- meshes ---- */

/* 60 robots with meshes on links and beside them (seed 5). The answer is that without a certificate; what is proven is
 * accepted and does not contradict the distance to the triangles; links are taken by their hulls. */
CASE(meshes_of_robots_leave_proofs_that_hold_and_answers_as_they_are) {
  cprox_certificate *c = cprox_certificate_create();
  rng r = rng_seed(5);
  size_t apart = 0, near = 0, none = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    robot_query q;
    robot_query_random(&q, &r, rng_log_uniform(&r, 0.02, 1.0), rng_uniform(&r, 0.3, 2.0), true, ws);
    cprox_options options = accurate(1e-5);
    cprox_result plain, with;
    assert_true(distance_of_list(q.mover, q.targets, q.n, &options, ws, &plain, NULL) >= 0);
    options.certificate = c;
    assert_true(distance_of_list(q.mover, q.targets, q.n, &options, ws, &with, NULL) >= 0);
    assert_true(with.status == plain.status && with.lower == plain.lower && with.upper == plain.upper);
    assert_true(with.t == plain.t && with.lod == plain.lod && with.nodes == plain.nodes);
    none += cprox_certificate_get_info(c).size == 0;
    if (cprox_certificate_get_info(c).size > 0) {
      robot_text text = robot_text_of(&q.mover, q.targets, q.n, ws);
      const finding found =
          robot_text_check(&text, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size);
      robot_text_free(&text);
      if (found.fault) fail_msg("robot %zu: refused: %s", i, found.fault);
      if (found.claim == CLAIM_APART ? found.delta >= plain.upper : found.delta < plain.lower)
        fail_msg("robot %zu: %g is proven of [%.17g, %.17g]", i, found.delta, plain.lower, plain.upper);
      apart += found.claim == CLAIM_APART, near += found.claim == CLAIM_NEAR;
    }
    robot_query_free(&q);
  }
  print_message("robots with meshes: %zu apart, %zu near, %zu without\n", apart, near, none);
  assert_true(apart > 10);
  cprox_certificate_free(c);
}

/* 20 robots (seed 6) within a closed box: they are apart from its triangles, and inside of the solid. */
CASE(robots_inside_of_a_solid_are_not_apart_from_it) {
  cprox_certificate *c = cprox_certificate_create();
  rng r = rng_seed(6);
  test_mesh box = mesh_box(vec(50, 50, 50));
  cprox_body *surface = mesh_body(&box, CPROX_MESH_FILL_SURFACE, ws);
  cprox_body *solid = mesh_body(&box, CPROX_MESH_FILL_SOLID, ws);
  cprox_options options = accurate(1e-3);
  options.certificate = c;
  for (int i = 0; i < 20; i++) {
    test_robot robot;
    robot_make(&r, 0.5, &robot);
    const cprox_mover along = cprox_robot_along(robot.motion, NULL, 0);
    cprox_obstacle target = cprox_obstacle_at(solid, rng_pose(&r, 1.0));
    for (int round = 0; round < 2; round++) {
      cprox_result result;
      assert_true(distance_of_list(along, &target, 1, &options, ws, &result, NULL) >= 0);
      assert_true(round == 0 ? result.upper == 0.0 : result.lower > 1.0);
      robot_text text = robot_text_of(&along, &target, 1, ws);
      const cprox_certificate_info info = cprox_certificate_get_info(c);
      assert_null(robot_text_check(&text, info.bytes, info.size).fault);
      robot_text_free(&text);
      target.body = surface;
    }
    target.body = solid;
    const cprox_certificate_info info = cprox_certificate_get_info(c);
    robot_text text = robot_text_of(&along, &target, 1, ws);
    assert_string_equal(robot_text_check(&text, info.bytes, info.size).fault, "a part does not begin outside a mesh");
    robot_text_free(&text);
    robot_free(&robot);
  }
  cprox_body_free(surface);
  cprox_body_free(solid);
  mesh_free(&box);
  cprox_certificate_free(c);
}

/* ---- directions whose squares underflow ---- */

static size_t put(unsigned char *to, uint64_t bits, size_t n) {
  for (size_t i = 0; i < n; i++) to[i] = (unsigned char)(bits >> (8 * i) & 255);
  return n;
}

static size_t put_number(unsigned char *to, double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return put(to, bits, 8);
}

/* A ball slides along x from 0 to 1. */
typedef struct slide {
  cprox_body *ball;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_mover along;
} slide;

static void slide_make(slide *s) {
  assert_int_equal(cprox_body_create_sphere(0.25, ws, &s->ball), CPROX_OK);
  const cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {1, 0, 0}, .multiplier = 1.0};
  const cprox_link_geometry geometry = {.body = s->ball, .pose = CPROX_POSE_IDENTITY};
  const double at[2] = {0.0, 1.0};
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = &at[0]}, {.time = 1.0, .positions = &at[1]}};
  const int32_t variable = 0;
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = &variable,
                                      .n_variables = 1,
                                      .waypoints = points,
                                      .n_waypoints = 2,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR};
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &s->robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(s->robot, &d, ws, &s->motion), CPROX_OK);
  s->along = cprox_robot_along(s->motion, NULL, 0);
}

static void slide_free(slide *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  cprox_body_free(s->ball);
}

/* Towards another ball, which it comes within .5 of. One interval, the one direction that parts them, of any length. */
static finding check_slide(double delta, double length) {
  slide s;
  slide_make(&s);
  cprox_pose there = CPROX_POSE_IDENTITY;
  there.position.x = 2.0;
  const cprox_obstacle target = cprox_obstacle_at(s.ball, there);

  unsigned char bytes[64];
  size_t n = put(bytes, 0x31435043, 4); /* "CPC1" */
  n += put(bytes + n, 8, 4);
  n += put_number(bytes + n, delta);
  n += put(bytes + n, CLAIM_APART, 4);
  n += put(bytes + n, 1, 4);
  n += put(bytes + n, 2, 2);
  n += put(bytes + n, 0, 2);
  for (int k = 0; k < 3; k++) n += put_number(bytes + n, k == 0 ? -length : 0.0);
  robot_text text = robot_text_of(&s.along, &target, 1, ws);
  const finding found = robot_text_check(&text, bytes, n);
  robot_text_free(&text);
  slide_free(&s);
  return found;
}

CASE(a_direction_of_any_length_proves_what_is_so_and_nothing_else) {
  static const double LENGTH[] = {1.0, 1e-3, 1e20, 1e-29, 1e-160, 1e-200, 1e-300, 5e-324, 1e160, 1e300};
  for (size_t i = 0; i < sizeof LENGTH / sizeof *LENGTH; i++) {
    assert_int_equal(check_slide(0.51, LENGTH[i]).claim, CLAIM_NONE);
    assert_int_equal(check_slide(100.0, LENGTH[i]).claim, CLAIM_NONE);
    if (i < 4) assert_int_equal(check_slide(0.49, LENGTH[i]).claim, CLAIM_APART);
  }
}

/* Halfspaces whose plane the ball comes within .1 of, or goes .1 into, whatever way the normal points: that both are
 * within .2 of each other is proven. Seed 6. */
CASE(a_halfspace_is_near_whatever_way_it_faces) {
  slide s;
  slide_make(&s);
  cprox_certificate *c = cprox_certificate_create();
  rng r = rng_seed(6);
  for (size_t i = 0; i < 200; i++) {
    const vec3 n = i < 6 ? vec(i == 0   ? 1
                               : i == 1 ? -1
                                        : 0,
                               i == 2   ? 1
                               : i == 3 ? -1
                                        : 0,
                               i == 4   ? 1
                               : i == 5 ? -1
                                        : 0)
                         : rng_unit(&r);
    /* the least of n·x over the motion is min(0, n.x), less the radius */
    const double least = fmin(0.0, n.x) - 0.25, gap = i % 2 ? 0.1 : -0.1;
    cprox_body *half;
    assert_int_equal(cprox_body_create_halfspace(n, gap - least, ws, &half), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(half, CPROX_POSE_IDENTITY);
    cprox_options options = accurate(1e-6);
    options.certificate = c;
    cprox_result result;
    assert_int_equal(cprox_tolerance(s.along, target, 0.2, &options, ws, &result), CPROX_OK);
    assert_int_equal(result.verdict, CPROX_VERDICT_VIOLATED);
    const cprox_certificate_info info = cprox_certificate_get_info(c);
    if (info.size == 0) fail_msg("halfspace %zu: no certificate: %s", i, cprox_workspace_error(ws));
    robot_text text = robot_text_of(&s.along, &target, 1, ws);
    const finding found = robot_text_check(&text, info.bytes, info.size);
    robot_text_free(&text);
    if (found.fault || found.claim != CLAIM_NEAR) fail_msg("halfspace %zu: refused: %s", i, found.fault);
    cprox_body_free(half);
  }
  cprox_certificate_free(c);
  slide_free(&s);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
