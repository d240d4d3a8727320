/* SPDX-License-Identifier: BSD-3-Clause */
/* Blocks of balls against boxes round stretches of a curve. */
#include "base/lanes.h"
#include "base/rounding.h"
#include "query/batch_lanes.h"

LANES_DISPATCHED
void lanes_block_bounds(const lanes_blocks *blocks, const lanes_box *boxes, size_t n, double radius, double slack,
                        double *lower) {
  const double *restrict low_x = blocks->low[0], *restrict low_y = blocks->low[1], *restrict low_z = blocks->low[2];
  const double *restrict high_x = blocks->high[0], *restrict high_y = blocks->high[1];
  const double *restrict high_z = blocks->high[2], *restrict sizes = blocks->sizes;
  double *restrict out = lower;
  for (size_t i = 0; i < blocks->padded; i += BLOCK) {
    double least[BLOCK] = {INFINITY, INFINITY, INFINITY, INFINITY};
    for (size_t b = 0; b < n; b++) {
      const vec3 low = boxes[b].low, high = boxes[b].high;
#pragma omp simd
      for (size_t l = 0; l < BLOCK; l++) {
        const size_t k = i + l;
        double dx = low.x - high_x[k] > low_x[k] - high.x ? low.x - high_x[k] : low_x[k] - high.x;
        double dy = low.y - high_y[k] > low_y[k] - high.y ? low.y - high_y[k] : low_y[k] - high.y;
        double dz = low.z - high_z[k] > low_z[k] - high.z ? low.z - high_z[k] : low_z[k] - high.z;
        dx = dx > 0.0 ? dx : 0.0;
        dy = dy > 0.0 ? dy : 0.0;
        dz = dz > 0.0 ? dz : 0.0;
        const double square = dx * dx + dy * dy + dz * dz;
        least[l] = square < least[l] ? square : least[l];
      }
    }
#pragma omp simd
    for (size_t l = 0; l < BLOCK; l++) {
      const size_t k = i + l;
      const double distance = sqrt(least[l]);
      out[k] = distance - radius - ROUND_UP * (slack + 64.0 * ROUND_U * (distance + radius + sizes[k]));
    }
  }
}
