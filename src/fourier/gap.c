/* SPDX-License-Identifier: BSD-3-Clause */
/* Making a pair ready: coefficients on the half lattice, in blocks, the largest first. */
#include "fourier/gap.h"

#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "fourier/grid.h"
#include "fourier/raster.h"

#define TAU 6.28318530717958647693

double gap_bytes(int dimension, int N) {
  const double rows = dimension == 2 ? N + 1.0 : (2.0 * N + 1.0) * (N + 1.0);
  const int blocks_of_row = (2 * N + 1 + LANES - 1) / LANES;
  return rows * blocks_of_row * (double)(sizeof(block) + (2 * LANES + 1) * sizeof(double)) + (double)sizeof(cprox_gap);
}

double gap_cost_of_turning(const cprox_solid *s) {
  if (s->n == 1 && s->pieces[0].kind == PIECE_ELLIPSOID) {
    const double *a = s->pieces[0].size;
    if (a[0] == a[1] && (s->dimension == 2 || a[1] == a[2])) return 0.0;
  }
  double cost = 0.0;
  for (size_t i = 0; i < s->n; i++) {
    const piece *p = &s->pieces[i];
    switch (p->kind) {
      case PIECE_ELLIPSOID: cost += s->dimension == 2 ? 20.0 : 3.0; break;
      case PIECE_BOX: cost += 2.0; break;
      case PIECE_POLYGON: cost += (double)p->n_corners; break;
      case PIECE_CYLINDER: cost += 30.0; break;
      case PIECE_CAPSULE: cost += 500.0; break;
      case PIECE_SWEEP: cost += 1e3 + 5.0 * (double)p->n_corners; break;
      case PIECE_SOUP: cost += 1e3 + 60.0 * (double)p->n_corners; break;
      case PIECE_GRID: cost += 1e6 + 10.0 * (double)p->counts[0] * p->counts[1] * p->counts[2]; break;
    }
  }
  return cost;
}

/* A block before sorting. */
typedef struct draft {
  block at;
  double energy; /* sum of |C|² */
  double c[2 * LANES];
} draft;

static int by_energy(const void *a, const void *b) {
  const draft *p = a, *q = b;
  if (p->energy != q->energy) return p->energy > q->energy ? -1 : 1;
  for (int j = 2; j >= 0; j--)
    if (p->at.k[j] != q->at.k[j]) return p->at.k[j] < q->at.k[j] ? -1 : 1;
  return 0;
}

/* J: k_z > 0, or k_z = 0 and k_y > 0, or both 0 and k_x > 0. Rows of it, in blocks; returns how many, writes where out
 * is given. */
static size_t list_blocks(const kernel *w, int dimension, draft *out) {
  const int N = w->n, top = dimension == 2 ? 0 : N;
  size_t n = 0;
  for (int z = 0; z <= top; z++)
    for (int y = z == 0 ? 0 : -N; y <= N; y++) {
      int end = N;
      while (end >= 0 && kernel_weight(w, (const int[3]){end, y, z}) == 0.0) end--;
      for (int x = z == 0 && y == 0 ? 1 : -end; x <= end; x += LANES, n++)
        if (out) out[n] = (draft){.at = {{x, y, z}}};
    }
  return n;
}

static vec3 frequency(const cprox_gap *gap, const block *b, int lane) {
  const double step = TAU / gap->info.period;
  return vec(step * (b->k[0] + lane), step * b->k[1], step * b->k[2]);
}

/* What coefficients are made of: W, S, T where it is a ball; S as a table where it is an aligned grid. */
typedef struct sources {
  const kernel *w;
  const cprox_solid *fixed, *ball;
  grid_table grid;
} sources;

/* Coefficients of a block: W S(q), times T(q) of a turned ball. */
static void fill_block(const cprox_gap *gap, const sources *from, draft *d) {
  const block *b = &d->at;
  for (int lane = 0; lane < LANES; lane++) {
    const double weight = kernel_weight(from->w, (const int[3]){b->k[0] + lane, b->k[1], b->k[2]});
    wave_jet s = {0}, t = {0};
    if (weight != 0.0) {
      const vec3 q = frequency(gap, b, lane);
      if (from->grid.value)
        s.value = grid_at(&from->grid, b->k[0] + lane, b->k[1], b->k[2], gap->info.dimension);
      else
        solid_spectrum(from->fixed, q, false, &s);
      if (from->ball) {
        solid_spectrum(from->ball, q, false, &t);
        s.value = wave_times(s.value, (wave){t.value.re, -t.value.im});
      }
    }
    const double re = weight * s.value.re, im = weight * s.value.im;
    d->c[lane] = re, d->c[LANES + lane] = im;
    d->energy += re * re + im * im;
  }
}

/* The bound on the rounding of a value: every term is a product of spectra and phases, each within a few (N + 10) u of
 * its error scale, and sums run over blocks of a chunk and then over chunks (doc/fourier.md, "Rounding"). */
static double rounding_bound(const cprox_gap *gap, const kernel *w, const cprox_solid *fixed, const cprox_solid *turned,
                             double corners) {
  const int N = gap->N;
  const double step = TAU / gap->info.period;
  double sum = gap->constant;
  /* by shells of |k|_inf: scales fall with |q|, so that each shell is bounded at its least |q| */
  for (int m = 1; m <= N; m++) {
    const double count = gap->info.dimension == 2 ? 8.0 * m : 24.0 * m * m + 2.0;
    const double weight = w->in_ball ? 1.0 : w->w[m];
    const double scale = gap->table ? gap->table->bounds.mass : solid_error_scale(turned, step * m);
    sum += count * weight * solid_error_scale(fixed, step * m) * scale;
  }
  return ROUND_U * (16.0 * N + 200.0 + corners + (double)gap->n_blocks / 16.0) * sum * gap->inverse;
}

static size_t corners_of(const cprox_solid *s) {
  size_t n = s->n;
  for (size_t i = 0; i < s->n; i++) n += s->pieces[i].n_corners;
  return n;
}

/* The largest blocks first, each followed by what all later ones can still add. */
static void order(cprox_gap *gap, draft *drafts) {
  qsort(drafts, gap->n_blocks, sizeof *drafts, by_energy);
  double left = 0.0;
  gap->tail[gap->n_blocks] = 0.0;
  for (size_t i = gap->n_blocks; i > 0; i--) {
    const draft *d = &drafts[i - 1];
    gap->blocks[i - 1] = d->at;
    for (int j = 0; j < 2 * LANES; j++) gap->c[2 * LANES * (i - 1) + (size_t)j] = d->c[j];
    left += d->energy;
    gap->tail[i - 1] = 2.0 * sqrt(left) * (1.0 + 1e-12);
  }
}

/* Bounds of the derivatives by the position: sum over J of |C| |q|^m |T|, by Cauchy-Schwarz from T's energy or from its
 * measure, whichever is less; T = 1 where it is folded into C. */
static void bound_derivatives(cprox_gap *gap, bool folded, double measure) {
  double square[2] = {0, 0}, plain[2] = {0, 0};
  for (size_t i = 0; i < gap->n_blocks; i++)
    for (int lane = 0; lane < LANES; lane++) {
      const double *c = gap->c + 2 * LANES * i + lane, c2 = c[0] * c[0] + c[LANES] * c[LANES];
      const double q2 = vec_norm2(frequency(gap, &gap->blocks[i], lane));
      square[0] += c2 * q2, square[1] += c2 * q2 * q2;
      plain[0] += sqrt(c2 * q2), plain[1] += sqrt(c2) * q2;
    }
  double bound[2];
  for (int m = 0; m < 2; m++)
    bound[m] = folded ? plain[m] : fmin(sqrt(square[m]) * sqrt(gap->half_energy), plain[m] * measure);
  gap->steepness = 2.0 * gap->inverse * bound[0] * (1.0 + 1e-9);
  gap->curvature = 2.0 * gap->inverse * bound[1] * (1.0 + 1e-9);
  for (int m = 0; m < 2; m++)
    gap->stirring[m] = 2.0 * gap->inverse * plain[m] * (folded ? 1.0 : measure) * (1.0 + 1e-9);
}

static size_t count_terms(const cprox_gap *gap) {
  size_t n = 0;
  for (size_t i = 0; i < gap->n_blocks; i++)
    for (int lane = 0; lane < LANES; lane++)
      n += gap->c[2 * LANES * i + (size_t)lane] != 0.0 || gap->c[2 * LANES * i + (size_t)(LANES + lane)] != 0.0;
  return n;
}

static bool is_centred_ball(const cprox_solid *s) {
  return gap_cost_of_turning(s) == 0.0 && vec_norm(s->pieces[0].centre) == 0.0;
}

static bool allocate(cprox_gap *gap) {
  gap->blocks = malloc(gap->n_blocks * sizeof *gap->blocks);
  gap->c = malloc(gap->n_blocks * 2 * LANES * sizeof *gap->c);
  gap->tail = malloc((gap->n_blocks + 1) * sizeof *gap->tail);
  return gap->blocks && gap->c && gap->tail;
}

/* All coefficients; false where memory is out, or the stop function wanted an end. */
static bool fill_blocks(const cprox_gap *gap, const kernel *w, const cprox_solid *fixed, const cprox_solid *ball,
                        cprox_workspace *workspace, draft *drafts) {
  sources from = {.w = w, .fixed = fixed, .ball = ball};
  if (fixed->n == 1 && grid_is_aligned(&fixed->pieces[0]) &&
      !grid_transform(&fixed->pieces[0], gap->info.dimension, gap->N, TAU / gap->info.period, workspace, &from.grid))
    return false;
  list_blocks(w, gap->info.dimension, drafts);
  enum { BLOCKS_BETWEEN_LOOKS = 8 };
  bool stopped = false;
  for (size_t i = 0; i < gap->n_blocks && !stopped; i++) {
    stopped = i % BLOCKS_BETWEEN_LOOKS == 0 && cprox_workspace_wants_stop(workspace);
    if (!stopped) fill_block(gap, &from, &drafts[i]);
  }
  free(from.grid.value);
  return !stopped;
}

double gap_farthest_frequency(int N, double period) {
  return sqrt(3.0) * (1.0 + 1e-9) * TAU * N / period;
}

/* T(0), which a table has as it has every other value. */
static double measure_of_turned(const cprox_gap *gap, double measure) {
  if (!gap->table) return measure;
  wave_jet jet;
  lookup_at(gap->table, vec(0, 0, 0), false, &jet);
  return jet.value.re;
}

double gap_images(const table_bounds *table, double peak, double measure) {
  return fmin(isfinite(peak) ? table->image_mass * peak : INFINITY, table->image_peak * measure);
}

/* Bounds of the turned solid's function, or of what its table stands for. */
static bool find_bounds(cprox_gap *gap, const cprox_solid *fixed, const cprox_solid *turned, double *energy,
                        double *measure) {
  solid_bounds bounds;
  if (!gap->table) {
    if (!solid_find_bounds(turned, &bounds)) return false;
    *energy = bounds.energy;
    *measure = cprox_solid_get_info(turned).measure;
    return true;
  }
  const table_bounds *t = &gap->table->bounds;
  if (!solid_find_bounds(fixed, &bounds)) return false;
  *energy = t->energy;
  *measure = t->mass;
  gap->images = gap_images(t, bounds.peak, cprox_solid_get_info(fixed).measure) * gap->inverse *
                pow(gap->info.period, gap->info.dimension);
  return true;
}

/* Everything that depends on the spectra. */
static bool fill(cprox_gap *gap, const kernel *w, const cprox_solid *fixed, cprox_solid *turned, bool tabulated,
                 cprox_workspace *workspace) {
  const int dimension = gap->info.dimension;
  gap->n_blocks = list_blocks(w, dimension, NULL);
  /* three samples are the fewest, so that there is a block */
  draft *drafts = gap->n_blocks > 0 ? calloc(gap->n_blocks, sizeof *drafts) : NULL;
  const bool folded = is_centred_ball(turned);
  bool failed = !drafts || !allocate(gap) || !fill_blocks(gap, w, fixed, folded ? turned : NULL, workspace, drafts);
  if (!failed && tabulated) {
    gap->table = lookup_create(turned->pieces, gap_farthest_frequency(gap->N, gap->info.period), workspace);
    failed = !gap->table;
  }
  double energy = INFINITY, measure = cprox_solid_get_info(turned).measure;
  failed = failed || (!folded && !find_bounds(gap, fixed, turned, &energy, &measure));
  if (!failed) {
    order(gap, drafts);
    const double L = gap->info.period;
    gap->constant = cprox_solid_get_info(fixed).measure * measure_of_turned(gap, measure);
    const double volume = dimension == 2 ? L * L : L * L * L;
    /* folded: T is 1 at each term, so that what is left of its energy is the number of lattice points left: of no use
     */
    const double mean = measure_of_turned(gap, measure);
    gap->half_energy = 0.5 * fmax(0.0, volume * energy - mean * mean);
    bound_derivatives(gap, folded, measure);
    gap->turned_reach = folded ? 0.0 : turned->radius + vec_norm(turned->centre);
    gap->info.rounding = rounding_bound(gap, w, fixed, turned, (double)(corners_of(fixed) + corners_of(turned)));
    gap->turned = folded || gap->table ? NULL : turned;
    if (!gap->turned) cprox_solid_free(turned);
  } else {
    cprox_solid_free(turned);
  }
  free(drafts);
  return !failed;
}

static double slope_length(const gap_plan *plan) {
  const double sample = plan->period / (2 * plan->N + 1);
  return plan->mode == CPROX_GAP_MODE_SIGNAL ? sample * GAP_SIGNAL_BLUR / 1.6 : 0.55 * sample;
}

cprox_status gap_build(const gap_plan *plan, cprox_solid *a, cprox_solid *b, size_t memory_limit,
                       cprox_workspace *workspace, cprox_gap **gap) {
  const double bytes = gap_bytes(plan->dimension, plan->N) + plan->bytes, L = plan->period;
  cprox_gap *made = bytes <= (double)memory_limit ? calloc(1, sizeof *made) : NULL;
  if (!made) {
    cprox_solid_free(a);
    cprox_solid_free(b);
    if (bytes <= (double)memory_limit) return fourier_fail(workspace, CPROX_MEMORY, "no memory for a gap");
    return fourier_fail(workspace, CPROX_INVALID, "n = %d samples need %.3g bytes, beyond the limit of %zu",
                        2 * plan->N + 1, bytes, memory_limit);
  }
  kernel w;
  if (plan->mode == CPROX_GAP_MODE_CERTIFIED)
    kernel_certified(&w, plan->N, plan->beta);
  else if (plan->mode == CPROX_GAP_MODE_TUNED)
    kernel_tuned(&w, plan->N);
  else
    kernel_signal(&w, plan->N);

  made->N = plan->N;
  made->info = (cprox_gap_info){.mode = plan->mode,
                                .dimension = plan->dimension,
                                .samples = 2 * (uint32_t)plan->N + 1,
                                .period = L,
                                .offset = plan->offset,
                                .over_reach = plan->mode == CPROX_GAP_MODE_SIGNAL ? INFINITY : plan->over_reach,
                                .guaranteed = plan->mode == CPROX_GAP_MODE_CERTIFIED,
                                .turned_first = plan->turned_first};
  /* -log(value) falls by about 1 in so many metres where it decides (doc/fourier.md, "The value in metres") */
  made->info.length = slope_length(plan);
  /* the signal's V_ref is its mean over all places */
  const double volume = plan->dimension == 2 ? L * L : L * L * L;
  made->info.threshold = plan->mode == CPROX_GAP_MODE_SIGNAL
                             ? cprox_solid_get_info(a).measure * cprox_solid_get_info(b).measure / volume
                             : gap_threshold(&w, plan, a, b);
  made->inverse = 1.0 / (made->info.threshold * volume);
  cprox_solid *turned = made->info.turned_first ? a : b, *fixed = made->info.turned_first ? b : a;
  const bool ok = fill(made, &w, fixed, turned, plan->tabulated, workspace);
  cprox_solid_free(fixed);
  if (!ok) {
    cprox_gap_free(made);
    if (cprox_workspace_wants_stop(workspace)) return fourier_stopped(workspace);
    return fourier_fail(workspace, CPROX_MEMORY, "no memory for a gap of n = %d", 2 * plan->N + 1);
  }
  made->simd = simd_of_machine();
  made->info.terms = count_terms(made);
  made->info.bytes = sizeof *made + made->n_blocks * (sizeof *made->blocks + (2 * LANES + 1) * sizeof *made->c);
  if (made->table) made->info.bytes += lookup_bytes(made->table);
  *gap = made;
  return CPROX_OK;
}

cprox_status cprox_gap_create(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                              cprox_workspace *workspace, cprox_gap **gap) {
  WORKSPACE_USE(workspace);
  fourier_clear(workspace);
  if (!a || !b || !gap) return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", !a ? "a" : !b ? "b" : "gap");
  const cprox_gap_options used = gap_options(options);
  gap_plan plan;
  cprox_status status = gap_plan_choose(a, b, &used, workspace, &plan);
  if (status != CPROX_OK) return status;

  double reach;
  const cprox_solid *form[2];
  status = gap_forms(&plan, a, b, workspace, form);
  if (status != CPROX_OK) return status;
  cprox_solid *p = solid_offset(form[0], plan.offset, &reach), *q = solid_offset(form[1], plan.offset, &reach);
  gap_forms_free(a, b, form);
  if (!p || !q) {
    cprox_solid_free(p);
    cprox_solid_free(q);
    return solid_out_of_memory(workspace);
  }
  cprox_gap *made = NULL;
  status = gap_build(&plan, p, q, used.memory_limit, workspace, &made);
  if (!made) return status;
  if (plan.mode == CPROX_GAP_MODE_SIGNAL) {
    kernel w;
    kernel_signal(&w, plan.N);
    if (!gap_bound_touching(&plan, &w, a, b, &made->info)) {
      cprox_gap_free(made);
      return solid_out_of_memory(workspace);
    }
  }
  made->centre_a = a->centre, made->centre_b = b->centre;
  made->radius_a = a->radius, made->radius_b = b->radius;
  const bool merged =
      a->n > ENCLOSURES_MOST_PAIRS || b->n > ENCLOSURES_MOST_PAIRS || a->n * b->n > ENCLOSURES_MOST_PAIRS;
  if (!enclosures_make(a, merged, &made->bounds_a) || !enclosures_make(b, merged, &made->bounds_b)) {
    cprox_gap_free(made);
    return solid_out_of_memory(workspace);
  }
  made->info.bytes += (made->bounds_a.n + made->bounds_b.n) * ENCLOSURE_TABLE * sizeof(double);
  *gap = made;
  return CPROX_OK;
}

void cprox_gap_free(cprox_gap *gap) {
  if (!gap) return;
  cprox_solid_free(gap->turned);
  lookup_free(gap->table);
  enclosures_free(&gap->bounds_a);
  enclosures_free(&gap->bounds_b);
  free(gap->blocks);
  free(gap->c);
  free(gap->tail);
  free(gap);
}

cprox_gap_info cprox_gap_get_info(const cprox_gap *gap) {
  return gap->info;
}
