/* SPDX-License-Identifier: BSD-3-Clause */
/* The sum of a body that does not turn. */
#include <stdlib.h>

#include "fourier/table.h"

struct table_floor {
  const cprox_gap *gap;
  double *c;     /* C conj(T), in the gap's blocks */
  double *phase; /* cos and sin of k = -N … N + LANES, of the three axes */
};

table_floor *table_floor_create(const cprox_gap *gap) {
  table_floor *f = calloc(1, sizeof *f);
  if (!f) return NULL;
  f->gap = gap;
  f->c = malloc(gap->n_blocks * 2 * LANES * sizeof *f->c);
  f->phase = malloc(6 * (size_t)(2 * gap->N + 2 * LANES) * sizeof *f->phase);
  const double step = TAU / gap->info.period;
  for (size_t i = 0; f->c && i < gap->n_blocks; i++)
    for (int l = 0; l < LANES; l++) {
      const block *b = &gap->blocks[i];
      const size_t at = 2 * LANES * i + (size_t)l;
      wave_jet jet = {0};
      solid_spectrum(gap->turned, vec(step * (b->k[0] + l), step * b->k[1], step * b->k[2]), false, &jet);
      const wave c = wave_times((wave){gap->c[at], gap->c[at + LANES]}, (wave){jet.value.re, -jet.value.im});
      f->c[at] = c.re, f->c[at + LANES] = c.im;
    }
  if (f->c && f->phase) return f;
  table_floor_free(f);
  return NULL;
}

void table_floor_free(table_floor *f) {
  if (!f) return;
  free(f->c);
  free(f->phase);
  free(f);
}

static inline __attribute__((always_inline)) table_answer sum_blocks(const table_floor *f) {
  const cprox_gap *gap = f->gap;
  const int N = gap->N;
  const size_t width = 2 * (size_t)N + 2 * LANES;
  const double *re[3], *im[3];
  for (int j = 0; j < 3; j++) re[j] = f->phase + 2 * (size_t)j * width + N, im[j] = re[j] + width;
  double v[LANES] = {0}, x[LANES] = {0}, y[LANES] = {0}, z[LANES] = {0};
  for (size_t i = 0; i < gap->n_blocks; i++) {
    const block *b = &gap->blocks[i];
    const double *c = f->c + 2 * LANES * i, *xr = re[0] + b->k[0], *xi = im[0] + b->k[0];
    const double yr = re[1][b->k[1]], yi = im[1][b->k[1]], zr = re[2][b->k[2]], zi = im[2][b->k[2]];
    const double r = yr * zr - yi * zi, s = yr * zi + yi * zr, kx = b->k[0], ky = b->k[1], kz = b->k[2];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const double er = r * xr[l] - s * xi[l], ei = r * xi[l] + s * xr[l];
      const double w = c[l] * ei + c[LANES + l] * er;
      v[l] += c[l] * er - c[LANES + l] * ei;
      x[l] -= w * (kx + l), y[l] -= w * ky, z[l] -= w * kz;
    }
  }
  table_answer a = {0};
  for (int l = 0; l < LANES; l++) a.value += v[l], a.position = vec_add(a.position, vec(x[l], y[l], z[l]));
  return a;
}

WIDTH_512 static table_answer sum_512(const table_floor *f) {
  return sum_blocks(f);
}

WIDTH_256 static table_answer sum_256(const table_floor *f) {
  return sum_blocks(f);
}

static table_answer sum_floor(const table_floor *f) {
  switch (f->gap->simd) {
    case SIMD_AVX512: return sum_512(f);
    case SIMD_AVX2: return sum_256(f);
    default: return sum_blocks(f);
  }
}

table_answer table_floor_sum(table_floor *f, vec3 x) {
  const cprox_gap *gap = f->gap;
  const size_t width = 2 * (size_t)gap->N + 2 * LANES;
  const double step = TAU / gap->info.period;
  phases p;
  fill_phases(&p, gap->N + LANES, step, x);
  for (int j = 0; j < 3; j++) {
    double *re = f->phase + 2 * (size_t)j * width + gap->N, *im = re + width;
    for (int k = 0; k < gap->N + LANES; k++) re[k] = p.re[j][k], im[k] = p.im[j][k];
    for (int k = 1; k <= gap->N; k++) re[-k] = re[k], im[-k] = -im[k];
  }
  table_answer a = sum_floor(f);
  a.value = (gap->constant + 2.0 * a.value) * gap->inverse;
  a.position = vec_scale(2.0 * gap->inverse * step, a.position);
  return a;
}
