/* SPDX-License-Identifier: BSD-3-Clause */
/* How many samples, which period, offset and kernel: no more than the accuracy asked needs. */
#include <stdio.h>
#include <stdlib.h>

#include "fourier/gap.h"
#include "fourier/grid.h"
#include "fourier/raster.h"

/* Images need a period of at least this: both bounding spheres' diameters. */
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
  double images;          /* what a tabulated solid's images overlap at most */
  double table_period[3]; /* of the table's window */
  bool ok;
} enlarged;

static double slope_of(const cprox_solid *s) {
  double sum = 0.0;
  for (size_t i = 0; i < s->n; i++) sum += piece_slope(&s->pieces[i], s->dimension);
  return sum;
}

/* How far the solid reaches from its centre along each axis. */
static void find_extents(const cprox_solid *s, double extent[3]) {
  for (int j = 0; j < 3; j++) extent[j] = 0.0;
  for (size_t i = 0; i < s->n; i++) {
    vec3 low, high;
    piece_box(&s->pieces[i], 3, &low, &high);
    low = vec_sub(low, s->centre), high = vec_sub(high, s->centre);
    extent[0] = fmax(extent[0], fmax(-low.x, high.x));
    extent[1] = fmax(extent[1], fmax(-low.y, high.y));
    extent[2] = fmax(extent[2], fmax(-low.z, high.z));
  }
}

/* What the spline between a turned grid's nodes makes of its function (doc/fourier.md, "Covers and tables"). Of a cover
 * whose cells are not made yet: what that of any grid with such cells makes of it at most. It holds the bare solid and
 * all within the offset, and is within the enlarged one. */
static void tabulate(const gap_plan *plan, const cprox_solid *fixed, double peak, const cprox_solid *bare,
                     const cprox_solid *turned, enlarged *e) {
  const double cell = plan->cell[plan->turned_first ? 0 : 1];
  table_bounds t;
  if (cell > 0.0) {
    double least[3], most[3];
    find_extents(bare, least);
    find_extents(turned, most);
    for (int j = 0; j < 3; j++) least[j] = fmax(least[j] + plan->offset, cell), most[j] += vec_norm(turned->centre);
    lookup_bound_cover(least, most, cell, cprox_solid_get_info(turned).measure, &t);
  } else {
    e->ok = lookup_find_bounds(turned->pieces, &t, NULL);
    if (!e->ok) return;
  }
  e->most *= t.peak, e->slope *= t.peak;
  e->images = gap_images(&t, peak, cprox_solid_get_info(fixed).measure);
  for (int j = 0; j < 3; j++) e->table_period[j] = t.period[j];
}

/* Both solids at the plan's offset. A cover is within the closed form that is enlarged by what the cells add: its
 * bounds are those of that form, and its peak is 1. */
static enlarged enlarge(const gap_plan *plan, const cprox_solid *a, const cprox_solid *b) {
  double reach[2];
  solid_bounds bounds[2];
  const cprox_solid *const bare[2] = {a, b};
  cprox_solid *s[2] = {NULL, NULL};
  enlarged e = {.ok = true};
  for (int i = 0; i < 2; i++) {
    const double cell = plan->cell[i], more = cell > 0.0 ? raster_growth(bare[i], cell) + sqrt(3.0) * cell : 0.0;
    s[i] = e.ok ? solid_offset(bare[i], plan->offset + more, &reach[i]) : NULL;
    e.ok = s[i] && solid_find_bounds(s[i], &bounds[i]);
  }
  /* where neither is a sum of indicators more samples than covers are made for could prove nothing: neither do these */
  const bool known = e.ok && (isfinite(bounds[0].peak) || isfinite(bounds[1].peak));
  for (int i = 0; known && i < 2; i++)
    if (plan->cell[i] > 0.0) bounds[i].peak = 1.0;
  if (e.ok) {
    e.reach = reach[0] + reach[1];
    e.most =
        fmin(cprox_solid_get_info(s[0]).measure * bounds[1].peak, cprox_solid_get_info(s[1]).measure * bounds[0].peak);
    e.slope = fmin(slope_of(s[0]) * bounds[1].peak, slope_of(s[1]) * bounds[0].peak);
    const int turned = plan->turned_first ? 0 : 1;
    if (plan->tabulated) tabulate(plan, s[1 - turned], bounds[1 - turned].peak, bare[turned], s[turned], &e);
  }
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
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
  const double left = t - e->images; /* the images may take so much of the threshold */
  if (!(left > 0.0)) return INFINITY;
  const double x = kernel_reach(outside, kernel_steps(plan->N), e->most / volume, e->slope * L / volume, left / volume);
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
    const enlarged e = enlarge(plan, a, b);
    if (!e.ok) return no_memory(workspace);
    plan->bytes = plan->tabulated ? lookup_size(e.table_period, gap_farthest_frequency(plan->N, plan->period)) : 0.0;
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

/* In the units of gap_cost_of_turning(), where a box is 2: what a look-up in a table costs. */
#define COST_OF_TABLE 150.0

/* Above this a solid that is not turned is covered by cells, too: the transforms of so many triangles. */
enum { MOST_TRIANGLES = 400 };

/* Up to so many samples covers and tables take the place of what costs too much: beyond, images of 1e-5 of a solid are
 * no longer small beside the threshold, and tables take more memory than a gap should. */
enum { TABLE_MOST_N = 32 };

/* Cells that cover a solid have this share of the certified offset as their edge. */
#define CELL_SHARE 0.25

/* What the least period over the solids' size will be, about: the proven over-reach is some 5.3 L/n. */
static double expected_period(int n, cprox_gap_mode mode) {
  return mode == CPROX_GAP_MODE_CERTIFIED ? 1.0 / fmax(0.4, 1.0 - 5.3 / n) : 1.1;
}

static bool is_tabulated(const cprox_solid *s) {
  return raster_is_possible(s) && gap_cost_of_turning(s) > COST_OF_TABLE;
}

static bool is_grid(const cprox_solid *s) {
  return s->n == 1 && grid_is_aligned(&s->pieces[0]);
}

/* Triangles of the offset: that of a mesh has wedges and caps besides the faces, some fifteen times as many. */
static double triangles_of(const cprox_solid *s) {
  double n = 0.0;
  for (size_t i = 0; i < s->n; i++) {
    const piece *p = &s->pieces[i];
    if (p->kind == PIECE_SOUP) n += piece_is_polytope(p) ? (double)p->n_corners / 3.0 : 15.0 * (double)p->n_triangles;
    if (p->kind == PIECE_CAPSULE) n += 20.0;
    if (p->kind == PIECE_GRID && !is_grid(s)) n += (double)p->counts[1] * p->counts[2];
  }
  return n;
}

/* Which solid is turned, and what takes the place of one whose closed form costs too much. */
static void choose_forms(const cprox_solid *a, const cprox_solid *b, gap_plan *plan) {
  /* a sweep's threshold is so low that images count beside it, too */
  if (plan->N > TABLE_MOST_N || sweep_length(a) > 0.0 || sweep_length(b) > 0.0) {
    plan->turned_first = gap_cost_of_turning(a) < gap_cost_of_turning(b);
    return;
  }
  const bool table_a = is_tabulated(a), table_b = is_tabulated(b);
  const double cost_a = table_a ? COST_OF_TABLE : gap_cost_of_turning(a);
  const double cost_b = table_b ? COST_OF_TABLE : gap_cost_of_turning(b);
  plan->turned_first = cost_a < cost_b || (table_a && table_b && a->radius < b->radius);
  plan->tabulated = plan->turned_first ? table_a : table_b;
  const int n = 2 * plan->N + 1;
  const double period = plan->period > 0.0 ? plan->period : expected_period(n, plan->mode) * solids_size(a, b);
  const double cell = CELL_SHARE * kernel_offset(plan->dimension, n, CPROX_GAP_MODE_CERTIFIED) * period / n;
  const cprox_solid *const both[2] = {a, b};
  for (int i = 0; i < 2; i++) {
    const bool turned = plan->turned_first == (i == 0);
    const bool covered =
        turned ? plan->tabulated : raster_is_possible(both[i]) && triangles_of(both[i]) > MOST_TRIANGLES;
    plan->cell[i] = covered && !is_grid(both[i]) ? cell : 0.0;
  }
}

/* Below what a table takes: its solid reaches at least as far along an axis as its radius over the root of 3. */
static double least_table_bytes(const gap_plan *plan, const cprox_solid *a, const cprox_solid *b) {
  if (!plan->tabulated) return 0.0;
  const double radius = plan->turned_first ? a->radius : b->radius;
  const double nodes = 3.0 * plan->N * radius / (1.05 * solids_size(a, b));
  return 4.0 * nodes * nodes * nodes * sizeof(wave);
}

void gap_forms_free(const cprox_solid *a, const cprox_solid *b, const cprox_solid *form[2]) {
  if (form[0] != a) cprox_solid_free((cprox_solid *)form[0]);
  if (form[1] != b) cprox_solid_free((cprox_solid *)form[1]);
}

cprox_status gap_forms(const gap_plan *plan, const cprox_solid *a, const cprox_solid *b, cprox_workspace *workspace,
                       const cprox_solid *form[2]) {
  form[0] = a, form[1] = b;
  for (int i = 0; i < 2; i++) {
    if (plan->cell[i] == 0.0) continue;
    const cprox_solid *cover = raster_cover(form[i], plan->cell[i], workspace);
    if (!cover) {
      gap_forms_free(a, b, form);
      if (cprox_workspace_wants_stop(workspace)) return fourier_stopped(workspace);
      return fourier_fail(workspace, CPROX_MEMORY, "no memory for the cells of n = %d", 2 * plan->N + 1);
    }
    form[i] = cover;
  }
  return CPROX_OK;
}

static cprox_status plan_for(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N,
                             cprox_workspace *workspace, gap_plan *plan) {
  *plan = (gap_plan){.mode = options->mode,
                     .dimension = a->dimension,
                     .N = N,
                     .beta = kernel_beta(a->dimension, 2 * N + 1),
                     .period = options->period};
  choose_forms(a, b, plan);
  const double least = least_table_bytes(plan, a, b);
  if (least > (double)options->memory_limit)
    return fourier_fail(workspace, CPROX_INVALID, "n = %d samples need %.3g bytes, beyond the limit of %zu", 2 * N + 1,
                        least, options->memory_limit);
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
  return plan->mode == CPROX_GAP_MODE_SIGNAL ? GAP_SIGNAL_BLUR * plan->period / (2 * plan->N + 1) : plan->over_reach;
}

/* What no period can bring the accuracy of 2N+1 samples below: the period is at least the solids' size, and both
 * offsets are part of a proven over-reach. */
static double best_accuracy(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options, int N) {
  const int n = 2 * N + 1;
  const double factor = options->mode == CPROX_GAP_MODE_SIGNAL  ? GAP_SIGNAL_BLUR
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
