/* SPDX-License-Identifier: BSD-3-Clause */
/* The signal of solids that touch, from both sides (doc/fourier.md, "The signal at touching"). */
#include <math.h>

#include "fourier/gap.h"

#define TAU 6.28318530717958647693

/* The kernel differs from the periodic Gaussian by less than this over L^d: the waves beyond the lattice. */
static double waves_left_out(const kernel *k, int dimension, double s) {
  double kept = 1.0, left = 0.0;
  for (int i = 1; i <= k->n; i++) kept += 2.0 * k->w[i];
  /* each further term is less than a hundredth of the one before */
  for (int i = k->n + 1; i <= k->n + 8; i++) left += 2.0 * exp(-0.5 * s * s * i * i);
  left *= 1.01;
  return pow(kept + left, dimension) - pow(kept, dimension) + 1e-14;
}

/* P(|v| > r) of a Gaussian of unit variance along each axis. */
static double share_outside(int dimension, double r) {
  const double fall = exp(-0.5 * r * r);
  return dimension == 2 ? fall : erfc(r * sqrt(0.5)) + sqrt(2.0 / (0.5 * TAU)) * r * fall;
}

/* E min(most, slope |v|), from above: the share outside falls, so that the left ends of steps bound its integral. */
static double most_overlap(int dimension, double most, double slope, double sigma) {
  enum { STEPS = 512 };
  const double span = fmin(most / (slope * sigma), 10.0), step = span / STEPS;
  double sum = 0.0;
  for (int i = 0; i < STEPS; i++) sum += step * share_outside(dimension, step * i);
  return fmin(most, slope * sigma * (sum + 1e-20));
}

/* The mean of a solid's function taken as a density, and at least the mean square of the way from there. */
typedef struct spread {
  vec3 mean;
  double square;
} spread;

static spread find_spread(const cprox_solid *s) {
  wave_jet jet;
  solid_spectrum(s, vec(0, 0, 0), true, &jet);
  const double measure = jet.value.re;
  const vec3 mean = vec_scale(-1.0 / measure, jet.im);
  /* 1 - cos u >= u²/2 (1 - u²/12) for what the axis sees of each point */
  const double radius = s->radius + vec_norm(vec_sub(mean, s->centre)), q = 0.05 / radius;
  double square = 0.0;
  for (int j = 0; j < s->dimension; j++) {
    const vec3 ray = vec(j == 0 ? q : 0.0, j == 1 ? q : 0.0, j == 2 ? q : 0.0);
    solid_spectrum(s, ray, false, &jet);
    const double phase = vec_dot(ray, mean);
    const double seen = (jet.value.re * cos(phase) - jet.value.im * sin(phase)) / measure;
    square += (2.0 * (1.0 - seen) + 1e-12) / (q * q * (1.0 - 0.0025 / 12.0));
  }
  return (spread){mean, square};
}

static double slope_of(const cprox_solid *s) {
  double sum = 0.0;
  for (size_t i = 0; i < s->n; i++) sum += piece_slope(&s->pieces[i], s->dimension);
  return sum;
}

/* The least V where solids meet: the mean of the Gaussian over both is at least the Gaussian at the mean square of the
 * distance between their points (Jensen). Their centres are at most both radii apart. */
static double least_at_touching(const cprox_solid *a, const cprox_solid *b, double sigma) {
  const spread p = find_spread(a), q = find_spread(b);
  const double apart =
      a->radius + vec_norm(vec_sub(p.mean, a->centre)) + b->radius + vec_norm(vec_sub(q.mean, b->centre));
  const double square = apart * apart + p.square + q.square;
  const double measures = cprox_solid_get_info(a).measure * cprox_solid_get_info(b).measure;
  return measures * pow(TAU * sigma * sigma, -0.5 * a->dimension) * exp(-0.5 * square / (sigma * sigma));
}

/* The most V where interiors do not overlap: moved by v from there, they overlap by at most what v uncovers. */
static double most_at_touching(const cprox_solid *a, const cprox_solid *b, double sigma, bool *ok) {
  solid_bounds p, q;
  *ok = solid_find_bounds(a, &p) && solid_find_bounds(b, &q);
  if (!*ok) return INFINITY;
  const double most = fmin(cprox_solid_get_info(a).measure * q.peak, cprox_solid_get_info(b).measure * p.peak);
  const double slope = fmin(slope_of(a) * q.peak, slope_of(b) * p.peak);
  return isfinite(most) && isfinite(slope) ? most_overlap(a->dimension, most, slope, sigma) : INFINITY;
}

bool gap_bound_touching(const gap_plan *plan, const kernel *k, const cprox_solid *a, const cprox_solid *b,
                        cprox_gap_info *info) {
  const double L = plan->period, sigma = GAP_SIGNAL_BLUR * L / info->samples, s = TAU * sigma / L;
  const double mean = info->threshold, left = waves_left_out(k, plan->dimension, s) + 2.0 * info->rounding;
  const bool bare = !plan->tabulated && !(plan->cell[0] > 0.0) && !(plan->cell[1] > 0.0);
  const double least = least_at_touching(a, b, sigma) / mean * (1.0 - 1e-9) - left;
  bool ok = true;
  const double most = bare ? most_at_touching(a, b, sigma, &ok) / mean * (1.0 + 1e-9) + left : INFINITY;
  info->touching_most = least > 0.0 ? -log(least) : INFINITY;
  info->touching_least = -log(most);
  return ok;
}
