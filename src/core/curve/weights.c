/* SPDX-License-Identifier: BSD-3-Clause */
/* The weights of a curve's coefficients at one parameter, a function a basis. */
#include <math.h>

#include "curve/curve.h"

/* De Casteljau on the weights: degree by degree, each weight passes on to its two successors. */
void curve_weights_bezier(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_points = d->n;
  const double t0 = d->t0, t1 = d->t1;
  const double after = (t - t0) / (t1 - t0), before = (t1 - t) / (t1 - t0);
  weights[0] = 1.0;
  for (size_t n = 1; n < n_points; n++) {
    weights[n] = after * weights[n - 1];
    for (size_t i = n - 1; i > 0; i--) weights[i] = before * weights[i] + after * weights[i - 1];
    weights[0] *= before;
  }
}

/* Cox and de Boor's recurrence on the degree + 1 functions that live at t. */
void curve_weights_bspline(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_points = d->n, degree = d->degree;
  const double *knots = d->knots;
  /* the span that t belongs to: the last one that begins at or before it and has a length */
  size_t span = degree;
  for (size_t i = degree; i < n_points; i++)
    if (knots[i] <= t && knots[i] < knots[i + 1]) span = i;
  for (size_t i = 0; i < n_points; i++) weights[i] = 0.0;
  double *w = weights + (span - degree);
  w[0] = 1.0;
  for (size_t p = 1; p <= degree; p++) {
    double passed = 0.0;
    for (size_t i = 0; i < p; i++) {
      const double left = knots[span + 1 + i - p], right = knots[span + 1 + i], length = right - left;
      const double share = length > 0.0 ? w[i] / length : 0.0;
      w[i] = passed + (right - t) * share;
      passed = (t - left) * share;
    }
    w[p] = passed;
  }
}

void curve_weights_polynomial(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_coefficients = d->n;
  for (size_t i = 0; i < n_coefficients; i++) weights[i] = i == 0 ? 1.0 : t * weights[i - 1];
}

/* (k + 1) P_(k+1) = (2k + 1) x P_k - k P_(k-1) */
void curve_weights_legendre(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_coefficients = d->n;
  const double t0 = d->t0, t1 = d->t1;
  const double x = ((t - t0) - (t1 - t)) / (t1 - t0);
  for (size_t i = 0; i < n_coefficients; i++) {
    const double k = (double)i - 1.0;
    weights[i] = i == 0 ? 1.0 : i == 1 ? x : ((2.0 * k + 1.0) * x * weights[i - 1] - k * weights[i - 2]) / (k + 1.0);
  }
}

void curve_weights_lagrange(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_points = d->n;
  const double *nodes = d->knots;
  for (size_t i = 0; i < n_points; i++) {
    weights[i] = 1.0;
    for (size_t k = 0; k < n_points; k++)
      if (k != i) weights[i] *= (t - nodes[k]) / (nodes[i] - nodes[k]);
  }
}

/* 1, cos t, sin t, cos 2t, … */
void curve_weights_trigonometric(const cprox_curve_description *d, double t, double *weights) {
  const size_t n_coefficients = d->n;
  for (size_t i = 0; i < n_coefficients; i++) {
    const size_t multiple = (i + 1) / 2;
    const double angle = (double)multiple * t;
    weights[i] = i % 2 ? cos(angle) : sin(angle);
  }
  weights[0] = 1.0;
}

/* w_i B_i / sum w_k B_k */
static void weigh_rational(const cprox_curve_description *d, double *weights) {
  double sum = 0.0;
  for (size_t i = 0; i < d->n; i++) {
    weights[i] *= d->weights[i];
    sum += weights[i];
  }
  for (size_t i = 0; i < d->n; i++) weights[i] /= sum;
}

void curve_weights_rational_bezier(const cprox_curve_description *d, double t, double *weights) {
  curve_weights_bezier(d, t, weights);
  weigh_rational(d, weights);
}

void curve_weights_nurbs(const cprox_curve_description *d, double t, double *weights) {
  curve_weights_bspline(d, t, weights);
  weigh_rational(d, weights);
}
