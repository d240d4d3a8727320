/* SPDX-License-Identifier: BSD-3-Clause */
#include "figures.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/measure.h"
#include "support/problems.h"

static const double EPSILON = 1e-10;

/* ---- ellipsoids and hulls ---- */

static double from_chord(vec3 p, vec3 a, vec3 b) {
  const vec3 along = vec_sub(b, a);
  const double square = vec_norm2(along);
  const double s = square > 0.0 ? fmin(fmax(vec_dot(vec_sub(p, a), along) / square, 0.0), 1.0) : 0.0;
  return vec_norm(vec_sub(p, vec_axpy(a, s, along)));
}

/* The largest distance of a control point over [a, b] from the chord; pieces end where they end. */
static double hull_reach(const cprox_curve *curve, double a, double b, cprox_workspace *w) {
  const cprox_curve_info info = cprox_curve_get_info(curve);
  vec3 first, last, point[CPROX_MAX_DEGREE + 1];
  cprox_curve_evaluate(curve, a, w, &first, NULL, NULL);
  cprox_curve_evaluate(curve, b, w, &last, NULL, NULL);
  double reach = 0.0;
  for (size_t i = 0; i < info.n_pieces; i++) {
    const cprox_curve_piece_info piece = cprox_curve_get_piece_info(curve, i);
    const double from = fmax(a, piece.t0), to = fmin(b, piece.t1);
    if (!(from < to) || cprox_curve_control_points(curve, from, to, w, point) < 0) continue;
    for (size_t k = 0; k <= info.degree; k++) reach = fmax(reach, from_chord(point[k], first, last));
  }
  return reach;
}

/* The same curve, known by its points and the bound u_psi of the lengths of its parts, no nearer than rounding allows:
 * the products and the root have 4u. */
static void known_point(void *user, double t, vec3 *point) {
  const named_curve *c = user;
  *point = c->paper.point(c, t);
}

static double known_length(void *user, double a, double b) {
  double error;
  const double energy = named_energy(user, a, b, &error);
  return sqrt((b - a) * fmax(energy + error, 0.0)) * (1.0 + 1e-15);
}

static cprox_curve *by_length(const named_curve *curve) {
  const cprox_rectifiable_curve functions = {
      .point = known_point, .length = known_length, .user = (void *)(uintptr_t)curve, .error = named_error(curve)};
  const cprox_curve_description d = {
      .kind = CPROX_CURVE_RECTIFIABLE, .t0 = curve->paper.t0, .t1 = curve->paper.t1, .rectifiable = &functions};
  cprox_curve *made = NULL;
  if (cprox_curve_create(&d, NULL, &made) < 0) exit(1);
  return made;
}

static void print_row(const char *workload, const char *method, const char *parameter, double nodes, double error) {
  printf("seeds,%s,%s,%s,,,%.0f,,%.4g,0,0\n", workload, method, parameter, nodes, error);
}

static void print_reaches(const char *name, const named_curve *curve, const cprox_curve *known, cprox_workspace *w) {
  const double t0 = curve->paper.t0, t1 = curve->paper.t1;
  for (int parts = 2; parts <= 256; parts *= 2) {
    double ellipsoids = 0.0, hulls = 0.0;
    for (int i = 0; i < parts; i++) {
      const double a = t0 + (t1 - t0) * i / parts, b = i + 1 == parts ? t1 : t0 + (t1 - t0) * (i + 1) / parts;
      cprox_curve_ellipsoid e;
      if (cprox_curve_get_ellipsoid(known, a, b, w, &e) < 0) exit(1);
      ellipsoids += e.radius / parts;
      hulls += hull_reach(curve->curve, a, b, w) / parts;
    }
    print_row("figure 11 reach", "ellipsoids", name, parts, ellipsoids);
    print_row("figure 11 reach", "control points", name, parts, hulls);
  }
}

/* A distance by Theorem 1 alone. */
typedef struct known_problem {
  const cprox_curve *known;
  const paper_curve *paper;
  const cprox_obstacle *polygon;
  const paper_obstacle *vertices;
  paper_node *heap;
  cprox_workspace *workspace;
} known_problem;

static void by_ellipsoids(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const known_problem *p = (const known_problem *)problems + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  const cprox_status status = cprox_distance(cprox_point_along(p->known), *p->polygon, &options, p->workspace, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = status != CPROX_OK;
}

static void by_paper(const void *problems, size_t i, void *state, bench_answer *a) {
  (void)state;
  const known_problem *p = (const known_problem *)problems + i;
  const paper_query q = {.query_type = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = PAPER_MAX_NODES};
  paper_answer answer;
  paper_search(p->paper, p->vertices, &q, p->heap, &answer);
  *a = (bench_answer){.lower = answer.lower, .upper = answer.upper, .nodes = answer.nodes};
}

void figure_eleven(const bench_size *size, const char *name, const named_curve *curve, const cprox_obstacle *polygon,
                   const paper_obstacle *vertices, paper_node *heap) {
  cprox_workspace *w = cprox_workspace_create();
  cprox_curve *known = by_length(curve);
  print_reaches(name, curve, known, w);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  if (cprox_distance(cprox_point_along(curve->curve), *polygon, &options, w, &r) < 0) exit(1);
  print_row("figure 11 intervals", "control points", name, r.nodes, r.upper - r.lower);
  const known_problem problem = {known, &curve->paper, polygon, vertices, heap, w};
  const bench_method methods[2] = {{"curve_proximity", by_ellipsoids, NULL}, {"paper", by_paper, NULL}};
  const bench_workload workload = {
      .group = "seeds", .name = "figure 11 ellipsoids", .parameter = name, .problems = &problem, .n = 1};
  bench_measure(&workload, size, methods, 2);
  cprox_curve_free(known);
  cprox_workspace_free(w);
}

/* ---- memory ---- */

static size_t bytes_in_use(void) {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  return mallinfo2().uordblks;
#else
  return (size_t)(unsigned)mallinfo().uordblks;
#endif
}

void figure_ten_memory(size_t order) {
  curve_problem *p = curve_problems_make(OBSTACLE_POINT, order, 1);
  vec3 points[CPROX_MAX_DEGREE + 1];
  if (cprox_curve_control_points(p->curve, 0.0, 1.0, NULL, points) < 0) exit(1);
  char parameter[32];
  snprintf(parameter, sizeof parameter, "order %02zu", order);

  cprox_workspace *w = cprox_workspace_create();
  const size_t of_workspace = bytes_in_use();
  const cprox_curve_description d = {.kind = CPROX_CURVE_BEZIER, .points = points, .n = order + 1, .t1 = 1.0};
  cprox_curve *curve = NULL;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_result r;
  if (cprox_curve_create(&d, w, &curve) < 0) exit(1);
  const size_t of_curve = bytes_in_use();
  if (cprox_distance(cprox_point_along(curve), p->target, &options, w, &r) < 0) exit(1);
  /* of the workspace as it says itself: malloc() counts small blocks that were freed before, too */
  print_row("figure 10 memory", "curve_proximity", parameter, r.nodes,
            (double)(of_curve - of_workspace + cprox_workspace_bytes(w)));
  print_row("figure 10 memory", "the curve alone", parameter, 0, (double)(of_curve - of_workspace));
  cprox_curve_free(curve);
  cprox_workspace_free(w);

  /* the published method keeps its open nodes, and a curve with the energy of |psi'|² */
  paper_node *heap = calloc(PAPER_MAX_NODES, sizeof *heap);
  const paper_query q = {.query_type = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = PAPER_MAX_NODES};
  paper_answer answer;
  paper_search(&p->paper, &p->paper_obstacle, &q, heap, &answer);
  print_row("figure 10 memory", "paper", parameter, answer.nodes,
            (double)(answer.nodes * sizeof(paper_node) + (3 * order + 1) * sizeof(vec3)));
  free(heap);
  curve_problems_free(p, 1);
}
