/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/grid.h"

#include <stdlib.h>

#include "fourier/profile.h"

bool grid_is_aligned(const piece *p) {
  const double *t = p->turn;
  return p->kind == PIECE_GRID && t[0] == 1.0 && t[4] == 1.0 && t[8] == 1.0;
}

/* phases[k][i] = exp(-i q (origin + cell (i + 1/2))) cell sinc(q cell/2), q = step k: the transform of cell i along one
 * axis. */
static void fill_phases(double origin, double cell, uint32_t count, int N, double step, wave *phases) {
  for (int k = -N; k <= N; k++) {
    const double q = step * k, weight = cell * profile_sinc(0.5 * q * cell);
    for (uint32_t i = 0; i < count; i++) {
      const wave e = wave_back(q * (origin + cell * (i + 0.5)));
      *phases++ = (wave){weight * e.re, weight * e.im};
    }
  }
}

/* Sums over the middle of three indices: out[o][k][i] = sum over j of phases[k][j] in[o][j][i]. */
static void transform_axis(const wave *in, size_t outer, size_t count, size_t inner, const wave *phases, size_t w,
                           wave *out) {
  for (size_t o = 0; o < outer; o++)
    for (size_t k = 0; k < w; k++) {
      wave *to = out + (o * w + k) * inner;
      for (size_t i = 0; i < inner; i++) to[i] = (wave){0.0, 0.0};
      for (size_t j = 0; j < count; j++) {
        const wave e = phases[k * count + j];
        const wave *from = in + (o * count + j) * inner;
        for (size_t i = 0; i < inner; i++) {
          const wave z = wave_times(e, from[i]);
          to[i].re += z.re, to[i].im += z.im;
        }
      }
    }
}

/* The first axis, straight from the bytes: most cells are empty. */
static void transform_cells(const piece *p, const wave *phases, size_t w, wave *out) {
  const size_t nx = p->counts[0], rows = (size_t)p->counts[1] * p->counts[2];
  for (size_t r = 0; r < rows; r++)
    for (size_t k = 0; k < w; k++) {
      wave sum = {0.0, 0.0};
      for (size_t i = 0; i < nx; i++)
        if (p->cells[r * nx + i]) sum.re += phases[k * nx + i].re, sum.im += phases[k * nx + i].im;
      out[r * w + k] = sum;
    }
}

bool grid_transform(const piece *p, int dimension, int N, double step, grid_table *table) {
  const size_t w = 2 * (size_t)N + 1, ny = p->counts[1], nz = p->counts[2];
  const size_t most = ny > nz ? ny : nz, longest = p->counts[0] > most ? p->counts[0] : most;
  wave *phases = calloc(w * longest, sizeof *phases), *x = calloc(w * ny * nz, sizeof *x);
  wave *y = calloc(w * w * nz, sizeof *y), *z = calloc(dimension == 2 ? 1 : w * w * w, sizeof *z);
  const bool ok = phases && x && y && z;
  if (ok) {
    fill_phases(p->centre.x, p->size[0], p->counts[0], N, step, phases);
    transform_cells(p, phases, w, x);
    fill_phases(p->centre.y, p->size[0], p->counts[1], N, step, phases);
    transform_axis(x, nz, ny, w, phases, w, y);
    if (dimension == 3) {
      fill_phases(p->centre.z, p->size[0], p->counts[2], N, step, phases);
      transform_axis(y, 1, nz, w * w, phases, w, z);
    }
  }
  *table = (grid_table){.N = N, .value = dimension == 2 ? y : z};
  free(phases);
  free(x);
  free(dimension == 2 ? z : y);
  if (!ok) {
    free(table->value);
    table->value = NULL;
  }
  return ok;
}
