/* SPDX-License-Identifier: BSD-3-Clause */
/* The spectrum of a grid of cells on the whole lattice at once, axis by axis. */
#ifndef CPROX_FOURIER_GRID_H
#define CPROX_FOURIER_GRID_H

#include "curve_proximity/cprox/base.h"
#include "fourier/piece.h"

/* Multiples of a step along an axis, and weights of the layers of cells across it; NULL: each is 1. */
typedef struct grid_range {
  int first, last;
  double step;
  const double *weight;
} grid_range;

/* F at q_j = step_j k_j of a grid whose axes are those of the lattice, k_x fastest: for the caller to free. NULL where
 * memory is out, or the stop function wants an end. Cost: cells times the multiples of the first axis, and less for the
 * others. */
wave *grid_spectrum(const piece *p, int dimension, const grid_range range[3], cprox_workspace *workspace);

/* F at q = step k, |k_j| <= N (k_z = 0 in the plane), of a grid whose axes are those of the lattice. */
typedef struct grid_table {
  int N;
  wave *value; /* k_x fastest */
} grid_table;

/* Whether the piece is such a grid. */
bool grid_is_aligned(const piece *p);

/* As grid_spectrum(); false where that is NULL. */
bool grid_transform(const piece *p, int dimension, int N, double step, cprox_workspace *workspace, grid_table *table);

static inline wave grid_at(const grid_table *t, int x, int y, int z, int dimension) {
  const int w = 2 * t->N + 1;
  return t->value[(size_t)(((dimension == 2 ? 0 : z + t->N) * w + y + t->N) * w + x + t->N)];
}

#endif
