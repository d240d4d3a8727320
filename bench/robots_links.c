/* SPDX-License-Identifier: BSD-3-Clause */
/* Arms against themselves by their own triangle meshes, along random paths of 2 to 8 waypoints: verdicts and distances
 * beside FCL at states between which no joint moves farther than .05 rad. FCL calls all of these states free, as the
 * planner of such a path does. The UR5's forearm and second wrist, whose hulls reach into each other, alone. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "kinematics/motion.h"
#include "peers/robot_states.h"
#include "peers/two_ended.h"
#include "robots.h"
#include "solve/list.h"
#include "support/random.h"

enum { PATHS = 110, MOST_POINTS = 8, MOST_TRIES = 200 };

static const double STEP = 0.05, LONGEST = 1.5;

typedef struct problem {
  const robot_case *c;
  robot_fcl *fcl;
  cprox_motion *motion;
  const cprox_robot_pair *pairs;
  size_t n_pairs;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  double epsilon;
} method_state;

static void verdict(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  cprox_result r;
  const cprox_status status =
      list_collision(cprox_robot_self(p->motion, p->pairs, p->n_pairs), NULL, 0, NULL, s->workspace, &r, NULL);
  *answer = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries, .failed = status < 0};
}

static void distance(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = s->epsilon;
  cprox_result r;
  const cprox_status status =
      list_distance(cprox_robot_self(p->motion, p->pairs, p->n_pairs), NULL, 0, &options, s->workspace, &r, NULL);
  *answer = (bench_answer){.lower = r.lower,
                           .upper = r.upper,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = status != CPROX_OK};
}

/* Whether a state collides; it ends with the first one. */
static bool collides(const problem *p, uint32_t *states) {
  double values[CASE_MAX_VARIABLES];
  for (size_t segment = 0; segment < p->motion->n_segments; segment++) {
    const int count = sampled_steps(p->motion, segment, STEP);
    for (int i = segment == 0 ? 0 : 1; i <= count; i++) {
      cprox_motion_evaluate(p->motion, (double)segment + (double)i / count, values);
      robot_states_place(p->fcl, p->c, values);
      (*states)++;
      if (robot_fcl_collides(p->fcl)) return true;
    }
  }
  return false;
}

static void by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  (void)state;
  const problem *p = (const problem *)problems + i;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  collides(p, &answer->nodes);
}

/* Straight from one waypoint to the next, a second each. */
static cprox_motion *path_along(const robot_case *c, double values[][CASE_MAX_VARIABLES], size_t n) {
  int32_t variables[CASE_MAX_VARIABLES];
  cprox_waypoint points[MOST_POINTS];
  for (int i = 0; i < CASE_MAX_VARIABLES; i++) variables[i] = i;
  for (size_t i = 0; i < n; i++) points[i] = (cprox_waypoint){.time = (double)i, .positions = values[i]};
  const cprox_motion_description d = {.variables = variables,
                                      .n_variables = c->n_variables,
                                      .waypoints = points,
                                      .n_waypoints = n,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR};
  cprox_motion *motion = NULL;
  cprox_motion_create(c->mesh_robot, &d, NULL, &motion);
  return motion;
}

/* `joints` joints move within +-range, the other variables stand still. Free by FCL's samples, one piece after the
 * other. */
static cprox_motion *random_path(const robot_case *c, robot_fcl *fcl, size_t joints, double range, rng *r) {
  double values[MOST_POINTS][CASE_MAX_VARIABLES] = {{0.0}};
  const size_t n = 2 + rng_index(r, MOST_POINTS - 1);
  for (size_t k = 0; k < joints; k++) values[0][k] = rng_uniform(r, -range, range);
  for (size_t i = 1, tries = 0; i < n; tries++) {
    const double length = rng_uniform(r, 0.2, LONGEST);
    if (tries > MOST_TRIES) return NULL;
    for (size_t k = 0; k < joints; k++) {
      const double to = values[i - 1][k] + rng_uniform(r, -length, length);
      values[i][k] = fmin(fmax(to, -range), range);
    }
    problem p = {.c = c, .fcl = fcl, .motion = path_along(c, values + i - 1, 2)};
    uint32_t states = 0;
    i += p.motion && !collides(&p, &states);
    cprox_motion_free(p.motion);
  }
  return path_along(c, values, n);
}

/* How many of n. */
static size_t random_paths(const robot_case *c, robot_fcl *fcl, size_t joints, double range, size_t n,
                           problem *problems) {
  rng r = rng_seed(18);
  size_t found = 0;
  for (int tries = 0; tries < MOST_TRIES && found < n; tries++) {
    const problem p = {.c = c,
                       .fcl = fcl,
                       .motion = random_path(c, fcl, joints, range, &r),
                       .pairs = c->self_pairs,
                       .n_pairs = c->n_self_pairs};
    if (p.motion) problems[found++] = p;
  }
  return found;
}

/* The geometry of a link; -1: it has none. */
static int32_t geometry_of(const robot_case *c, const char *link) {
  for (size_t i = 0; i < c->n_geometries; i++)
    if (strcmp(c->link_names[c->links[i]], link) == 0) return (int32_t)i;
  return -1;
}

/* Two links whose hulls reach into each other, alone. */
static void row_of_pair(const robot_case *c, const char *parameter, const char *link, const char *other,
                        problem *problems, size_t n, const bench_size *size, const bench_method *method) {
  const cprox_robot_pair pair = {geometry_of(c, link), geometry_of(c, other)};
  if (pair.geometry < 0 || pair.other < 0 || !bench_wanted(size, "own meshes of a pair")) return;
  for (size_t i = 0; i < n; i++) problems[i].pairs = &pair, problems[i].n_pairs = 1;
  const bench_workload w = {"robots", "own meshes of a pair", parameter, problems, n, NULL, 0.0};
  bench_measure(&w, size, method, 1);
  for (size_t i = 0; i < n; i++) problems[i].pairs = c->self_pairs, problems[i].n_pairs = c->n_self_pairs;
}

static void rows(const char *robot, size_t joints, double range, const bench_size *size, cprox_workspace *ws) {
  static robot_case c;
  static problem problems[PATHS];
  if (!robot_case_read_robot(BENCH_DATA_DIR "/motion", robot, &c)) return;
  robot_fcl *fcl = robot_states_fcl(&c);
  const size_t most = size->problems < PATHS ? size->problems : PATHS,
               n = random_paths(&c, fcl, joints, range, most, problems);
  method_state fine = {.workspace = ws, .epsilon = 1e-4}, coarse = {.workspace = ws, .epsilon = 1e-3};
  const int peers = robot_fcl_name() ? 2 : 1;
  const bench_method verdicts[] = {{"curve_proximity", verdict, &fine}, {"FCL boolean at .05", by_fcl, NULL}};
  const bench_method fines[] = {{"curve_proximity", distance, &fine}, {"FCL boolean at .05", by_fcl, NULL}};
  const bench_method coarses[] = {{"curve_proximity", distance, &coarse}, {"FCL boolean at .05", by_fcl, NULL}};
  bench_workload w = {"robots", "own meshes verdict", robot, problems, n, NULL, 0.0};
  if (bench_wanted(size, w.name)) bench_measure(&w, size, verdicts, (size_t)peers);
  w.name = "own meshes distance 1e-4";
  if (bench_wanted(size, w.name)) bench_measure(&w, size, fines, (size_t)peers);
  w.name = "own meshes distance 1e-3";
  if (bench_wanted(size, w.name)) bench_measure(&w, size, coarses, (size_t)peers);
  row_of_pair(&c, "forearm and second wrist verdict", "forearm_link", "wrist_2_link", problems, n, size, verdicts);
  row_of_pair(&c, "forearm and second wrist 1e-4", "forearm_link", "wrist_2_link", problems, n, size, fines);
  for (size_t i = 0; i < n; i++) cprox_motion_free(problems[i].motion);
  robot_fcl_free(fcl);
  robot_case_free(&c);
}

void bench_robot_links(const bench_size *size, cprox_workspace *ws) {
  if (!bench_wanted(size, "own meshes verdict") && !bench_wanted(size, "own meshes distance 1e-4") &&
      !bench_wanted(size, "own meshes distance 1e-3") && !bench_wanted(size, "own meshes of a pair"))
    return;
  rows("ur5", 6, 3.14159, size, ws);
  rows("panda", 7, 1.8, size, ws);
}
