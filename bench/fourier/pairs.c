/* SPDX-License-Identifier: BSD-3-Clause */
/* What a verdict costs: gaps of two boxes beside the certified distance between them by GJK. The distance is faster and
 * finer on convex pairs; the gap is smooth, and its time does not depend on convexity. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fourier/parts.h"
#include "fourier/shapes.h"
#include "support/random.h"

typedef struct pair_problem {
  cprox_pose a, b;
  cprox_obstacle at, bt;
  double truth;
} pair_problem;

typedef struct asked {
  const cprox_gap *gap;
  bool gradient;
  cprox_workspace *ws;
} asked;

static void by_gap(const void *problems, size_t i, void *state, bench_answer *answer) {
  const pair_problem *p = (const pair_problem *)problems + i;
  const asked *q = state;
  cprox_gap_result r = {0};
  const cprox_status status = (q->gradient ? cprox_gap_evaluate : cprox_gap_test)(q->gap, &p->a, &p->b, q->ws, &r);
  *answer = (bench_answer){.lower = NAN, .upper = NAN, .nodes = r.terms, .failed = status < CPROX_OK};
  answer->wrong = (r.verdict == CPROX_GAP_VERDICT_CLEAR || r.verdict == CPROX_GAP_VERDICT_FAR) && p->truth < -1e-9;
}

static void by_distance(const void *problems, size_t i, void *state, bench_answer *answer) {
  const pair_problem *p = (const pair_problem *)problems + i;
  const asked *q = state;
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.epsilon = 1e-3;
  cprox_result r = {0};
  const cprox_status status = cprox_pair(p->at, p->bt, &o, q->ws, &r);
  *answer = (bench_answer){.lower = NAN,
                           .upper = NAN,
                           .nodes = r.nodes,
                           .distance_queries = r.distance_queries,
                           .failed = status < CPROX_OK};
}

void fourier_pairs(const bench_size *size) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_solid *s[2];
  cprox_body *b[2];
  const cprox_vec3 edges[2] = {{1.0, 0.7, 0.5}, {0.8, 0.8, 0.4}};
  for (int k = 0; k < 2; k++)
    if (cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = edges[k]}, ws,
                           &s[k]) ||
        cprox_body_create_box(edges[k], ws, &b[k]))
      abort();
  pair_problem *problems = calloc(size->problems, sizeof *problems);
  rng r = rng_seed(78);
  for (size_t i = 0; problems && i < size->problems; i++) {
    pair_problem *p = &problems[i];
    p->a = (cprox_pose){.orientation = rng_quat(&r)};
    p->b = (cprox_pose){.orientation = rng_quat(&r), .position = vec_scale(rng_uniform(&r, 0.2, 1.25), rng_unit(&r))};
    p->at = cprox_obstacle_at(b[0], p->a), p->bt = cprox_obstacle_at(b[1], p->b);
    cprox_options o = CPROX_OPTIONS_DEFAULT;
    cprox_result x = {0};
    cprox_pair(p->at, p->bt, &o, ws, &x);
    p->truth = x.upper;
  }
  const uint32_t samples[] = {9, 17, 33};
  for (int i = 0; problems && i < 3; i++) {
    char parameter[32];
    snprintf(parameter, sizeof parameter, "n %u", samples[i]);
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.samples = samples[i];
    cprox_gap *gap;
    if (cprox_gap_create(s[0], s[1], &o, ws, &gap)) abort();
    asked verdict = {gap, false, ws}, gradient = {gap, true, ws}, distance = {NULL, false, ws};
    const bench_method methods[3] = {{"curve_proximity", by_gap, &verdict},
                                     {"curve_proximity with gradient", by_gap, &gradient},
                                     {"curve_proximity distance", by_distance, &distance}};
    const bench_workload workload = {"fourier", "boxes", parameter, problems, size->problems, NULL, 0.0};
    bench_measure(&workload, size, methods, 3);
    cprox_gap_free(gap);
  }
  free(problems);
  for (int k = 0; k < 2; k++) cprox_solid_free(s[k]), cprox_body_free(b[k]);
  cprox_workspace_free(ws);
}
