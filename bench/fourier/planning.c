/* SPDX-License-Identifier: BSD-3-Clause */
/* A planner's problems from many starts, most of them in contact: a solid that is placed as near to its goal as
 * obstacles allow, and a path among obstacles that is as short as they allow, in the plane and in space. What differs is
 * what tells the optimiser how free a pose is: the signed distance of convex parts, the same of superquadrics in their
 * place, the growth distance, certified gaps, signals, and sequences of these. Two optimisers solve them: a sequence of
 * quadratic programs (SLSQP) with constraints, and quasi-Newton (L-BFGS) with a penalty that grows. Whether an end is
 * free is measured by the boxes' distance, which shares no code with a gap. */
#include "fourier/parts.h"

#ifndef HAVE_NLOPT
#include <stdio.h>

void fourier_planning(const bench_size *size) {
  (void)size;
  fprintf(stderr, "fourier: without NLopt the planning problems are left out\n");
}

void fourier_smooth(const bench_size *size) {
  (void)size;
}
#else
#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fourier/freedom.h"
#include "support/random.h"

enum { POINTS = 6, SAMPLES = 49, MOST = 3 * POINTS, DENSE = 400 };

/* Samples of a path are apart by so much that between two of them a ball may come nearer by less than this [m]. */
#define PAD 0.02

static void add_box(thing *t, int dimension, const double low[3], const double high[3]) {
  /* in the plane the boxes are high enough never to be left along z */
  const cprox_vec3 size = {high[0] - low[0], high[1] - low[1], dimension == 2 ? 8.0 : high[2] - low[2]};
  const cprox_vec3 half = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
  t->at[t->n] = CPROX_POSE_IDENTITY;
  t->at[t->n].position =
      (cprox_vec3){0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), dimension == 2 ? 0.0 : 0.5 * (low[2] + high[2])};
  t->cone[t->n] = (cone_body){CONE_BOX, {half.x, half.y, half.z}};
  if (cprox_body_create_box(size, NULL, &t->part[t->n])) abort();
  if (cprox_body_create_superquadric(half, (cprox_vec3){10, 10, 10}, NULL, &t->rounded[t->n])) abort();
  t->n++;
}

static void make_solid(thing *t, int dimension) {
  cprox_solid *parts[PARTS];
  for (int i = 0; i < t->n; i++) {
    const cprox_body_info info = cprox_body_get_info(t->part[i]);
    cprox_vec3 most;
    cprox_solid_description d = {.dimension = dimension};
    if (info.kind == CPROX_BODY_SPHERE) {
      d.kind = CPROX_SOLID_BALL, d.radius = cprox_body_support(t->part[i], (cprox_vec3){1, 0, 0}, &most);
    } else {
      cprox_body_support(t->part[i], (cprox_vec3){1, 1, 1}, &most);
      d.kind = CPROX_SOLID_BOX, d.size = (cprox_vec3){2 * most.x, 2 * most.y, 2 * most.z};
    }
    if (cprox_solid_create(&d, NULL, &parts[i])) abort();
  }
  if (cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = t->at, .n = (size_t)t->n},
          NULL, &t->solid))
    abort();
  for (int i = 0; i < t->n; i++) cprox_solid_free(parts[i]);
}

static void make_ball(thing *t, double radius) {
  t->n = 1;
  t->at[0] = CPROX_POSE_IDENTITY;
  t->cone[0] = (cone_body){CONE_ELLIPSOID, {radius, radius, radius}};
  if (cprox_body_create_sphere(radius, NULL, &t->part[0])) abort();
  if (cprox_body_create_sphere(radius, NULL, &t->rounded[0])) abort();
}

static void free_thing(thing *t) {
  for (int i = 0; i < t->n; i++) cprox_body_free(t->part[i]), cprox_body_free(t->rounded[i]);
  cprox_solid_free(t->solid);
}

/* ---- Unknowns ---- */

static int unknowns(const problem *p) {
  return p->path ? p->dimension * POINTS : p->dimension == 2 ? 3 : 6;
}

/* The cubic B-spline of 8 points with clamped ends, at t of [0, 1]. */
static void spline_weights(double t, double w[POINTS + 2]) {
  enum { N = POINTS + 2, K = 4 };
  static const double knots[N + K] = {0, 0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1, 1, 1};
  double b[N + K - 1] = {0};
  int span = 3;
  while (span < N - 1 && t >= knots[span + 1]) span++;
  b[span] = 1.0;
  for (int d = 1; d < K; d++)
    for (int i = 0; i < N + K - 1 - d; i++) {
      const double l = knots[i + d] - knots[i], r = knots[i + d + 1] - knots[i + 1];
      b[i] = (l > 0 ? (t - knots[i]) / l * b[i] : 0) + (r > 0 ? (knots[i + d + 1] - t) / r * b[i + 1] : 0);
    }
  for (int i = 0; i < N; i++) w[i] = b[i];
}

static cprox_pose pose_at(const problem *p, const double *x, double t, double w[POINTS + 2]) {
  cprox_pose pose = CPROX_POSE_IDENTITY;
  if (!p->path) {
    pose.position = (cprox_vec3){x[0], x[1], p->dimension == 2 ? 0 : x[2]};
    pose.orientation =
        rotation_exponential(p->dimension == 2 ? (cprox_vec3){0, 0, x[2]} : (cprox_vec3){x[3], x[4], x[5]});
    return pose;
  }
  spline_weights(t, w);
  double at[3] = {0, 0, 0};
  for (int j = 0; j < p->dimension; j++) {
    at[j] = w[0] * p->goal[j] + w[POINTS + 1] * p->goal[3 + j];
    for (int i = 0; i < POINTS; i++) at[j] += w[i + 1] * x[p->dimension * i + j];
  }
  pose.position = (cprox_vec3){at[0], at[1], at[2]};
  return pose;
}

static double objective(const problem *p, const double *x, double *g) {
  const int n = unknowns(p);
  for (int i = 0; i < n && g; i++) g[i] = 0;
  double sum = 0.0;
  if (!p->path) {
    for (int i = 0; i < n; i++) {
      const double weight = i < p->dimension ? 1.0 : 0.1, d = x[i] - p->goal[i];
      sum += weight * d * d;
      if (g) g[i] = 2 * weight * d;
    }
    return sum;
  }
  for (int i = 0; i <= POINTS; i++)
    for (int j = 0; j < p->dimension; j++) {
      const double from = i == 0 ? p->goal[j] : x[p->dimension * (i - 1) + j],
                   to = i == POINTS ? p->goal[3 + j] : x[p->dimension * i + j], d = to - from;
      sum += d * d;
      if (g && i > 0) g[p->dimension * (i - 1) + j] -= 2 * d;
      if (g && i < POINTS) g[p->dimension * i + j] += 2 * d;
    }
  return sum;
}

/* How free sample i of the problem is; the gradient by the unknowns. */
static double freedom_at(problem *p, const double *x, int i, double *g) {
  double w[POINTS + 2];
  const cprox_pose pose = pose_at(p, x, (i + 1.0) / (SAMPLES + 1.0), w);
  const freedom f = freedom_of(p, &pose);
  const double by[3] = {f.position.x, f.position.y, f.position.z};
  if (!g) return f.value;
  if (p->path) {
    for (int k = 0; k < POINTS; k++)
      for (int j = 0; j < p->dimension; j++) g[p->dimension * k + j] = w[k + 1] * by[j];
  } else if (p->dimension == 2) {
    g[0] = by[0], g[1] = by[1], g[2] = f.rotation.z;
  } else {
    const cprox_vec3 r = rotation_by_vector((cprox_vec3){x[3], x[4], x[5]}, f.rotation);
    for (int j = 0; j < 3; j++) g[j] = by[j];
    g[3] = r.x, g[4] = r.y, g[5] = r.z;
  }
  return f.value;
}

static int samples_of(const problem *p) {
  return p->path ? SAMPLES : 1;
}

static void constraints(unsigned m, double *result, unsigned n, const double *x, double *gradient, void *data) {
  problem *p = data;
  for (unsigned i = 0; i < m; i++) {
    result[i] = -freedom_at(p, x, (int)i, gradient ? gradient + i * n : NULL);
    for (unsigned j = 0; j < n && gradient; j++) gradient[i * n + j] = -gradient[i * n + j];
  }
}

static double cost(unsigned n, const double *x, double *gradient, void *data) {
  problem *p = data;
  double sum = objective(p, x, gradient), g[MOST];
  for (int i = 0; p->weight > 0.0 && i < samples_of(p); i++) {
    const double v = fmin(0.0, freedom_at(p, x, i, g)), w = p->weight / samples_of(p);
    sum += w * v * v;
    for (unsigned j = 0; gradient && j < n; j++) gradient[j] += 2 * w * v * g[j];
  }
  return sum;
}

/* By constraints (SLSQP), or by a penalty of this weight for each square metre of violation (L-BFGS). */
static void solve(problem *p, measure by, double weight, double *x) {
  const unsigned n = (unsigned)unknowns(p);
  double least, tolerance[SAMPLES];
  for (int i = 0; i < SAMPLES; i++) tolerance[i] = 1e-6;
  p->by = by, p->weight = weight;
  const bool constrained = weight == 0.0 && by != NONE;
  nlopt_opt solver = nlopt_create(constrained ? NLOPT_LD_SLSQP : NLOPT_LD_LBFGS, n);
  nlopt_set_min_objective(solver, cost, p);
  if (constrained) nlopt_add_inequality_mconstraint(solver, (unsigned)samples_of(p), constraints, p, tolerance);
  nlopt_set_xtol_rel(solver, 1e-6);
  nlopt_set_ftol_rel(solver, 1e-8);
  nlopt_set_maxeval(solver, 200);
  nlopt_optimize(solver, x, &least);
  nlopt_destroy(solver);
}

/* The least exact distance over the end of a run. */
static double clearance(problem *p, const double *x) {
  double least = INFINITY, w[POINTS + 2];
  for (int i = 0; i <= (p->path ? DENSE : 0); i++) {
    const cprox_pose pose = pose_at(p, x, (double)i / DENSE, w);
    least = fmin(least, freedom_by_pairs(p, DISTANCE, &pose).value);
  }
  return least;
}

/* What leads first, in order; the distance comes last, but where a method is alone. */
enum { STAGES = 4 };
typedef struct recipe {
  const char *name;
  int n;
  measure by[STAGES];
} recipe;

static const recipe RECIPES[] = {
    {"signed distance", 1, {DISTANCE}},
    {"superquadrics; then distance", 2, {SUPERQUADRIC, DISTANCE}},
    {"growth distance; then distance", 2, {GROWTH, DISTANCE}},
    {"no obstacle; then distance", 2, {NONE, DISTANCE}},
    {"finest gap", 1, {FINE}},
    {"signal; then distance", 2, {SIGNAL, DISTANCE}},
    {"gaps from coarse to fine; then distance", 4, {COARSE, MIDDLE, FINE, DISTANCE}},
    {"guide", 1, {GUIDE}},
};

/* What of these is smooth, and how others measure it. */
static const recipe SMOOTH[] = {
    {"signed distance", 1, {DISTANCE}},
    {"growth distance; then distance", 2, {GROWTH, DISTANCE}},
    {"growth by a cone program; then distance", 2, {CONES, DISTANCE}},
    {"growth of 8 tilts; then distance", 2, {TILTED, DISTANCE}},
    {"randomised smoothing; then distance", 2, {JITTERED, DISTANCE}},
};
enum { N_RECIPES = sizeof RECIPES / sizeof *RECIPES, N_SMOOTH = sizeof SMOOTH / sizeof *SMOOTH };

/* Penalties grow. A stage that leads begins and ends with weights that let the next one correct it. */
static const double LEADING[] = {10, 100}, FINAL[] = {10, 100, 1e3, 1e4, 1e6};

static void follow(problem *p, const recipe *how, bool by_penalties, double *x) {
  for (int k = 0; k < how->n; k++) {
    const bool leads = k + 1 < how->n;
    if (!by_penalties || how->by[k] == NONE) {
      solve(p, how->by[k], leads && how->by[k] == SIGNAL ? 10.0 : 0.0, x);
      continue;
    }
    const double *weights = leads ? LEADING : FINAL;
    const size_t n = leads ? sizeof LEADING / sizeof *LEADING : sizeof FINAL / sizeof *FINAL;
    for (size_t i = how->n > 1 && !leads ? 2 : 0; i < n; i++) solve(p, how->by[k], weights[i], x);
  }
}

/* A shelf of three or four boxes, and a part of two whose place is a third of a metre within its floor. */
static void make_placing(problem *p) {
  const int d = p->dimension;
  add_box(&p->fixed, d, (double[]){-0.8, -0.3, -0.6}, (double[]){0.8, 0.0, 0.6});
  add_box(&p->fixed, d, (double[]){-0.8, 0.0, -0.6}, (double[]){-0.5, 0.9, 0.6});
  add_box(&p->fixed, d, (double[]){0.5, 0.0, -0.6}, (double[]){0.8, 0.9, 0.6});
  if (d == 3) add_box(&p->fixed, d, (double[]){-0.8, -0.3, -0.9}, (double[]){0.8, 0.9, -0.6});
  add_box(&p->moving, d, (double[]){-0.4, -0.3, -0.4}, (double[]){0.4, 0.0, 0.4});
  add_box(&p->moving, d, (double[]){-0.4, 0.0, -0.4}, (double[]){-0.1, 0.5, 0.4});
  p->goal[1] = 0.3 - 0.35;
}

/* Six boxes at random between both ends of a path. */
static void make_path(problem *p, unsigned scene) {
  rng r = rng_seed(830 + scene);
  for (int i = 0; i < PARTS; i++) {
    double low[3], high[3];
    for (int j = 0; j < 3; j++) {
      const double middle = rng_uniform(&r, -0.9, 0.9), half = rng_uniform(&r, 0.1, j == 0 ? 0.25 : 0.5);
      low[j] = middle - half, high[j] = middle + half;
    }
    add_box(&p->fixed, p->dimension, low, high);
  }
  make_ball(&p->moving, 0.1 + PAD);
  p->goal[0] = -1.4, p->goal[3] = 1.4;
}

static void make_problem(problem *p, int dimension, bool path, unsigned scene, bool gaps, cprox_workspace *ws) {
  *p = (problem){.ws = ws, .dimension = dimension, .path = path};
  const int d = dimension;
  if (path)
    make_path(p, scene);
  else
    make_placing(p);
  make_solid(&p->fixed, d);
  make_solid(&p->moving, d);
  for (int k = 0; k < GAPS && gaps; k++) {
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.mode = k == CERTIFIED ? CPROX_GAP_MODE_SIGNAL : CPROX_GAP_MODE_CERTIFIED;
    const uint32_t samples[GAPS] = {d == 2 ? 17 : 9, d == 2 ? 33 : 17, d == 2 ? 65 : 33, 9};
    o.samples = samples[k];
    if (cprox_gap_create(p->fixed.solid, p->moving.solid, &o, ws, &p->gap[k])) abort();
    p->info[k] = cprox_gap_get_info(p->gap[k]);
  }
}

static void start(const problem *p, rng *r, double *x) {
  const int n = unknowns(p), d = p->dimension;
  for (int i = 0; i < n; i++) x[i] = rng_uniform(r, -1.2, 1.2);
  if (!p->path)
    for (int i = d; i < n; i++) x[i] = rng_uniform(r, -1.5, 1.5);
  else
    for (int i = 0; i < POINTS; i++)
      x[d * i] = p->goal[0] + (p->goal[3] - p->goal[0]) * (i + 1.0) / (POINTS + 1.0) + rng_uniform(r, -0.2, 0.2);
}

/* How many starts end free, and how many of these near the best that any method has found there. */
typedef struct tally {
  double seconds;
  size_t starts, free, near;
} tally;

/* From the same starts for all. */
static void compare(problem *p, const recipe *recipes, int n, bool by_penalties, unsigned scene, size_t starts,
                    tally *sum) {
  double *found = calloc((size_t)n * starts, sizeof *found), best = INFINITY;
  if (!found) abort();
  for (int m = 0; m < n; m++) {
    rng r = rng_seed(83 + scene);
    const double begin = bench_thread_seconds();
    for (size_t i = 0; i < starts; i++) {
      double x[MOST];
      start(p, &r, x);
      follow(p, &recipes[m], by_penalties, x);
      const bool is_free = clearance(p, x) >= -(p->path ? PAD : 1e-3);
      found[(size_t)m * starts + i] = is_free ? objective(p, x, NULL) : (double)INFINITY;
      best = fmin(best, found[(size_t)m * starts + i]);
    }
    sum[m].seconds += bench_thread_seconds() - begin;
  }
  for (int m = 0; m < n; m++)
    for (size_t i = 0; i < starts; i++) {
      const double x = found[(size_t)m * starts + i];
      sum[m].starts++, sum[m].free += isfinite(x), sum[m].near += x <= 1.1 * best;
    }
  free(found);
}

/* The placing problems, or all of them, by these recipes: rows of workloads `what`. */
static void plan_all(const bench_size *size, const char *what, const recipe *recipes, int n, bool all) {
  static const char *const names[2][2] = {{"an L into a U", "a prism into a bracket"},
                                          {"a disc's path", "a ball's path"}};
  cprox_workspace *ws = cprox_workspace_create();
  const size_t starts = size->problems < 50 ? size->problems : 50;
  for (int path = 0; path < (all ? 2 : 1); path++)
    for (int dimension = 2; dimension <= 3; dimension++) {
      const unsigned scenes = path ? 10 : 1;
      tally sum[2][N_RECIPES] = {0};
      for (unsigned scene = 0; scene < scenes; scene++) {
        problem p;
        make_problem(&p, dimension, path, scene, all, ws);
        for (int k = 0; k < 2; k++) compare(&p, recipes, n, k == 1, scene, (starts + scenes - 1) / scenes, sum[k]);
        for (int k = 0; k < GAPS; k++) cprox_gap_free(p.gap[k]);
        free_thing(&p.fixed), free_thing(&p.moving);
      }
      for (int k = 0; k < 2; k++)
        for (int m = 0; m < n; m++) {
          const tally *t = &sum[k][m];
          const double tried = (double)t->starts, us = 1e6 * t->seconds / tried;
          char workload[80];
          snprintf(workload, sizeof workload, "%s: %s by %s", what, names[path][dimension - 2],
                   k ? "penalties" : "constraints");
          /* the last number: the share of starts that do not end so */
          fourier_row(workload, recipes[m].name, "free", us, (double)t->free, 1.0 - (double)t->free / tried, 0, 0);
          fourier_row(workload, recipes[m].name, "near the best", us, (double)t->near, 1.0 - (double)t->near / tried, 0,
                      0);
        }
    }
  cprox_workspace_free(ws);
}

void fourier_planning(const bench_size *size) {
  plan_all(size, "planning", RECIPES, N_RECIPES, true);
}

void fourier_smooth(const bench_size *size) {
  _Static_assert(N_SMOOTH <= N_RECIPES, "a tally has room for all");
  plan_all(size, "smooth", SMOOTH, N_SMOOTH, false);
}
#endif
