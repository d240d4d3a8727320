/* SPDX-License-Identifier: BSD-3-Clause */
/* Uniform cubic B-splines of 10 to 1000 segments, and trigonometric series (which we compile to quintic pieces):
 * distance and tolerance against a polygon or a polytope, ours beside the paper's method, which knows both exactly. */
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/make_curve.h"
#include "support/measure.h"
#include "support/problems.h"
#include "support/samples.h"

enum { MOST_SEGMENTS = 1000, HARMONICS = 3, TERMS = 2 * HARMONICS + 1 };

typedef struct problem {
  cprox_curve *curve;
  obstacle obstacle;
  cprox_obstacle target;
  paper_curve paper;
  paper_obstacle paper_obstacle;
  /* what the paper's method knows: Bézier segments and the energy before each, or a series and that of its squared
   * speed */
  size_t segments;
  paper_bezier *segment;
  double *before;
  vec3 series[TERMS];
  double speed2[4 * HARMONICS + 1];
} problem;

typedef struct asked {
  double epsilon, factor; /* tolerance: delta is this times the distance; 0: the distance is asked for */
  const double *distance;
  cprox_workspace *workspace;
  paper_node *heap;
} asked;

static void check(cprox_status status, const cprox_workspace *ws) {
  if (status == CPROX_OK) return;
  fprintf(stderr, "a problem could not be made: %s\n", cprox_workspace_error(ws));
  exit(1);
}

/* ---- what the paper's method knows ---- */

static size_t segment_at(const problem *p, double t) {
  return t >= (double)p->segments ? p->segments - 1 : (size_t)t;
}

static vec3 spline_point(const void *self, double t) {
  const problem *p = self;
  const size_t i = segment_at(p, t);
  const paper_curve piece = paper_bezier_curve(&p->segment[i], true);
  return piece.point(piece.self, t - (double)i);
}

static double spline_energy(const void *self, double t) {
  const problem *p = self;
  const size_t i = segment_at(p, t);
  const paper_curve piece = paper_bezier_curve(&p->segment[i], true);
  return p->before[i] + piece.energy(piece.self, t - (double)i);
}

static vec3 series_point(const void *self, double t) {
  const problem *p = self;
  vec3 sum = p->series[0];
  for (size_t k = 1; k <= HARMONICS; k++) {
    sum = vec_axpy(sum, cos((double)k * t), p->series[2 * k - 1]);
    sum = vec_axpy(sum, sin((double)k * t), p->series[2 * k]);
  }
  return sum;
}

/* speed2: |psi'|² as a series of its own, integrated term by term. */
static double series_energy(const void *self, double t) {
  const problem *p = self;
  double sum = p->speed2[0] * t;
  for (size_t k = 1; k <= 2 * HARMONICS; k++)
    sum += (p->speed2[2 * k - 1] * sin((double)k * t) + p->speed2[2 * k] * (1.0 - cos((double)k * t))) / (double)k;
  return sum;
}

/* cos, sin products to sums; psi' has the coefficients k b_k of cos kt and -k a_k of sin kt. */
static void square_speed(problem *p) {
  memset(p->speed2, 0, sizeof p->speed2);
  for (size_t i = 1; i <= HARMONICS; i++) {
    for (size_t j = 1; j <= HARMONICS; j++) {
      const vec3 ci = vec_scale((double)i, p->series[2 * i]), si = vec_scale(-(double)i, p->series[2 * i - 1]);
      const vec3 cj = vec_scale((double)j, p->series[2 * j]), sj = vec_scale(-(double)j, p->series[2 * j - 1]);
      const size_t low = i > j ? i - j : j - i, high = i + j;
      const double sign = i > j ? 1.0 : -1.0;
      const double even = 0.5 * (vec_dot(ci, cj) + vec_dot(si, sj)), odd = vec_dot(si, cj);
      p->speed2[low == 0 ? 0 : 2 * low - 1] += even;
      p->speed2[2 * high - 1] += 0.5 * (vec_dot(ci, cj) - vec_dot(si, sj));
      p->speed2[2 * high] += odd;
      if (low > 0) p->speed2[2 * low] += sign * odd;
    }
  }
}

/* ---- problems ---- */

/* A random walk with inertia, grown to fill a box of width 5 about the obstacles. */
static void walk(rng *r, bool planar, vec3 *points, size_t n) {
  vec3 at = vec(0, 0, 0), step = vec(0, 0, 0), low = at, high = at;
  for (size_t i = 0; i < n; i++) {
    step = vec_axpy(vec_scale(0.8, step), 0.25, rng_in_cube(r, 0.5));
    if (planar) step.z = 0.0;
    at = vec_add(at, step);
    points[i] = at;
    low = vec(fmin(low.x, at.x), fmin(low.y, at.y), fmin(low.z, at.z));
    high = vec(fmax(high.x, at.x), fmax(high.y, at.y), fmax(high.z, at.z));
  }
  const vec3 size = vec_sub(high, low), middle = vec_lerp(low, high, 0.5);
  const double grow = 5.0 / fmax(size.x, fmax(size.y, size.z));
  for (size_t i = 0; i < n; i++)
    points[i] = vec_add(vec(0.5, 0.5, planar ? 0.0 : 0.5), vec_scale(grow, vec_sub(points[i], middle)));
}

static void make_spline(rng *r, bool planar, size_t segments, cprox_workspace *ws, problem *p) {
  static vec3 points[MOST_SEGMENTS + 3];
  static double knots[MOST_SEGMENTS + 7];
  walk(r, planar, points, segments + 3);
  for (size_t i = 0; i < segments + 7; i++) knots[i] = (double)i - 3.0;
  check(
      curve_from(describe_bspline(points, segments + 3, 3, knots, segments + 7, 0.0, (double)segments), ws, &p->curve),
      ws);
  p->segments = segments;
  p->segment = calloc(segments, sizeof *p->segment);
  p->before = calloc(segments + 1, sizeof *p->before);
  if (!p->segment || !p->before) exit(1);
  for (size_t i = 0; i < segments; i++) {
    const vec3 *d = points + i;
    const vec3 b1 = vec_lerp(d[1], d[2], 1.0 / 3.0), b2 = vec_lerp(d[1], d[2], 2.0 / 3.0);
    const vec3 bezier[4] = {vec_lerp(vec_lerp(d[0], d[1], 2.0 / 3.0), b1, 0.5), b1, b2,
                            vec_lerp(b2, vec_lerp(d[2], d[3], 1.0 / 3.0), 0.5)};
    paper_bezier_make(bezier, 3, &p->segment[i]);
    const paper_curve piece = paper_bezier_curve(&p->segment[i], planar);
    p->before[i + 1] = p->before[i] + piece.energy(piece.self, 1.0);
  }
  p->paper = (paper_curve){0.0, (double)segments, planar, p, spline_point, spline_energy};
}

static void make_series(rng *r, bool planar, cprox_workspace *ws, problem *p) {
  p->series[0] = planar ? vec(0.5, 0.5, 0) : vec(0.5, 0.5, 0.5);
  for (size_t k = 1; k < TERMS; k++) {
    p->series[k] = vec_scale(0.4 / (double)((k + 1) / 2), rng_in_cube(r, 1.0));
    if (planar) p->series[k].z = 0.0;
  }
  check(curve_from(describe_trigonometric(p->series, TERMS, 0.0, 6.283185307179586), ws, &p->curve), ws);
  square_speed(p);
  p->paper = (paper_curve){0.0, 6.283185307179586, planar, p, series_point, series_energy};
}

static void problem_free(problem *p) {
  obstacle_free(&p->obstacle);
  cprox_curve_free(p->curve);
  free(p->segment);
  free(p->before);
}

/* segments 0: series. Drawn again where curve and obstacle touch; *distance: certified to 1e-12. */
static void make_problem(rng *r, bool planar, size_t segments, cprox_workspace *ws, problem *p, double *distance) {
  for (;;) {
    *p = (problem){.segments = 0};
    if (segments > 0)
      make_spline(r, planar, segments, ws, p);
    else
      make_series(r, planar, ws, p);
    obstacle_make(r, planar ? OBSTACLE_POLYGON : OBSTACLE_POLYTOPE, &p->obstacle);
    p->target = cprox_obstacle_at(p->obstacle.body, CPROX_POSE_IDENTITY);
    p->paper_obstacle = (paper_obstacle){.vertex = p->obstacle.vertex, .n = p->obstacle.n};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-12;
    cprox_result found;
    cprox_distance(cprox_point_along(p->curve), p->target, &options, ws, &found);
    *distance = 0.5 * (found.lower + found.upper);
    if (found.lower > 1e-3) return;
    problem_free(p);
  }
}

/* ---- methods ---- */

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const asked *q = state;
  const cprox_mover mover = cprox_point_along(p->curve);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = q->epsilon;
  cprox_result r;
  const cprox_status status =
      q->factor > 0.0 ? cprox_tolerance(mover, p->target, q->factor * q->distance[i], &options, q->workspace, &r)
                      : cprox_distance(mover, p->target, &options, q->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status != CPROX_OK && status != CPROX_PRECISION;
  if (q->factor == 0.0) return;
  a->wrong = r.verdict != (q->factor < 1.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  a->lower = a->upper = NAN;
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  const problem *p = (const problem *)problems + i;
  const asked *q = state;
  const paper_query query = {.query_type = q->factor > 0.0 ? PAPER_TOLERANCE : PAPER_DISTANCE,
                             .delta = q->factor * q->distance[i],
                             .epsilon = q->epsilon,
                             .max_nodes = PAPER_MAX_NODES};
  paper_answer r;
  paper_search(&p->paper, &p->paper_obstacle, &query, q->heap, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.evaluations};
  a->failed = !r.ended;
  if (q->factor == 0.0) return;
  a->wrong = r.verdict != (q->factor < 1.0);
  a->lower = a->upper = NAN;
}

/* ---- workloads ---- */

/* Time against accuracy, and samples, which have no accuracy but an error. */
static void measure_accuracies(const bench_size *size, const char *name, const problem *problems, size_t n, asked *q) {
  char workload[64];
  snprintf(workload, sizeof workload, "%s 3-D accuracy", name);
  if (!bench_wanted(size, workload)) return;
  const bench_method methods[] = {{"curve_proximity", ours, q}, {"paper", paper, q}};
  q->factor = 0.0;
  for (int digits = 2; digits <= 14; digits += 2) {
    char parameter[32];
    snprintf(parameter, sizeof parameter, "eps 1e-%02d", digits);
    q->epsilon = pow(10.0, -digits);
    const bench_workload w = {"splines", workload, parameter, problems, n, q->distance, 2e-12};
    bench_measure(&w, size, methods, 2);
  }
  sampled_query *queries = calloc(n, sizeof *queries);
  if (!queries) exit(1);
  for (size_t i = 0; i < n; i++)
    queries[i] = (sampled_query){.curve = problems[i].curve, .obstacle = &problems[i].obstacle};
  samples_measure(size, "splines", workload, "", queries, n, q->distance);
  free(queries);
}

static void measure(const bench_size *size, const char *name, const char *parameter, bool planar, size_t segments,
                    asked *q) {
  const size_t n = size->problems / 4;
  problem *problems = calloc(n, sizeof *problems);
  double *distance = calloc(n, sizeof *distance);
  if (!problems || !distance) exit(1);
  rng r = rng_seed(900 + segments + (planar ? 1 : 0));
  for (size_t i = 0; i < n; i++) make_problem(&r, planar, segments, q->workspace, &problems[i], &distance[i]);
  q->distance = distance;
  const bench_method methods[] = {{"curve_proximity", ours, q}, {"paper", paper, q}};
  static const double factors[] = {0.0, 0.9, 1.1};
  static const char *const queries[] = {"distance", "tolerance clear", "tolerance violated"};
  for (size_t k = 0; k < 3; k++) {
    char workload[64];
    snprintf(workload, sizeof workload, "%s %s %s", name, planar ? "2-D" : "3-D", queries[k]);
    q->epsilon = 1e-10, q->factor = factors[k];
    const bench_workload w = {"splines", workload, parameter, problems, n, k == 0 ? distance : NULL, 2e-12};
    if (bench_wanted(size, workload)) bench_measure(&w, size, methods, 2);
  }
  if (!planar && (segments == 0 || segments == 100)) measure_accuracies(size, name, problems, n, q);
  for (size_t i = 0; i < n; i++) problem_free(&problems[i]);
  free(distance);
  free(problems);
}

static size_t bytes_in_use(void) {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  return mallinfo2().uordblks + mallinfo2().hblkhd;
#else
  return (size_t)(unsigned)mallinfo().uordblks + (size_t)(unsigned)mallinfo().hblkhd;
#endif
}

/* Column nodes: the bytes of a segment of a quintic spline. */
static void measure_bytes(size_t segments, asked *q) {
  enum { DEGREE = 5 };
  static vec3 points[MOST_SEGMENTS + DEGREE];
  static double knots[MOST_SEGMENTS + 2 * DEGREE + 1];
  rng r = rng_seed(950);
  walk(&r, false, points, segments + DEGREE);
  for (size_t i = 0; i < segments + 2 * DEGREE + 1; i++) knots[i] = (double)i - DEGREE;
  cprox_curve *curve = NULL;
  const size_t before = bytes_in_use();
  check(curve_from(describe_bspline(points, segments + DEGREE, DEGREE, knots, segments + 2 * DEGREE + 1, 0.0,
                                    (double)segments),
                   q->workspace, &curve),
        q->workspace);
  printf("splines,bytes a segment,curve_proximity,%zu segments,,,%.4g,,,0,0\n", segments,
         (double)(bytes_in_use() - before) / (double)segments);
  cprox_curve_free(curve);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  asked q = {.workspace = cprox_workspace_create(), .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!q.workspace || !q.heap) return 1;
  static const size_t segments[] = {10, 30, 100, 300, MOST_SEGMENTS};
  for (int planar = 1; planar >= 0; planar--) {
    for (size_t k = 0; k < sizeof segments / sizeof *segments; k++) {
      char parameter[32];
      snprintf(parameter, sizeof parameter, "%zu segments", segments[k]);
      measure(&size, "B-spline", parameter, planar, segments[k], &q);
    }
    measure(&size, "trigonometric", "3 harmonics", planar, 0, &q);
  }
  for (size_t k = 1; k < 5 && bench_wanted(&size, "bytes a segment"); k++) measure_bytes(segments[k], &q);
  free(q.heap);
  cprox_workspace_free(q.workspace);
  return 0;
}
