/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls and clusters of them against boxes round intervals of a curve. */
#include "base/rounding.h"
#include "curve/packets.h"
#include "simd/dispatch.h"

void packet_boxes(const packet_chords *c, packet_box boxes[PACKET_INTERVALS]) {
  for (size_t q = 0; q < PACKET_INTERVALS; q++) {
    const size_t first = q * INTERVAL;
    vec3 low = vec(c->x[first], c->y[first], c->z[first]), high = low;
    for (size_t k = first + 1; k <= first + INTERVAL; k++) {
      low = vec(lesser(low.x, c->x[k]), lesser(low.y, c->y[k]), lesser(low.z, c->z[k]));
      high = vec(greater(high.x, c->x[k]), greater(high.y, c->y[k]), greater(high.z, c->z[k]));
    }
    boxes[q] = (packet_box){low, high};
  }
}

/* The ends of CLUSTER boxes, one array a coordinate; of points both ends are one. */
typedef struct spans {
  const double *low_x, *low_y, *low_z, *high_x, *high_y, *high_z;
} spans;

/* The squared distance of each from the nearest of the n boxes. Inlined into each clone, it is compiled for it. */
static inline __attribute__((always_inline)) void nearest_squares(const packet_box *boxes, size_t n, spans s,
                                                                  double least[CLUSTER]) {
  for (size_t l = 0; l < CLUSTER; l++) least[l] = INFINITY;
  for (size_t b = 0; b < n; b++) {
    const vec3 low = boxes[b].low, high = boxes[b].high;
#pragma omp simd
    for (size_t l = 0; l < CLUSTER; l++) {
      double dx = low.x - s.high_x[l] > s.low_x[l] - high.x ? low.x - s.high_x[l] : s.low_x[l] - high.x;
      double dy = low.y - s.high_y[l] > s.low_y[l] - high.y ? low.y - s.high_y[l] : s.low_y[l] - high.y;
      double dz = low.z - s.high_z[l] > s.low_z[l] - high.z ? low.z - s.high_z[l] : s.low_z[l] - high.z;
      dx = dx > 0.0 ? dx : 0.0;
      dy = dy > 0.0 ? dy : 0.0;
      dz = dz > 0.0 ? dz : 0.0;
      const double square = dx * dx + dy * dy + dz * dz;
      least[l] = square < least[l] ? square : least[l];
    }
  }
}

SIMD_CLONES
void packet_box_bounds(const packet_balls *balls, const packet_box *boxes, size_t n, double radius, double slack,
                       double *lower) {
  const double *restrict x = balls->x, *restrict y = balls->y, *restrict z = balls->z;
  const double *restrict reach = balls->reach, *restrict sizes = balls->sizes;
  double *restrict out = lower;
  for (size_t i = 0; i < balls->padded; i += CLUSTER) {
    double least[CLUSTER];
    nearest_squares(boxes, n, (spans){x + i, y + i, z + i, x + i, y + i, z + i}, least);
#pragma omp simd
    for (size_t l = 0; l < CLUSTER; l++) {
      const size_t k = i + l;
      const double distance = sqrt(least[l]), margin = radius + reach[k];
      const double bound =
          distance - margin - ROUND_UP * (slack + ROUND_BALLS * ROUND_U * (distance + margin + sizes[k]));
      out[k] = bound > out[k] ? bound : out[k];
    }
  }
}

SIMD_CLONES
void packet_cluster_bounds(const packet_clusters *clusters, const packet_box *boxes, size_t n, double radius,
                           double slack, double *lower) {
  const double *restrict low_x = clusters->low[0], *restrict low_y = clusters->low[1],
                         *restrict low_z = clusters->low[2];
  const double *restrict high_x = clusters->high[0], *restrict high_y = clusters->high[1];
  const double *restrict high_z = clusters->high[2], *restrict sizes = clusters->sizes;
  double *restrict out = lower;
  for (size_t i = 0; i < clusters->padded; i += CLUSTER) {
    double least[CLUSTER];
    nearest_squares(boxes, n, (spans){low_x + i, low_y + i, low_z + i, high_x + i, high_y + i, high_z + i}, least);
#pragma omp simd
    for (size_t l = 0; l < CLUSTER; l++) {
      const size_t k = i + l;
      const double distance = sqrt(least[l]);
      out[k] = distance - radius - ROUND_UP * (slack + ROUND_BALLS * ROUND_U * (distance + radius + sizes[k]));
    }
  }
}
