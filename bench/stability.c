/* SPDX-License-Identifier: BSD-3-Clause */
/* Hard inputs: families of curves and what they are held against whose distance is known by construction. For every method it is counted
 * what is right, wrong (column unsound) and given up (column failures: out of intervals, or no answer). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "paper/paper.h"
#include "support/measure.h"
#include "support/random.h"

#include "curve_proximity/cprox.h"

static const double EPSILON = 1e-9;
enum { MAX_POINTS = 46, MAX_VERTICES = 8, SEED = 20260611 };

/* One question with its answer. */
typedef struct hard {
  size_t degree, n;
  vec3 points[MAX_POINTS];
  vec3 vertex[MAX_VERTICES]; /* of the obstacle; n = 0: the second curve */
  vec3 other[MAX_POINTS];    /* a second curve of the same degree */
  double truth;
  bool planar;
  cprox_curve *curve, *second;
  cprox_body *body;
  paper_bezier bezier[2];
} hard;

typedef struct tools {
  cprox_workspace *workspace;
  paper_node *heap;
} tools;

/* ---- judging: the same for all ---------------------------------------------------------------------------------------------------- */

/* The distances are sums of a few doubles of the inputs' size. */
static double doubt(const hard *h) {
  double size = 1.0;
  for (size_t i = 0; i <= h->degree; i++) size = fmax(size, vec_norm(h->points[i]));
  return 16.0 * 0x1p-52 * size;
}

static void judge(const hard *h, bool ended, double lower, double upper, bench_answer *a) {
  *a = (bench_answer){.lower = NAN, .upper = NAN, .nodes = a->nodes, .probes = a->probes};
  const double slack = doubt(h);
  const bool contains = lower <= h->truth + slack && upper >= h->truth - slack;
  const bool narrow = upper - lower <= EPSILON + 4.0 * slack;
  a->wrong = !contains || (ended && !narrow);
  a->failed = !a->wrong && !ended;
}

/* ---- the methods ------------------------------------------------------------------------------------------------------------------- */

static void ours(const void *problems, size_t i, void *state, bench_answer *a) {
  const hard *h = (const hard *)problems + i;
  const tools *t = state;
  cprox_options options = cprox_options_default();
  options.epsilon = EPSILON;
  const cprox_target target = h->second ? cprox_curve_target(h->second, 0.0) : cprox_at(h->body, cprox_pose_identity());
  cprox_result r = {.status = CPROX_INVALID};
  cprox_distance(cprox_point_along(h->curve), target, &options, t->workspace, &r);
  *a = (bench_answer){.nodes = r.nodes, .probes = r.probes};
  judge(h, r.status == CPROX_OK || (r.status == CPROX_PRECISION && r.upper - r.lower <= EPSILON + 4.0 * doubt(h)),
        r.lower, r.upper, a);
}

static void paper(const void *problems, size_t i, void *state, bench_answer *a) {
  const hard *h = (const hard *)problems + i;
  const tools *t = state;
  const paper_question q = {.verb = PAPER_DISTANCE, .epsilon = EPSILON, .max_nodes = 20000};
  const paper_curve first = paper_bezier_curve(&h->bezier[0], h->planar);
  paper_answer r;
  if (h->second) {
    const paper_curve second = paper_bezier_curve(&h->bezier[1], h->planar);
    paper_search_curves(&first, &second, &q, t->heap, &r);
  } else {
    const paper_obstacle obstacle = {.vertex = h->vertex, .n = h->n};
    paper_search(&first, &obstacle, &q, t->heap, &r);
  }
  *a = (bench_answer){.nodes = r.nodes, .probes = r.evaluations};
  judge(h, r.ended, r.lower, r.upper, a);
}

/* What is mostly done: the least distance of a thousand points of the curve (and of the other one). It never says that it may be off. */
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

/* ---- building the families ---------------------------------------------------------------------------------------------------------- */

/* A unit square below y = 0, whose upper side is hard to tell apart along. */
static void square_below(hard *h) {
  h->n = 4, h->planar = true;
  const vec3 corner[4] = {{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}};
  for (size_t i = 0; i < 4; i++) h->vertex[i] = corner[i];
}

static void one_point(hard *h, vec3 p) {
  h->n = 1, h->planar = true;
  h->vertex[0] = p;
}

/* The control points of (x(t), c (x(t))^power + gap) for x = 2t - 1: by the elevation of a monomial to Bernstein form. */
static void graph_of_power(hard *h, size_t power, double c, double gap) {
  h->degree = power;
  for (size_t i = 0; i <= power; i++) {
    const double x = 2.0 * (double)i / (double)power - 1.0;
    /* (2t - 1)^p has the Bernstein coefficients (-1)^(p - i) */
    const double y = ((power - i) % 2 == 0 ? c : -c) + gap;
    h->points[i] = vec(0.5 * x, y, 0.0);
  }
}

/* Keeps the part from 0 to t of a curve (de Casteljau), or with `last` the part from t to 1. */
static void cut(vec3 *points, size_t degree, double t, bool last) {
  vec3 p[MAX_POINTS], kept[MAX_POINTS];
  for (size_t i = 0; i <= degree; i++) p[i] = points[i];
  for (size_t k = 0; k <= degree; k++) {
    kept[last ? degree - k : k] = p[last ? degree - k : 0];
    for (size_t i = 0; i + k < degree; i++) p[i] = vec_add(vec_scale(1.0 - t, p[i]), vec_scale(t, p[i + 1]));
  }
  for (size_t i = 0; i <= degree; i++) points[i] = kept[i];
}

/* What is special about a curve is in its middle at first, where every halving meets it: moved elsewhere. */
static void shift_middle(rng *r, hard *h) {
  cut(h->points, h->degree, rng_uniform(r, 0.7, 1.0), false);
  cut(h->points, h->degree, rng_uniform(r, 0.0, 0.3), true);
}

/* Along a side at an uneven speed. */
static void parallel_to_side(rng *r, hard *h) {
  square_below(h);
  h->degree = 5;
  h->truth = rng_uniform(r, 0.1, 0.5);
  for (size_t i = 0; i <= 5; i++) h->points[i] = vec(rng_uniform(r, -0.9, 0.9), h->truth, 0.0);
}

/* A parabola or a flatter curve that all but touches. */
static void near_tangent(rng *r, hard *h) {
  square_below(h);
  h->truth = 1e-9 * rng_uniform(r, 0.5, 2.0);
  graph_of_power(h, 2, rng_uniform(r, 0.1, 1.0), h->truth);
  shift_middle(r, h);
}

static void eightfold_contact(rng *r, hard *h) {
  square_below(h);
  h->truth = rng_uniform(r, 0.01, 0.1);
  graph_of_power(h, 8, rng_uniform(r, 0.1, 1.0), h->truth);
  shift_middle(r, h);
}

static void touching(rng *r, hard *h) {
  square_below(h);
  h->truth = 0.0;
  graph_of_power(h, 2, rng_uniform(r, 0.1, 1.0), 0.0);
  shift_middle(r, h);
}

static void end_touches(rng *r, hard *h) {
  square_below(h);
  h->degree = 3;
  h->truth = 0.0;
  for (size_t i = 0; i <= 3; i++) h->points[i] = vec(rng_uniform(r, -0.5, 0.5), 0.2 * (double)i, 0.0);
}

/* The cusp of (s², s³ + gap …), turned to the square: its tip is nearest. */
static void cusp(rng *r, hard *h) {
  square_below(h);
  h->degree = 3;
  h->truth = rng_uniform(r, 0.05, 0.2);
  /* x = s³, y = s² + gap, s = 2t - 1: Bernstein of s² at degree 3: 1, -1/3, -1/3, 1; of s³: -1, 1, -1, 1 */
  const double x[4] = {-1.0, 1.0, -1.0, 1.0}, y[4] = {1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0};
  for (size_t i = 0; i < 4; i++) h->points[i] = vec(0.4 * x[i], 0.3 * y[i] + h->truth, 0.0);
  shift_middle(r, h);
}

static void constant_curve(rng *r, hard *h) {
  h->degree = 5;
  const vec3 p = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  for (size_t i = 0; i <= 5; i++) h->points[i] = p;
  one_point(h, vec(p.x + 0.3, p.y + 0.4, 0.0));
  h->truth = vec_norm(vec_sub(h->vertex[0], p));
}

static void through_the_point(rng *r, hard *h) {
  h->degree = 4;
  for (size_t i = 0; i <= 4; i++) h->points[i] = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  h->points[2] = vec(-(h->points[0].x + 4.0 * h->points[1].x + 4.0 * h->points[3].x + h->points[4].x) / 6.0,
                     -(h->points[0].y + 4.0 * h->points[1].y + 4.0 * h->points[3].y + h->points[4].y) / 6.0, 0.0);
  one_point(h, vec(0.0, 0.0, 0.0)); /* psi(1/2) = 0 */
  h->truth = 0.0;
  shift_middle(r, h);
}

/* A quarter of a circle, as a cubic as near to it as a cubic can be, about its centre: the distance is nearly the same everywhere; it is
 * least where the cubic meets the circle, at its ends and its middle. */
static void about_the_centre(rng *r, hard *h) {
  h->degree = 3;
  const double size = rng_uniform(r, 0.5, 2.0), k = 4.0 / 3.0 * (sqrt(2.0) - 1.0);
  h->points[0] = vec(size, 0.0, 0.0);
  h->points[1] = vec(size, k * size, 0.0);
  h->points[2] = vec(k * size, size, 0.0);
  h->points[3] = vec(0.0, size, 0.0);
  one_point(h, vec(0.0, 0.0, 0.0));
  h->truth = size;
}

/* Small things far from the origin. */
static void far_away(rng *r, hard *h) {
  square_below(h);
  h->truth = 1e-6 * rng_uniform(r, 0.5, 2.0);
  graph_of_power(h, 2, 1e-6 * rng_uniform(r, 0.1, 1.0), h->truth);
  const vec3 away = vec(1e6, 1e6, 0.0);
  for (size_t i = 0; i <= h->degree; i++) h->points[i] = vec_add(vec(1e-6 * h->points[i].x, h->points[i].y, 0.0), away);
  for (size_t i = 0; i < h->n; i++) h->vertex[i] = vec_add(vec_scale(1e-6, h->vertex[i]), away);
  h->truth =
      h->points[1].y - h->vertex[2].y; /* the control polygon's own, as rounded; the apex is between its points */
  h->truth = 0.25 * (h->points[0].y + 2.0 * h->points[1].y + h->points[2].y) - h->vertex[2].y;
}

/* Two curves. */
static void same_twice(rng *r, hard *h) {
  h->degree = 5, h->planar = true;
  for (size_t i = 0; i <= 5; i++)
    h->points[i] = h->other[i] = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  h->truth = 0.0;
}

static void crossing(rng *r, hard *h) {
  h->degree = 3, h->planar = true;
  for (size_t i = 0; i <= 3; i++) {
    const double s = (double)i / 1.5 - 1.0;
    h->points[i] = vec(s, rng_uniform(r, -0.3, 0.3), 0.0);
    h->other[i] = vec(rng_uniform(r, -0.3, 0.3), s, 0.0);
  }
  h->truth = 0.0; /* one goes from left to right below and above the other's ends */
}

static void parallel_lines(rng *r, hard *h) {
  h->degree = 3, h->planar = true;
  h->truth = rng_uniform(r, 0.1, 0.5);
  for (size_t i = 0; i <= 3; i++) {
    h->points[i] = vec((double)i / 3.0, 0.0, 0.0);
    h->other[i] = vec((double)i / 3.0 + 0.1, h->truth, 0.0);
  }
}

static void nested_parabolas(rng *r, hard *h) {
  h->degree = 2, h->planar = true;
  h->truth = rng_uniform(r, 0.05, 0.2);
  const double c = rng_uniform(r, 0.02, 0.1);
  hard upper;
  graph_of_power(h, 2, c, 0.0);
  graph_of_power(&upper, 2, 2.0 * c, h->truth);
  for (size_t i = 0; i <= 2; i++) h->other[i] = upper.points[i];
  shift_middle(r, h);
}

typedef struct family {
  const char *name;
  void (*make)(rng *r, hard *h);
} family;

static const family FAMILIES[] = {{"parallel to a side", parallel_to_side}, {"near tangent at 1e-9", near_tangent},
                                  {"eightfold contact", eightfold_contact}, {"touching", touching},
                                  {"its end touches", end_touches},         {"cusp", cusp},
                                  {"constant curve", constant_curve},       {"through the point", through_the_point},
                                  {"about its centre", about_the_centre},   {"1e-6 m at 1e6 m", far_away},
                                  {"the same curve twice", same_twice},     {"crossing curves", crossing},
                                  {"parallel lines", parallel_lines},       {"nested parabolas", nested_parabolas}};

/* ---- running them ------------------------------------------------------------------------------------------------------------------- */

static void finish(hard *h) {
  cprox_status status = cprox_curve_create_bezier(h->points, h->degree + 1, 0.0, 1.0, NULL, &h->curve);
  if (status >= 0 && h->n > 0) status = cprox_body_create_polytope(h->vertex, h->n, NULL, &h->body);
  if (status >= 0 && h->n == 0) status = cprox_curve_create_bezier(h->other, h->degree + 1, 0.0, 1.0, NULL, &h->second);
  if (status < 0) exit(1);
  paper_bezier_make(h->points, h->degree, &h->bezier[0]);
  if (h->n == 0) paper_bezier_make(h->other, h->degree, &h->bezier[1]);
}

static void measure(const bench_size *size, const family *f, size_t number, tools *t) {
  hard *problems = calloc(size->problems, sizeof *problems);
  if (!problems) exit(1);
  rng r = rng_seed(SEED + number);
  for (size_t i = 0; i < size->problems; i++) {
    f->make(&r, &problems[i]);
    finish(&problems[i]);
  }
  char parameter[48];
  snprintf(parameter, sizeof parameter, "%zu cases seed %zu", size->problems, SEED + number);
  const bench_workload w = {
      .group = "stability", .name = f->name, .parameter = parameter, .problems = problems, .n = size->problems};
  const bench_method methods[] = {
      {"curve_proximity", ours, t}, {"paper", paper, t}, {"sampling at 1000 points", sampling, t}};
  bench_measure(&w, size, methods, 3);
  for (size_t i = 0; i < size->problems; i++) {
    cprox_curve_free(problems[i].curve);
    cprox_curve_free(problems[i].second);
    cprox_body_free(problems[i].body);
  }
  free(problems);
}

int main(int argc, char **argv) {
  bench_size size = bench_arguments(argc, argv);
  size.rounds = 1; /* counts, not times */
  tools t = {.workspace = cprox_workspace_create(), .heap = calloc(PAPER_MAX_NODES, sizeof(paper_node))};
  if (!t.workspace || !t.heap) return 1;
  for (size_t i = 0; i < sizeof FAMILIES / sizeof *FAMILIES; i++)
    if (bench_wanted(&size, FAMILIES[i].name)) measure(&size, &FAMILIES[i], i, &t);
  free(t.heap);
  cprox_workspace_free(t.workspace);
  return 0;
}
