/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets of 10 to 10^4 bodies against asking all of them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "solve/list.h"
#include "worlds/worlds.h"

static void of_set(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  const cprox_options o = worlds_options(WORLDS_EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_obstacles_distance(p->set, worlds_mover(p), &o, ((worlds_asked *)state)->ws, &r, NULL);
  worlds_take(&r, a);
}

static void of_all(const void *problems, size_t i, void *state, bench_answer *a) {
  const worlds_problem *p = (const worlds_problem *)problems + i;
  const cprox_options o = worlds_options(WORLDS_EPSILON);
  cprox_result r = {.status = CPROX_INVALID};
  list_distance(worlds_mover(p), p->targets, p->n_targets, &o, ((worlds_asked *)state)->ws, &r, NULL);
  worlds_take(&r, a);
}

/* Boxes at one density: a curve meets as many, however many there are. */
void worlds_ask_sets(const bench_size *size, worlds_asked *q) {
  static const size_t counts[] = {10, 100, 1000, 10000};
  if (!bench_wanted(size, "set distance")) return;
  cprox_body *body = NULL;
  worlds_check(cprox_body_create_box(vec(0.2, 0.1, 0.3), q->ws, &body), q->ws);
  for (int k = 0; k < 4; k++) {
    rng r = rng_seed(307);
    const size_t n = counts[k], m = size->problems < 40 ? size->problems : 40;
    const double half = 0.5 * cbrt((double)n);
    cprox_obstacle *targets = worlds_get(n * sizeof *targets);
    for (size_t i = 0; i < n; i++) targets[i] = cprox_obstacle_at(body, rng_pose(&r, half));
    cprox_obstacles *set = NULL;
    worlds_check(cprox_obstacles_create(targets, n, CPROX_INDEX_BVH, q->ws, &set), q->ws);
    worlds_problem *problems = worlds_get(m * sizeof *problems);
    double *truth = worlds_get(m * sizeof *truth);
    for (size_t i = 0; i < m; i++) {
      problems[i] = (worlds_problem){.set = set, .targets = targets, .n_targets = n};
      const double inner = 0.5 * half;
      worlds_curve_make(&r, &problems[i], vec(0, 0, 0), vec(inner, inner, inner), 1.0);
      cprox_result result;
      const cprox_options fine = worlds_options(1e-12);
      worlds_check(list_distance(worlds_mover(&problems[i]), targets, n, &fine, q->ws, &result, NULL), q->ws);
      truth[i] = 0.5 * (result.lower + result.upper);
    }
    char parameter[32];
    snprintf(parameter, sizeof parameter, "targets %zu", n);
    const bench_workload w = {.group = "worlds",
                              .name = "set distance",
                              .parameter = parameter,
                              .problems = problems,
                              .n = m,
                              .truth = truth,
                              .doubt = 1e-12};
    const bench_method methods[2] = {{"curve_proximity", of_set, q}, {"all targets", of_all, q}};
    bench_measure(&w, size, methods, 2);
    for (size_t i = 0; i < m; i++) cprox_curve_free(problems[i].curve);
    cprox_obstacles_free(set);
    free(targets), free(problems), free(truth);
  }
  cprox_body_free(body);
}
