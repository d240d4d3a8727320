/* SPDX-License-Identifier: BSD-3-Clause */
/* Chords seen from a box that stands anywhere. */
#include "curve/packets.h"
#include "simd/dispatch.h"

/* How often a chord's point and the box's go to each other's nearest before the bound is taken. */
enum { STEPS = 2 };

/* Squares below this may have lost their digits. */
static const double LEAST_SQUARE = 1e-280;

SIMD_CLONES
double packet_least(const double *values, uint32_t *which) {
  double best[LANES];
#pragma omp simd
  for (int k = 0; k < LANES; k++) best[k] = values[k] < values[k + LANES] ? values[k] : values[k + LANES];
  for (int half = LANES / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) best[k] = best[k] < best[k + half] ? best[k] : best[k + half];
  uint32_t first = CHORDS - 1;
  for (uint32_t k = CHORDS - 1; k-- > 0;) first = values[k] == best[0] ? k : first;
  *which = first;
  return best[0];
}

static inline double held(double x, double half) {
  x = x < -half ? -half : x;
  return x > half ? half : x;
}

SIMD_CLONES
void packet_see_obb(const packet_chords *c, const packet_obb *obb, packet_sample *sample) {
  const double *r = obb->r;
  const vec3 at = obb->position, m = obb->centre, h = obb->half;
  double px[CHORDS], py[CHORDS], pz[CHORDS], dx[CHORDS], dy[CHORDS], dz[CHORDS];
  double *restrict s = sample->s, *restrict lower = sample->lower, *restrict square = sample->square;

  /* into the box's frame; begin nearest to its middle */
#pragma omp simd
  for (int k = 0; k < CHORDS; k++) {
    const double x = c->x[k] - at.x, y = c->y[k] - at.y, z = c->z[k] - at.z;
    px[k] = r[0] * x + r[3] * y + r[6] * z - m.x;
    py[k] = r[1] * x + r[4] * y + r[7] * z - m.y;
    pz[k] = r[2] * x + r[5] * y + r[8] * z - m.z;
    dx[k] = r[0] * c->dx[k] + r[3] * c->dy[k] + r[6] * c->dz[k];
    dy[k] = r[1] * c->dx[k] + r[4] * c->dy[k] + r[7] * c->dz[k];
    dz[k] = r[2] * c->dx[k] + r[5] * c->dy[k] + r[8] * c->dz[k];
    s[k] = held(-(px[k] * dx[k] + py[k] * dy[k] + pz[k] * dz[k]) * c->per_length2[k] - 0.5, 0.5) + 0.5;
  }

  for (int step = 0; step < STEPS; step++) {
#pragma omp simd
    for (int k = 0; k < CHORDS; k++) {
      const double x = held(px[k] + s[k] * dx[k], h.x) - px[k], y = held(py[k] + s[k] * dy[k], h.y) - py[k];
      const double z = held(pz[k] + s[k] * dz[k], h.z) - pz[k];
      s[k] = held((x * dx[k] + y * dy[k] + z * dz[k]) * c->per_length2[k] - 0.5, 0.5) + 0.5;
    }
  }

  /* along w, from the box to the chord's point, the chord is no nearer than either of its ends: weak duality, whatever
   * w is */
#pragma omp simd
  for (int k = 0; k < CHORDS; k++) {
    const double x = px[k] + s[k] * dx[k], y = py[k] + s[k] * dy[k], z = pz[k] + s[k] * dz[k];
    const double wx = x - held(x, h.x), wy = y - held(y, h.y), wz = z - held(z, h.z);
    const double w2 = wx * wx + wy * wy + wz * wz, on = wx * dx[k] + wy * dy[k] + wz * dz[k];
    const double begin = wx * px[k] + wy * py[k] + wz * pz[k];
    const double support = fabs(wx) * h.x + fabs(wy) * h.y + fabs(wz) * h.z;
    const double apart = (begin + (on < 0.0 ? on : 0.0) - support) / sqrt(w2 > LEAST_SQUARE ? w2 : 1.0);
    square[k] = w2;
    lower[k] = w2 > LEAST_SQUARE && apart > 0.0 ? apart : 0.0;
  }
}
