/* SPDX-License-Identifier: BSD-3-Clause */
/* Over-reach against n, and outlines of obstacles: rays from deep overlap outwards, the last place called colliding on
 * each. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fourier/gap.h"
#include "fourier/parts.h"
#include "fourier/shapes.h"
#include "support/random.h"
#ifdef HAVE_LIQUID
#include <liquid/liquid.h>
#endif

#define PI 3.14159265358979323846

/* The gap of a method, or NULL where it has none. */
typedef cprox_gap *(*gap_maker)(const shape *a, const shape *b, uint32_t samples, cprox_workspace *ws);

static cprox_gap *make(const shape *a, const shape *b, cprox_gap_mode mode, uint32_t samples, cprox_workspace *ws) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = mode, o.samples = samples;
  cprox_gap *gap = NULL;
  cprox_gap_create(a->solid, b->solid, &o, ws, &gap);
  return gap;
}

static cprox_gap *make_certified(const shape *a, const shape *b, uint32_t samples, cprox_workspace *ws) {
  return make(a, b, CPROX_GAP_MODE_CERTIFIED, samples, ws);
}

static cprox_gap *make_tuned(const shape *a, const shape *b, uint32_t samples, cprox_workspace *ws) {
  return make(a, b, CPROX_GAP_MODE_TUNED, samples, ws);
}

#ifdef HAVE_LIQUID
/* The least value of the kernel of separable weights w over its period. */
static double least_value(const kernel *w) {
  enum { HALF = 4096 };
  static double cosine[2 * HALF]; /* of a whole turn: kernels are many, and this is most of what they take */
  if (cosine[0] == 0.0)
    for (int i = 0; i < 2 * HALF; i++) cosine[i] = cos(PI * i / HALF);
  double low = INFINITY, high = 0.0;
  for (int i = 0; i <= HALF; i++) {
    double sum = w->w[0];
    for (int k = 1; k <= w->n; k++) sum += 2.0 * w->w[k] * cosine[i * k % (2 * HALF)];
    low = fmin(low, sum), high = fmax(high, sum);
  }
  return fmin(0.0, low * high); /* the plane's: one factor negative, the other at its peak */
}

/* The paper's kernel: Parks-McClellan with pass band x0 and stop band x1, as weights with w[0] = 1. */
static bool paper_kernel(int N, double x0, double x1, kernel *w) {
  float bands[4] = {0.0F, (float)x0, (float)x1, 0.5F}, want[2] = {1.0F, 0.0F}, taps[2 * KERNEL_MOST_N + 1];
  float weights[2] = {1.0F, 1.0F};
  liquid_firdespm_wtype kinds[2] = {LIQUID_FIRDESPM_FLATWEIGHT, LIQUID_FIRDESPM_FLATWEIGHT};
  if (firdespm_run((unsigned)(2 * N + 1), 2, bands, want, weights, kinds, LIQUID_FIRDESPM_BANDPASS, taps) != 0)
    return false;
  *w = (kernel){.n = N};
  for (int k = 0; k <= N; k++) w->w[k] = (double)taps[N + k] / (double)taps[N];
  return isfinite(w->w[N]) && taps[N] > 0.0F;
}

/* A gap with that kernel and the threshold that its negative part leaves: t - eta mu mu (the corrected theorem). Pass
 * and stop band are those of the least 2 rho + x1 with a threshold above 0 out of a scan. */
static cprox_gap *make_paper(const shape *a, const shape *b, uint32_t samples, cprox_workspace *ws) {
  const int N = (int)samples / 2;
  double best = INFINITY, best_threshold = 0.0;
  kernel chosen = {.n = 0};
  gap_plan plan = {.mode = CPROX_GAP_MODE_CERTIFIED, .dimension = 2, .N = N, .beta = kernel_beta(2, (int)samples)};
  plan.period = 2.6 * (a->solid->radius + b->solid->radius);
  const double area = plan.period * plan.period;
  for (double x0 = 0.3 / samples; x0 < 0.15; x0 *= 1.25)
    for (double dx = 0.5 / samples; x0 + dx < 0.3; dx *= 1.25) {
      kernel w;
      if (2.0 * x0 + x0 + dx >= best || !paper_kernel(N, x0, x0 + dx, &w)) continue;
      double reach;
      cprox_solid *p = solid_offset(a->solid, x0 * plan.period, &reach),
                  *q = solid_offset(b->solid, x0 * plan.period, &reach);
      const double mu = cprox_solid_get_info(p).measure / area * (cprox_solid_get_info(q).measure / area);
      const double t = kernel_threshold(&w, 2, x0, NULL) + least_value(&w) * mu;
      cprox_solid_free(p);
      cprox_solid_free(q);
      if (t > 0.0) best = 3.0 * x0 + dx, best_threshold = t, chosen = w, plan.offset = x0 * plan.period;
    }
  if (isinf(best)) return NULL;

  double reach;
  cprox_gap *gap;
  if (gap_build(&plan, solid_offset(a->solid, plan.offset, &reach), solid_offset(b->solid, plan.offset, &reach),
                (size_t)1 << 30, ws, &gap))
    return NULL;
  kernel certified;
  kernel_certified(&certified, N, plan.beta);
  for (size_t i = 0; i < gap->n_blocks; i++) {
    for (int j = 0; j < 2 * LANES; j++) {
      const int k[3] = {gap->blocks[i].k[0] + j % LANES, gap->blocks[i].k[1], 0};
      const double was = kernel_weight(&certified, k);
      if (was > 0.0) gap->c[2 * LANES * i + (size_t)j] *= kernel_weight(&chosen, k) / was;
    }
  }
  double left = 0.0; /* what the blocks from each on can still add, by the new coefficients */
  for (size_t i = gap->n_blocks; i > 0; i--) {
    for (size_t j = 0; j < 2 * LANES; j++) left += pow(gap->c[2 * LANES * (i - 1) + j], 2.0);
    gap->tail[i - 1] = 2.0 * sqrt(left) * (1.0 + 1e-12);
  }
  gap->inverse = 1.0 / (best_threshold * area * area);
  gap->centre_a = a->solid->centre, gap->centre_b = b->solid->centre;
  gap->radius_a = a->solid->radius, gap->radius_b = b->solid->radius;
  return gap;
}
#endif

/* A gap of the kernel, decided by the sum alone as the paper's is, or as cprox_gap_test() answers: by bounds per
 * direction first. A chart of the verdict says nothing of the sum. */
typedef struct method {
  const char *name;
  gap_maker make;
  bool sum_alone;
} method;

static const method METHODS[] = {
    {"curve_proximity sum", make_certified, true},
    {"curve_proximity", make_certified, false},
    {"curve_proximity tuned sum", make_tuned, true},
    {"curve_proximity tuned", make_tuned, false},
#ifdef HAVE_LIQUID
    {"paper", make_paper, true}, /* of gap_build() alone: it has no bounds per direction */
#endif
};
enum { N_METHODS = sizeof METHODS / sizeof *METHODS };

static void decide_by_sum(cprox_gap *gap) {
  enclosures_free(&gap->bounds_a);
  enclosures_free(&gap->bounds_b);
}

/* "May collide": a verdict, for which most sums may stop early. */
static bool may_collide(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b, cprox_workspace *ws) {
  cprox_gap_result r;
  if (cprox_gap_test(gap, a, b, ws, &r) < CPROX_OK) abort();
  return r.verdict == CPROX_GAP_VERDICT_COLLIDE || r.verdict == CPROX_GAP_VERDICT_UNDECIDED;
}

/* Outwards from the edge of the bounding spheres: the first distance along the ray at which the gap says "may collide",
 * to 1e-4. */
static double ray_end(const cprox_gap *gap, double phi, double theta, cprox_workspace *ws) {
  const double most = gap->radius_a + gap->radius_b, step = most / 150.0;
  const cprox_pose a = shape_pose(0, 0, 0);
  for (double x = most; x > 0.0; x -= step) {
    const cprox_pose b = shape_pose(x * cos(phi), x * sin(phi), theta);
    if (!may_collide(gap, &a, &b, ws)) continue;
    double low = x, high = x + step;
    for (int i = 0; i < 10; i++) {
      const double mid = 0.5 * (low + high);
      const cprox_pose at = shape_pose(mid * cos(phi), mid * sin(phi), theta);
      if (may_collide(gap, &a, &at, ws))
        low = mid;
      else
        high = mid;
    }
    return low;
  }
  return 0.0;
}

/* What value and gradient cost at random poses inside the bounding spheres [us]. */
static double time_of(const cprox_gap *gap, cprox_workspace *ws) {
  enum { POSES = 64, ROUNDS = 5 };
  const cprox_pose a = shape_pose(0, 0, 0);
  double best = INFINITY;
  for (int round = 0; round < ROUNDS; round++) {
    rng r = rng_seed(81);
    struct timespec begin, end;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    for (int i = 0; i < POSES; i++) {
      const double far = rng_uniform(&r, 0.0, 0.9) * (gap->radius_a + gap->radius_b);
      const cprox_pose b = shape_pose(far, 0.0, rng_uniform(&r, 0, 2 * PI));
      cprox_gap_result found;
      cprox_gap_evaluate(gap, &a, &b, ws, &found);
    }
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    best = fmin(best, 1e6 * (double)(end.tv_sec - begin.tv_sec) + 1e-3 * (double)(end.tv_nsec - begin.tv_nsec));
  }
  return best / POSES;
}

/* The largest clearance called colliding on random rays around random rotations, over the period; overlaps called clear
 * are unsound. */
static void measure_reach(const method *m, const shape *a, const shape *b, uint32_t samples, size_t rays,
                          cprox_workspace *ws) {
  char parameter[64], workload[64];
  cprox_gap *gap = m->make(a, b, samples, ws);
  snprintf(parameter, sizeof parameter, "n %u", samples);
  snprintf(workload, sizeof workload, "over-reach %s %s", a->name, b->name);
  if (!gap) {
    fourier_row(workload, m->name, parameter, NAN, 0, NAN, 0, 0);
    return;
  }
  if (m->sum_alone) decide_by_sum(gap);
  const cprox_gap_info info = cprox_gap_get_info(gap);
  rng r = rng_seed(77);
  double most = 0.0;
  unsigned long unsound = 0;
  const cprox_pose here = shape_pose(0, 0, 0);
  for (size_t i = 0; i < rays; i++) {
    const double phi = rng_uniform(&r, 0, 2 * PI), theta = rng_uniform(&r, 0, 2 * PI), x = ray_end(gap, phi, theta, ws);
    const cprox_pose end = shape_pose(x * cos(phi), x * sin(phi), theta);
    most = fmax(most, shape_distance(a, &here, b, &end));
    const cprox_pose beyond = shape_pose((x + 1e-3) * cos(phi), (x + 1e-3) * sin(phi), theta);
    unsound += shape_distance(a, &here, b, &beyond) < -1e-9;
  }
  fourier_row(workload, m->name, parameter, time_of(gap, ws), (double)info.terms, most / info.period, unsound, 0);
  cprox_gap_free(gap);
}

void fourier_over_reach(const bench_size *size) {
  shape s[SHAPES];
  shapes_create(s);
  cprox_workspace *ws = cprox_workspace_create();
  const int pairs[4][2] = {{0, 1}, {2, 3}, {4, 3}, {5, 2}};
  const uint32_t samples[] = {9, 17, 33, 65, 129};
  for (int p = 0; p < 4; p++)
    for (int i = 0; i < (size->problems >= 200 ? 5 : 4); i++)
      for (int m = 0; m < N_METHODS; m++)
        measure_reach(&METHODS[m], &s[pairs[p][0]], &s[pairs[p][1]], samples[i], size->problems >= 200 ? 60 : 24, ws);
  cprox_workspace_free(ws);
  shapes_free(s);
}

/* Outlines of the obstacle of an L and a T: at one rotation for several n and exactly, and at n = 17 for twelve
 * rotations. */
static double exact_end(const shape *a, const shape *b, double phi, double theta) {
  const cprox_pose here = shape_pose(0, 0, 0);
  double x = 3.0;
  for (int i = 0; i < 200 && x > 0.0; i++) { /* sphere tracing: no step passes the obstacle */
    const cprox_pose at = shape_pose(x * cos(phi), x * sin(phi), theta);
    const double d = shape_distance(a, &here, b, &at);
    if (d < 1e-5) break;
    x -= d;
  }
  return fmax(0.0, x);
}

void fourier_obstacle(const bench_size *size) {
  shape s[SHAPES];
  shapes_create(s);
  cprox_workspace *ws = cprox_workspace_create();
  const int rays = size->problems >= 200 ? 120 : 48;
  const uint32_t samples[] = {0, 9, 17, 33, 65};
  for (int i = 0; i < 9; i++) {
    const uint32_t n = samples[(i + 1) / 2]; /* the sum alone, then the verdict */
    const bool sum_alone = i % 2 == 1;
    cprox_gap *gap = n ? make_certified(&s[0], &s[1], n, ws) : NULL;
    if (sum_alone) decide_by_sum(gap);
    for (int slice = 0; slice < (n == 17 ? 12 : 1); slice++)
      for (int k = 0; k < rays; k++) {
        const double phi = 2 * PI * k / rays, theta = 0.6 + 2 * PI * slice / 12;
        char parameter[96];
        snprintf(parameter, sizeof parameter, "n %u theta %.4f phi %.4f", n, theta, phi);
        const double x = gap ? ray_end(gap, phi, theta, ws) : exact_end(&s[0], &s[1], phi, theta);
        const char *by = !gap ? "exact" : sum_alone ? "curve_proximity sum" : "curve_proximity";
        fourier_row("obstacle L T", by, parameter, NAN, 0, x, 0, 0);
      }
    cprox_gap_free(gap);
  }
  cprox_workspace_free(ws);
  shapes_free(s);
}

/* Along one ray out of an overlap, the three rows of the paper's Fig. 5: the value, the part of the sum that it takes to
 * decide by the sum alone, and that a verdict takes, the length of the gradient by the position [1/m]. */
void fourier_profile(const bench_size *size) {
  shape s[SHAPES];
  shapes_create(s);
  cprox_workspace *ws = cprox_workspace_create();
  const int steps = size->problems >= 200 ? 40 : 20;
  const uint32_t samples[] = {9, 17, 33};
  const cprox_pose a = shape_pose(0, 0, 0);
  for (int i = 0; i < 3; i++) {
    cprox_gap *gap = make_certified(&s[0], &s[1], samples[i], ws);
    const double terms = (double)cprox_gap_get_info(gap).terms;
    cprox_gap by_sum = *gap; /* its bounds are the gap's to free */
    by_sum.bounds_a = by_sum.bounds_b = (enclosures){0};
    for (int k = 0; k <= steps; k++) {
      const double x = 1.8 * k / steps;
      const cprox_pose b = shape_pose(x * cos(0.4), x * sin(0.4), 0.6);
      cprox_gap_result whole, early, verdict;
      if (cprox_gap_evaluate(gap, &a, &b, ws, &whole) < CPROX_OK || cprox_gap_test(&by_sum, &a, &b, ws, &early) < 0 ||
          cprox_gap_test(gap, &a, &b, ws, &verdict) < CPROX_OK)
        abort();
      char parameter[96];
      snprintf(parameter, sizeof parameter, "n %u x %.4f clearance %.4f", samples[i], x,
               shape_distance(&s[0], &a, &s[1], &b));
      fourier_row("profile value", "curve_proximity", parameter, NAN, 0, whole.value, 0, 0);
      fourier_row("profile terms", "curve_proximity sum", parameter, NAN, 0, fmin(1.0, early.terms / terms), 0, 0);
      fourier_row("profile terms", "curve_proximity", parameter, NAN, 0, fmin(1.0, verdict.terms / terms), 0, 0);
      fourier_row("profile gradient", "curve_proximity", parameter, NAN, 0, vec_norm(whole.position_b), 0, 0);
    }
    cprox_gap_free(gap);
  }
  cprox_workspace_free(ws);
  shapes_free(s);
}
