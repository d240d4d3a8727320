/* SPDX-License-Identifier: BSD-3-Clause */
/* Straight edges of a planner, as RRT-Connect meets them in the scenes of the saved trajectories: certified, beside
 * samples by the same lanes. The robot is the Panda by 59 balls, against the scene and itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "peers/lane_sampling.h"
#include "robots.h"
#include "support/random.h"

enum { EDGES = 4096, JOINTS = 7, TREE = 128, MOST_WORLDS = 64, MEMORY = 1 << 16 };

/* Of the Panda [rad], the longest edge, the share of edges towards the goal, and samples to each radian. */
static const double LOW[JOINTS] = {-2.9671, -1.8326, -2.9671, -3.1416, -2.9671, -0.0873, -2.9671};
static const double HIGH[JOINTS] = {2.9671, 1.8326, 2.9671, 0.0873, 2.9671, 3.8223, 2.9671};
static const double LONGEST = 2.0, TO_GOAL = 0.2, PER_RADIAN = 32.0;

typedef struct edge_problem {
  const cprox_edge_checker *checker;
  const cprox_robot *robot; /* what that was made of */
  const cprox_obstacles *obstacles;
  const cprox_robot_pair *self_pairs;
  size_t n_self_pairs;
  double from[JOINTS], to[JOINTS];
  bool valid;
} edge_problem;

typedef struct edge_state {
  cprox_workspace *workspace;
  double per_radian;
} edge_state;

static _Alignas(64) char lanes[MEMORY], motion[MEMORY];

static void certified(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  uint8_t verdict;
  cprox_edge_result r;
  const cprox_status status = cprox_robot_edges(p->checker, p->from, p->to, 1, s->workspace, &verdict, &r);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.intervals, .distance_queries = r.nodes};
  answer->failed = status < 0 || verdict == CPROX_VERDICT_UNDECIDED;
  answer->wrong = verdict != (p->valid ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
}

static void by_samples(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  answer->wrong = lane_sampling_hits(p->checker, p->from, p->to, s->per_radian, lanes, motion) == p->valid;
}

/* The same edge as a motion that is made for it, by the query for any motion. */
static void as_motion(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const edge_state *s = state;
  static const int32_t VARIABLES[JOINTS] = {0, 1, 2, 3, 4, 5, 6};
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = p->from}, {.time = 1.0, .positions = p->to}};
  const cprox_motion_description edge = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .variables = VARIABLES,
                                         .n_variables = JOINTS,
                                         .waypoints = ends,
                                         .n_waypoints = 2,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR};
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .failed = true};
  cprox_motion *along = NULL;
  if (cprox_motion_create(p->robot, &edge, s->workspace, &along) < 0) return;
  const cprox_mover mover = cprox_robot_whole(cprox_robot_along(along, NULL, 0), p->self_pairs, p->n_self_pairs);
  cprox_result r = {0};
  const cprox_status status = cprox_obstacles_collision(p->obstacles, mover, NULL, s->workspace, &r, NULL);
  answer->nodes = r.nodes, answer->distance_queries = r.distance_queries;
  answer->failed = status < 0 || r.verdict == CPROX_VERDICT_UNDECIDED;
  answer->wrong = r.verdict != (p->valid ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  cprox_motion_free(along);
}

static double apart2(const double *a, const double *b) {
  double d = 0.0;
  for (int k = 0; k < JOINTS; k++) d += (a[k] - b[k]) * (a[k] - b[k]);
  return d;
}

static cprox_verdict verdict_of(const cprox_edge_checker *c, const double *from, const double *to,
                                cprox_workspace *ws) {
  uint8_t verdict = CPROX_VERDICT_UNDECIDED;
  cprox_robot_edges(c, from, to, 1, ws, &verdict, NULL);
  return (cprox_verdict)verdict;
}

/* The edges that a tree from a motion's beginning and end tries. */
static size_t grow(const edge_problem *in, const double ends[2][JOINTS], size_t wanted, rng *r, edge_problem *out,
                   cprox_workspace *ws) {
  const cprox_edge_checker *c = in->checker;
  double grown[TREE][JOINTS];
  size_t n_grown = 2, n = 0;
  memcpy(grown, ends, 2 * sizeof grown[0]);
  for (size_t tries = 0; tries < 4 * wanted && n < wanted; tries++) {
    double towards[JOINTS];
    const bool to_goal = rng_uniform(r, 0, 1) < TO_GOAL;
    for (int k = 0; k < JOINTS; k++) towards[k] = to_goal ? ends[1][k] : rng_uniform(r, LOW[k], HIGH[k]);
    size_t nearest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < n_grown; k++) {
      const double d = apart2(grown[k], towards);
      if (d < least && d > 1e-6) least = d, nearest = k;
    }
    if (isinf(least)) continue;
    edge_problem p = *in;
    const double share = fmin(1.0, LONGEST / sqrt(least));
    for (int k = 0; k < JOINTS; k++) {
      p.from[k] = grown[nearest][k];
      p.to[k] = p.from[k] + share * (towards[k] - p.from[k]);
    }
    if (verdict_of(c, p.from, p.from, ws) != CPROX_VERDICT_CLEAR) continue;
    const cprox_verdict verdict = verdict_of(c, p.from, p.to, ws);
    if (verdict == CPROX_VERDICT_UNDECIDED) fprintf(stderr, "edges: one is undecided\n");
    p.valid = verdict == CPROX_VERDICT_CLEAR;
    out[n++] = p;
    if (p.valid && n_grown < TREE) memcpy(grown[n_grown++], p.to, sizeof p.to);
  }
  return n;
}

static void rows(const char *parameter, const edge_problem *all, size_t n, bool valid, const bench_size *size,
                 cprox_workspace *ws) {
  static edge_problem some[EDGES];
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (all[i].valid == valid) some[count++] = all[i];
  edge_state state = {.workspace = ws, .per_radian = PER_RADIAN};
  const bench_method methods[] = {{"curve_proximity", certified, &state},
                                  {"each as a motion", as_motion, &state},
                                  {"the same lanes at 32 a radian", by_samples, &state}};
  const bench_workload w = {"robots", valid ? "valid edges" : "invalid edges", parameter, some, count, NULL, 0.0};
  if (count > 0 && bench_wanted(size, w.name)) bench_measure(&w, size, methods, lane_sampling_exists() ? 3 : 2);
}

void bench_robot_edges(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *ws) {
  if (!bench_wanted(size, "valid edges") && !bench_wanted(size, "invalid edges")) return;
  static robot_case balls;
  static edge_problem all[EDGES];
  if (!robot_case_read_robot(BENCH_DATA_DIR "/motion", "panda_spheres", &balls)) return;
  cprox_obstacles *sets[MOST_WORLDS];
  cprox_edge_checker *checkers[MOST_WORLDS];
  size_t n_worlds = 0, worlds = 0, n_all = 0;
  for (size_t i = 0; i < n; i++) worlds += strcmp(cases[i].robot_name, "panda") == 0 && worlds < MOST_WORLDS;
  rng r = rng_seed(94);
  for (size_t i = 0; i < n && n_worlds < worlds; i++) {
    if (strcmp(cases[i].robot_name, "panda") != 0) continue;
    const cprox_robot_pair *self = balls.self_pairs;
    if (cprox_obstacles_create(cases[i].targets, cases[i].n_targets, CPROX_INDEX_NONE, ws, &sets[n_worlds]) != CPROX_OK)
      continue;
    const cprox_edge_query asked = {
        .obstacles = sets[n_worlds], .self_pairs = self, .n_self_pairs = balls.n_self_pairs};
    if (cprox_edge_checker_create(balls.robot, &asked, ws, &checkers[n_worlds]) != CPROX_OK) {
      cprox_obstacles_free(sets[n_worlds]);
      continue;
    }
    double ends[2][CASE_MAX_VARIABLES], arm[2][JOINTS];
    const cprox_motion_info info = cprox_motion_get_info(cases[i].motion);
    for (int k = 0; k < 2; k++) {
      cprox_motion_evaluate(cases[i].motion, k ? info.t1 : info.t0, ends[k]);
      memcpy(arm[k], ends[k], sizeof arm[k]);
    }
    const edge_problem in = {.checker = checkers[n_worlds],
                             .robot = balls.robot,
                             .obstacles = sets[n_worlds],
                             .self_pairs = self,
                             .n_self_pairs = balls.n_self_pairs};
    n_worlds++;
    n_all += grow(&in, (const double(*)[JOINTS])arm, EDGES / worlds, &r, all + n_all, ws);
  }
  rows("panda_spheres scene and self", all, n_all, true, size, ws);
  rows("panda_spheres scene and self", all, n_all, false, size, ws);
  for (size_t i = 0; i < n_worlds; i++) {
    cprox_edge_checker_free(checkers[i]);
    cprox_obstacles_free(sets[i]);
  }
  balls.n_targets = 0;
  robot_case_free(&balls);
}
