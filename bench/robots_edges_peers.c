/* SPDX-License-Identifier: BSD-3-Clause */
/* The edges of a planner beside samples: of the core's own lanes, of FCL, and of a planner's validator where one is
 * built in. The states are the same for all three, eight to a batch, spread over the edge each time, its end first. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "peers/lane_sampling.h"
#include "peers/robot_states.h"
#include "robots_edges.h"
#include "shape/body.h"
#include "support/edge_truth.h"

enum { FINENESS = 8, AT_ONCE = 8, NAME = 80 };

void edge_world_ready_peers(edge_world *world) {
  static robot_case seen;
  seen = *world->model;
  memcpy(seen.targets, world->targets, sizeof seen.targets);
  seen.n_targets = world->n_targets;
  if (robot_fcl_name()) world->fcl = robot_states_fcl(&seen);
  world->validator = edge_validator_create(world->moves->name);
  for (size_t i = 0; world->validator && i < world->n_targets; i++) {
    const cprox_obstacle *target = &world->targets[i];
    const double *size = target->body->shape.size;
    if (target->body->kind == CPROX_BODY_BOX)
      edge_validator_add_box(world->validator, target->pose, (cprox_vec3){size[0], size[1], size[2]});
    else if (target->body->kind == CPROX_BODY_CAPSULE)
      edge_validator_add_capsule(world->validator, target->pose, size[0], size[1]);
    else
      edge_validator_add_sphere(world->validator, target->pose, target->body->shape.margin);
  }
  if (world->validator) edge_validator_ready(world->validator);
}

void edge_by_fcl(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const robot_case *model = p->world->model;
  double length = 0.0, values[CASE_MAX_VARIABLES];
  for (size_t k = 0; k < model->n_variables; k++) length += (p->to[k] - p->from[k]) * (p->to[k] - p->from[k]);
  const int n = (int)fmax(ceil(sqrt(length) * ((const edge_state *)state)->per_radian / AT_ONCE), 1.0);
  bool hits = false;
  for (int at = 0; at < n && !hits; at++)
    for (int l = 0; l < AT_ONCE && !hits; l++) {
      const double t = (double)((l + 1) * n - at) / (double)(AT_ONCE * n);
      for (size_t k = 0; k < model->n_variables; k++) values[k] = p->from[k] + t * (p->to[k] - p->from[k]);
      robot_states_place(p->world->fcl, model, values);
      hits = robot_fcl_collides(p->world->fcl);
    }
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .wrong = hits == p->valid};
}

void edge_by_validator(const void *problems, size_t i, void *state, bench_answer *answer) {
  const edge_problem *p = (const edge_problem *)problems + i;
  const int per_radian = (int)((const edge_state *)state)->per_radian;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  answer->wrong = edge_validator_hits(p->world->validator, p->from, p->to, per_radian) == p->valid;
}

void edge_judge(edge_problem *problems, size_t n) {
  size_t unknown = 0, other = 0;
  for (size_t i = 0; i < n; i++) {
    const edge_world *w = problems[i].world;
    const edge_truth truth = edge_truth_of(w->model, w->targets, w->n_targets, problems[i].from, problems[i].to);
    unknown += truth == EDGE_TRUTH_UNKNOWN;
    if (truth == EDGE_TRUTH_UNKNOWN || problems[i].valid == (truth == EDGE_TRUTH_CLEAR)) continue;
    problems[i].valid = !problems[i].valid, other++;
  }
  if (unknown > 0) fprintf(stderr, "edges: of %zu of %zu the truth is not known\n", unknown, n);
  if (other > 0) fprintf(stderr, "edges: %zu of %zu verdicts are not true\n", other, n);
}

/* A method at each fineness. */
static size_t add_methods(bench_method *methods, const char *pattern, const char *of, bench_run run, edge_state *states,
                          char names[FINENESS][NAME]) {
  for (int k = 0; k < FINENESS; k++) {
    snprintf(names[k], NAME, pattern, of, (int)states[k].per_radian);
    methods[k] = (bench_method){names[k], run, &states[k]};
  }
  return FINENESS;
}

/* So many finenesses are enough: at the last one of them samples are never wrong. */
static int enough(const edge_problem *problems, size_t n, edge_state *states) {
  for (int k = 0; k < FINENESS && lane_sampling_exists(); k++) {
    size_t wrong = 0;
    for (size_t i = 0; i < n; i++) {
      bench_answer answer;
      edge_by_lanes(problems, i, &states[k], &answer);
      wrong += answer.wrong;
    }
    if (wrong == 0) return k + 1;
  }
  return FINENESS;
}

void edge_rows_of_samples(const edge_robot *robot, const char *workload, const edge_problem *problems, size_t n,
                          const bench_size *size, cprox_workspace *ws) {
  static char names[3][FINENESS][NAME];
  edge_state states[FINENESS], own = {.workspace = ws};
  for (int k = 0; k < FINENESS; k++) states[k] = (edge_state){.workspace = ws, .per_radian = (double)(4 << k)};
  bench_method methods[1 + 2 * FINENESS] = {{"curve_proximity", edge_certified, &own}};
  size_t count = 1;
  if (n == 0) return;
  if (lane_sampling_exists())
    count += add_methods(methods + count, "%s at %d a radian", "the same lanes", edge_by_lanes, states, names[0]);
  if (problems[0].world->validator)
    count +=
        add_methods(methods + count, "%s at %d a radian", edge_validator_name(), edge_by_validator, states, names[1]);
  const bench_workload w = {"robots", workload, robot->parameter, problems, n, NULL, 0.0};
  bench_measure(&w, size, methods, count);

  /* FCL takes minutes: once, and no finer than it needs */
  const bench_size once = {.problems = size->problems, .rounds = 1};
  if (!problems[0].world->fcl) return;
  add_methods(methods, "%s at %d a radian", "FCL", edge_by_fcl, states, names[2]);
  bench_measure(&w, &once, methods, (size_t)enough(problems, n, states));
}
