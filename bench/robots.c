/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots along joint splines, 23 trajectories (test/data/motion): the least distance to the scene and to the robot
 * itself, verdicts, and thin obstacles. Beside ours: the bound of both ends, and samples, both on our own kinematics
 * and distances. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "peers/robot_states.h"
#include "peers/two_ended.h"
#include "robots.h"
#include "solve/list.h"
#include "support/measure.h"
#include "support/random.h"
#include "support/robot_case.h"

enum { MAX_CASES = 32, MAX_PROBLEMS = 64, PEER_NODES = 60000 };

typedef struct problem {
  const robot_case *c;
  bool self;
  double truth;
  robot_fcl *fcl;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  double epsilon, factor, step; /* factor: verdicts at that much of the true distance, below 0: none */
  int order;                    /* of a bound */
} method_state;

static cprox_mover mover_of(const problem *p) {
  return p->self ? cprox_robot_self(p->c->motion, p->c->self_pairs, p->c->n_self_pairs)
                 : cprox_robot_along(p->c->motion, NULL, 0);
}

static size_t targets_of(const problem *p) {
  return p->self ? 0 : p->c->n_targets;
}

static void ours(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state *s = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = s->epsilon;
  cprox_result r;
  cprox_status status;
  if (s->factor < 0.0) {
    status = list_distance(mover_of(p), p->c->targets, targets_of(p), &options, s->workspace, &r, NULL);
    *answer = (bench_answer){.lower = r.lower, .upper = r.upper};
  } else {
    status = list_tolerance(mover_of(p), p->c->targets, targets_of(p), s->factor * p->truth, &options, s->workspace, &r,
                            NULL);
    *answer = (bench_answer){.lower = p->truth, .upper = p->truth};
    answer->wrong = r.verdict != (s->factor < 1.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  }
  answer->nodes = r.nodes, answer->distance_queries = r.distance_queries, answer->failed = status != CPROX_OK;
}

static void by_bound(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state *s = state;
  const cprox_mover mover = mover_of(p);
  peer_answer r;
  central_distance(&mover, p->c->targets, targets_of(p), s->order, s->epsilon, PEER_NODES, s->workspace, &r);
  *answer = (bench_answer){.lower = r.lower,
                           .upper = r.upper,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = !r.complete};
}

static void by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  *answer = (bench_answer){0};
  answer->lower = answer->upper = robot_states_distance(p->fcl, p->c, s->step, p->self, &answer->nodes);
}

static void sampled(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state *s = state;
  const cprox_mover mover = mover_of(p);
  peer_answer r;
  sampled_distance(&mover, p->c->targets, targets_of(p), s->step, false, s->workspace, &r);
  *answer =
      (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  if (s->factor < 0.0) return;
  *answer =
      (bench_answer){.lower = p->truth, .upper = p->truth, .nodes = r.nodes, .distance_queries = r.distance_queries};
  answer->wrong = (r.upper > s->factor * p->truth) != (s->factor < 1.0);
}

static void distances(const problem *problems, size_t n, bool self, const bench_size *size, cprox_workspace *ws) {
  static const double EPSILON[] = {1e-3, 1e-4, 1e-6};
  problem some[MAX_PROBLEMS];
  double truth[MAX_PROBLEMS];
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (problems[i].self == self) some[count] = problems[i], truth[count++] = problems[i].truth;
  for (int k = 0; k < 3; k++) {
    method_state state = {.workspace = ws, .epsilon = EPSILON[k], .factor = -1.0, .step = 0.05};
    method_state bound[3] = {state, state, state};
    for (int order = 0; order < 3; order++) bound[order].order = order > 0 ? order + 1 : 0;
    char parameter[40];
    snprintf(parameter, sizeof parameter, "epsilon %g", EPSILON[k]);
    const bench_workload w = {"robots", self ? "self" : "environment", parameter, some, count, truth, 1.1e-6};
    const bench_method methods[] = {{"curve_proximity", ours, &state},
                                    {"two-ended bound", by_bound, &bound[0]},
                                    {"bound M2", by_bound, &bound[1]},
                                    {"bound M3", by_bound, &bound[2]},
                                    {"sampling .05", sampled, &state}};
    bench_measure(&w, size, methods, 5);
  }
  static const double STEP[] = {0.05, 0.01};
  for (int k = 0; k < 2; k++) {
    method_state state = {.workspace = ws, .epsilon = 1e-4, .factor = -1.0, .step = STEP[k]};
    char parameter[40];
    snprintf(parameter, sizeof parameter, "step %g", STEP[k]);
    const bench_workload w = {"robots", self ? "self" : "environment", parameter, some, count, truth, 1.1e-6};
    const bench_method methods[] = {{"curve_proximity", ours, &state}, {"sampling", sampled, &state}};
    bench_measure(&w, size, methods, 2);
  }

  /* FCL takes seconds: some of them, once */
  enum { SOME = 8 };
  method_state state = {.workspace = ws, .epsilon = 1e-4, .factor = -1.0, .step = 0.05};
  const bench_size once = {.problems = SOME, .rounds = 1};
  const bench_workload w = {
      "robots", self ? "self" : "environment", "FCL at step 0.05", some, count < SOME ? count : SOME, truth, 1.1e-6};
  const bench_method methods[] = {{"curve_proximity", ours, &state}, {"FCL distance", by_fcl, &state}};
  bench_measure(&w, &once, methods, robot_fcl_name() ? 2 : 1);
}

/* Verdicts by a least distance, at an epsilon that tells it from delta: what they cost without a search of their own.
 */
static void verdict_by_distance(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state s = *(const method_state *)state;
  s.epsilon = 0.5 * fabs(s.factor - 1.0) * p->truth, s.factor = -1.0;
  if (s.order < 0)
    ours(problems, i, &s, answer);
  else
    by_bound(problems, i, &s, answer);
  answer->lower = answer->upper = p->truth;
}

static void verdicts(const problem *problems, size_t n, const bench_size *size, cprox_workspace *ws) {
  static const double FACTOR[] = {0.5, 0.9, 0.99, 1.01, 1.1};
  for (int k = 0; k < 5; k++) {
    method_state state = {.workspace = ws, .epsilon = 1e-6, .factor = FACTOR[k], .step = 0.05};
    char parameter[40];
    snprintf(parameter, sizeof parameter, "delta %g D", FACTOR[k]);
    const bench_workload w = {"robots", "tolerance", parameter, problems, n, NULL, 0.0};
    method_state best_first = state, two_ended = state, fourth = state;
    best_first.order = -1, two_ended.order = 0, fourth.order = 4;
    const bench_method methods[] = {{"curve_proximity", ours, &state},
                                    {"sampling .05", sampled, &state},
                                    {"by distance", verdict_by_distance, &best_first},
                                    {"bound M4", verdict_by_distance, &fourth},
                                    {"two-ended bound", verdict_by_distance, &two_ended}};
    bench_measure(&w, size, methods, 5);
  }
}

/* ---- thin obstacles ---- */

enum { FULL_RUN = 200 };

typedef struct thin {
  const robot_case *c;
  cprox_obstacle target;
} thin;

static cprox_body *thin_body(rng *r) {
  cprox_body *body = NULL;
  const double length = rng_uniform(r, 0.05, 0.6), width = rng_log_uniform(r, 5e-4, 3e-3);
  if (rng_index(r, 2))
    cprox_body_create_cylinder(length, width, NULL, &body);
  else
    cprox_body_create_box((cprox_vec3){length, rng_index(r, 2) ? length : width, width}, NULL, &body);
  return body;
}

/* Blades: superquadrics from round to all but boxes; lenses: two balls and a plane that cuts them. */
static cprox_body *implicit_body(rng *r) {
  cprox_body *body = NULL;
  const double length = rng_uniform(r, 0.05, 0.6), width = rng_log_uniform(r, 5e-4, 3e-3);
  if (rng_index(r, 2)) {
    const cprox_vec3 semi_axes = {0.5 * length, rng_index(r, 2) ? 0.5 * length : 0.5 * width, 0.5 * width};
    const cprox_vec3 exponents = {rng_log_uniform(r, 1.2, 100), rng_log_uniform(r, 1.2, 100),
                                  rng_log_uniform(r, 1.2, 100)};
    cprox_body_create_superquadric(semi_axes, exponents, NULL, &body);
  } else {
    const double radius = (0.25 * length * length + 0.25 * width * width) / width, off = radius - 0.5 * width;
    const double balls[2][10] = {{1, 0, 0, 1, 0, 1, 0, 0, 2 * off, off * off - radius * radius},
                                 {1, 0, 0, 1, 0, 1, 0, 0, -2 * off, off * off - radius * radius}};
    const double plane[1][4] = {{1, 0, 0, -rng_uniform(r, 0, 0.4) * length}};
    const cprox_implicit_description lens = {.quadrics = balls, .n_quadrics = 2, .planes = plane, .n_planes = 1};
    cprox_body_create_implicit(&lens, NULL, NULL, &body);
  }
  return body;
}

static void ours_thin(const void *problems, size_t i, void *state, bench_answer *answer) {
  const thin *p = (const thin *)problems + i;
  method_state *s = state;
  cprox_result r;
  peer_answer fine;
  const cprox_mover mover = cprox_robot_along(p->c->motion, NULL, 0);
  const cprox_status status = cprox_collision(mover, p->target, NULL, s->workspace, &r);
  *answer = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries, .failed = status < 0};
  if (s->step > 0.0 &&
      r.verdict ==
          CPROX_VERDICT_CLEAR) { /* a sample that hits would give the lie to it; every eighth is looked at closer */
    const double step = i % 8 == 0 ? 0.3 * s->step : s->step;
    sampled_distance(&mover, &p->target, 1, step, true, s->workspace, &fine);
    answer->wrong = fine.upper <= 0.0;
  }
}

static void sampled_thin(const void *problems, size_t i, void *state, bench_answer *answer) {
  const thin *p = (const thin *)problems + i;
  method_state *s = state;
  const cprox_mover mover = cprox_robot_along(p->c->motion, NULL, 0);
  peer_answer r;
  cprox_result certified;
  sampled_distance(&mover, &p->target, 1, s->step, true, s->workspace, &r);
  *answer = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries};
  if (r.upper <= 0.0) return;
  cprox_collision(mover, p->target, NULL, s->workspace, &certified); /* a hit with a witness that the samples missed */
  answer->wrong = certified.verdict == CPROX_VERDICT_VIOLATED;
}

typedef struct thin_family {
  const char *name;
  cprox_body *(*make)(rng *r);
  size_t n, seed;
} thin_family;

static void thin_obstacles(const thin_family *family, const robot_case *cases, size_t n_cases, const bench_size *size,
                           cprox_workspace *ws) {
  rng r = rng_seed(family->seed);
  /* a quick run looks at a few, any other at all of them, once */
  const size_t n = size->problems < FULL_RUN ? size->problems : family->n;
  const bench_size once = {.problems = n, .rounds = 1};
  thin *problems = calloc(n, sizeof *problems);
  for (size_t i = 0; i < n; i++) {
    const cprox_pose pose = {
        .position = {rng_uniform(&r, -0.9, 0.9), rng_uniform(&r, -0.9, 0.9), rng_uniform(&r, 0, 1.2)},
        .orientation = rng_quat(&r)};
    problems[i] = (thin){&cases[rng_index(&r, n_cases)], cprox_obstacle_at(family->make(&r), pose)};
  }
  method_state certified = {.workspace = ws}, coarse = {.workspace = ws, .step = 0.05},
               fine = {.workspace = ws, .step = 0.01}, checked = {.workspace = ws, .step = 0.01};
  char parameter[64];
  snprintf(parameter, sizeof parameter, "%s %zu cases seed %zu", family->name, n, family->seed);
  const bench_workload w = {"robots", "thin obstacles", parameter, problems, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", ours_thin, &certified},
                                  {"curve_proximity checked", ours_thin, &checked},
                                  {"sampling .05", sampled_thin, &coarse},
                                  {"sampling .01", sampled_thin, &fine}};
  bench_measure(&w, &once, methods, 4);
  for (size_t i = 0; i < n; i++) cprox_body_free((cprox_body *)problems[i].target.body);
  free(problems);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  static robot_case cases[MAX_CASES];
  problem problems[MAX_PROBLEMS];
  size_t n_cases = 0, n = 0;
  cprox_workspace *ws = cprox_workspace_create();
  FILE *f = fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  if (!f || fscanf(f, "%zu", &n_cases) != 1 || n_cases > MAX_CASES) return 1;
  for (size_t i = 0; i < n_cases; i++) {
    robot_case *c = &cases[i];
    if (!robot_case_read(f, BENCH_DATA_DIR "/motion", c)) return 1;
    for (size_t k = 0; k < c->n_answers; k++)
      if (c->answers[k].lower > 0.0)
        problems[n++] = (problem){c, c->answers[k].self, 0.5 * (c->answers[k].lower + c->answers[k].upper), NULL};
  }
  fclose(f);
  robot_fcl *fcl[MAX_CASES] = {NULL};
  for (size_t i = 0; i < n_cases; i++) fcl[i] = robot_states_fcl(&cases[i]);
  for (size_t i = 0; i < n; i++) problems[i].fcl = fcl[problems[i].c - cases];
  if (bench_wanted(&size, "environment")) distances(problems, n, false, &size, ws);
  if (bench_wanted(&size, "self")) distances(problems, n, true, &size, ws);
  if (bench_wanted(&size, "tolerance")) verdicts(problems, n, &size, ws);
  static const thin_family families[] = {{"wires pins plates", thin_body, 10000, 77},
                                         {"implicit blades and lenses", implicit_body, 2000, 78}};
  for (size_t i = 0; i < 2 && bench_wanted(&size, "thin obstacles"); i++)
    thin_obstacles(&families[i], cases, n_cases, &size, ws);
  if (bench_wanted(&size, "pairs measured")) bench_robot_pairs(cases, n_cases, ws);
  bench_robot_waypoints(cases, n_cases, &size, ws);
  bench_robot_gradients(cases, n_cases, &size, ws);
  bench_robot_scale(&cases[0], &size, ws);
  bench_robot_links(&size, ws);
  bench_robot_states(cases, n_cases, &size, ws);
  bench_robot_errors(cases, n_cases, &size, ws);
  bench_robot_edges(cases, n_cases, &size, ws);
  for (size_t i = 0; i < n_cases; i++) {
    robot_fcl_free(fcl[i]);
    robot_case_free(&cases[i]);
  }
  cprox_workspace_free(ws);
  return 0;
}
