/* SPDX-License-Identifier: BSD-3-Clause */
/* Verdicts for every execution within bounds of its errors, beside plain verdicts; the largest scale of the bounds. */
#include <math.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "robots.h"

enum { MOST = 64 };

/* Objects and base are off by this [m]. */
static const double PLACES = 2e-4;

/* Joints are off by so much [rad, m], and by so much times their speed [s]. */
typedef struct error_size {
  const char *name;
  double tracking, speed;
} error_size;

static const error_size SIZES[] = {{"joints off by 0.5 mrad", 5e-4, 0.0},
                                   {"joints off by 2 mrad", 2e-3, 0.0},
                                   {"joints off by 2 mrad and 5 ms", 2e-3, 5e-3},
                                   {"joints off by 5 mrad and 20 ms", 5e-3, 0.02}};

typedef struct problem {
  cprox_mover mover;
  const cprox_obstacles *obstacles;
  cprox_error_bounds bounds;
  double delta;
} problem;

static void answer_with(cprox_status status, const cprox_result *r, bench_answer *answer) {
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r->nodes, .distance_queries = r->distance_queries};
  answer->failed = status != CPROX_OK;
  answer->wrong = r->verdict != CPROX_VERDICT_CLEAR;
}

static void robust(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_result r;
  answer_with(cprox_robust_tolerance(p->obstacles, p->mover, p->delta, &p->bounds, NULL, state, &r), &r, answer);
}

static void plain(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_result r;
  answer_with(cprox_obstacles_tolerance(p->obstacles, p->mover, p->delta, NULL, state, &r, NULL), &r, answer);
}

/* nodes: the verdicts that the search for the scale asked for. */
static void scale(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  cprox_robust_scale s;
  const cprox_status status = cprox_robust_find_scale(p->obstacles, p->mover, p->delta, &p->bounds, NULL, state, &s);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = (uint32_t)s.n_verdicts, .failed = status < 0};
  answer->wrong = s.verdict != CPROX_VERDICT_CLEAR;
}

static void measure_size(const robot_case *cases, size_t n_cases, const error_size *errors, const bench_size *size,
                         cprox_workspace *ws) {
  double tracking[CASE_MAX_VARIABLES], speed[CASE_MAX_VARIABLES];
  for (size_t i = 0; i < CASE_MAX_VARIABLES; i++) tracking[i] = errors->tracking, speed[i] = errors->speed;
  problem problems[MOST];
  cprox_obstacles *obstacles[MOST];
  size_t n = 0;
  for (size_t i = 0; i < n_cases && n < MOST; i++) {
    const robot_case *c = &cases[i];
    if (c->n_targets == 0) continue;
    if (cprox_obstacles_create(c->targets, c->n_targets, CPROX_INDEX_BVH, ws, &obstacles[n]) != CPROX_OK) continue;
    problem *p = &problems[n];
    *p = (problem){.mover = cprox_robot_along(c->motion, NULL, 0), .obstacles = obstacles[n]};
    p->bounds = (cprox_error_bounds){.tracking = tracking,
                                     .speed = speed,
                                     .n_variables = c->n_variables,
                                     .base_position = PLACES,
                                     .object_position = PLACES};
    cprox_result r;
    /* half of what is certified: both are clear */
    cprox_robust_distance(p->obstacles, p->mover, &p->bounds, NULL, ws, &r);
    p->delta = 0.5 * r.lower;
    if (r.lower > 0.0)
      n++;
    else
      cprox_obstacles_free(obstacles[n]);
  }
  const bench_workload verdicts = {"robots", "robust verdict", errors->name, problems, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", robust, ws}, {"plain verdict", plain, ws}};
  if (bench_wanted(size, verdicts.name)) bench_measure(&verdicts, size, methods, 2);
  const bench_workload scales = {"robots", "largest scale", errors->name, problems, n, NULL, 0.0};
  const bench_method method = {"curve_proximity", scale, ws};
  if (bench_wanted(size, scales.name)) bench_measure(&scales, size, &method, 1);
  for (size_t i = 0; i < n; i++) cprox_obstacles_free(obstacles[i]);
}

void bench_robot_errors(const robot_case *cases, size_t n_cases, const bench_size *size, cprox_workspace *ws) {
  if (!bench_wanted(size, "robust verdict") && !bench_wanted(size, "largest scale")) return;
  for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++) measure_size(cases, n_cases, &SIZES[i], size, ws);
}
