/* SPDX-License-Identifier: BSD-3-Clause */
/* States of robots without a motion: is this posture free, how near is anything? By the robots' own meshes, against the
 * scene, against themselves and both, one state a call and many. FCL sees the same meshes, boxes and cylinders, one
 * state after the other. States are drawn about the saved trajectories; those of the UR5, which has none, anywhere, in
 * the scenes of the Panda. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "peers/robot_states.h"
#include "robots.h"
#include "support/random.h"

enum { STATES = 256, MANY = 32, MOST_CASES = 32, UR5_SCENES = 4 };

/* Joints are that far beside the trajectory at most, in rad or m. */
static const double BESIDE = 0.2;

typedef enum side { SCENE = 1, SELF = 2, BOTH = 3 } side;

/* A case as both see it. */
typedef struct world {
  const robot_case *c;
  cprox_obstacles *obstacles;
  robot_fcl *fcl;
} world;

typedef struct problem {
  const world *w;
  const double *states; /* rows of all variables, */
  size_t n;             /* so many */
  side about;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  bool distance;
} method_state;

static void ours(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  const robot_case *c = p->w->c;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  const cprox_state_query asked = {.obstacles = p->about & SCENE ? p->w->obstacles : NULL,
                                   .self_pairs = c->self_pairs,
                                   .n_self_pairs = c->n_self_pairs,
                                   .without_self = !(p->about & SELF),
                                   .distance = s->distance,
                                   .options = &options};
  cprox_result results[MANY];
  const cprox_status status =
      cprox_robot_ask_states(c->mesh_robot, &asked, p->states, p->n, s->workspace, results, NULL);
  *answer = (bench_answer){.failed = status < 0};
  for (size_t k = 0; k < p->n; k++) {
    answer->distance_queries += results[k].distance_queries;
    answer->failed = answer->failed || (!s->distance && results[k].verdict == CPROX_VERDICT_UNDECIDED);
    if (p->n == 1 && s->distance) answer->lower = results[k].lower, answer->upper = results[k].upper;
  }
}

static void by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .distance_queries = (uint32_t)p->n};
  for (size_t k = 0; k < p->n; k++) {
    robot_states_place(p->w->fcl, p->w->c, p->states + k * p->w->c->n_variables);
    if (!s->distance) {
      robot_fcl_collides(p->w->fcl);
      continue;
    }
    if (p->about & SCENE) robot_fcl_distance(p->w->fcl, false);
    if (p->about & SELF) robot_fcl_distance(p->w->fcl, true);
  }
}

/* How many verdicts are not FCL's. */
static uint32_t differing(const problem *problems, size_t n, cprox_workspace *ws) {
  uint32_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const problem *p = &problems[i];
    const robot_case *c = p->w->c;
    const cprox_state_query asked = {.obstacles = p->about & SCENE ? p->w->obstacles : NULL,
                                     .self_pairs = c->self_pairs,
                                     .n_self_pairs = c->n_self_pairs,
                                     .without_self = !(p->about & SELF)};
    cprox_result r;
    if (cprox_robot_ask_states(c->mesh_robot, &asked, p->states, 1, ws, &r, NULL) < 0) continue;
    robot_states_place(p->w->fcl, c, p->states);
    count += robot_fcl_collides(p->w->fcl) != (r.verdict == CPROX_VERDICT_VIOLATED);
  }
  return count;
}

/* FCL's world of what is asked about alone. */
static robot_fcl *fcl_of(const robot_case *c, side about) {
  static robot_case part;
  part = *c;
  if (!(about & SCENE)) part.n_targets = 0;
  if (!(about & SELF)) part.n_self_pairs = 0;
  return robot_states_fcl(&part);
}

static void draw_states(const robot_case *c, size_t n, rng *r, double *states) {
  const cprox_motion_info info = cprox_motion_get_info(c->mesh_motion);
  for (size_t i = 0; i < n; i++) {
    double *row = states + i * c->n_variables;
    for (size_t k = 0; c->n_answers == 0 && k < c->n_variables; k++) row[k] = rng_uniform(r, -3.14159, 3.14159);
    if (c->n_answers == 0) continue;
    cprox_motion_evaluate(c->mesh_motion, rng_uniform(r, info.t0, info.t1), row);
    for (size_t k = 0; k < c->n_variables; k++) row[k] += rng_uniform(r, -BESIDE, BESIDE);
  }
}

static void rows(const char *robot, const robot_case *cases, size_t n_cases, side about, const bench_size *size,
                 cprox_workspace *ws) {
  static const char *const NAMES[] = {"", "scene", "self", "scene and self"};
  static double states[STATES * CASE_MAX_VARIABLES];
  static problem one[STATES], many[STATES / MANY];
  world worlds[MOST_CASES];
  size_t n_worlds = 0, n = 0, n_many = 0, used = 0;
  rng r = rng_seed(93);
  for (size_t i = 0; i < n_cases; i++)
    if (strcmp(cases[i].robot_name, robot) == 0) n_worlds++;
  const size_t each = n_worlds ? STATES / n_worlds / MANY * MANY : 0,
               most = size->problems < STATES ? size->problems : STATES;
  n_worlds = 0;
  for (size_t i = 0; i < n_cases && n < most; i++) {
    if (strcmp(cases[i].robot_name, robot) != 0) continue;
    world *w = &worlds[n_worlds++];
    *w = (world){.c = &cases[i], .fcl = fcl_of(&cases[i], about)};
    if (cprox_obstacles_create(cases[i].targets, cases[i].n_targets, CPROX_INDEX_BVH, ws, &w->obstacles) != CPROX_OK) {
      fprintf(stderr, "states: %s\n", cprox_workspace_error(ws));
      continue;
    }
    double *first = states + used;
    const size_t count = each ? each : MANY;
    draw_states(w->c, count, &r, first);
    used += count * w->c->n_variables;
    for (size_t k = 0; k < count && n < most; k++)
      one[n++] = (problem){.w = w, .states = first + k * w->c->n_variables, .n = 1, .about = about};
    for (size_t k = 0; k + MANY <= count; k += MANY)
      many[n_many++] = (problem){.w = w, .states = first + k * w->c->n_variables, .n = MANY, .about = about};
  }
  method_state verdicts = {.workspace = ws}, distances = {.workspace = ws, .distance = true};
  const int peers = robot_fcl_name() ? 2 : 1;
  const bench_method verdict[] = {{"curve_proximity", ours, &verdicts}, {"FCL", by_fcl, &verdicts}};
  const bench_method distance[] = {{"curve_proximity", ours, &distances}, {"FCL", by_fcl, &distances}};
  char parameter[80];
  snprintf(parameter, sizeof parameter, "%s %s", robot, NAMES[about]);
  bench_workload w = {"robots", "state verdict", parameter, one, n, NULL, 0.0};
  if (n > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, verdict, (size_t)peers);
  if (n > 0 && peers == 2 && bench_wanted(size, w.name)) {
    const uint32_t other = differing(one, n, ws);
    if (other > 0) fprintf(stderr, "states of %s: %u of %zu verdicts are not FCL's\n", parameter, other, n);
  }
  w.name = "32 state verdicts", w.problems = many, w.n = n_many;
  if (n_many > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, verdict, (size_t)peers);
  w.name = "state distance", w.problems = one, w.n = n;
  if (n > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, distance, (size_t)peers);
  for (size_t i = 0; i < n_worlds; i++) {
    robot_fcl_free(worlds[i].fcl);
    cprox_obstacles_free(worlds[i].obstacles);
  }
}

void bench_robot_states(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *ws) {
  if (!bench_wanted(size, "state verdict") && !bench_wanted(size, "32 state verdicts") &&
      !bench_wanted(size, "state distance"))
    return;
  static const char *const ROBOTS[] = {"panda", "fanuc_m10ia", "husky"};
  for (size_t i = 0; i < sizeof ROBOTS / sizeof *ROBOTS; i++)
    for (int about = SCENE; about <= BOTH; about++) rows(ROBOTS[i], cases, n, (side)about, size, ws);

  /* the same UR5 in several scenes, whose objects stay the others' */
  static robot_case ur5[UR5_SCENES];
  size_t scenes = 0;
  if (!robot_case_read_robot(BENCH_DATA_DIR "/motion", "ur5", &ur5[0])) return;
  for (size_t i = 0; i < n && scenes < UR5_SCENES; i += 3, scenes++) {
    ur5[scenes] = ur5[0];
    memcpy(ur5[scenes].targets, cases[i].targets, sizeof cases[i].targets);
    ur5[scenes].n_targets = cases[i].n_targets;
  }
  for (int about = SCENE; about <= BOTH; about++) rows("ur5", ur5, scenes, (side)about, size, ws);
  ur5[0].n_targets = 0;
  robot_case_free(&ur5[0]);
}
