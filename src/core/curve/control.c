/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/control.h"

#include "base/rounding.h"
#include "curve/curve.h"
#include "simd/dispatch.h"

/* Of the usual low degrees, whose loops the compiler unrolls: registers of four would stay half empty. */
static inline double least_of_few(const double *points, size_t degree, vec3 n) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) least = lesser(n.x * x[i] + n.y * y[i] + n.z * z[i], least);
  return least;
}

/* Along the diagonals of de Casteljau's scheme (base/bernstein.h says why). */
static inline void split_few(double *left, double *right, size_t degree, double s) {
  const double r = 1.0 - s;
  for (size_t k = 0; k < 3; k++) {
    double w[6], *at = right + k * (degree + 1), *l = left + k * (degree + 1);
    for (size_t j = 0; j <= degree; j++) {
      w[j] = at[j];
      for (size_t i = j; i > 0; i--) w[i - 1] = r * w[i - 1] + s * w[i];
      l[j] = w[0];
    }
    for (size_t i = 0; i <= degree; i++) at[i] = w[i];
  }
}

SIMD_CLONES
static double least_of_many(const double *points, size_t degree, vec3 n) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  double least = INFINITY;
#pragma omp simd reduction(min : least)
  for (size_t i = 0; i <= degree; i++) {
    const double g = n.x * x[i] + n.y * y[i] + n.z * z[i];
    least = g < least ? g : least;
  }
  return least;
}

double control_least(const double *points, size_t degree, vec3 n) {
  if (degree == 3) return least_of_few(points, 3, n);
  if (degree == 5) return least_of_few(points, 5, n);
  return least_of_many(points, degree, n);
}

size_t control_lowest(const double *points, size_t degree, vec3 n) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  size_t lowest = 0;
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) {
    const double g = n.x * x[i] + n.y * y[i] + n.z * z[i];
    if (g < least) least = g, lowest = i;
  }
  return lowest;
}

SIMD_CLONES
double control_magnitude(const double *points, size_t degree) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (size_t i = 0; i <= degree; i++) {
    const double square = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    most = square > most ? square : most;
  }
  return sqrt(most);
}

SIMD_CLONES
static void split_many(double *left, double *right, size_t degree, double s) {
  const double r = 1.0 - s;
  for (int k = 0; k < 3; k++) {
    double *w = right + (size_t)k * (degree + 1), *l = left + (size_t)k * (degree + 1);
    l[0] = w[0];
    for (size_t level = 1; level <= degree; level++) {
#pragma omp simd
      for (size_t i = 0; i <= degree - level; i++) w[i] = r * w[i] + s * w[i + 1];
      l[level] = w[0];
    }
  }
}

double control_split(double *left, double *right, size_t degree, double s, double magnitude) {
  switch (degree) {
    case 3: split_few(left, right, 3, s); break;
    case 5: split_few(left, right, 5, s); break;
    default: split_many(left, right, degree, s);
  }
  /* doc/rounding.md, T1: a level costs u |M| at s = 1/2, where both products are exact, and 3 u |M| elsewhere. The sum
   * over the three coordinates is at most sqrt(3) times the largest vector. */
  const double levels = (s == 0.5 ? 1.0 : 3.0) * (double)degree;
  return ROUND_UP * levels * ROUND_U * 1.7320508075688774 * magnitude;
}

SIMD_CLONES
double control_distance_from(const double *points, size_t degree, const double *binomial, vec3 centre,
                             const vec3 *axis) {
  const double *restrict x = points, *restrict y = points + degree + 1, *restrict z = y + degree + 1;
  const double *restrict per_twice = curve_per_twice(binomial, degree);
  double once[CPROX_MAX_DEGREE + 1], wx[CPROX_MAX_DEGREE + 1], wy[CPROX_MAX_DEGREE + 1], wz[CPROX_MAX_DEGREE + 1];
  curve_own_binomials(binomial, degree, once);

  /* w_i = C(n, i) (P_i - centre), or its part across the axis, so that products of two of them need no further weight
   */
  const vec3 e = axis ? *axis : vec(0, 0, 0);
  double reach2 = 0.0;
#pragma omp simd reduction(max : reach2)
  for (size_t i = 0; i <= degree; i++) {
    const double vx = x[i] - centre.x, vy = y[i] - centre.y, vz = z[i] - centre.z;
    const double along = e.x * vx + e.y * vy + e.z * vz, v2 = vx * vx + vy * vy + vz * vz;
    reach2 = v2 > reach2 ? v2 : reach2;
    wx[i] = once[i] * (vx - along * e.x);
    wy[i] = once[i] * (vy - along * e.y);
    wz[i] = once[i] * (vz - along * e.z);
  }

  /* coefficient k of |w|^2 in the Bernstein basis of degree 2n: sum over i of w_i w_(k-i) / C(2n, k); i and k - i count
   * twice */
  double sum[2 * CPROX_MAX_DEGREE + 1];
  for (size_t k = 0; k <= 2 * degree; k++) sum[k] = 0.0;
  for (size_t i = 0; i <= degree; i++) {
    const double ax = 2.0 * wx[i], ay = 2.0 * wy[i], az = 2.0 * wz[i];
    double *restrict at = sum + i;
    at[i] += 0.5 * (ax * wx[i] + ay * wy[i] + az * wz[i]);
#pragma omp simd
    for (size_t j = i + 1; j <= degree; j++) at[j] += ax * wx[j] + ay * wy[j] + az * wz[j];
  }
  double least = INFINITY;
  const double *restrict back = sum + degree;
#pragma omp simd reduction(min : least)
  for (size_t k = 0; k <= degree; k++) {
    const double first = sum[k] * per_twice[k], second = back[k] * per_twice[degree - k];
    least = first < least ? first : least;
    least = second < least ? second : least;
  }

  /* the coefficients are convex combinations of products below reach^2; doc/rounding.md counts (14 n + 40) u of them */
  least -= ROUND_UP * (14.0 * (double)degree + 40.0) * ROUND_U * reach2;
  return least > 0.0 ? (1.0 - 4.0 * ROUND_U) * sqrt(least) : 0.0;
}
