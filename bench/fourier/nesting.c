/* SPDX-License-Identifier: BSD-3-Clause */
/* Nesting: bring an L as close to an E as their interiors allow, centre to centre, from random poses (most of them deep
 * inside), by NLopt's SLSQP. The constraint is the certified gap, from coarse to fine; or the signed distance of the
 * nearest pair of convex pieces; or the one first and then the other. */
#include "fourier/parts.h"

#ifndef HAVE_NLOPT
#include <stdio.h>

void fourier_nesting(const bench_size *size) {
  (void)size;
  fprintf(stderr, "fourier: without NLopt the nesting problem is left out\n");
}
#else
#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <time.h>

#include "fourier/shapes.h"
#include "support/random.h"

typedef struct nest {
  shape s[SHAPES];
  const shape *a, *b;
  cprox_gap *gap;
  cprox_workspace *ws;
} nest;

static double closeness(unsigned n, const double *x, double *gradient, void *data) {
  (void)n, (void)data;
  if (gradient) gradient[0] = 2 * x[0], gradient[1] = 2 * x[1], gradient[2] = 0;
  return x[0] * x[0] + x[1] * x[1];
}

/* log V/t <= 0, continued by its tangent below V/t = 0.05, where the sum rings. */
static double gap_constraint(unsigned n, const double *x, double *gradient, void *data) {
  (void)n;
  nest *q = data;
  const cprox_pose a = shape_pose(0, 0, 0), b = shape_pose(x[0], x[1], x[2]);
  cprox_gap_result r;
  if (cprox_gap_evaluate(q->gap, &a, &b, q->ws, &r) < CPROX_OK) return HUGE_VAL;
  const double v = fmax(r.value, 0.05);
  if (gradient) gradient[0] = r.position_b.x / v, gradient[1] = r.position_b.y / v, gradient[2] = r.rotation_b.z / v;
  return log(v) + (r.value < 0.05 ? r.value / 0.05 - 1.0 : 0.0);
}

static double signed_distance(nest *q, const double *x) {
  const cprox_pose a = shape_pose(0, 0, 0), b = shape_pose(x[0], x[1], x[2]);
  return shape_distance(q->a, &a, q->b, &b);
}

static double distance_constraint(unsigned n, const double *x, double *gradient, void *data) {
  for (unsigned i = 0; gradient && i < n; i++) {
    double up[3] = {x[0], x[1], x[2]}, down[3] = {x[0], x[1], x[2]};
    up[i] += 1e-6, down[i] -= 1e-6;
    gradient[i] = -(signed_distance(data, up) - signed_distance(data, down)) / 2e-6;
  }
  return -signed_distance(data, x);
}

static double now(void) {
  return (double)clock() / CLOCKS_PER_SEC;
}

/* Gaps from coarse to fine, then the distance, each where the method has it. */
typedef struct recipe {
  const char *name;
  int gaps;
  bool distance;
} recipe;

enum { GAPS = 3 };
static const recipe RECIPES[] = {{"curve_proximity", GAPS, false},
                                 {"curve_proximity then signed distance", GAPS, true},
                                 {"signed distance", 0, true}};
enum { N_RECIPES = sizeof RECIPES / sizeof *RECIPES };

static void solve(nest *q, nlopt_func constraint, double x[3]) {
  double least;
  nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, 3);
  nlopt_set_min_objective(solver, closeness, NULL);
  nlopt_add_inequality_constraint(solver, constraint, q, 1e-6);
  nlopt_set_xtol_rel(solver, 1e-6);
  nlopt_set_maxeval(solver, 300);
  nlopt_optimize(solver, x, &least);
  nlopt_destroy(solver);
}

/* From the same starts for all. found[i]: how close start i ended, infinite where it overlaps by more than 1e-3.
 * Returns the time a start took [us]. */
static double run(nest *q, const recipe *how, cprox_gap *const gaps[GAPS], size_t starts, double *found) {
  rng r = rng_seed(79);
  const double begin = now();
  for (size_t i = 0; i < starts; i++) {
    double x[3] = {rng_uniform(&r, -1.2, 1.2), rng_uniform(&r, -1.2, 1.2), rng_uniform(&r, -3.14, 3.14)};
    for (int k = 0; k < how->gaps; k++) q->gap = gaps[k], solve(q, gap_constraint, x);
    if (how->distance) solve(q, distance_constraint, x);
    found[i] = signed_distance(q, x) >= -1e-3 ? hypot(x[0], x[1]) : INFINITY;
  }
  return 1e6 * (now() - begin) / (double)starts;
}

void fourier_nesting(const bench_size *size) {
  nest q = {.ws = cprox_workspace_create()};
  shapes_create(q.s);
  q.a = &q.s[2], q.b = &q.s[0];
  cprox_gap *gaps[GAPS];
  const uint32_t samples[GAPS] = {17, 33, 65};
  for (int k = 0; k < GAPS; k++) {
    cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
    options.samples = samples[k];
    if (cprox_gap_create(q.a->solid, q.b->solid, &options, q.ws, &gaps[k])) abort();
  }

  const size_t starts = size->problems;
  double *found = calloc(N_RECIPES * starts, sizeof *found), time[N_RECIPES], best = INFINITY;
  for (int m = 0; found && m < N_RECIPES; m++) {
    time[m] = run(&q, &RECIPES[m], gaps, starts, found + (size_t)m * starts);
    for (size_t i = 0; i < starts; i++) best = fmin(best, found[(size_t)m * starts + i]);
  }
  for (int m = 0; found && m < N_RECIPES; m++) {
    int valid = 0, good = 0;
    double sum = 0.0;
    for (size_t i = 0; i < starts; i++) {
      const double x = found[(size_t)m * starts + i];
      valid += isfinite(x), good += x <= 1.25 * best;
      sum += isfinite(x) ? x : 0.0;
    }
    fourier_row("nesting: ends without overlap", RECIPES[m].name, "E L", time[m], 100.0 * valid / (double)starts,
                sum / fmax(valid, 1), 0, 0);
    fourier_row("nesting: within a quarter of the best", RECIPES[m].name, "E L", time[m], 100.0 * good / (double)starts,
                best, 0, 0);
  }
  free(found);
  for (int k = 0; k < GAPS; k++) cprox_gap_free(gaps[k]);
  shapes_free(q.s);
  cprox_workspace_free(q.ws);
}
#endif
