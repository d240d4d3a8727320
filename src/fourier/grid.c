/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/grid.h"

#include <stdlib.h>

#include "base/workspace.h"
#include "fourier/profile.h"

bool grid_is_aligned(const piece *p) {
  const double *t = p->turn;
  return p->kind == PIECE_GRID && t[0] == 1.0 && t[4] == 1.0 && t[8] == 1.0;
}

/* phases[k][i] = exp(-i q (origin + cell (i + 1/2))) cell sinc(q cell/2) weight[i], q = step k: the transform of cell i
 * along one axis. */
static void fill_phases(double origin, double cell, uint32_t count, const grid_range *range, wave *phases) {
  for (int k = range->first; k <= range->last; k++) {
    const double q = range->step * k, share = cell * profile_sinc(0.5 * q * cell);
    for (uint32_t i = 0; i < count; i++) {
      const wave e = wave_back(q * (origin + cell * (i + 0.5)));
      const double w = range->weight ? share * range->weight[i] : share;
      *phases++ = (wave){w * e.re, w * e.im};
    }
  }
}

static size_t width(const grid_range *range) {
  return (size_t)(range->last - range->first) + 1;
}

/* Sums over the middle of three indices: out[o][k][i] = sum over j of phases[k][j] in[o][j][i]. False: stopped. */
static bool transform_axis(const wave *in, size_t outer, size_t count, size_t inner, const wave *phases, size_t w,
                           cprox_workspace *workspace, wave *out) {
  for (size_t o = 0; o < outer; o++)
    for (size_t k = 0; k < w; k++) {
      if (cprox_workspace_wants_stop(workspace)) return false;
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
  return true;
}

/* The first axis, straight from the bytes: most cells are empty. `list` is room for a row's occupied cells. */
static bool transform_cells(const piece *p, const wave *phases, size_t w, cprox_workspace *workspace, uint32_t *list,
                            wave *out) {
  const size_t nx = p->counts[0], rows = (size_t)p->counts[1] * p->counts[2];
  for (size_t r = 0; r < rows; r++) {
    if (r % 64 == 0 && cprox_workspace_wants_stop(workspace)) return false;
    size_t n = 0;
    for (size_t i = 0; i < nx; i++)
      if (p->cells[r * nx + i]) list[n++] = (uint32_t)i;
    for (size_t k = 0; k < w; k++) {
      wave sum = {0.0, 0.0};
      for (size_t i = 0; i < n; i++) sum.re += phases[k * nx + list[i]].re, sum.im += phases[k * nx + list[i]].im;
      out[r * w + k] = sum;
    }
  }
  return true;
}

wave *grid_spectrum(const piece *p, int dimension, const grid_range range[3], cprox_workspace *workspace) {
  const size_t nx = p->counts[0], ny = p->counts[1], nz = p->counts[2];
  const size_t wx = width(&range[0]), wy = width(&range[1]), wz = dimension == 2 ? 1 : width(&range[2]);
  const size_t yz = wy * ny > wz * nz ? wy * ny : wz * nz, longest = wx * nx > yz ? wx * nx : yz;
  wave *phases = calloc(longest, sizeof *phases), *x = calloc(wx * ny * nz, sizeof *x);
  wave *y = calloc(wx * wy * nz, sizeof *y), *z = dimension == 2 ? NULL : calloc(wx * wy * wz, sizeof *z);
  uint32_t *list = calloc(nx, sizeof *list);
  bool ok = phases && x && y && list && (dimension == 2 || z);
  if (ok) {
    const double cell = p->size[0];
    fill_phases(p->centre.x, cell, p->counts[0], &range[0], phases);
    ok = transform_cells(p, phases, wx, workspace, list, x);
    fill_phases(p->centre.y, cell, p->counts[1], &range[1], phases);
    ok = ok && transform_axis(x, nz, ny, wx, phases, wy, workspace, y);
    if (ok && dimension == 3) {
      fill_phases(p->centre.z, cell, p->counts[2], &range[2], phases);
      ok = transform_axis(y, 1, nz, wx * wy, phases, wz, workspace, z);
    }
  }
  wave *out = dimension == 2 ? y : z;
  free(list);
  free(phases);
  free(x);
  free(dimension == 2 ? z : y);
  if (ok) return out;
  free(out);
  return NULL;
}

bool grid_transform(const piece *p, int dimension, int N, double step, cprox_workspace *workspace, grid_table *table) {
  const grid_range all = {.first = -N, .last = N, .step = step}, range[3] = {all, all, all};
  *table = (grid_table){.N = N, .value = grid_spectrum(p, dimension, range, workspace)};
  return table->value != NULL;
}
