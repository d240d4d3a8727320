/* SPDX-License-Identifier: BSD-3-Clause */
/* How the cost grows: an arm among more and more obstacles, a chain of more and more links against itself, two arms. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec.h"
#include "curve_proximity/cprox.h"
#include "peers/two_ended.h"
#include "robots.h"
#include "solve/list.h"
#include "support/random.h"

static const double EPSILON = 1e-4, STEP = 0.05;

typedef struct problem {
  cprox_mover mover;
  const cprox_obstacle *targets;
  size_t n;
  const cprox_obstacles *set;
  double delta;   /* verdicts; below 0: a distance */
  double epsilon; /* 0: EPSILON */
} problem;

static void answer_with(cprox_status status, const cprox_result *r, bench_answer *answer) {
  *answer =
      (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .distance_queries = r->distance_queries};
  answer->failed = status != CPROX_OK;
}

static void by_set(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  answer_with(cprox_obstacles_distance(p->set, p->mover, &options, state, &r, NULL), &r, answer);
}

static double epsilon_of(const problem *p) {
  return p->epsilon > 0.0 ? p->epsilon : EPSILON;
}

static void by_list(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon_of(p);
  cprox_result r;
  if (p->delta < 0.0) {
    answer_with(list_distance(p->mover, p->targets, p->n, &options, state, &r, NULL), &r, answer);
    return;
  }
  answer_with(list_tolerance(p->mover, p->targets, p->n, p->delta, &options, state, &r, NULL), &r, answer);
  answer->lower = answer->upper = NAN;
  answer->wrong = r.verdict != CPROX_VERDICT_CLEAR;
}

static void sampled(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  peer_answer r;
  sampled_distance(&p->mover, p->targets, p->n, STEP, false, state, &r);
  *answer =
      (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
}

static void two_ended(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  peer_answer r;
  two_ended_distance(&p->mover, p->targets, p->n, epsilon_of(p), 60000, state, &r);
  *answer = (bench_answer){.lower = r.lower,
                           .upper = r.upper,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = !r.complete};
}

/* The distance by list, which is what all others are held against. */
static double truth_of(const problem *p, cprox_workspace *ws) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-7;
  cprox_result r;
  list_distance(p->mover, p->targets, p->n, &options, ws, &r, NULL);
  return 0.5 * (r.lower + r.upper);
}

static void measure(const char *name, const char *parameter, const problem *p, const bench_size *size,
                    const bench_method *methods, size_t n, cprox_workspace *ws) {
  const double truth = truth_of(p, ws);
  const bench_workload w = {"robots", name, parameter, p, 1, p->delta < 0.0 ? &truth : NULL, 1.1e-7};
  bench_measure(&w, size, methods, n);
}

/* ---- obstacles ---- */

/* Boxes of up to a decimetre, crowded round the arm, none nearer to its path than 2 centimetres. */
static void obstacles(const robot_case *arm, const bench_size *size, cprox_workspace *ws) {
  enum { MOST = 10000 };
  static const double CLEAR = 0.02, HALF = 1.2;
  static const size_t COUNTS[] = {10, 30, 100, 300, 1000, 3000, MOST};
  rng r = rng_seed(90);
  cprox_obstacle *targets = calloc(MOST, sizeof *targets);
  cprox_body *boxes[8];
  for (int i = 0; i < 8; i++) {
    const cprox_vec3 edges = {rng_uniform(&r, 0.01, 0.1), rng_uniform(&r, 0.01, 0.1), rng_uniform(&r, 0.01, 0.1)};
    cprox_body_create_box(edges, NULL, &boxes[i]);
  }
  const cprox_mover mover = cprox_robot_along(arm->motion, NULL, 0);
  size_t n = 0;
  for (size_t k = 0; k < sizeof COUNTS / sizeof *COUNTS; k++) {
    while (n < COUNTS[k]) {
      targets[n] = cprox_obstacle_at(boxes[rng_index(&r, 8)], rng_pose(&r, HALF));
      cprox_result clear;
      cprox_tolerance(mover, targets[n], CLEAR, NULL, ws, &clear);
      n += clear.verdict == CPROX_VERDICT_CLEAR;
    }
    cprox_obstacles *set = NULL;
    cprox_obstacles_create(targets, n, CPROX_INDEX_BVH, ws, &set);
    const problem p = {.mover = mover, .targets = targets, .n = n, .set = set, .delta = -1.0};
    char parameter[40];
    snprintf(parameter, sizeof parameter, "obstacles %zu", n);
    const bench_method methods[] = {
        {"curve_proximity", by_set, ws}, {"as a list", by_list, ws}, {"sampling .05", sampled, ws}};
    measure("growth obstacles", parameter, &p, size, methods, 3, ws);
    cprox_obstacles_free(set);
  }
  for (int i = 0; i < 8; i++) cprox_body_free(boxes[i]);
  free(targets);
}

/* ---- links ---- */

enum { LONGEST_CHAIN = 96 };

/* How a chain bends, from one gentle curve to another to a third. */
typedef struct bends {
  double values[3][LONGEST_CHAIN];
} bends;

static cprox_motion *bend(const cprox_robot *robot, const bends *b, size_t n) {
  int32_t variables[LONGEST_CHAIN];
  cprox_waypoint points[3];
  for (int32_t i = 0; i < (int32_t)n; i++) variables[i] = i;
  for (int k = 0; k < 3; k++) points[k] = (cprox_waypoint){.time = k, .positions = b->values[k]};
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = variables,
                                      .n_variables = n,
                                      .waypoints = points,
                                      .n_waypoints = 3,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR};
  cprox_motion *motion = NULL;
  cprox_motion_create(robot, &d, NULL, &motion);
  return motion;
}

/* Chains of capsules, their axes in turns across and up; of each length the first links of the same 45 chains. */
static void links(const bench_size *size, cprox_workspace *ws) {
  enum { CHAINS = 45 };
  static const size_t COUNTS[] = {6, 12, 24, 48, LONGEST_CHAIN};
  static cprox_link tree[LONGEST_CHAIN];
  static cprox_link_geometry bodies[LONGEST_CHAIN];
  static bends chains[CHAINS];
  rng r = rng_seed(91);
  cprox_body *capsule = NULL;
  cprox_body_create_capsule(0.12, 0.03, NULL, &capsule);
  for (int32_t i = 0; i < LONGEST_CHAIN; i++) {
    const double up = i % 2;
    tree[i] = (cprox_link){.parent = i - 1,
                           .origin = {.position = {0, 0, i > 0 ? 0.15 : 0.0}, .orientation = {.w = 1.0}},
                           .type = CPROX_JOINT_REVOLUTE,
                           .axis = {up, 1.0 - up, 0},
                           .variable = i,
                           .multiplier = 1.0};
    bodies[i] = (cprox_link_geometry){
        .link = i, .body = capsule, .pose = {.position = {0, 0, 0.075}, .orientation = {.w = 1.0}}};
    for (int c = 0; c < CHAINS; c++)
      for (int k = 0; k < 3; k++) chains[c].values[k][i] = rng_uniform(&r, -0.3, 0.3);
  }
  for (size_t k = 0; k < sizeof COUNTS / sizeof *COUNTS; k++) {
    cprox_robot *robot = NULL;
    cprox_robot_create(tree, COUNTS[k], bodies, COUNTS[k], COUNTS[k], NULL, &robot);
    problem problems[CHAINS];
    double truth[CHAINS];
    for (int c = 0; c < CHAINS; c++) {
      problems[c] = (problem){.mover = cprox_robot_self(bend(robot, &chains[c], COUNTS[k]), NULL, 0), .delta = -1.0};
      truth[c] = truth_of(&problems[c], ws);
    }
    char parameter[40];
    snprintf(parameter, sizeof parameter, "links %zu", COUNTS[k]);
    const bench_method methods[] = {{"curve_proximity", by_list, ws}, {"sampling .05", sampled, ws}};
    const bench_workload w = {"robots", "growth links", parameter, problems, CHAINS, truth, 1.1e-7};
    bench_measure(&w, size, methods, 2);
    for (int c = 0; c < CHAINS; c++) cprox_motion_free((cprox_motion *)problems[c].mover.motion);
    cprox_robot_free(robot);
  }
  cprox_body_free(capsule);
}

/* ---- two arms ---- */

/* The arm and its like face to face, each with balls (tools, cables) at its links besides; as many pairs as an SRDF of
 * such a cell leaves. */
static void two_arms(const robot_case *arm, const bench_size *size, cprox_workspace *ws) {
  enum { PAIRS = 560, MOST_LINKS = 2 * CASE_MAX_LINKS, MOST_BODIES = 4 * CASE_MAX_GEOMETRIES };
  cprox_link tree[MOST_LINKS];
  cprox_link_geometry bodies[MOST_BODIES];
  cprox_robot_pair pairs[PAIRS];
  int32_t hulls[2][CASE_MAX_GEOMETRIES];
  size_t n_bodies = 0, n_pairs = 0;
  cprox_body *ball = NULL;
  cprox_body_create_sphere(0.07, NULL, &ball);
  for (size_t side = 0; side < 2; side++) {
    for (size_t i = 0; i < arm->n_links; i++) {
      cprox_link *link = &tree[side * arm->n_links + i];
      *link = arm->tree[i];
      if (link->parent >= 0) link->parent += (int32_t)(side * arm->n_links);
      if (link->variable >= 0) link->variable += (int32_t)(side * arm->n_variables);
      if (link->parent < 0 && side) /* opposite, turned round */
        link->origin = (cprox_pose){.position = {1.3, 0.25, 0.0}, .orientation = {.z = 1.0}};
    }
    for (size_t i = 0; i < arm->n_geometries; i++) {
      const int32_t link = arm->links[i] + (int32_t)(side * arm->n_links);
      hulls[side][i] = (int32_t)n_bodies;
      bodies[n_bodies++] = (cprox_link_geometry){.link = link, .body = arm->bodies[i], .pose = arm->poses[i]};
      for (int k = 0; k < (i == 0 ? 2 : 1); k++)
        bodies[n_bodies++] = (cprox_link_geometry){.link = link, .body = ball, .pose = arm->poses[i]};
    }
  }

  double start[2 * CASE_MAX_VARIABLES], middle[2 * CASE_MAX_VARIABLES], end[2 * CASE_MAX_VARIABLES];
  int32_t variables[2 * CASE_MAX_VARIABLES];
  const cprox_motion_info info = cprox_motion_get_info(arm->motion);
  const double t0 = info.t0, t1 = info.t1;
  for (size_t side = 0; side < 2; side++) { /* the other one the other way */
    cprox_motion_evaluate(arm->motion, side ? t1 : t0, start + side * arm->n_variables);
    cprox_motion_evaluate(arm->motion, 0.5 * (t0 + t1), middle + side * arm->n_variables);
    cprox_motion_evaluate(arm->motion, side ? t0 : t1, end + side * arm->n_variables);
  }
  for (size_t i = 0; i < 2 * arm->n_variables; i++) variables[i] = (int32_t)i;
  const cprox_waypoint points[3] = {
      {.time = 0, .positions = start}, {.time = 1, .positions = middle}, {.time = 2, .positions = end}};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  const bool made =
      cprox_robot_create(tree, 2 * arm->n_links, bodies, n_bodies, 2 * arm->n_variables, ws, &robot) == CPROX_OK &&
      cprox_motion_create(robot,
                          &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                      .variables = variables,
                                                      .n_variables = 2 * arm->n_variables,
                                                      .waypoints = points,
                                                      .n_waypoints = 3,
                                                      .interpolation = CPROX_INTERPOLATION_LINEAR},
                          ws, &motion) == CPROX_OK;
  /* all of one arm against all of the other, and of each arm what its SRDF leaves */
  const size_t half = n_bodies / 2;
  for (size_t i = half; i < n_bodies; i++)
    for (size_t k = 0; k < half && n_pairs < PAIRS; k++) pairs[n_pairs++] = (cprox_robot_pair){(int32_t)i, (int32_t)k};
  for (size_t i = 0; i < 2 * arm->n_self_pairs && n_pairs < PAIRS; i++) {
    const cprox_robot_pair *own = &arm->self_pairs[i / 2];
    pairs[n_pairs++] = (cprox_robot_pair){hulls[i % 2][own->geometry], hulls[i % 2][own->other]};
  }
  problem p = {.mover = cprox_robot_self(motion, pairs, n_pairs), .delta = -1.0};
  char parameter[40];
  snprintf(parameter, sizeof parameter, "pairs %zu", n_pairs);
  const bench_method distance[] = {
      {"curve_proximity", by_list, ws}, {"two-ended bound", two_ended, ws}, {"sampling .05", sampled, ws}};
  if (made) {
    measure("two arms distance", parameter, &p, size, distance, 3, ws);
    p.delta = 0.9 * truth_of(&p, ws);
    measure("two arms tolerance", parameter, &p, size, distance, 1, ws);
  } else {
    fprintf(stderr, "two arms: %s\n", cprox_workspace_error(ws));
  }
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* ---- a flat minimum ---- */

/* A base that slides along a wall from rest to rest, turning a little on the way and back: it is as near as it gets all
 * the way. */
static void slide(const bench_size *size, cprox_workspace *ws) {
  static const double EPSILONS[] = {1e-3, 1e-6};
  const cprox_link tree[2] = {{.parent = -1,
                               .origin = CPROX_POSE_IDENTITY,
                               .type = CPROX_JOINT_PRISMATIC,
                               .axis = {1, 0, 0},
                               .multiplier = 1.0},
                              {.parent = 0,
                               .origin = CPROX_POSE_IDENTITY,
                               .type = CPROX_JOINT_REVOLUTE,
                               .axis = {0, 0, 1},
                               .variable = 1,
                               .multiplier = 1.0}};
  cprox_body *base = NULL, *wall = NULL;
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  cprox_body_create_cylinder(0.4, 0.3, ws, &base);
  cprox_body_create_box((cprox_vec3){6.0, 0.1, 2.0}, ws, &wall);
  const cprox_link_geometry body = {.link = 1, .body = base, .pose = CPROX_POSE_IDENTITY};
  const double still[2] = {0, 0}, from[2] = {-1.5, 0}, middle[2] = {0, 0.1}, to[2] = {1.5, 0};
  const int32_t variables[2] = {0, 1};
  const cprox_waypoint points[3] = {{.time = 0, .positions = from, .velocities = still, .accelerations = still},
                                    {.time = 2, .positions = middle, .velocities = still, .accelerations = still},
                                    {.time = 4, .positions = to, .velocities = still, .accelerations = still}};
  if (cprox_robot_create(tree, 2, &body, 1, 2, ws, &robot) == CPROX_OK &&
      cprox_motion_create(robot,
                          &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                      .variables = variables,
                                                      .n_variables = 2,
                                                      .waypoints = points,
                                                      .n_waypoints = 3,
                                                      .interpolation = CPROX_INTERPOLATION_QUINTIC},
                          ws, &motion) == CPROX_OK) {
    const cprox_obstacle target =
        cprox_obstacle_at(wall, (cprox_pose){.position = {0, 0.5, 0}, .orientation = {.w = 1.0}});
    for (int k = 0; k < 2; k++) {
      const problem p = {.mover = cprox_robot_along(motion, NULL, 0),
                         .targets = &target,
                         .n = 1,
                         .delta = -1.0,
                         .epsilon = EPSILONS[k]};
      char parameter[40];
      snprintf(parameter, sizeof parameter, "to %g", EPSILONS[k]);
      const bench_method methods[] = {{"curve_proximity", by_list, ws}, {"two-ended bound", two_ended, ws}};
      measure("flat slide", parameter, &p, size, methods, 2, ws);
    }
  } else {
    fprintf(stderr, "flat slide: %s\n", cprox_workspace_error(ws));
  }
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(base);
  cprox_body_free(wall);
}

void bench_robot_scale(const robot_case *arm, const bench_size *size, cprox_workspace *ws) {
  if (bench_wanted(size, "growth obstacles")) obstacles(arm, size, ws);
  if (bench_wanted(size, "growth links")) links(size, ws);
  if (bench_wanted(size, "flat slide")) slide(size, ws);
  if (bench_wanted(size, "two arms")) two_arms(arm, size, ws);
}
