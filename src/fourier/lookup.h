/* SPDX-License-Identifier: BSD-3-Clause */
/* A turned solid's spectrum as a table with a value for each node of a lattice in the frequency, and splines between.
 *
 * Splines between the nodes of a spectrum are the exact spectrum of another function: the solid's times a window
 * sinc(y/P)^6 along each axis, and images of it at the distances P, which the window all but takes away. The window is
 * nonnegative, and cells are weighted by one over its least value on them: the function is nonnegative and at least 1
 * on the solid, so that a certified gap's proof holds for it (doc/fourier.md, "Covers and tables"). */
#ifndef CPROX_FOURIER_LOOKUP_H
#define CPROX_FOURIER_LOOKUP_H

#include "fourier/piece.h"

/* The spline's order: nodes along an axis that a value is made of. */
enum { TABLE_ORDER = 6 };

/* What the window makes of a grid's function; upper bounds. */
typedef struct table_bounds {
  double period[3];  /* P, along each axis */
  double peak;       /* of the function apart from its images */
  double mass;       /* its integral, images and all */
  double image_mass; /* that of the images */
  double image_peak; /* the sum of the images' largest values */
  double energy;     /* of the function and its images, wherever these are moved */
} table_bounds;

typedef struct spectrum_table {
  int first[3], last[3]; /* nodes along each axis; those with k_z below -2 are conjugates of others */
  double per_step[3];    /* nodes for each unit of frequency */
  wave *value;           /* k_x fastest */
  table_bounds bounds;
} spectrum_table;

/* Of a grid about the origin, in its own axes. weight: of the layers along each axis, room for its counts; may be NULL.
 * False where memory is out. */
bool lookup_find_bounds(const piece *grid, table_bounds *bounds, double *const weight[3]);

/* The same of any grid with cells of this edge and at most this measure whose farthest cell along each axis reaches to
 * between least and most from the origin. */
void lookup_bound_cover(const double least[3], const double most[3], double cell, double measure, table_bounds *bounds);

/* Bytes of a table for |q| <= most whose window has these periods. */
double lookup_size(const double period[3], double most);

/* NULL where memory is out or the stop function wants an end. */
spectrum_table *lookup_create(const piece *grid, double most, cprox_workspace *workspace);
void lookup_free(spectrum_table *table);
size_t lookup_bytes(const spectrum_table *table);

/* The spline along one axis: the values, and the derivatives by the node, of the six functions about a place; the first
 * is that of the node *from. */
static inline void lookup_spline(double at, bool gradient, int *from, double w[TABLE_ORDER], double d[TABLE_ORDER]) {
  const double low = floor(at), f = at - low;
  *from = (int)low - (TABLE_ORDER / 2 - 1);
  double b[TABLE_ORDER];
  b[0] = 1.0;
  for (int k = 1; k < TABLE_ORDER; k++) {
    if (gradient && k == TABLE_ORDER - 1) {
      d[0] = -b[0];
      for (int r = 1; r < k; r++) d[r] = b[r - 1] - b[r];
      d[k] = b[k - 1];
    }
    double saved = 0.0;
    for (int r = 0; r < k; r++) {
      const double share = b[r] / k;
      b[r] = saved + (r + 1 - f) * share;
      saved = (f + (k - r - 1)) * share;
    }
    b[k] = saved;
  }
  for (int r = 0; r < TABLE_ORDER; r++) w[r] = b[r];
}

/* T at q; gradient too where asked. Frequencies beyond the table's have the value 0. */
static inline void lookup_at(const spectrum_table *t, vec3 q, bool gradient, wave_jet *jet) {
  *jet = (wave_jet){0};
  /* a real function's spectrum at -q is the conjugate of that at q */
  const double sign = q.z < 0.0 ? -1.0 : 1.0;
  const double at[3] = {sign * q.x * t->per_step[0], sign * q.y * t->per_step[1], sign * q.z * t->per_step[2]};
  int from[3];
  double w[3][TABLE_ORDER], d[3][TABLE_ORDER] = {{0}};
  for (int j = 0; j < 3; j++) {
    lookup_spline(at[j], gradient, &from[j], w[j], d[j]);
    if (from[j] < t->first[j] || from[j] + TABLE_ORDER - 1 > t->last[j]) return;
  }
  const size_t row = (size_t)(t->last[0] - t->first[0]) + 1, layer = row * ((size_t)(t->last[1] - t->first[1]) + 1);
  const wave *nodes = t->value + (size_t)(from[2] - t->first[2]) * layer + (size_t)(from[1] - t->first[1]) * row +
                      (size_t)(from[0] - t->first[0]);
  /* along x the nodes stay side by side, real and imaginary parts: plain, and by the derivatives across */
  double plain[2 * TABLE_ORDER] = {0}, by_y[2 * TABLE_ORDER] = {0}, by_z[2 * TABLE_ORDER] = {0};
  for (int z = 0; z < TABLE_ORDER; z++)
    for (int y = 0; y < TABLE_ORDER; y++) {
      const double *v = (const double *)(nodes + (size_t)z * layer + (size_t)y * row);
      const double s = w[1][y] * w[2][z], sy = d[1][y] * w[2][z], sz = w[1][y] * d[2][z];
      for (int i = 0; i < 2 * TABLE_ORDER; i++) plain[i] += s * v[i];
      if (gradient)
        for (int i = 0; i < 2 * TABLE_ORDER; i++) by_y[i] += sy * v[i], by_z[i] += sz * v[i];
    }
  double sum[4][2] = {{0}};
  for (int i = 0; i < TABLE_ORDER; i++)
    for (int part = 0; part < 2; part++) {
      sum[0][part] += w[0][i] * plain[2 * i + part];
      sum[1][part] += d[0][i] * plain[2 * i + part];
      sum[2][part] += w[0][i] * by_y[2 * i + part];
      sum[3][part] += w[0][i] * by_z[2 * i + part];
    }
  jet->value = (wave){sum[0][0], sign * sum[0][1]};
  if (!gradient) return;
  const double *s = t->per_step;
  jet->re = vec_scale(sign, vec(s[0] * sum[1][0], s[1] * sum[2][0], s[2] * sum[3][0]));
  jet->im = vec(s[0] * sum[1][1], s[1] * sum[2][1], s[2] * sum[3][1]);
}

#endif
