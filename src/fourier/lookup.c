/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/lookup.h"

#include <stdlib.h>

#include "base/workspace.h"
#include "fourier/grid.h"
#include "fourier/profile.h"

#define PI 3.14159265358979323846
#define TAU 6.28318530717958647693

/* The period over the largest distance of a cell from the origin along the axis: images are so far that less than 1e-5
 * of the mass is left of them, and the window is never below 0.85. */
#define PERIOD 8.0

/* Images that are added up one by one; those beyond are less than 1e-5 of these. */
enum { IMAGES = 8 };

static double sixth_power(double x) {
  return x * x * x * x * x * x;
}

static double axis_of(vec3 v, int j) {
  return j == 0 ? v.x : j == 1 ? v.y : v.z;
}

static double period_of(const piece *grid, int j) {
  const double low = axis_of(grid->centre, j), high = low + grid->size[0] * grid->counts[j];
  return PERIOD * fmax(fabs(low), fabs(high));
}

/* Of a layer of cells: one over the window's least value, that times its largest, and that times the images'
 * windows. */
typedef struct layer {
  double weight, central, images;
} layer;

static layer layer_at(double low, double high, double period) {
  const double far = fmax(fabs(low), fabs(high)) / period;
  const double near = low <= 0.0 && high >= 0.0 ? 0.0 : fmin(fabs(low), fabs(high)) / period;
  const double weight = 1.0 / sixth_power(profile_sinc(PI * far));
  double images = 0.0;
  for (int j = 1; j <= IMAGES; j++)
    images += sixth_power(sin(PI * far) / (PI * (j - far))) + sixth_power(sin(PI * far) / (PI * (j + near)));
  return (layer){weight, weight * sixth_power(profile_sinc(PI * near)), weight * images * (1.0 + 1e-4)};
}

/* The bounds from the layers along each axis. */
static void add_cells(const piece *grid, layer *const of[3], table_bounds *bounds) {
  const double cell = grid->size[0], volume = cell * cell * cell;
  double square = 0.0;
  for (uint32_t z = 0; z < grid->counts[2]; z++)
    for (uint32_t y = 0; y < grid->counts[1]; y++) {
      const layer ly = of[1][y], lz = of[2][z];
      const double across = ly.central * lz.central, all_across = (ly.central + ly.images) * (lz.central + lz.images);
      const unsigned char *row = grid->cells + ((size_t)z * grid->counts[1] + y) * grid->counts[0];
      double central = 0.0, squares = 0.0, all = 0.0, most = 0.0;
      for (uint32_t x = 0; x < grid->counts[0]; x++) {
        if (!row[x]) continue;
        const layer lx = of[0][x];
        central += lx.central, squares += lx.central * lx.central, all += lx.central + lx.images;
        most = fmax(most, lx.central);
      }
      bounds->peak = fmax(bounds->peak, most * across);
      square += volume * squares * across * across;
      bounds->mass += volume * all * all_across;
      bounds->image_mass += volume * (all * all_across - central * across);
    }
  bounds->image_mass = fmax(0.0, bounds->image_mass) + 1e-13 * bounds->mass;
  const double root = sqrt(square) + sqrt(bounds->image_mass * bounds->image_peak);
  bounds->energy = root * root * (1.0 + 1e-9);
}

bool lookup_find_bounds(const piece *grid, table_bounds *bounds, double *const weight[3]) {
  layer *layers = calloc((size_t)grid->counts[0] + grid->counts[1] + grid->counts[2], sizeof *layers);
  if (!layers) return false;
  layer *const of[3] = {layers, layers + grid->counts[0], layers + grid->counts[0] + grid->counts[1]};
  *bounds = (table_bounds){0};
  double central = 1.0, all = 1.0; /* the products over the axes of the largest */
  for (int j = 0; j < 3; j++) {
    bounds->period[j] = period_of(grid, j);
    double most = 0.0, images = 0.0;
    for (uint32_t i = 0; i < grid->counts[j]; i++) {
      const double low = axis_of(grid->centre, j) + grid->size[0] * i;
      of[j][i] = layer_at(low, low + grid->size[0], bounds->period[j]);
      most = fmax(most, of[j][i].central), images = fmax(images, of[j][i].images);
      if (weight) weight[j][i] = of[j][i].weight;
    }
    central *= most, all *= most + images;
  }
  bounds->image_peak = all - central;
  add_cells(grid, of, bounds);
  free(layers);
  return true;
}

/* The outermost layer, at an eighth of the period, has the largest images, and over a layer there the window falls the
 * most: the nearer the farthest cell, the more. */
void lookup_bound_cover(const double least[3], const double most[3], double cell, double measure,
                        table_bounds *bounds) {
  *bounds = (table_bounds){0};
  double central = 1.0, all = 1.0;
  for (int j = 0; j < 3; j++) {
    const layer l = layer_at(fmax(0.0, least[j] - cell), least[j], PERIOD * least[j]);
    bounds->period[j] = PERIOD * most[j];
    central *= l.central, all *= l.central + l.images;
  }
  bounds->peak = central;
  bounds->image_peak = all - central;
  bounds->mass = all * measure;
  bounds->image_mass = bounds->image_peak * measure;
}

/* The nodes along an axis: those of |q| <= most, and those that its splines go by. */
static void choose_nodes(const double period[3], double most, spectrum_table *t) {
  for (int j = 0; j < 3; j++) {
    t->per_step[j] = period[j] / TAU;
    t->last[j] = (int)ceil(most * t->per_step[j]) + TABLE_ORDER / 2;
    t->first[j] = j == 2 ? -(TABLE_ORDER / 2 - 1) : -t->last[j];
  }
}

double lookup_size(const double period[3], double most) {
  double bytes = sizeof(wave);
  for (int j = 0; j < 3; j++) {
    const double last = ceil(most * period[j] / TAU) + 0.5 * TABLE_ORDER;
    bytes *= j == 2 ? last + 0.5 * TABLE_ORDER : 2.0 * last + 1.0;
  }
  return bytes;
}

spectrum_table *lookup_create(const piece *grid, double most, cprox_workspace *workspace) {
  spectrum_table *t = calloc(1, sizeof *t);
  double *weights = calloc((size_t)grid->counts[0] + grid->counts[1] + grid->counts[2], sizeof *weights);
  double *const weight[3] = {weights, weights + grid->counts[0], weights + grid->counts[0] + grid->counts[1]};
  if (t && weights && lookup_find_bounds(grid, &t->bounds, weight)) {
    choose_nodes(t->bounds.period, most, t);
    grid_range range[3];
    for (int j = 0; j < 3; j++) range[j] = (grid_range){t->first[j], t->last[j], 1.0 / t->per_step[j], weight[j]};
    t->value = grid_spectrum(grid, 3, range, workspace);
  }
  free(weights);
  if (t && t->value) return t;
  free(t);
  return NULL;
}

void lookup_free(spectrum_table *table) {
  if (!table) return;
  free(table->value);
  free(table);
}

size_t lookup_bytes(const spectrum_table *table) {
  size_t nodes = 1;
  for (int j = 0; j < 3; j++) nodes *= (size_t)(table->last[j] - table->first[j]) + 1;
  return nodes * sizeof(wave) + sizeof *table;
}
