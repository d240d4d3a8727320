/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/kernel.h"

#include <math.h>
#include <stdlib.h>

#include "fourier/piece.h"
#include "fourier/profile.h"

#define TAU 6.28318530717958647693

void kernel_certified(kernel *k, int N, double beta) {
  double window[KERNEL_MOST_N + 1];
  for (int i = 0; i <= N; i++) {
    const double x = N > 0 ? 2.0 * i / N - 1.0 : 0.0;
    window[i] = profile_i0(beta * sqrt(fmax(0.0, 1.0 - x * x)));
  }
  *k = (kernel){.n = N};
  for (int lag = 0; lag <= N; lag++)
    for (int i = 0; i + lag <= N; i++) k->w[lag] += window[i] * window[i + lag];
  for (int lag = N; lag >= 0; lag--) k->w[lag] /= k->w[0];
}

void kernel_tuned(kernel *k, int N) {
  *k = (kernel){.n = N, .in_ball = true};
  for (int i = 0; i <= N; i++) k->w[i] = 1.0;
}

/* exp(-sigma² |q|²/2), sigma = 2.2 L/n */
void kernel_signal(kernel *k, int N) {
  *k = (kernel){.n = N};
  const double s = 2.2 * TAU / (2 * N + 1);
  for (int i = 0; i <= N; i++) k->w[i] = exp(-0.5 * s * s * i * i);
}

double kernel_beta(int dimension, int samples) {
  return 2.0 + (dimension == 2 ? 0.7 : 1.07) * fmax(0.0, log2(samples / 9.0));
}

/* The tuned mode's falls in steps, the others' does not depend on n. */
double kernel_offset(int dimension, int samples, cprox_gap_mode mode) {
  if (mode == CPROX_GAP_MODE_SIGNAL) return 0.0;
  if (mode == CPROX_GAP_MODE_CERTIFIED) return dimension == 2 ? 0.75 : 1.05;
  if (dimension == 3 || samples >= 97) return 0.75;
  return samples < 13 ? 0.35 : samples < 49 ? 0.5 : 0.6;
}

/* The transform of the ball of radius rho at |q|. */
static double ball_spectrum(int dimension, double rho, double q) {
  return ball_measure(dimension, rho) * (dimension == 2 ? profile_disc(q * rho) : profile_ball(q * rho));
}

/* Over the octant k >= 0, each point as often as it has mirror images. The matrix sum of W b² q q^T is a multiple of 1,
 * because W and b² are symmetric in the axes: its trace over d bounds the bend. */
double kernel_threshold(const kernel *k, int dimension, double rho, double *bend) {
  const int top = dimension == 2 ? 0 : k->n;
  double sum = 0.0, second = 0.0;
  for (int c = 0; c <= top; c++)
    for (int b = 0; b <= k->n; b++)
      for (int a = 0; a <= k->n; a++) {
        const double weight = kernel_weight(k, (const int[3]){a, b, c});
        if (weight == 0.0) continue;
        const double q2 = TAU * TAU * (double)(a * a + b * b + c * c);
        const double spectrum = ball_spectrum(dimension, rho, sqrt(q2));
        const double term = (a ? 2.0 : 1.0) * (b ? 2.0 : 1.0) * (c ? 2.0 : 1.0) * weight * spectrum * spectrum;
        sum += term;
        second += term * q2 / dimension;
      }
  if (bend) *bend = second;
  return sum;
}

/* Of many samples a mass takes microseconds, and a disc milliseconds. */
enum { STEPS_BETWEEN_LOOKS = 64, DISCS_BETWEEN_LOOKS = 8 };

/* The integral of the one-dimensional kernel over [-x, x] at x = i/(2 M), i = 0 … M, rounded down by 1e-14. */
static bool list_masses(const kernel *k, int M, cprox_workspace *workspace, double *mass) {
  for (int i = 0; i <= M; i++) {
    if (i % STEPS_BETWEEN_LOOKS == 0 && cprox_workspace_wants_stop(workspace)) return false;
    /* sum of w_j sin(j a)/(pi j), by Clenshaw */
    const double a = TAU * i / (2.0 * M), twice = 2.0 * cos(a);
    double b1 = 0.0, b2 = 0.0;
    for (int j = k->n; j >= 1; j--) {
      const double b = 2.0 * k->w[j] / (0.5 * TAU * j) + twice * b1 - b2;
      b2 = b1, b1 = b;
    }
    mass[i] = fmax(0.0, (double)i / M + b1 * sin(a) - 1e-14);
  }
  return true;
}

/* A lower bound of the product kernel's integral over the ball of radius R/(2M): strips of the one axis, each over the
 * chord at its outer end of the other, whose integral `inner` lists. Both are non-decreasing, since the kernel is
 * nonnegative. */
static double disc_mass(const double *mass, const double *inner, int R) {
  double sum = 0.0;
  for (int i = 0; i < R; i++) {
    const double chord = sqrt((double)R * R - (double)(i + 1) * (i + 1));
    sum += (mass[i + 1] - mass[i]) * inner[(int)chord];
  }
  return sum;
}

/* The masses of discs of i * by / (2 M), i = 0 … n. */
static bool list_discs(const double *mass, const double *inner, int n, int by, cprox_workspace *workspace,
                       double *disc) {
  for (int i = 0; i <= n; i++) {
    if (i % DISCS_BETWEEN_LOOKS == 0 && cprox_workspace_wants_stop(workspace)) return false;
    disc[i] = disc_mass(mass, inner, by * i);
  }
  return true;
}

int kernel_steps(int N) {
  return 16 * (N + 1);
}

cprox_status kernel_list_outside(const kernel *k, int dimension, int steps, cprox_workspace *workspace,
                                 double *outside) {
  const int fine = dimension == 2 ? 8 : 4, M = fine * steps;
  double *mass = calloc(2 * ((size_t)M + 1), sizeof *mass);
  if (!mass) return CPROX_MEMORY;
  double *disc = mass + M + 1, *inner = dimension == 3 ? disc : mass;
  const bool made = list_masses(k, M, workspace, mass) &&
                    (dimension == 2 || list_discs(mass, mass, M, 1, workspace, disc)) &&
                    list_discs(mass, inner, steps, fine, workspace, outside);
  for (int i = 0; made && i <= steps; i++) outside[i] = fmax(0.0, 1.0 - outside[i]) + 1e-13;
  free(mass);
  return made ? CPROX_OK : CPROX_STOPPED;
}

/* V <= integral over |u| > x of K(u) min(most, slope (|u| - x)) = slope times the integral of outside(s) over s from x
 * to x + most/slope; outside() falls, so that the left ends of the steps bound it. */
double kernel_reach(const double *outside, int steps, double most, double slope, double t) {
  const double step = 0.5 / steps;
  const double span = fmin(ceil(most / slope / step), (double)steps);
  const int width = (int)span;
  double sum = 0.0;
  for (int j = steps; j > 0; j--) {
    /* sum over [j, j + width) of outside */
    sum += outside[j];
    if (j + width <= steps) sum -= outside[j + width];
    if (slope * step * sum >= t) return j == steps ? 0.5 : step * (j + 1);
  }
  return 0.0;
}
