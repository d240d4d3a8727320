/* SPDX-License-Identifier: BSD-3-Clause */
/* How many samples, which period, offset and kernel: no more than the accuracy asked needs. */
#include <stdio.h>
#include <stdlib.h>

#include "fourier/gap.h"

/* The signal's blur sigma in L/n. */
#define SIGNAL_BLUR 2.2

/* Images need a period of at least this: both bounding balls' diameters. */
static double solids_size(const cprox_solid *a, const cprox_solid *b) {
  return 2.0 * (a->radius + b->radius);
}

/* Measured over-reach of the tuned mode, in L/n, times 1.25: rods at n = 9 are the worst. */
static double tuned_reach(int dimension, int samples) {
  return samples < 13 ? 2.8 : dimension == 2 ? 2.1 : 1.9;
}

/* Both solids at rho, as far as the over-reach depends on them: how far the offsets go, how much they can overlap, and
 * how fast that grows with depth. */
typedef struct enlarged {
  double reach, most, slope;
  bool ok;
} enlarged;

static double slope_of(const cprox_solid *s) {
  double sum = 0.0;
  for (size_t i = 0; i < s->n; i++) sum += piece_slope(&s->pieces[i], s->dimension);
  return sum;
}

static enlarged enlarge(const cprox_solid *a, const cprox_solid *b, double rho) {
  double reach_a, reach_b;
  solid_bounds bound_a, bound_b;
  cprox_solid *p = solid_offset(a, rho, &reach_a), *q = solid_offset(b, rho, &reach_b);
  enlarged e = {.ok = p && q && solid_find_bounds(p, &bound_a) && solid_find_bounds(q, &bound_b)};
  if (e.ok) {
    e.reach = reach_a + reach_b;
    e.most = fmin(cprox_solid_get_info(p).measure * bound_b.peak, cprox_solid_get_info(q).measure * bound_a.peak);
    e.slope = fmin(slope_of(p) * bound_b.peak, slope_of(q) * bound_a.peak);
  }
  cprox_solid_free(p);
  cprox_solid_free(q);
  return e;
}

static double power(double x, int dimension) {
  return dimension == 2 ? x * x : x * x * x;
}

/* The length of a sweep, or 0. */
static double sweep_length(const cprox_solid *s) {
  const piece *p = s->pieces;
  return p->kind == PIECE_SWEEP ? piece_measure(p, s->dimension) / ball_measure(s->dimension, p->size[0]) : 0.0;
}

/* Of a sweep: the integral over its length of the parabola below G (doc/fourier.md, "Sweeps"). In units of L for
 * lengths. */
static double sweep_threshold(double t, double bend, double length) {
  const double s = fmin(length, sqrt(2.0 * t / bend));
  return t * s - bend * s * s * s / 6.0;
}

double gap_threshold(const kernel *k, const gap_plan *plan, const cprox_solid *a, const cprox_solid *b) {
  double bend;
  const double L = plan->period, t = kernel_threshold(k, plan->dimension, plan->offset / L, &bend);
  const double length = fmax(sweep_length(a), sweep_length(b));
  return length > 0.0 ? L * power(L, plan->dimension) * sweep_threshold(t, bend, length / L)
                      : power(L, plan->dimension) * t;
}

/* The least period that keeps images apart for N, and the over-reach there: L >= 2 (r_a + r_b) + over-reach, where the
 * over-reach itself depends on L. Each step enlarges L; over_reach is infinite where it does not settle: then clear is
 * still a proof. */
static cprox_status no_memory(cprox_workspace *workspace) {
  return fourier_fail(workspace, CPROX_MEMORY, "no memory to plan a gap");
}

/* The over-reach at the plan's period. `outside` is the certified kernel's table. */
static double over_reach(const gap_plan *plan, const enlarged *e, double t, const double *outside) {
  if (plan->mode == CPROX_GAP_MODE_SIGNAL) return INFINITY;
  if (plan->mode == CPROX_GAP_MODE_TUNED)
    return tuned_reach(plan->dimension, 2 * plan->N + 1) * plan->period / (2 * plan->N + 1);
  if (isinf(e->most)) return INFINITY;
  const double L = plan->period, volume = power(L, plan->dimension);
  /* lengths in units of L, overlaps in units of L^d */
  const double x = kernel_reach(outside, kernel_steps(plan->N), e->most / volume, e->slope * L / volume, t / volume);
  return x < 0.5 ? e->reach + x * L : INFINITY;
}

/* A period is given up beyond so many times the solids' size: offsets that grow as fast as the period never let it
 * settle. */
enum { MOST_STEPS = 60, LONGEST_PERIOD = 64 };

/* Enlarges L until images are apart: from each other at the offsets, and by the over-reach where there is one. */
static cprox_status choose_period(const cprox_solid *a, const cprox_solid *b, const double *outside, const kernel *k,
                                  cprox_workspace *workspace, gap_plan *plan) {
  const double size = solids_size(a, b), asked = plan->period;
  const int n = 2 * plan->N + 1;
  plan->period = asked > 0.0 ? asked : 1.05 * size;
  for (int step = 0; step < MOST_STEPS && (asked > 0.0 || plan->period <= LONGEST_PERIOD * size); step++) {
    if (cprox_workspace_wants_stop(workspace)) return CPROX_STOPPED;
    plan->offset = kernel_offset(plan->dimension, n, plan->mode) * plan->period / n;
    const enlarged e = enlarge(a, b, plan->offset);
    if (!e.ok) return no_memory(workspace);
    plan->unbounded = plan->mode == CPROX_GAP_MODE_CERTIFIED && isinf(e.most);
    plan->over_reach = over_reach(plan, &e, gap_threshold(k, plan, a, b), outside);
    const bool known = plan->over_reach < INFINITY;
    const double needed = size + (known ? fmax(e.reach, plan->over_reach) : e.reach);
    if (asked > 0.0 && asked < needed)
      return fourier_fail(workspace, CPROX_INVALID, "period %g is too small: images of the solids need %g at n = %d",
                          asked, needed, n);
    /* a period four times the solids is the end of trying for an over-reach that coarse samples do not have */
    const bool hopeless = plan->mode != CPROX_GAP_MODE_CERTIFIED || plan->unbounded || plan->period > 4.0 * size;
    if (asked > 0.0 || (plan->period >= needed && (known || hopeless))) return CPROX_OK;
    plan->period = known || plan->period < needed ? fmax(1.002 * needed, plan->period) : 1.15 * plan->period;
  }
  return fourier_fail(workspace, CPROX_INVALID, "n = %d samples are too few for these solids", n);
}

static cprox_status settle(const cprox_solid *a, const cprox_solid *b, cprox_workspace *workspace, gap_plan *plan) {
  kernel k;
  if (plan->mode == CPROX_GAP_MODE_TUNED)
    kernel_tuned(&k, plan->N);
  else
    kernel_certified(&k, plan->N, plan->beta);
  const int steps = kernel_steps(plan->N);
  double *outside = malloc((size_t)(steps + 1) * sizeof *outside);
  cprox_status status = outside ? CPROX_OK : no_memory(workspace);
  if (status == CPROX_OK && plan->mode == CPROX_GAP_MODE_CERTIFIED) {
    status = kernel_list_outside(&k, plan->dimension, steps, workspace, outside);
    if (status == CPROX_MEMORY) status = no_memory(workspace);
  }
  if (status == CPROX_OK) status = choose_period(a, b, outside, &k, workspace, plan);
  free(outside);
  return status;
}

static cprox_status plan_for(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N,
                             cprox_workspace *workspace, gap_plan *plan) {
  *plan = (gap_plan){.mode = options->mode,
                     .dimension = a->dimension,
                     .N = N,
                     .beta = kernel_beta(a->dimension, 2 * N + 1),
                     .period = options->period,
                     .turned_first = gap_cost_of_turning(a) < gap_cost_of_turning(b)};
  return settle(a, b, workspace, plan);
}

cprox_gap_options gap_options(const cprox_gap_options *options) {
  cprox_gap_options copy = CPROX_GAP_OPTIONS_DEFAULT;
  if (options && options->size == sizeof copy)
    copy = *options;
  else if (options)
    copy.size = options->size;
  return copy;
}

static cprox_status check_options(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *o,
                                  cprox_workspace *workspace) {
  if (o->size != sizeof *o)
    return fourier_fail(workspace, CPROX_INVALID,
                        "options.size is %zu, this library knows %zu: start from CPROX_GAP_OPTIONS_DEFAULT", o->size,
                        sizeof *o);
  if (o->mode != CPROX_GAP_MODE_CERTIFIED && o->mode != CPROX_GAP_MODE_TUNED && o->mode != CPROX_GAP_MODE_SIGNAL)
    return fourier_fail(workspace, CPROX_INVALID, "mode %d is none", (int)o->mode);
  if (a->dimension != b->dimension)
    return fourier_fail(workspace, CPROX_INVALID, "the solids have dimensions %d and %d", a->dimension, b->dimension);
  if (sweep_length(a) > 0.0 && sweep_length(b) > 0.0)
    return fourier_fail(workspace, CPROX_INVALID, "both solids are sweeps: at most one may be");
  if (o->samples != 0 && (o->samples < 3 || o->samples > 2 * KERNEL_MOST_N + 1 || o->samples % 2 == 0))
    return fourier_fail(workspace, CPROX_INVALID, "samples is %u, must be odd and within 3 … %d", o->samples,
                        2 * KERNEL_MOST_N + 1);
  if (!(o->period >= 0.0) || o->period > SOLID_LARGEST)
    return fourier_fail(workspace, CPROX_INVALID, "period is %g, must be > 0, or 0 for the least", o->period);
  if (o->samples != 0 && o->delta != 0.0)
    return fourier_fail(workspace, CPROX_INVALID, "delta is %g and samples is %u: give one of the two, delta chooses n",
                        o->delta, o->samples);
  if (o->samples != 0) return CPROX_OK;
  if (!(o->delta > 0.0))
    return fourier_fail(workspace, CPROX_INVALID, "delta is %g, must be > 0 (or give samples)", o->delta);
  if (o->period > 0.0 && o->period < solids_size(a, b))
    return fourier_fail(workspace, CPROX_INVALID, "period %g is too small: images of the solids need more than %g",
                        o->period, solids_size(a, b));
  if (o->delta > a->radius + b->radius)
    return fourier_fail(workspace, CPROX_INVALID,
                        "delta %g is larger than the bodies (radii %g and %g): their bounding spheres say as much",
                        o->delta, a->radius, b->radius);
  return CPROX_OK;
}

/* The signal has no over-reach: its blur sigma = 2.2 L/n is what delta means. */
static double accuracy(const gap_plan *plan) {
  return plan->mode == CPROX_GAP_MODE_SIGNAL ? SIGNAL_BLUR * plan->period / (2 * plan->N + 1) : plan->over_reach;
}

/* What no period can bring the accuracy of 2N+1 samples below: the period is at least the solids' size, and both
 * offsets are part of a proven over-reach. */
static double best_accuracy(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N) {
  const int n = 2 * N + 1;
  const double factor = options->mode == CPROX_GAP_MODE_SIGNAL  ? SIGNAL_BLUR
                        : options->mode == CPROX_GAP_MODE_TUNED ? tuned_reach(a->dimension, n)
                                                                : 2.0 * kernel_offset(a->dimension, n, options->mode);
  return (1.0 - 1e-9) * factor * solids_size(a, b) / n;
}

/* One trial of the search for n. A refusal (no period keeps images apart, or only a longer one than was asked) says
 * that these samples are too few, as an accuracy above delta does: more may do. */
typedef struct trial {
  gap_plan plan;
  double accuracy; /* infinite where refused, or known to be above delta without a plan */
  bool enough;
} trial;

static cprox_status try_samples(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N,
                                cprox_workspace *workspace, trial *t) {
  *t = (trial){.plan = {.N = N}, .accuracy = INFINITY};
  if (best_accuracy(a, b, options, N) > options->delta) return CPROX_OK;
  const cprox_status status = plan_for(a, b, options, N, workspace, &t->plan);
  if (status == CPROX_OK) t->accuracy = accuracy(&t->plan);
  t->enough = t->accuracy <= options->delta;
  if (status != CPROX_INVALID) return status;
  fourier_clear(workspace);
  return CPROX_OK;
}

/* The trials so far. Over-reaches fall with n, those of sweeps down to a least one: from there on their threshold falls
 * faster than what the kernel has outside. */
typedef struct search {
  int low, high;     /* not enough, and the trial after it */
  int before, after; /* the best trial lies between these */
  int rises;         /* trials in a row that were worse than the one before */
  double best, last;
  bool enough;
} search;

enum { MOST_RISES = 3 };

static cprox_status too_many(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N,
                             cprox_workspace *workspace) {
  gap_plan plan;
  const cprox_status status = plan_for(a, b, options, N, workspace, &plan);
  if (status != CPROX_OK) return status;
  const int n = 2 * N + 1;
  char beyond[64] = "", had[64] = "no over-reach can be proven there";
  if (N < KERNEL_MOST_N) snprintf(beyond, sizeof beyond, ", beyond the limit of %zu", options->memory_limit);
  if (isfinite(accuracy(&plan))) snprintf(had, sizeof had, "%g is had there", accuracy(&plan));
  return fourier_fail(workspace, CPROX_INVALID, "delta %g needs more than n = %d samples, %.3g bytes%s; %s",
                      options->delta, n, gap_bytes(a->dimension, N), beyond, had);
}

/* Gallops up to enough samples, to more than may be, or to where more are worse. */
static cprox_status gallop(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                           cprox_workspace *workspace, search *s) {
  for (;;) {
    trial t;
    const cprox_status status = try_samples(a, b, options, s->high, workspace, &t);
    if (status != CPROX_OK) return status;
    s->enough = t.enough;
    if (t.enough) return CPROX_OK;
    if (t.plan.unbounded)
      return fourier_fail(workspace, CPROX_INVALID,
                          "no over-reach can be proven for these solids (two that are not sums of convex pieces): "
                          "give samples");
    const int next = s->high + s->high / 2 + 1 < KERNEL_MOST_N ? s->high + s->high / 2 + 1 : KERNEL_MOST_N;
    s->rises = t.accuracy > s->last ? s->rises + 1 : 0;
    if (s->rises == MOST_RISES) return CPROX_OK;
    s->last = t.accuracy;
    if (t.accuracy < s->best) s->best = t.accuracy, s->before = s->low, s->after = next;
    if (s->high == KERNEL_MOST_N || gap_bytes(a->dimension, s->high) > (double)options->memory_limit)
      return too_many(a, b, options, s->high, workspace);
    s->low = s->high;
    s->high = next;
  }
}

/* Between samples that are too few and more that are worse again: in thirds down to the least accuracy, until one is
 * enough. */
static cprox_status search_valley(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                                  cprox_workspace *workspace, search *s) {
  int low = s->before, high = s->after;
  while (high - low > 1) {
    const int third = (high - low + 2) / 3, at[2] = {low + third, high - third};
    trial t[2];
    for (int i = 0; i < 2; i++) {
      const cprox_status status = try_samples(a, b, options, at[i], workspace, &t[i]);
      if (status != CPROX_OK) return status;
      s->best = fmin(s->best, t[i].accuracy);
      s->low = s->before, s->high = at[i];
      s->enough = t[i].enough;
      if (t[i].enough) return CPROX_OK;
    }
    if (t[0].accuracy <= t[1].accuracy)
      high = at[1];
    else
      low = at[0];
  }
  return fourier_fail(workspace, CPROX_INVALID,
                      "delta %g cannot be proven for these solids: %g is the least, and more samples are worse",
                      options->delta, s->best);
}

static cprox_status choose(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                           cprox_workspace *workspace, gap_plan *plan) {
  cprox_status status = check_options(a, b, options, workspace);
  if (status != CPROX_OK) return status;
  if (options->samples != 0) return plan_for(a, b, options, (int)options->samples / 2, workspace, plan);

  search s = {.high = 1, .best = INFINITY, .last = INFINITY};
  status = gallop(a, b, options, workspace, &s);
  if (status == CPROX_OK && !s.enough) status = search_valley(a, b, options, workspace, &s);
  if (status != CPROX_OK) return status;

  /* halve down to the least */
  while (s.high - s.low > 1) {
    trial t;
    const int mid = (s.low + s.high) / 2;
    status = try_samples(a, b, options, mid, workspace, &t);
    if (status != CPROX_OK) return status;
    if (t.enough)
      s.high = mid;
    else
      s.low = mid;
  }
  return plan_for(a, b, options, s.high, workspace, plan);
}

cprox_status gap_plan_choose(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                             cprox_workspace *workspace, gap_plan *plan) {
  const cprox_status status = choose(a, b, options, workspace, plan);
  return status == CPROX_STOPPED ? fourier_stopped(workspace) : status;
}
