/* SPDX-License-Identifier: BSD-3-Clause */
/* Bézier curves against points, polygons and polytopes, and against each other: distance and tolerance, ours beside the
 * paper's method, over orders and accuracies. */
#include <stdio.h>
#include <stdlib.h>

#include "peers/libraries.h"
#include "support/measure.h"
#include "support/problems.h"
#include "support/samples.h"

/* What is asked, for both methods. */
typedef struct asked {
  double epsilon;
  double factor; /* tolerance: delta is this times the distance; 0: the distance itself is asked for */
  const double *truth;
  cprox_workspace *workspace;
  paper_node *heap;
} asked;

static void judge_verdict(const asked *q, cprox_verdict verdict, bench_answer *a) {
  a->wrong = verdict != (q->factor < 1.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  a->lower = a->upper = NAN;
}

static void take(const asked *q, size_t i, cprox_mover mover, cprox_obstacle target, bench_answer *a) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = q->epsilon;
  cprox_result r;
  const cprox_status status = q->factor > 0.0
                                  ? cprox_tolerance(mover, target, q->factor * q->truth[i], &options, q->workspace, &r)
                                  : cprox_distance(mover, target, &options, q->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status != CPROX_OK && status != CPROX_PRECISION;
  if (q->factor > 0.0) judge_verdict(q, r.verdict, a);
}

static paper_query paper_query_of(const asked *q, size_t i) {
  return (paper_query){.query_type = q->factor > 0.0 ? PAPER_TOLERANCE : PAPER_DISTANCE,
                       .delta = q->factor > 0.0 ? q->factor * q->truth[i] : 0.0,
                       .epsilon = q->epsilon,
                       .max_nodes = PAPER_MAX_NODES};
}

static void take_paper(const asked *q, const paper_answer *r, bench_answer *a) {
  *a = (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .distance_queries = r->evaluations};
  a->failed = !r->ended;
  if (q->factor > 0.0) judge_verdict(q, r->verdict ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED, a);
}

/* ---- the methods ---- */

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const curve_problem *p = (const curve_problem *)problems + i;
  take(state, i, cprox_point_along(p->curve), p->target, a);
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  const curve_problem *p = (const curve_problem *)problems + i;
  const asked *q = state;
  const paper_query query = paper_query_of(q, i);
  paper_answer r;
  paper_search(&p->paper, &p->paper_obstacle, &query, q->heap, &r);
  take_paper(q, &r, a);
}

static void ours_pair(const void *pairs, size_t i, void *state, bench_answer *a) {
  const curve_pair *p = (const curve_pair *)pairs + i;
  take(state, i, cprox_point_along(p->curve[0]), cprox_obstacle_curve(p->curve[1], 0.0), a);
}

static void paper_pair(const void *pairs, size_t i, void *state, bench_answer *a) {
  const curve_pair *p = (const curve_pair *)pairs + i;
  const asked *q = state;
  const paper_query query = paper_query_of(q, i);
  paper_answer r;
  paper_search_curves(&p->paper[0], &p->paper[1], &query, q->heap, &r);
  take_paper(q, &r, a);
}

/* ---- the workloads ---- */

/* Distance at 1e-10, at other accuracies, and verdicts about one set of problems. */
static void measure(const bench_size *size, const char *name, int order, bool accuracies, bench_method *methods,
                    size_t n_methods, const void *problems, size_t n, const double *truth, bool known, asked *q) {
  char workload[64], parameter[64];
  bench_workload w = {.group = "curves", .name = workload, .parameter = parameter, .problems = problems, .n = n};
  w.truth = known ? truth : NULL;
  w.doubt = 1e-15;
  q->truth = truth;

  snprintf(workload, sizeof workload, "%s distance", name);
  snprintf(parameter, sizeof parameter, "order %d eps 1e-10", order);
  q->epsilon = 1e-10, q->factor = 0.0;
  bench_measure(&w, size, methods, n_methods);
  for (int digits = 2; accuracies && digits <= 14; digits += 2) {
    if (digits == 10) continue;
    q->epsilon = pow(10.0, -digits);
    snprintf(parameter, sizeof parameter, "order %d eps 1e-%02d", order, digits);
    bench_measure(&w, size, methods, n_methods);
  }

  static const double factors[] = {0.5, 0.9, 0.99, 1.01, 1.1, 1.5};
  q->epsilon = 1e-10;
  for (size_t k = 0; known && k < sizeof factors / sizeof *factors; k++) {
    q->factor = factors[k];
    snprintf(workload, sizeof workload, "%s tolerance %s", name, factors[k] < 1.0 ? "clear" : "violated");
    snprintf(parameter, sizeof parameter, "order %d delta %.2f d", order, factors[k]);
    w.truth = NULL;
    bench_measure(&w, size, methods, n_methods);
  }
}

/* ---- samples, and libraries for curves, on the same problems ---- */

typedef struct library {
  const curve_peer *peer;
  void *(*own)[2][MOST_LIBRARIES];
  size_t number;
} library;

static void by_library(const void *queries, size_t i, void *state, bench_answer *a) {
  const sampled_query *p = (const sampled_query *)queries + i;
  const library *s = state;
  const void *first = s->own[i][0][s->number], *second = s->own[i][1][s->number];
  double point[3] = {0.0, 0.0, 0.0};
  if (p->obstacle)
    point[0] = p->obstacle->vertex[0].x, point[1] = p->obstacle->vertex[0].y, point[2] = p->obstacle->vertex[0].z;
  a->lower = a->upper = p->second ? s->peer->to_curve(first, second) : s->peer->to_point(first, point);
  a->failed = isnan(a->upper);
}

/* own: the libraries' copies of the curves, or NULL. */
static void measure_others(const bench_size *size, const char *name, int order, sampled_query *queries, size_t n,
                           const double *truth, void *(*own)[2][MOST_LIBRARIES]) {
  char workload[64], prefix[32], parameter[48];
  snprintf(workload, sizeof workload, "%s distance", name);
  snprintf(prefix, sizeof prefix, "order %d ", order);
  snprintf(parameter, sizeof parameter, "order %d as it is", order);
  samples_measure(size, "curves", workload, prefix, queries, n, truth);
  for (size_t k = 0; own && curve_libraries[k]; k++) {
    library s = {.peer = curve_libraries[k], .own = own, .number = k};
    const bench_workload w = {"curves", workload, parameter, queries, n, truth, 1e-15};
    bench_measure(&w, size, &(bench_method){curve_libraries[k]->name, by_library, &s}, 1);
  }
  for (size_t i = 0; own && i < n; i++) {
    libraries_drop(own[i][0]);
    libraries_drop(own[i][1]);
  }
}

static void others_of_obstacles(const bench_size *size, obstacle_kind kind, const char *name,
                                const curve_problem *problems, const double *truth) {
  const size_t n = size->problems / 4;
  sampled_query *queries = calloc(n, sizeof *queries);
  void *(*own)[2][MOST_LIBRARIES] = calloc(n, sizeof *own);
  if (!queries || !own) exit(1);
  for (size_t i = 0; i < n; i++) {
    queries[i] = (sampled_query){.curve = problems[i].curve, .obstacle = &problems[i].obstacle};
    if (kind == OBSTACLE_POINT)
      libraries_make(problems[i].points, problems[i].degree + 1, problems[i].degree, NULL, own[i][0]);
  }
  measure_others(size, name, (int)problems[0].degree, queries, n, truth, kind == OBSTACLE_POINT ? own : NULL);
  free(own);
  free(queries);
}

static void others_of_pairs(const bench_size *size, const char *name, const curve_pair *pairs, const double *truth) {
  const size_t n = size->problems / 4;
  sampled_query *queries = calloc(n, sizeof *queries);
  void *(*own)[2][MOST_LIBRARIES] = calloc(n, sizeof *own);
  if (!queries || !own) exit(1);
  for (size_t i = 0; i < n; i++) {
    queries[i] = (sampled_query){.curve = pairs[i].curve[0], .second = pairs[i].curve[1]};
    for (int k = 0; k < 2; k++)
      libraries_make(pairs[i].points[k], pairs[i].degree + 1, pairs[i].degree, NULL, own[i][k]);
  }
  measure_others(size, name, (int)pairs[0].degree, queries, n, truth, own);
  free(own);
  free(queries);
}

/* ---- all of one kind ---- */

static void measure_obstacles(const bench_size *size, obstacle_kind kind, const char *name, asked *q) {
  if (!bench_wanted(size, name)) return;
  static const int orders[] = {5, 15, 45};
  for (size_t k = 0; k < 3; k++) {
    curve_problem *problems = curve_problems_make(kind, (size_t)orders[k], size->problems);
    double *truth = curve_problems_truth(problems, size->problems, kind);
    bench_method methods[] = {{"curve_proximity", ours, q}, {"paper", paper, q}};
    measure(size, name, orders[k], orders[k] == 15, methods, 2, problems, size->problems, truth,
            kind != OBSTACLE_LARGE_POLYTOPE, q);
    if (orders[k] == 15 && (kind == OBSTACLE_POINT || kind == OBSTACLE_POLYTOPE))
      others_of_obstacles(size, kind, name, problems, truth);
    free(truth);
    curve_problems_free(problems, size->problems);
  }
}

static void measure_pairs(const bench_size *size, bool planar, const char *name, asked *q) {
  if (!bench_wanted(size, name)) return;
  static const int orders[] = {5, 10};
  const size_t n = size->problems / 2;
  for (size_t k = 0; k < 2; k++) {
    curve_pair *pairs = curve_pairs_make((size_t)orders[k], planar, n);
    double *truth = curve_pairs_truth(pairs, n);
    bench_method methods[] = {{"curve_proximity", ours_pair, q}, {"paper", paper_pair, q}};
    measure(size, name, orders[k], orders[k] == 5, methods, 2, pairs, n, truth, true, q);
    if (orders[k] == 5 && !planar) others_of_pairs(size, name, pairs, truth);
    free(truth);
    curve_pairs_free(pairs, n);
  }
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create(), .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!q.workspace || !q.heap) return 1;
  measure_obstacles(&size, OBSTACLE_POINT, "point 2-D", &q);
  measure_obstacles(&size, OBSTACLE_POLYGON, "polygon 2-D", &q);
  measure_obstacles(&size, OBSTACLE_POLYTOPE, "polytope 3-D", &q);
  measure_obstacles(&size, OBSTACLE_LARGE_POLYTOPE, "polytope 500 3-D", &q);
  measure_pairs(&size, true, "curves 2-D", &q);
  measure_pairs(&size, false, "curves 3-D", &q);
  free(q.heap);
  cprox_workspace_free(q.workspace);
  return 0;
}
