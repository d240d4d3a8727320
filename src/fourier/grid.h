/* SPDX-License-Identifier: BSD-3-Clause */
/* The spectrum of a grid of cells on the whole lattice at once, axis by axis. */
#ifndef CPROX_FOURIER_GRID_H
#define CPROX_FOURIER_GRID_H

#include "fourier/piece.h"

/* F at q = step k, |k_j| <= N (k_z = 0 in the plane), of a grid whose axes are those of the lattice. */
typedef struct grid_table {
  int N;
  wave *value; /* k_x fastest */
} grid_table;

/* Whether the piece is such a grid. */
bool grid_is_aligned(const piece *p);

/* false where memory is out. Cost: cells (2N+1) for the first axis and less for the others, instead of runs (2N+1)^d.
 */
bool grid_transform(const piece *p, int dimension, int N, double step, grid_table *table);

static inline wave grid_at(const grid_table *t, int x, int y, int z, int dimension) {
  const int w = 2 * t->N + 1;
  return t->value[(size_t)(((dimension == 2 ? 0 : z + t->N) * w + y + t->N) * w + x + t->N)];
}

#endif
