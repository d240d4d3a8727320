/* SPDX-License-Identifier: BSD-3-Clause */
/* Points and curves, curves and curves. unsound counts distances that are off by more than WRONG. References: long
 * double for Bézier curves, our interval of width 1e-12 for splines, which the soundness campaigns hold. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peers/ask.h"
#include "peers/libraries.h"
#include "support/make_curve.h"
#include "support/problems.h"

enum { MOST_SPLINE_POINTS = 23 };
static const double WRONG = 1e-6;

/* A value that claims to be exact. */
static void judge_value(double value, double truth, bench_answer *a) {
  *a = (bench_answer){.lower = value, .upper = value};
  a->failed = isnan(value);
  a->wrong = !a->failed && fabs(value - truth) > WRONG;
}

/* One query: two curves, or a curve and a point. */
typedef struct query {
  cprox_mover mover;
  cprox_obstacle target;
  double point[3];
  void *own[2][MOST_LIBRARIES]; /* the libraries' copies of both curves */
  bool is_point;
  double truth;
} query;

typedef struct peer_state {
  const curve_peer *peer;
  size_t number;
} peer_state;

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const query *p = (const query *)problems + i;
  const asked *q = state;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = q->epsilon;
  cprox_result r;
  ask_take(cprox_distance(p->mover, p->target, &options, q->workspace, &r), &r, a);
}

static void theirs(const void *problems, size_t i, void *state, bench_answer *a) {
  const query *p = (const query *)problems + i;
  const peer_state *s = state;
  const void *first = p->own[0][s->number], *second = p->own[1][s->number];
  judge_value(p->is_point ? s->peer->to_point(first, p->point) : s->peer->to_curve(first, second), p->truth, a);
}

static void measure_queries(const bench_size *size, const char *workload, const char *parameter, const query *queries,
                            size_t n, double doubt, asked *q) {
  peer_state states[2];
  bench_method methods[MOST_METHODS] = {{"curve_proximity", ours, q}};
  size_t count = 1;
  for (size_t k = 0; curve_libraries[k]; k++) {
    states[k] = (peer_state){curve_libraries[k], k};
    methods[count++] = (bench_method){curve_libraries[k]->name, theirs, &states[k]};
  }
  double *truth = ask_memory(n, sizeof *truth);
  for (size_t i = 0; i < n; i++) truth[i] = queries[i].truth;
  q->epsilon = 1e-12;
  const bench_workload w = {"peers", workload, parameter, queries, n, truth, doubt};
  bench_measure(&w, size, methods, count);
  free(truth);
}

static void take_from_peers(query *queries, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (int side = 0; side < 2; side++) libraries_drop(queries[i].own[side]);
  free(queries);
}

void ask_points_and_curves(const bench_size *size, size_t degree, asked *q) {
  const size_t n = size->problems;
  curve_problem *problems = curve_problems_make(OBSTACLE_POINT, degree, n);
  double *truth = curve_problems_truth(problems, n, OBSTACLE_POINT);
  query *queries = ask_memory(n, sizeof *queries);
  for (size_t i = 0; i < n; i++) {
    const vec3 p = problems[i].obstacle.vertex[0];
    queries[i] = (query){.mover = cprox_point_along(problems[i].curve),
                         .target = problems[i].target,
                         .point = {p.x, p.y, p.z},
                         .is_point = true,
                         .truth = truth[i]};
    libraries_make(problems[i].points, degree + 1, degree, NULL, queries[i].own[0]);
  }
  char parameter[32];
  snprintf(parameter, sizeof parameter, "degree %zu", degree);
  measure_queries(size, "point and curve", parameter, queries, n, 1e-15, q);
  take_from_peers(queries, n);
  free(truth);
  curve_problems_free(problems, n);
}

void ask_curves_and_curves(const bench_size *size, size_t degree, asked *q) {
  const size_t n = size->problems / 2;
  curve_pair *pairs = curve_pairs_make(degree, false, n);
  double *truth = curve_pairs_truth(pairs, n);
  query *queries = ask_memory(n, sizeof *queries);
  for (size_t i = 0; i < n; i++) {
    queries[i] = (query){.mover = cprox_point_along(pairs[i].curve[0]),
                         .target = cprox_obstacle_curve(pairs[i].curve[1], 0.0),
                         .truth = truth[i]};
    for (int k = 0; k < 2; k++) libraries_make(pairs[i].points[k], degree + 1, degree, NULL, queries[i].own[k]);
  }
  char parameter[32];
  snprintf(parameter, sizeof parameter, "degree %zu", degree);
  measure_queries(size, "curve and curve", parameter, queries, n, 1e-15, q);
  take_from_peers(queries, n);
  free(truth);
  curve_pairs_free(pairs, n);
}

/* Two cubic B-splines of 20 segments in neighbouring cubes. */
void ask_splines_and_splines(const bench_size *size, asked *q) {
  const size_t n = size->problems / 2;
  query *queries = ask_memory(n, sizeof *queries);
  rng r = rng_seed(77);
  double knots[MOST_SPLINE_POINTS + 4];
  for (size_t i = 0; i < MOST_SPLINE_POINTS + 4; i++) knots[i] = (double)i;
  for (size_t i = 0; i < n; i++) {
    cprox_curve *curve[2] = {NULL, NULL};
    for (int k = 0; k < 2; k++) {
      vec3 points[MOST_SPLINE_POINTS];
      for (size_t j = 0; j < MOST_SPLINE_POINTS; j++) points[j] = vec_add(vec(1.1 * k, 0, 0), rng_in_cube(&r, 0.5));
      ask_check(curve_from(describe_bspline(points, MOST_SPLINE_POINTS, 3, knots, MOST_SPLINE_POINTS + 4, 3.0,
                                            MOST_SPLINE_POINTS),
                           q->workspace, &curve[k]),
                q->workspace);
      libraries_make(points, MOST_SPLINE_POINTS, 3, knots, queries[i].own[k]);
    }
    queries[i].mover = cprox_point_along(curve[0]);
    queries[i].target = cprox_obstacle_curve(curve[1], 0.0);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-13;
    cprox_result found;
    cprox_distance(queries[i].mover, queries[i].target, &options, q->workspace, &found);
    queries[i].truth = 0.5 * (found.lower + found.upper);
  }
  measure_queries(size, "curve and curve", "20 segments", queries, n, 1e-12, q);
  for (size_t i = 0; i < n; i++) {
    cprox_curve_free((cprox_curve *)queries[i].mover.curve);
    cprox_curve_free((cprox_curve *)queries[i].target.curve);
  }
  take_from_peers(queries, n);
}
