/* SPDX-License-Identifier: BSD-3-Clause */
/* The least distance of robots along their motions with all its derivatives, in turns with the distance alone; the least
 * growth distance with its derivatives, in turns with the distance's. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "robots.h"

enum { MOST_PROBLEMS = 2 * 128, MOST_VALUES = CASE_MAX_POINTS * CASE_MAX_VARIABLES };

typedef struct problem {
  const cprox_obstacles *obstacles; /* NULL: the robot itself */
  cprox_mover mover;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  cprox_motion_gradient gradient; /* with its arrays */
  double rows[4][MOST_VALUES];
} method_state;

static void ask(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_result r;
  const cprox_status status = cprox_obstacles_distance(p->obstacles, p->mover, NULL, state, &r, NULL);
  *answer = (bench_answer){.lower = r.lower,
                           .upper = r.upper,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = status != CPROX_OK};
}

static void ask_gradient(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state *s = state;
  cprox_result r;
  const cprox_status status =
      cprox_robot_distance_gradient(p->obstacles, p->mover, NULL, s->workspace, &r, &s->gradient);
  *answer = (bench_answer){.lower = r.lower,
                           .upper = r.upper,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = status != CPROX_OK};
}

static void ask_growth(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  method_state *s = state;
  cprox_motion_growth found;
  const cprox_status status = cprox_robot_growth(p->obstacles, p->mover, NULL, s->workspace, &found, &s->gradient);
  *answer = (bench_answer){.lower = found.growth.lower,
                           .upper = found.growth.upper,
                           .distance_queries = found.growth.pairs,
                           .failed = status != CPROX_OK};
}

/* Motions that stay apart: overlaps have no gradient here. */
void bench_robot_gradients(const robot_case *cases, size_t n_cases, const bench_size *size, cprox_workspace *ws) {
  if (!bench_wanted(size, "gradient")) return;
  cprox_obstacles *obstacles[MOST_PROBLEMS] = {NULL};
  static problem problems[MOST_PROBLEMS];
  static method_state with;
  with.workspace = ws;
  with.gradient = (cprox_motion_gradient){
      .variables = with.rows[0], .positions = with.rows[1], .velocities = with.rows[2], .accelerations = with.rows[3]};
  size_t n = 0;
  for (size_t i = 0; i < n_cases && n + 2 <= MOST_PROBLEMS; i++) {
    const robot_case *c = &cases[i];
    if (cprox_obstacles_create(c->targets, c->n_targets, CPROX_INDEX_BVH, ws, &obstacles[i]) != CPROX_OK) continue;
    const problem both[2] = {{obstacles[i], cprox_robot_along(c->motion, NULL, 0)},
                             {NULL, cprox_robot_self(c->motion, c->self_pairs, c->n_self_pairs)}};
    for (int k = 0; k < 2; k++) {
      cprox_result r = {.upper = 0.0};
      cprox_obstacles_distance(both[k].obstacles, both[k].mover, NULL, ws, &r, NULL);
      if (r.upper > 0.0 && isfinite(r.upper)) problems[n++] = both[k];
    }
  }
  const bench_workload w = {"robots", "gradient", "value and all derivatives", problems, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", ask_gradient, &with}, {"distance alone", ask, ws}};
  if (n > 0) bench_measure(&w, size, methods, 2);
  const bench_workload growth = {"robots", "growth distance", "value and all derivatives", problems, n, NULL, 0.0};
  const bench_method beside[] = {{"curve_proximity", ask_growth, &with},
                                 {"distance and derivatives", ask_gradient, &with}};
  if (n > 0) bench_measure(&growth, size, beside, 2);
  for (size_t i = 0; i < MOST_PROBLEMS; i++) cprox_obstacles_free(obstacles[i]);
}
