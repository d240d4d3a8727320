/* SPDX-License-Identifier: BSD-3-Clause */
/* The Bernstein coefficients of some variables of a track, one variable a lane. */
#ifndef CPROX_KINEMATICS_LANES_H
#define CPROX_KINEMATICS_LANES_H

#include "kinematics/motion.h"

typedef double lane_row[MOTION_LANES];

/* Those of a polynomial: as many rows. */
enum { LANE_ROWS = MOTION_MAX_DEGREE + 1 };

/* In whole lanes. */
static inline size_t lanes_padded(size_t n) {
  return (n + MOTION_LANES - 1) / MOTION_LANES * MOTION_LANES;
}

/* Of a segment, from variable `first` on; the last one fills the lanes that are left. Their errors, if not NULL. */
static inline void lanes_load(const motion_track *t, size_t segment, size_t first, lane_row *c, double *error) {
  const size_t degree = t->degree[segment], stride = t->stride, n = t->n_moving;
  const double *coefficients = t->coefficients + segment * n * stride, *errors = t->error + segment * n;
  for (size_t l = 0; l < MOTION_LANES; l++) {
    const size_t k = first + l < n ? first + l : n - 1;
    for (size_t i = 0; i <= degree; i++) c[i][l] = coefficients[k * stride + i];
    if (error) error[l] = errors[k];
  }
}

/* c = r c + s d in every lane. */
static inline void lanes_blend(double r, double s, const double *d, double *c) {
#pragma omp simd
  for (int l = 0; l < MOTION_LANES; l++) c[l] = r * c[l] + s * d[l];
}

/* The coefficients of [a, b], by two cuts. Both cuts of neighbours need not be the same point to the last bit: the
 * error of a segment covers that (doc/robot-motion-bounds.md). */
static inline void lanes_cut(size_t degree, double a, double b, lane_row *c) {
  if (a > 0.0)
    for (size_t r = 1; r <= degree; r++)
      for (size_t i = 0; i + r <= degree; i++) lanes_blend(1.0 - a, a, c[i + 1], c[i]);
  if (b >= 1.0) return;
  const double s = (b - a) / (1.0 - a);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = degree; i >= r; i--) lanes_blend(s, 1.0 - s, c[i - 1], c[i]);
}

#endif
