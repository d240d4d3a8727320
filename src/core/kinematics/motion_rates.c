/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/motion_rates.h"

#include <math.h>

#include "base/rounding.h"

/* The coefficients of the first or second derivative by time of a variable over a segment; returns their degree. A
 * constant has the one coefficient 0. */
static size_t derivative(const motion_track *t, size_t slot, size_t segment, int order,
                         double d[MOTION_MAX_DEGREE + 1]) {
  size_t degree = t->degree[segment];
  const double *c = t->coefficients + (segment * t->n_moving + slot) * t->stride;
  const double duration = t->times[segment + 1] - t->times[segment];
  for (size_t i = 0; i <= degree; i++) d[i] = c[i];
  for (int k = 0; k < order; k++) {
    if (degree == 0) d[0] = d[1] = 0.0;
    if (degree == 0) return 0;
    for (size_t i = 0; i < degree; i++) d[i] = (double)degree * (d[i + 1] - d[i]) / duration;
    degree--;
  }
  return degree;
}

/* What rounding, and that of the coefficients, adds to such a derivative. */
static double derivative_error(const motion_track *t, size_t slot, size_t segment, int order) {
  const double duration = t->times[segment + 1] - t->times[segment], n = t->degree[segment];
  const double grows = order == 1 ? 2.0 * n / duration : 4.0 * n * n / (duration * duration);
  return ROUND_UP * 2.0 * t->error[segment * t->n_moving + slot] * grows;
}

/* The coefficients over [a, b] of [0, 1], by two cuts. */
static void cut(double *c, size_t degree, double a, double b) {
  for (size_t r = 1; r <= degree && a > 0.0; r++)
    for (size_t i = 0; i + r <= degree; i++) c[i] = (1.0 - a) * c[i] + a * c[i + 1];
  const double v = a < 1.0 ? (b - a) / (1.0 - a) : 1.0;
  for (size_t r = 1; r <= degree && v < 1.0; r++)
    for (size_t i = degree; i >= r; i--) c[i] = (1.0 - v) * c[i - 1] + v * c[i];
}

void motion_rates_at(const cprox_motion *m, int32_t variable, size_t segment, double u, double rates[2]) {
  const motion_track *t = &m->tracks[0];
  for (int k = 0; k < 2; k++) {
    double d[MOTION_MAX_DEGREE + 1];
    const size_t degree = derivative(t, (size_t)m->slot[variable], segment, k + 1, d);
    rates[k] = fabs(bernstein_at(d, degree, u));
  }
}

void motion_rates_over(const cprox_motion *m, int32_t variable, const motion_interval *over, double rates[2]) {
  const motion_track *t = &m->tracks[0];
  const size_t slot = (size_t)m->slot[variable];
  rates[0] = rates[1] = 0.0;
  for (size_t segment = over->first; segment < over->last; segment++) {
    for (int k = 0; k < 2; k++) {
      double d[MOTION_MAX_DEGREE + 1], most = 0.0;
      const size_t degree = derivative(t, slot, segment, k + 1, d);
      if (!motion_is_span(over)) cut(d, degree, over->a, over->b);
      for (size_t i = 0; i <= degree; i++) most = greater(fabs(d[i]), most);
      rates[k] = greater(ROUND_UP * most + derivative_error(t, slot, segment, k + 1), rates[k]);
    }
  }
}
