/* SPDX-License-Identifier: BSD-3-Clause */
/* What robots in motion are asked: against the saved answers of another program for real robots, against static pairs
 * at many times (which know nothing of motions), and against hulls in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/of_list.h"
#include "support/robot_case.h"
#include "support/robots.h"

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* ---- real robots ---- */

enum { REFERENCE_CASES = 64 };

/* The saved answers have 9 decimals and come from a search without rounding bounds: 1e-8. */
static const double SAVED = 1e-8;

static const char *folder(void) {
  return TEST_DATA_DIR "/motion";
}

static FILE *open_cases(size_t *n) {
  char path[400];
  snprintf(path, sizeof path, "%s/cases.txt", folder());
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  assert_int_equal(fscanf(f, "%zu", n), 1);
  return f;
}

static cprox_mover mover_of(const robot_case *c, const case_answer *a) {
  return a->self ? cprox_robot_self(c->motion, c->self_pairs, c->n_self_pairs) : cprox_robot_along(c->motion, NULL, 0);
}

static cprox_result ask(const robot_case *c, const case_answer *a, double delta) {
  const cprox_mover mover = mover_of(c, a);
  const size_t n = a->self ? 0 : c->n_targets;
  cprox_result r;
  const cprox_status status = delta < 0.0 ? distance_of_list(mover, c->targets, n, NULL, ws, &r, NULL)
                                          : tolerance_of_list(mover, c->targets, n, delta, NULL, ws, &r, NULL);
  if (status != CPROX_OK) fail_msg("%s: %s", c->name, cprox_workspace_error(ws));
  return r;
}

CASE(saved_answers_are_found_again) {
  size_t n, counted = 0;
  FILE *f = open_cases(&n);
  double nodes[REFERENCE_CASES], distance_queries[REFERENCE_CASES];
  for (size_t i = 0; i < n; i++) {
    robot_case c;
    assert_true(robot_case_read(f, folder(), &c));
    for (size_t k = 0; k < c.n_answers; k++) {
      const case_answer *a = &c.answers[k];
      const cprox_result r = ask(&c, a, -1.0);
      if (!(r.lower <= a->upper + SAVED && r.upper >= a->lower - SAVED && r.lower <= a->sampled + SAVED &&
            r.upper - r.lower <= 1e-6))
        fail_msg("%s: [%.10g, %.10g], saved [%.10g, %.10g], sampled %.10g", c.name, r.lower, r.upper, a->lower,
                 a->upper, a->sampled);
      if (a->lower == 0.0) continue;
      nodes[counted] = r.nodes, distance_queries[counted++] = r.distance_queries;

      /* verdicts on either side of the distance */
      assert_int_equal(ask(&c, a, 0.99 * r.lower).verdict, CPROX_VERDICT_CLEAR);
      assert_int_equal(ask(&c, a, 1.01 * r.upper).verdict, CPROX_VERDICT_VIOLATED);
    }
    robot_case_free(&c);
  }
  fclose(f);
  qsort(nodes, counted, sizeof *nodes, ascending);
  qsort(distance_queries, counted, sizeof *distance_queries, ascending);
  print_message("%zu answers: nodes %g in the median, %g at most; distances %g, %g\n", counted, nodes[counted / 2],
                nodes[counted - 1], distance_queries[counted / 2], distance_queries[counted - 1]);
  assert_true(nodes[counted / 2] <= 150 && distance_queries[counted / 2] <= 200 && nodes[counted - 1] <= 600);
}

/* The surface of a box as 12 triangles. */
static cprox_body *mesh_of_box(const cprox_body *box) {
  static const uint32_t TRIANGLES[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                                            {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 7, 3}, {1, 5, 7}};
  cprox_vec3 v[8];
  const double *half = box->shape.size;
  for (int i = 0; i < 8; i++)
    v[i] = vec(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]);
  cprox_body *mesh = NULL;
  assert_int_equal(cprox_body_create_mesh(v, 8, TRIANGLES, 12, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &mesh), CPROX_OK);
  return mesh;
}

/* The robot starts outside; where it does not touch, the surface is as far as the solid. */
CASE(surfaces_of_boxes_are_as_far_as_boxes) {
  size_t n, compared = 0;
  FILE *f = open_cases(&n);
  for (size_t i = 0; i < n; i++) {
    robot_case c;
    assert_true(robot_case_read(f, folder(), &c));
    if (i % 5 == 0 && c.answers[0].lower > 0.0) {
      const cprox_result solid = ask(&c, &c.answers[0], -1.0);
      for (size_t k = 0; k < c.n_targets; k++) {
        if (cprox_body_get_info(c.targets[k].body).kind != CPROX_BODY_BOX) continue;
        cprox_body *mesh = mesh_of_box(c.targets[k].body);
        cprox_body_free((cprox_body *)c.targets[k].body);
        c.targets[k].body = mesh;
        compared++;
      }
      const cprox_result surface = ask(&c, &c.answers[0], -1.0);
      assert_true(surface.lower <= solid.upper && solid.lower <= surface.upper);
      assert_int_equal(surface.lod, CPROX_LOD_MESH);
      assert_int_equal(ask(&c, &c.answers[0], 0.99 * solid.lower).verdict, CPROX_VERDICT_CLEAR);
      assert_int_equal(ask(&c, &c.answers[0], 1.01 * solid.upper).verdict, CPROX_VERDICT_VIOLATED);
    }
    robot_case_free(&c);
  }
  fclose(f);
  assert_true(compared > 10);
}

CASE(nothing_is_allocated_once_the_workspace_has_grown) {
  size_t n;
  FILE *f = open_cases(&n);
  robot_case c;
  assert_true(robot_case_read(f, folder(), &c));
  fclose(f);
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(c.targets, c.n_targets, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  size_t before = 0;
  for (int round = 0; round < 2; round++) {
    before = allocations_made();
    for (size_t k = 0; k < c.n_answers; k++) {
      const case_answer *a = &c.answers[k];
      cprox_result r;
      assert_int_equal(cprox_obstacles_distance(a->self ? NULL : all, mover_of(&c, a), NULL, ws, &r, NULL), CPROX_OK);
    }
  }
  assert_int_equal(allocations_made(), before);
  cprox_obstacles_free(all);
  robot_case_free(&c);
}

/* Against obstacles and itself at once: the lesser of both, from one search. */
CASE(the_whole_robot_is_as_near_as_the_nearer_of_both) {
  size_t n, compared = 0;
  uint64_t both_nodes = 0, whole_nodes = 0;
  FILE *f = open_cases(&n);
  for (size_t i = 0; i < n; i++) {
    robot_case c;
    assert_true(robot_case_read(f, folder(), &c));
    cprox_obstacles *all = NULL;
    const cprox_obstacle_index index = i % 2 ? CPROX_INDEX_BVH : CPROX_INDEX_NONE;
    assert_int_equal(cprox_obstacles_create(c.targets, c.n_targets, index, ws, &all), CPROX_OK);
    const cprox_mover scene = cprox_robot_along(c.motion, NULL, 0),
                      self = cprox_robot_self(c.motion, c.self_pairs, c.n_self_pairs);
    cprox_mover whole = scene;
    whole.kind = CPROX_MOVER_ROBOT_WHOLE, whole.self_pairs = c.self_pairs, whole.n_self_pairs = c.n_self_pairs;
    cprox_result a, b, r, first[3];
    assert_true(cprox_obstacles_distance(all, scene, NULL, ws, &a, NULL) >= 0);
    assert_true(cprox_obstacles_distance(NULL, self, NULL, ws, &b, NULL) >= 0);
    assert_true(cprox_obstacles_distance(all, whole, NULL, ws, &r, NULL) >= 0);
    assert_true(r.lower <= fmin(a.upper, b.upper) && fmin(a.lower, b.lower) <= r.upper);
    if (b.upper < a.lower - 1e-6) assert_int_equal(r.obstacle_index, (int32_t)c.n_targets + b.obstacle_index);
    if (a.upper < b.lower - 1e-6) assert_int_equal(r.obstacle_index, a.obstacle_index);
    const double least = fmin(a.lower, b.lower);
    for (int k = 0; k < 2 && least > 0.0; k++) {
      const double delta = (k ? 1.01 : 0.9) * fmin(a.upper, b.upper);
      cprox_result of_scene, of_itself;
      assert_int_equal(cprox_obstacles_tolerance(all, whole, delta, NULL, ws, &r, NULL), CPROX_OK);
      assert_int_equal(r.verdict, k ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      cprox_obstacles_tolerance(all, scene, delta, NULL, ws, &of_scene, NULL);
      cprox_obstacles_tolerance(NULL, self, delta, NULL, ws, &of_itself, NULL);
      both_nodes += of_scene.nodes + of_itself.nodes, whole_nodes += r.nodes;
      compared++;
    }
    assert_true(cprox_obstacles_collision(all, whole, NULL, ws, &r, NULL) >= 0);
    if (least > 0.0) assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
    assert_true(cprox_obstacles_time_of_contact(all, scene, NULL, ws, &first[0]) >= 0);
    assert_true(cprox_obstacles_time_of_contact(NULL, self, NULL, ws, &first[1]) >= 0);
    assert_true(cprox_obstacles_time_of_contact(all, whole, NULL, ws, &first[2]) >= 0);
    for (int k = 0; k < 2; k++)
      if (first[k].verdict == CPROX_VERDICT_VIOLATED) assert_true(first[2].t_contact_lower <= first[k].t);

    /* a certificate changes no answer */
    cprox_certificate *proof = cprox_certificate_create();
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    cprox_result proven;
    options.certificate = proof;
    const cprox_status status = cprox_obstacles_distance(all, whole, &options, ws, &proven, NULL);
    if (i % 2 == 0) {
      assert_true(status >= 0 && cprox_obstacles_distance(all, whole, NULL, ws, &r, NULL) >= 0);
      assert_true(proven.lower == r.lower && proven.upper == r.upper && proven.t == r.t);
    } else {
      assert_int_equal(status, CPROX_INVALID); /* of a hierarchy of obstacles */
    }
    cprox_certificate_free(proof);

    /* what it does not have */
    cprox_result each[CASE_MAX_OBJECTS];
    cprox_listed listed;
    assert_int_equal(cprox_obstacles_nearest_pairs(all, whole, 1, 1.0, NULL, ws, each, &listed), CPROX_INVALID);
    if (i % 2 == 0) assert_int_equal(cprox_obstacles_distance(all, whole, NULL, ws, &r, each), CPROX_INVALID);
    cprox_obstacles_free(all);
    robot_case_free(&c);
  }
  fclose(f);
  print_message("%zu verdicts: %g nodes at once, %g one after the other\n", compared, (double)whole_nodes,
                (double)both_nodes);
  assert_true(compared > 10 && whole_nodes < both_nodes);
}

/* ---- random robots ---- */

enum { SAMPLES = 60, TARGETS = 3 };

/* The distance of a point from everything on the robot, at a time, in long double (hulls of the vertices
 * rounded to double: 1e-15). */
static long double distance_at(const test_robot *t, long double time, const vec3 *points, size_t n) {
  long double values[TEST_MAX_VARIABLES + 1], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, time, values);
  robot_ref_links(t, values, links);
  for (size_t g = 0; g < t->n_links; g++) {
    vec3l exact[TEST_VERTICES];
    vec3 v[TEST_VERTICES];
    robot_ref_vertices(t, links, g, exact);
    for (size_t k = 0; k < TEST_VERTICES; k++) v[k] = vec((double)exact[k].x, (double)exact[k].y, (double)exact[k].z);
    for (size_t i = 0; i < n; i++)
      least = fminl(least, fmaxl(ref_point_hull(ref_vec(points[i]), v, TEST_VERTICES) - t->margin, 0.0L));
  }
  return least;
}

static void make_points(rng *r, vec3 *points, cprox_obstacle *targets) {
  for (size_t i = 0; i < TARGETS; i++) {
    cprox_body *body;
    points[i] = rng_in_cube(r, 2.0);
    assert_int_equal(cprox_body_create_point(points[i], ws, &body), CPROX_OK);
    targets[i] = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  }
}

static void free_targets(cprox_obstacle *targets) {
  for (size_t i = 0; i < TARGETS; i++) cprox_body_free((cprox_body *)targets[i].body);
}

CASE(no_sample_is_nearer_than_lower) {
  rng r = rng_seed(4411);
  for (size_t i = 0; i < test_cases(250); i++) {
    test_robot t;
    vec3 points[TARGETS];
    cprox_obstacle targets[TARGETS];
    robot_make(&r, rng_log_uniform(&r, 0.1, 2), &t);
    make_points(&r, points, targets);
    cprox_result d, first;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-5;
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    const cprox_status status = distance_of_list(mover, targets, TARGETS, &options, ws, &d, NULL);
    if (status != CPROX_OK) fail_msg("robot %zu: %s", i, cprox_workspace_error(ws));
    if (d.obstacle_index < 0) { /* nothing moves */
      assert_true(isinf(d.lower));
    } else {
      const cprox_motion_info info = cprox_motion_get_info(t.motion);
      const double t0 = info.t0, t1 = info.t1;
      assert_true(time_of_contact_of_list(mover, targets, TARGETS, &options, ws, &first) >= 0);
      assert_true(fabsl(distance_at(&t, d.t, points, TARGETS) - d.upper) <= 1e-9L);
      for (int k = 0; k <= SAMPLES; k++) {
        const long double time = t0 + ((long double)t1 - t0) * k / SAMPLES;
        const long double at = distance_at(&t, time, points, TARGETS);
        if (at < d.lower) fail_msg("robot %zu: %.12Lg at %.12Lg, lower is %.12g", i, at, time, d.lower);
        if (at <= 0.0L && time < first.t_contact_lower)
          fail_msg("robot %zu: contact at %.12Lg, late at %.12g", i, time, first.t_contact_lower);
      }
      if (d.lower > 0.0) assert_int_equal(first.verdict, CPROX_VERDICT_CLEAR);
      if (first.verdict == CPROX_VERDICT_VIOLATED) assert_true(first.t >= first.t_contact_lower && d.upper <= 0.0);
    }
    free_targets(targets);
    robot_free(&t);
  }
}

/* Wherever a link is: what static pairs say there. */
static double static_distance(const test_robot *t, double time, const cprox_robot_pair *pair) {
  double values[TEST_MAX_VARIABLES + 1];
  cprox_motion_evaluate(t->motion, time, values);
  cprox_obstacle side[2];
  for (int k = 0; k < 2; k++) {
    const cprox_link_geometry *g = &t->geometries[k ? pair->other : pair->geometry];
    long double exact[TEST_MAX_VARIABLES + 1];
    for (size_t v = 0; v < t->n_variables; v++) exact[v] = values[v];
    ref_pose links[TEST_MAX_LINKS];
    robot_ref_links(t, exact, links);
    const long double *q = links[g->link].q;
    const vec3l p = links[g->link].p;
    const cprox_pose link = {.position = {(double)p.x, (double)p.y, (double)p.z},
                             .orientation = {(double)q[3], (double)q[0], (double)q[1], (double)q[2]}};
    side[k] = cprox_with_margin(cprox_obstacle_at(g->body, frame_compose(&link, &g->pose)), g->margin);
  }
  cprox_result r;
  assert_true(cprox_pair(side[0], side[1], NULL, ws, &r) >= 0);
  return fmax(r.upper, 0.0);
}

CASE(the_robot_is_no_nearer_to_itself_than_lower) {
  rng r = rng_seed(4412);
  size_t asked = 0;
  for (size_t i = 0; i < test_cases(250); i++) {
    test_robot t;
    robot_make(&r, rng_log_uniform(&r, 0.1, 2), &t);
    for (int32_t a = 1; a < (int32_t)t.n_links; a++) {
      const cprox_robot_pair pair = {a, (int32_t)rng_index(&r, (size_t)a)};
      const cprox_link_info between = cprox_motion_get_link_info(t.motion, pair.geometry, pair.other);
      if (between.n_joints < 2 || between.n_moved == 0) continue;
      cprox_result d;
      const cprox_status status = distance_of_list(cprox_robot_self(t.motion, &pair, 1), NULL, 0, NULL, ws, &d, NULL);
      if (status < 0) fail_msg("robot %zu: %s", i, cprox_workspace_error(ws));
      const cprox_motion_info info = cprox_motion_get_info(t.motion);
      const double t0 = info.t0, t1 = info.t1;
      for (int k = 0; k <= SAMPLES; k++) {
        const double time = t0 + (t1 - t0) * k / SAMPLES, at = static_distance(&t, time, &pair);
        if (at < d.lower - 1e-12) fail_msg("robot %zu: %.12g at %.12g, lower is %.12g", i, at, time, d.lower);
      }
      if (d.upper > 0.0) assert_true(fabs(static_distance(&t, d.t, &pair) - d.upper) <= 2e-6);
      asked++;
    }
    robot_free(&t);
  }
  assert_true(asked > test_cases(250));
}

CASE(a_profile_is_true_on_every_interval) {
  rng r = rng_seed(4413);
  for (size_t i = 0; i < test_cases(40); i++) {
    enum { INTERVALS = 7 };
    test_robot t;
    vec3 points[TARGETS];
    cprox_obstacle targets[TARGETS];
    robot_make(&r, 1.0, &t);
    make_points(&r, points, targets);
    double breaks[INTERVALS + 1];
    cprox_profile_interval intervals[INTERVALS];
    const cprox_motion_info info = cprox_motion_get_info(t.motion);
    const double t0 = info.t0, t1 = info.t1;
    for (int k = 0; k <= INTERVALS; k++) breaks[k] = k == INTERVALS ? t1 : t0 + (t1 - t0) * k / INTERVALS;
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    cprox_result whole, nearest[2];
    size_t count = 0;
    assert_int_equal(profile_of_list(mover, targets, TARGETS, breaks, INTERVALS, NULL, ws, intervals), CPROX_OK);
    assert_int_equal(distance_of_list(mover, targets, TARGETS, NULL, ws, &whole, NULL), CPROX_OK);
    assert_int_equal(nearest_of_list(mover, targets, TARGETS, 2, NULL, ws, nearest, &count), CPROX_OK);
    double least = INFINITY;
    for (int k = 0; k < INTERVALS; k++) {
      for (int s = 0; s <= 10 && intervals[k].obstacle_index >= 0; s++) {
        const long double time = breaks[k] + ((long double)breaks[k + 1] - breaks[k]) * s / 10;
        assert_true(distance_at(&t, time, points, TARGETS) >= intervals[k].lower - 1e-14L);
      }
      /* 1e-9: times are rounded */
      if (intervals[k].obstacle_index >= 0)
        assert_true(distance_at(&t, intervals[k].t, points, TARGETS) <= intervals[k].upper + 1e-9L);
      least = fmin(least, intervals[k].lower);
    }
    if (whole.obstacle_index >= 0) {
      assert_true(least <= whole.upper && whole.lower <= least + 1e-6);
      assert_true(count == 2 && nearest[0].lower <= whole.upper && whole.lower <= nearest[0].upper);
    }
    free_targets(targets);
    robot_free(&t);
  }
}

/* ---- what is refused ---- */

#define REFUSED(call, part)                                                                  \
  do {                                                                                       \
    assert_int_equal(call, CPROX_INVALID);                                                   \
    if (!strstr(cprox_workspace_error(ws), part)) fail_msg("%s", cprox_workspace_error(ws)); \
  } while (0)

/* A slider of three balls on a rail, through a wall at its end, where it may also touch itself; written with many
 * waypoints. */
CASE(proven_contact_ends_a_query_at_once) {
  enum { POINTS = 4000, BALLS = 3 };
  cprox_link links[BALLS];
  cprox_link_geometry geometries[BALLS];
  cprox_body *ball = NULL, *wall = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.1, 4, 4}, ws, &wall), CPROX_OK);
  int32_t variables[BALLS];
  for (int32_t i = 0; i < BALLS; i++) {
    links[i] = (cprox_link){.parent = i - 1,
                            .type = CPROX_JOINT_PRISMATIC,
                            .origin = CPROX_POSE_IDENTITY,
                            .axis = {1, 0, 0},
                            .variable = i,
                            .multiplier = 1.0};
    geometries[i] = (cprox_link_geometry){.body = ball, .pose = CPROX_POSE_IDENTITY, .link = i};
    variables[i] = i;
  }
  static double values[POINTS][BALLS];
  static cprox_waypoint points[POINTS];
  for (int i = 0; i < POINTS; i++) {
    values[i][0] = (double)i / POINTS;
    points[i] = (cprox_waypoint){.time = i, .positions = values[i]};
    for (int k = 1; k < BALLS; k++) values[i][k] = 0.05 + 1e-6 * i;
  }
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_robot_create(links, BALLS, geometries, BALLS, BALLS, ws, &robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(robot,
                                       &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                                   .variables = variables,
                                                                   .n_variables = BALLS,
                                                                   .waypoints = points,
                                                                   .n_waypoints = POINTS,
                                                                   .interpolation = CPROX_INTERPOLATION_LINEAR},
                                       ws, &motion),
                   CPROX_OK);
  const cprox_obstacle targets[2] = {
      cprox_obstacle_at(wall, (cprox_pose){.position = {0.5, 0, 0}, .orientation = {.w = 1.0}}),
      cprox_obstacle_at(wall, (cprox_pose){.position = {9, 0, 0}, .orientation = {.w = 1.0}})};
  cprox_obstacles *sets[2] = {NULL};
  assert_int_equal(cprox_obstacles_create(targets, 2, CPROX_INDEX_NONE, ws, &sets[0]), CPROX_OK);
  assert_int_equal(cprox_obstacles_create(targets, 2, CPROX_INDEX_BVH, ws, &sets[1]), CPROX_OK);
  for (int i = 0; i < 3; i++) {
    const cprox_mover mover = i == 2 ? cprox_robot_self(motion, NULL, 0) : cprox_robot_along(motion, NULL, 0);
    const cprox_obstacles *set = i == 2 ? NULL : sets[i];
    cprox_result r[3];
    assert_int_equal(cprox_obstacles_distance(set, mover, NULL, ws, &r[0], NULL), CPROX_OK);
    assert_int_equal(cprox_obstacles_collision(set, mover, NULL, ws, &r[1], NULL), CPROX_OK);
    assert_int_equal(cprox_obstacles_tolerance(set, mover, 0.01, NULL, ws, &r[2], NULL), CPROX_OK);
    for (int k = 0; k < 3; k++) {
      assert_true(r[k].upper <= (k == 2 ? 0.01 : 0.0) && r[k].lower <= r[k].upper);
      if (k > 0) assert_int_equal(r[k].verdict, CPROX_VERDICT_VIOLATED);
      if (r[k].nodes > 1 || r[k].distance_queries > 18)
        fail_msg("set %d query %d: %u nodes, %u distances", i, k, r[k].nodes, r[k].distance_queries);
    }
  }
  for (int i = 0; i < 2; i++) cprox_obstacles_free(sets[i]);
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(ball);
  cprox_body_free(wall);
}

/* A box on a rail meets a box of the same section at t = 0.5, face to face: its sides slide along the other's, which
 * proves nothing. From x = 0.65 on they cross at the beginning. */
CASE(contact_of_faces_is_proven_near_its_time) {
  cprox_body *bodies[2], *wall;
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.2, 0.2, 0.2}, ws, &bodies[0]), CPROX_OK);
  assert_int_equal(cprox_body_create_box((cprox_vec3){1.0, 0.2, 0.2}, ws, &wall), CPROX_OK);
  bodies[1] = mesh_of_box(bodies[0]);
  const cprox_obstacle target =
      cprox_obstacle_at(wall, (cprox_pose){.position = {1.2, 0, 0}, .orientation = {.w = 1.0}});
  cprox_obstacles *sets[2];
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &sets[0]), CPROX_OK);
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_BVH, ws, &sets[1]), CPROX_OK);
  const cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {1, 0, 0}, .multiplier = 1.0};
  for (int i = 0; i < 8; i++) {
    const cprox_link_geometry geometry = {.body = bodies[i % 2], .pose = CPROX_POSE_IDENTITY};
    const double from = i / 4 ? 0.65 : 0.1, to = from + 1.0;
    const cprox_waypoint points[2] = {{.time = 0, .positions = &from}, {.time = 1, .positions = &to}};
    const int32_t variable = 0;
    const cprox_motion_description d = {.variables = &variable,
                                        .n_variables = 1,
                                        .waypoints = points,
                                        .n_waypoints = 2,
                                        .interpolation = CPROX_INTERPOLATION_LINEAR};
    cprox_robot *robot = NULL;
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
    assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
    cprox_result r;
    const cprox_mover mover = cprox_robot_along(motion, NULL, 0);
    assert_int_equal(cprox_obstacles_time_of_contact(sets[i / 2 % 2], mover, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    const double exact = i / 4 ? 0.0 : 0.5;
    assert_true(r.t_contact_lower <= exact && r.t >= exact - 1e-12);
    assert_true(r.t_contact_lower >= exact - 2e-6 && r.t <= exact + 2e-6);
    if (i / 4 && (r.nodes > 1 || r.distance_queries > 20))
      fail_msg("case %d: %u nodes, %u distances", i, r.nodes, r.distance_queries);
    cprox_motion_free(motion);
    cprox_robot_free(robot);
  }
  for (int i = 0; i < 2; i++) cprox_obstacles_free(sets[i]);
  for (int i = 0; i < 2; i++) cprox_body_free(bodies[i]);
  cprox_body_free(wall);
}

CASE(bad_input_gets_a_message) {
  rng r = rng_seed(4414);
  test_robot t;
  robot_make(&r, 1.0, &t);
  cprox_robot *robot = NULL;
  cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_REVOLUTE, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1};
  REFUSED(cprox_robot_create(NULL, 0, NULL, 0, 0, ws, &robot), "at least one link");
  REFUSED(cprox_robot_create(&link, 1, NULL, 0, 0, ws, &robot), "needs 1 variables");
  link.axis.z = 0;
  REFUSED(cprox_robot_create(&link, 1, NULL, 0, 1, ws, &robot), "axis is (0, 0, 0)");
  link.axis.z = 1, link.parent = 0;
  REFUSED(cprox_robot_create(&link, 1, NULL, 0, 1, ws, &robot), "parents stand before");
  assert_null(robot);

  link.parent = -1;
  assert_int_equal(cprox_robot_create(&link, 1, NULL, 0, 1, ws, &robot), CPROX_OK);
  const double still[] = {0.0}, bad[] = {NAN};
  const int32_t variables[] = {0, 0}, wrong[] = {3};
  cprox_waypoint points[] = {{.time = 0.0, .positions = still}, {.time = 0.0, .positions = still}};
  cprox_motion *motion = NULL;
  cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                .variables = variables,
                                .n_variables = 1,
                                .waypoints = points,
                                .n_waypoints = 1,
                                .interpolation = CPROX_INTERPOLATION_LINEAR};
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "at least 2");
  d.n_waypoints = 2;
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "must ascend");
  points[1].time = 1.0;
  d.n_variables = 2;
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "named twice");
  d.variables = wrong, d.n_variables = 1;
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "no variable 3");
  d.variables = variables, d.interpolation = CPROX_INTERPOLATION_CUBIC;
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "no velocities");
  points[1].positions = bad;
  d.interpolation = CPROX_INTERPOLATION_LINEAR;
  REFUSED(cprox_motion_create(robot, &d, ws, &motion), "position 0 is");
  assert_null(motion);
  const double knots[] = {0, 0, 1, 1};
  cprox_motion_description spline = {.kind = CPROX_MOTION_BSPLINE,
                                     .variables = variables,
                                     .n_variables = 1,
                                     .control = (const double[]){0, 1},
                                     .n_control = 2,
                                     .degree = 1,
                                     .knots = knots,
                                     .n_knots = 3};
  REFUSED(cprox_motion_create(robot, &spline, ws, &motion), "need 4 knots, got 3");
  spline.kind = (cprox_motion_kind)7;
  REFUSED(cprox_motion_create(robot, &spline, ws, &motion), "7 is no kind of motion");
  REFUSED(cprox_motion_create(robot, NULL, ws, &motion), "description of the motion is NULL");
  REFUSED(cprox_motion_create(NULL, &spline, ws, &motion), "robot is NULL");
  assert_null(motion);
  spline.kind = CPROX_MOTION_BSPLINE, spline.n_knots = 4;
  assert_int_equal(cprox_motion_create(robot, &spline, ws, &motion), CPROX_OK);
  const cprox_motion_info info = cprox_motion_get_info(motion);
  assert_true(info.kind == CPROX_MOTION_BSPLINE && info.t0 == 0.0 && info.t1 == 1.0 && info.n_pieces == 1);
  assert_int_equal(cprox_motion_get_link_info(motion, 0, -1).n_moved, 1);
  assert_int_equal(cprox_motion_get_link_info(motion, 0, 0).n_joints, 0);
  cprox_motion_free(motion);

  /* quaternions through 0 */
  cprox_robot *flying = NULL;
  link.type = CPROX_JOINT_FLOATING;
  assert_int_equal(cprox_robot_create(&link, 1, NULL, 0, 7, ws, &flying), CPROX_OK);
  const double q0[] = {0, 0, 0, 0, 0, 0, 1}, q1[] = {0, 0, 0, 0, 0, 0, -1};
  const int32_t seven[] = {0, 1, 2, 3, 4, 5, 6};
  const cprox_waypoint turn[] = {{.time = 0.0, .positions = q0}, {.time = 1.0, .positions = q1}};
  REFUSED(cprox_motion_create(flying,
                              &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                          .variables = seven,
                                                          .n_variables = 7,
                                                          .waypoints = turn,
                                                          .n_waypoints = 2,
                                                          .interpolation = CPROX_INTERPOLATION_LINEAR},
                              ws, &motion),
          "too near 0");

  const cprox_robot_pair pair = {0, 9}, far = {99, 0};
  cprox_result result;
  REFUSED(distance_of_list(cprox_robot_self(t.motion, &pair, 1), NULL, 0, NULL, ws, &result, NULL), "no geometry 9");
  REFUSED(distance_of_list(cprox_robot_self(t.motion, &far, 1), NULL, 0, NULL, ws, &result, NULL), "no geometry 99");
  cprox_robot_free(flying);
  cprox_robot_free(robot);
  robot_free(&t);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
