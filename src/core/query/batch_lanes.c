/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/batch_lanes.h"

#include "base/lanes.h"
#include "base/rounding.h"

LANES_DISPATCHED
void lanes_ball_bounds(const lanes_balls *balls, const curve_capsule *capsule, double radius, double *lower) {
  const double *restrict x = balls->x, *restrict y = balls->y, *restrict z = balls->z;
  const double *restrict reach = balls->reach, *restrict sizes = balls->sizes;
  double *restrict out = lower;
  const vec3 a = capsule->a, ab = vec_sub(capsule->b, a);
  /* a chord whose square would underflow is a point and a little more */
  const double length2 = vec_norm2(ab), per_length2 = length2 > 1e-280 ? 1.0 / length2 : 0.0;
  const double own = capsule->radius + radius + (length2 > 1e-280 ? 0.0 : 1e-140);
  const double own_sizes = vec_norm(a) + vec_norm(capsule->b) + own;
#pragma omp simd
  for (size_t k = 0; k < balls->padded; k++) {
    /* the nearest point of the chord; any other would only lie farther away, by no more than the rounding of s */
    const double px = x[k] - a.x, py = y[k] - a.y, pz = z[k] - a.z;
    double s = (px * ab.x + py * ab.y + pz * ab.z) * per_length2;
    s = s < 0.0 ? 0.0 : s;
    s = s > 1.0 ? 1.0 : s;
    const double dx = px - s * ab.x, dy = py - s * ab.y, dz = pz - s * ab.z;
    const double distance = sqrt(dx * dx + dy * dy + dz * dz);
    out[k] = distance - (own + reach[k]) - 64.0 * ROUND_U * (own_sizes + sizes[k]);
  }
}

void lanes_basis(size_t degree, double *basis) {
  for (size_t k = 0; k < SAMPLES; k++) {
    const double s = ((double)k + 0.5) / SAMPLES, r = 1.0 - s;
    basis[k] = 1.0;
    for (size_t n = 1; n <= degree; n++) {
      /* B(n, j) = r B(n-1, j) + s B(n-1, j-1), from above so that one row is enough */
      basis[n * SAMPLES + k] = s * basis[(n - 1) * SAMPLES + k];
      for (size_t j = n - 1; j > 0; j--)
        basis[j * SAMPLES + k] = r * basis[j * SAMPLES + k] + s * basis[(j - 1) * SAMPLES + k];
      basis[k] *= r;
    }
  }
}

LANES_DISPATCHED
void lanes_sample(const double *basis, const vec3 *points, size_t degree, double *samples) {
  double x[SAMPLES] = {0}, y[SAMPLES] = {0}, z[SAMPLES] = {0};
  for (size_t j = 0; j <= degree; j++) {
    const double *restrict b = basis + j * SAMPLES;
    const vec3 p = points[j];
#pragma omp simd
    for (int k = 0; k < SAMPLES; k++) {
      x[k] += b[k] * p.x;
      y[k] += b[k] * p.y;
      z[k] += b[k] * p.z;
    }
  }
  for (int k = 0; k < SAMPLES; k++) {
    samples[k] = x[k];
    samples[SAMPLES + k] = y[k];
    samples[2 * SAMPLES + k] = z[k];
  }
}

LANES_DISPATCHED
double lanes_closest(const double *samples, vec3 centre, size_t *sample) {
  const double *restrict x = samples, *restrict y = x + SAMPLES, *restrict z = y + SAMPLES;
  double square[SAMPLES];
#pragma omp simd
  for (int k = 0; k < SAMPLES; k++) {
    const double dx = x[k] - centre.x, dy = y[k] - centre.y, dz = z[k] - centre.z;
    square[k] = dx * dx + dy * dy + dz * dz;
  }
  double least[LANES];
#pragma omp simd
  for (int k = 0; k < LANES; k++) least[k] = square[k] < square[k + LANES] ? square[k] : square[k + LANES];
  for (int half = LANES / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) least[k] = least[k] < least[k + half] ? least[k] : least[k + half];
  size_t first = 0;
  while (first + 1 < SAMPLES && square[first] != least[0]) first++;
  *sample = first;
  return least[0];
}
