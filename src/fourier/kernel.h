/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels by their weights on the lattice, their thresholds, and how far they reach. Everything here is in units of the
 * period: L = 1. */
#ifndef CPROX_FOURIER_KERNEL_H
#define CPROX_FOURIER_KERNEL_H

#include "curve_proximity/cprox_fourier.h"

enum { KERNEL_MOST_N = 512 };

typedef struct kernel {
  int n;        /* N: weights 0 … N */
  bool in_ball; /* weights are 1 for |k| <= N + 1/2, else 0; w is not used */
  double w[KERNEL_MOST_N + 1];
} kernel;

/* The kernel of a mode at 2N+1 samples. beta: Kaiser's, of the certified mode. */
void kernel_certified(kernel *k, int N, double beta);
void kernel_tuned(kernel *k, int N);
void kernel_signal(kernel *k, int N);

/* Kaiser's beta, and the offset rho n/L, that make the certified over-reach of bodies of ordinary proportions least,
 * within 3 % (a scan over both; doc/fourier.md, "Kernels"); the tuned mode's offsets. */
double kernel_beta(int dimension, int samples);
double kernel_offset(int dimension, int samples, cprox_gap_mode mode);

/* W at a lattice point. */
static inline double kernel_weight(const kernel *k, const int at[3]) {
  const int a = at[0] < 0 ? -at[0] : at[0], b = at[1] < 0 ? -at[1] : at[1], c = at[2] < 0 ? -at[2] : at[2];
  if (k->in_ball) return 4 * (a * a + b * b + c * c) <= (2 * k->n + 1) * (2 * k->n + 1) ? 1.0 : 0.0;
  return a <= k->n && b <= k->n && c <= k->n ? k->w[a] * k->w[b] * k->w[c] : 0.0;
}

/* t of two balls of radius rho at one place: the least value of a pair whose interiors overlap. bend: G(u) >= t - bend
 * |u|²/2 for two balls u apart (NULL if not needed). */
double kernel_threshold(const kernel *k, int dimension, double rho, double *bend);

/* Upper bounds of the part of a nonnegative kernel's integral outside the balls of radius i/(2 steps), i = 0 … steps.
 * kernel_steps() says how fine the table should be; false where memory is out. */
int kernel_steps(int N);
cprox_status kernel_list_outside(const kernel *k, int dimension, int steps, cprox_workspace *workspace,
                                 double *outside);

/* The least x of the table's radii such that V < t wherever the obstacle is farther away than x, where the overlap of
 * two bodies is at most `most` and grows by at most `slope` for each unit of depth; 0.5 where there is none below. */
double kernel_reach(const double *outside, int steps, double most, double slope, double t);

#endif
