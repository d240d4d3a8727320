/* SPDX-License-Identifier: BSD-3-Clause */
/* The tables and figures of Lakshmanan et al. (2019) that the other groups do not measure: Table I, Fig. 7, Fig. 10,
 * Fig. 11, Table II. The kinds of curves are the paper's; where they stand, and the polygons, are ours, since it does
 * not print them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "figures.h"
#include "named.h"
#include "support/measure.h"
#include "support/problems.h"

typedef struct tools {
  cprox_workspace *workspace;
  paper_node *heap;
} tools;

/* One query of Table II or Fig. 10, put to both methods. */
typedef struct query {
  const tools *tools;
  paper_query_type query_type;
  double delta;
  cprox_mover mover;
  cprox_obstacle target;
  const paper_curve *first, *second; /* second NULL: the obstacle */
  const paper_obstacle *obstacle;
  const paper_bezier *bezier; /* or NULL: the curve is none, or there are two */
} query;

static const double EPSILON = 1e-10;
static const char *const QUERY_TYPES[] = {"distance", "tolerance", "collision"};

static void ours(const void *queries, size_t i, void *state, bench_answer *a) {
  (void)state;
  const query *q = (const query *)queries + i;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILON;
  cprox_workspace *w = q->tools->workspace;
  cprox_result r = {.status = CPROX_INVALID};
  switch (q->query_type) {
    case PAPER_DISTANCE: cprox_distance(q->mover, q->target, &options, w, &r); break;
    case PAPER_TOLERANCE: cprox_tolerance(q->mover, q->target, q->delta, &options, w, &r); break;
    case PAPER_COLLISION: cprox_collision(q->mover, q->target, &options, w, &r); break;
  }
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.distance_queries};
  a->failed = r.status != CPROX_OK && r.status != CPROX_PRECISION;
}

static void paper(const void *queries, size_t i, void *state, bench_answer *a) {
  (void)state;
  const query *q = (const query *)queries + i;
  const paper_query asked = {
      .query_type = q->query_type, .delta = q->delta, .epsilon = EPSILON, .max_nodes = PAPER_MAX_NODES};
  paper_answer r;
  if (q->second) {
    paper_search_curves(q->first, q->second, &asked, q->tools->heap, &r);
  } else {
    paper_search(q->first, q->obstacle, &asked, q->tools->heap, &r);
  }
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.evaluations};
  a->failed = !r.ended;
}

/* Distances alone: the subdivision's authors ask for nothing else. */
static void subdivision(const void *queries, size_t i, void *state, bench_answer *a) {
  (void)state;
  const query *q = (const query *)queries + i;
  paper_answer r;
  paper_subdivide(q->bezier, q->obstacle, EPSILON, &r);
  *a = (bench_answer){.lower = r.lower, .upper = r.upper, .nodes = r.nodes, .distance_queries = r.evaluations};
  a->failed = !r.ended;
}

static void measure(const bench_size *size, const char *workload, const char *parameter, const query *queries,
                    size_t n) {
  const bench_workload w = {.group = "seeds", .name = workload, .parameter = parameter, .problems = queries, .n = n};
  const bench_method methods[] = {
      {"curve_proximity", ours, NULL}, {"paper", paper, NULL}, {"subdivision", subdivision, NULL}};
  bench_measure(&w, size, methods, queries->bezier && queries->query_type == PAPER_DISTANCE ? 3 : 2);
}

/* Distance, tolerance and collision; delta is half of the distance, as far as curves that cross have one. */
static void measure_query_types(const bench_size *size, const char *workload, const char *parameter, query *queries,
                                size_t n) {
  for (size_t i = 0; i < n; i++) {
    bench_answer a;
    queries[i].query_type = PAPER_DISTANCE;
    ours(queries, i, NULL, &a);
    queries[i].delta = 0.5 * a.lower;
  }
  for (int query_type = PAPER_DISTANCE; query_type <= PAPER_COLLISION; query_type++) {
    for (size_t i = 0; i < n; i++) queries[i].query_type = (paper_query_type)query_type;
    char name[96];
    snprintf(name, sizeof name, "%s %s", workload, QUERY_TYPES[query_type]);
    measure(size, name, parameter, queries, n);
  }
}

/* ---- Table I: the length of a curve by quadrature, and its bound in closed form ---- */

/* One of the three curves, over one interval. */
typedef struct interval {
  double (*speed2)(double t);           /* |psi'|² */
  double (*energy)(double a, double b); /* its integral */
  double a, b;
} interval;

static double ellipse_speed2(double t) {
  return 4.0 * sin(t) * sin(t) + cos(t) * cos(t);
}
static double ellipse_energy(double a, double b) {
  return 2.5 * (b - a) - 0.75 * (sin(2.0 * b) - sin(2.0 * a));
}
static double cubic_speed2(double t) {
  return (3.0 * t * t + 1.0) * (3.0 * t * t + 1.0) + 1.0;
}
static double cubic_integral(double t) {
  return 1.8 * t * t * t * t * t + 2.0 * t * t * t + 2.0 * t;
}
static double cubic_energy(double a, double b) {
  return cubic_integral(b) - cubic_integral(a);
}
static double hyperbola_speed2(double t) {
  return 1.0 / ((t + 1.0) * (t + 1.0) * (t + 1.0) * (t + 1.0)) + 1.0;
}
static double hyperbola_energy(double a, double b) {
  return (1.0 / ((a + 1.0) * (a + 1.0) * (a + 1.0)) - 1.0 / ((b + 1.0) * (b + 1.0) * (b + 1.0))) / 3.0 + (b - a);
}

/* The 15 points of Gauss and Kronrod, and their 7 of Gauss for the error that the quadrature reports. */
static const double KRONROD_X[8] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                    0.586087235467691130294144691693,    0.405845151377397166906606412076961,
                                    0.207784955007898467600689403773245, 0.0};
static const double KRONROD_W[8] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                    0.16900472663926790282829453,        0.190350578064785409913256402421014,
                                    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};

static void length(const void *intervals, size_t i, void *state, bench_answer *a) {
  (void)state;
  const interval *s = (const interval *)intervals + i;
  const double middle = 0.5 * (s->a + s->b), half = 0.5 * (s->b - s->a);
  double sum = KRONROD_W[7] * sqrt(s->speed2(middle));
  for (int k = 0; k < 7; k++)
    sum +=
        KRONROD_W[k] * (sqrt(s->speed2(middle - half * KRONROD_X[k])) + sqrt(s->speed2(middle + half * KRONROD_X[k])));
  *a = (bench_answer){.lower = half * sum, .upper = half * sum};
}

static void length_bound(const void *intervals, size_t i, void *state, bench_answer *a) {
  (void)state;
  const interval *s = (const interval *)intervals + i;
  const double bound = sqrt((s->b - s->a) * s->energy(s->a, s->b));
  *a = (bench_answer){.lower = 0.0, .upper = bound};
}

static void table_one(const bench_size *size) {
  static const struct {
    const char *name;
    double (*speed2)(double t);
    double (*energy)(double a, double b);
  } curves[] = {{"2 cos t | sin t", ellipse_speed2, ellipse_energy},
                {"t^3 + t | t", cubic_speed2, cubic_energy},
                {"1/(t + 1) | t", hyperbola_speed2, hyperbola_energy}};
  enum { N = 32 };
  for (size_t k = 0; k < 3; k++) {
    interval intervals[N];
    for (size_t i = 0; i < N; i++) {
      const double a = (double)(i % 8) / 16.0;
      intervals[i] = (interval){curves[k].speed2, curves[k].energy, a, a + 1.0 / (double)(2 + i / 8)};
    }
    const bench_workload w = {
        .group = "seeds", .name = "table I", .parameter = curves[k].name, .problems = intervals, .n = N};
    const bench_method methods[] = {{"length by quadrature", length, NULL},
                                    {"bound in closed form", length_bound, NULL}};
    bench_measure(&w, size, methods, 2);
  }
}

/* ---- Fig. 7: how the interval narrows ---- */

static void print_width(const char *method, uint32_t nodes, double width) {
  printf("seeds,figure 7,%s,after %03u intervals,,,%u,,%.3g,0,0\n", method, nodes, nodes, width);
}

static void figure_seven(const tools *t) {
  curve_problem *p = curve_problems_make(OBSTACLE_POLYGON, 13, 1);
  double last = INFINITY;
  for (uint32_t nodes = 1; nodes < 400 && last > EPSILON; nodes += 2) {
    const paper_query q = {.query_type = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = nodes};
    paper_answer r;
    paper_search(&p->paper, &p->paper_obstacle, &q, t->heap, &r);
    if (r.upper - r.lower < last) print_width("paper", nodes, last = r.upper - r.lower);
  }
  last = INFINITY;
  for (uint32_t budget = 1; budget < 400 && last > EPSILON; budget++) { /* it counts distance queries, too */
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = EPSILON;
    options.max_nodes = budget;
    cprox_result r;
    if (cprox_distance(cprox_point_along(p->curve), p->target, &options, t->workspace, &r) < 0) break;
    if (r.upper - r.lower < last) print_width("curve_proximity", r.nodes, last = r.upper - r.lower);
  }
  curve_problems_free(p, 1);
}

/* ---- Fig. 10: ten Bézier curves of each order and a point ---- */

static void figure_ten(const bench_size *size, const tools *t) {
  enum { N = 10 };
  for (size_t order = 5; order <= 45; order += 5) {
    curve_problem *p = curve_problems_make(OBSTACLE_POINT, order, N);
    query queries[N];
    for (size_t i = 0; i < N; i++) {
      queries[i] = (query){.tools = t,
                           .mover = cprox_point_along(p[i].curve),
                           .target = p[i].target,
                           .first = &p[i].paper,
                           .obstacle = &p[i].paper_obstacle,
                           .bezier = &p[i].bezier};
    }
    char parameter[32];
    snprintf(parameter, sizeof parameter, "order %02zu", order);
    measure_query_types(size, "figure 10", parameter, queries, N);
    curve_problems_free(p, N);
  }
}

/* ---- Table II: the pairs of Fig. 11 ---- */

static const vec3 PENTAGON[5] = {{2.0, 0.2, 0.0}, {2.9, -0.1, 0.0}, {3.2, 0.7, 0.0}, {2.6, 1.3, 0.0}, {2.1, 0.9, 0.0}};

static void table_two_polygon(const bench_size *size, const tools *t, const char *name, const named_curve *curve,
                              const vec3 *vertex, size_t n) {
  cprox_body *body = NULL;
  if (cprox_body_create_polytope(vertex, n, t->workspace, &body) < 0) exit(1);
  const paper_obstacle polygon = {.vertex = vertex, .n = n};
  query q = {.tools = t,
             .mover = cprox_point_along(curve->curve),
             .target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY),
             .first = &curve->paper,
             .obstacle = &polygon};
  measure_query_types(size, "table II", name, &q, 1);
  cprox_body_free(body);
}

/* ---- Fig. 11 b: what ellipsoids are worth ---- */

static void figure_eleven_polygon(const bench_size *size, const tools *t, const char *name, const named_curve *curve,
                                  const vec3 *vertex, size_t n) {
  cprox_body *body = NULL;
  if (cprox_body_create_polytope(vertex, n, t->workspace, &body) < 0) exit(1);
  const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  const paper_obstacle polygon = {.vertex = vertex, .n = n};
  figure_eleven(size, name, curve, &target, &polygon, t->heap);
  cprox_body_free(body);
}

static void figures_eleven(const bench_size *size, const tools *t) {
  named_curve c;
  named_heart(vec(0.0, 0.0, 0.0), 1.2, &c);
  figure_eleven_polygon(size, t, "a heart", &c, PENTAGON, 5);
  cprox_curve_free(c.curve);
  named_epicycloid(vec(0.0, 0.0, 0.0), 1.2, &c);
  figure_eleven_polygon(size, t, "b epicycloid", &c, PENTAGON, 5);
  cprox_curve_free(c.curve);
  named_spiral(vec(0.0, 0.0, 0.0), &c);
  figure_eleven_polygon(size, t, "c Euler spiral", &c, PENTAGON, 5);
  cprox_curve_free(c.curve);
}

static void table_two_pair(const bench_size *size, const tools *t, const char *name, const cprox_curve *const curve[2],
                           const paper_curve *first, const paper_curve *second) {
  query q = {.tools = t,
             .mover = cprox_point_along(curve[0]),
             .target = cprox_obstacle_curve(curve[1], 0.0),
             .first = first,
             .second = second};
  measure_query_types(size, "table II", name, &q, 1);
}

static void table_two_named(const bench_size *size, const tools *t, const char *name, const named_curve *a,
                            const named_curve *b) {
  const cprox_curve *const curve[2] = {a->curve, b->curve};
  table_two_pair(size, t, name, curve, &a->paper, &b->paper);
}

static void table_two(const bench_size *size, const tools *t) {
  named_curve a, b;
  named_heart(vec(0.0, 0.0, 0.0), 1.2, &a);
  table_two_polygon(size, t, "a heart | polygon", &a, PENTAGON, 5);
  cprox_curve_free(a.curve);
  named_epicycloid(vec(0.0, 0.0, 0.0), 1.2, &a);
  table_two_polygon(size, t, "b epicycloid | polygon", &a, PENTAGON, 5);
  cprox_curve_free(a.curve);
  named_spiral(vec(0.0, 0.0, 0.0), &a);
  table_two_polygon(size, t, "c Euler spiral | polygon", &a, PENTAGON, 5);
  cprox_curve_free(a.curve);

  curve_pair *pair = curve_pairs_make(10, true, 1);
  const cprox_curve *const curves[2] = {pair->curve[0], pair->curve[1]};
  table_two_pair(size, t, "d Bezier | Bezier", curves, &pair->paper[0], &pair->paper[1]);
  curve_pairs_free(pair, 1);

  named_involute(vec(0.0, 0.0, 0.0), 6.0, &a);
  named_involute(vec(-14.5, 1.0, 0.0), 6.0, &b);
  table_two_named(size, t, "e involute | involute", &a, &b);
  cprox_curve_free(a.curve);
  cprox_curve_free(b.curve);
  named_fish(vec(0.0, 0.0, 0.0), 1.0, &a);
  named_lissajous(vec(2.6, 0.4, 0.0), 1.0, &b);
  table_two_named(size, t, "f fish | Lissajous", &a, &b);
  cprox_curve_free(a.curve);
  cprox_curve_free(b.curve);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  const tools t = {.workspace = cprox_workspace_create(), .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!t.workspace || !t.heap) return 1;
  if (bench_wanted(&size, "table I")) table_one(&size);
  if (bench_wanted(&size, "figure 7")) figure_seven(&t);
  if (bench_wanted(&size, "figure 10")) figure_ten(&size, &t);
  if (bench_wanted(&size, "table II")) table_two(&size, &t);
  if (bench_wanted(&size, "figure 11")) figures_eleven(&size, &t);
  for (size_t order = 5; bench_wanted(&size, "figure 10 memory") && order <= 45; order += 5) figure_ten_memory(order);
  free(t.heap);
  cprox_workspace_free(t.workspace);
  return 0;
}
