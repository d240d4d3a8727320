/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods that answer the families, and how they are judged. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peers/libraries.h"
#include "stability/hard.h"
#include "support/make_curve.h"

static const double EPSILON = 1e-9;

/* ---- judging: the same for all ---- */

/* The distances are sums of a few doubles of the inputs' size. */
static double doubt(const hard *h) {
  double size = 1.0;
  for (size_t i = 0; i <= h->degree; i++) size = fmax(size, vec_norm(h->points[i]));
  return 16.0 * 0x1p-52 * size;
}

static void judge(const hard *h, bool ended, double lower, double upper, bench_answer *a) {
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = a->nodes, .distance_queries = a->distance_queries};
  const double slack = doubt(h);
  const bool contains = lower <= h->truth + slack && upper >= h->truth - slack;
  const bool narrow = upper - lower <= EPSILON + 4.0 * slack;
  a->wrong = !contains || (ended && !narrow);
  a->failed = !a->wrong && !ended;
}

/* ---- the methods ---- */

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const hard *h = (const hard *)problems + i;
  const tools *t = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  const cprox_obstacle target =
      h->second ? cprox_obstacle_curve(h->second, 0.0) : cprox_obstacle_at(h->body, CPROX_POSE_IDENTITY);
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance(cprox_point_along(h->curve), target, &options, t->workspace, &r);
  *a = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries};
  judge(h, r.status == CPROX_OK || (r.status == CPROX_PRECISION && r.upper - r.lower <= EPSILON + 4.0 * doubt(h)),
        r.lower, r.upper, a);
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  const hard *h = (const hard *)problems + i;
  const tools *t = state;
  const paper_query q = {.query_type = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = 20000};
  const paper_curve first = paper_bezier_curve(&h->bezier[0], h->planar);
  paper_answer r;
  if (h->second) {
    const paper_curve second = paper_bezier_curve(&h->bezier[1], h->planar);
    paper_search_curves(&first, &second, &q, t->heap, &r);
  } else {
    const paper_obstacle obstacle = {.vertex = h->vertex, .n = h->n};
    paper_search(&first, &obstacle, &q, t->heap, &r);
  }
  *a = (bench_answer){.nodes = r.nodes, .distance_queries = r.evaluations};
  judge(h, r.ended, r.lower, r.upper, a);
}

/* What is mostly done: the least distance of a thousand points of the curve (and of the other one). It never says that
 * it may be off. */
static void sampling(const void *problems, size_t i, void *state, bench_answer *a) {
  enum { SAMPLES = 1000, OTHER = 100 };
  const hard *h = (const hard *)problems + i;
  const tools *t = state;
  vec3 other[OTHER + 1];
  for (size_t k = 0; h->second && k <= OTHER; k++)
    cprox_curve_evaluate(h->second, (double)k / OTHER, t->workspace, &other[k], NULL, NULL);
  double least = INFINITY;
  for (size_t k = 0; k <= SAMPLES; k++) {
    vec3 x;
    cprox_curve_evaluate(h->curve, (double)k / SAMPLES, t->workspace, &x, NULL, NULL);
    if (!h->second) least = fmin(least, fmax(0.0, cprox_body_nearest(h->body, x, NULL)));
    for (size_t m = 0; h->second && m <= OTHER; m++) least = fmin(least, vec_norm(vec_sub(x, other[m])));
  }
  *a = (bench_answer){.nodes = SAMPLES};
  judge(h, true, least, least, a);
}

/* A library for curves: a value that claims to be the distance. */
typedef struct library {
  const curve_peer *peer;
  size_t number;
} library;

static void by_library(const void *problems, size_t i, void *state, bench_answer *a) {
  const hard *h = (const hard *)problems + i;
  const library *s = state;
  const void *own[2] = {h->own[0][s->number], h->own[1][s->number]};
  double vertex[MAX_VERTICES][3], value = NAN;
  for (size_t k = 0; k < h->n; k++)
    vertex[k][0] = h->vertex[k].x, vertex[k][1] = h->vertex[k].y, vertex[k][2] = h->vertex[k].z;
  if (own[0] && h->n == 0 && own[1]) value = s->peer->to_curve(own[0], own[1]);
  if (own[0] && h->n == 1) value = s->peer->to_point(own[0], vertex[0]);
  if (own[0] && h->n > 1) value = s->peer->to_polygon(own[0], (const double(*)[3])vertex, h->n);
  judge(h, true, value, value, a);
  a->failed = isnan(value);
  a->wrong = a->wrong && !a->failed;
}

/* ---- one family ---- */

static void finish(hard *h) {
  cprox_status status = curve_from(describe_bezier(h->points, h->degree + 1, 0.0, 1.0), NULL, &h->curve);
  if (status >= 0 && h->n > 0) status = cprox_body_create_polytope(h->vertex, h->n, NULL, &h->body);
  if (status >= 0 && h->n == 0)
    status = curve_from(describe_bezier(h->other, h->degree + 1, 0.0, 1.0), NULL, &h->second);
  if (status < 0) exit(1);
  paper_bezier_make(h->points, h->degree, &h->bezier[0]);
  if (h->n == 0) paper_bezier_make(h->other, h->degree, &h->bezier[1]);
  libraries_make(h->points, h->degree + 1, h->degree, NULL, h->own[0]);
  if (h->n == 0) libraries_make(h->other, h->degree + 1, h->degree, NULL, h->own[1]);
}

static void drop(hard *h) {
  cprox_curve_free(h->curve);
  cprox_curve_free(h->second);
  cprox_body_free(h->body);
  libraries_drop(h->own[0]);
  libraries_drop(h->own[1]);
}

void stability_family(const bench_size *size, const family *f, uint64_t seed, tools *t) {
  hard *problems = calloc(size->problems, sizeof *problems);
  if (!problems) exit(1);
  rng r = rng_seed(seed);
  for (size_t i = 0; i < size->problems; i++) {
    f->make(&r, &problems[i]);
    finish(&problems[i]);
  }
  char parameter[48];
  snprintf(parameter, sizeof parameter, "%zu cases seed %llu", size->problems, (unsigned long long)seed);
  const bench_workload w = {
      .group = "stability", .name = f->name, .parameter = parameter, .problems = problems, .n = size->problems};
  bench_method methods[3 + MOST_LIBRARIES] = {
      {"curve_proximity", ours, t}, {"paper", paper, t}, {"sampling at 1000 points", sampling, t}};
  library libraries[MOST_LIBRARIES];
  size_t n = 3;
  for (size_t k = 0; curve_libraries[k]; k++) {
    if (problems[0].n > 1 && !curve_libraries[k]->to_polygon) continue;
    libraries[k] = (library){curve_libraries[k], k};
    methods[n++] = (bench_method){curve_libraries[k]->name, by_library, &libraries[k]};
  }
  bench_measure(&w, size, methods, n);
  for (size_t i = 0; i < size->problems; i++) drop(&problems[i]);
  free(problems);
}
