/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/control.h"

#include "base/lanes.h"
#include "base/rounding.h"

LANES_DISPATCHED
double control_least(const double *points, size_t degree, vec3 n) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  double least = INFINITY;
#pragma omp simd reduction(min : least)
  for (size_t i = 0; i <= degree; i++) {
    const double g = n.x * x[i] + n.y * y[i] + n.z * z[i];
    least = g < least ? g : least;
  }
  return least;
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

LANES_DISPATCHED
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

LANES_DISPATCHED
double control_split(double *left, double *right, size_t degree, double s, double magnitude) {
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
  /* doc/rounding.md, T1: a level costs u |M| at s = 1/2, where both products are exact, and 3 u |M| elsewhere. The sum over
   * the three coordinates is at most sqrt(3) times the largest vector. */
  const double levels = (s == 0.5 ? 1.0 : 3.0) * (double)degree;
  return ROUND_UP * levels * ROUND_U * 1.7320508075688774 * magnitude;
}

/* What is left of v when its part along the unit axis is taken away. */
static vec3 orthogonal_part(vec3 v, const vec3 *axis) {
  return axis ? vec_axpy(v, -vec_dot(*axis, v), *axis) : v;
}

LANES_DISPATCHED
double control_distance_from(const double *points, size_t degree, vec3 centre, const vec3 *axis, double *scratch) {
  const double *x = points, *y = points + degree + 1, *z = y + degree + 1;
  double *wx = scratch, *wy = wx + degree + 1, *wz = wy + degree + 1;

  /* w_i = C(n, i) (P_i - centre), so that products of two of them need no further weight */
  double binomial = 1.0, reach2 = 0.0;
  for (size_t i = 0; i <= degree; i++) {
    const vec3 v = vec(x[i] - centre.x, y[i] - centre.y, z[i] - centre.z), w = orthogonal_part(v, axis);
    reach2 = fmax(reach2, vec_norm2(v));
    wx[i] = binomial * w.x, wy[i] = binomial * w.y, wz[i] = binomial * w.z;
    binomial = binomial * (double)(degree - i) / (double)(i + 1);
  }

  /* coefficient k of |w|^2 in the Bernstein basis of degree 2n: sum over i of w_i w_(k-i) / C(2n, k); i and k - i count twice */
  double least = INFINITY, divisor = 1.0;
  for (size_t k = 0; k <= 2 * degree; k++) {
    const size_t first = k > degree ? k - degree : 0, half = (k + 1) / 2;
    double sum = 0.0;
    for (size_t i = first; i < half; i++) sum += wx[i] * wx[k - i] + wy[i] * wy[k - i] + wz[i] * wz[k - i];
    sum *= 2.0;
    if (k % 2 == 0) sum += wx[half] * wx[half] + wy[half] * wy[half] + wz[half] * wz[half];
    least = fmin(least, sum / divisor);
    divisor = divisor * (double)(2 * degree - k) / (double)(k + 1);
  }

  /* the coefficients are convex combinations of products below reach^2; doc/rounding.md counts (14 n + 40) u of them */
  least -= ROUND_UP * (14.0 * (double)degree + 40.0) * ROUND_U * reach2;
  return least > 0.0 ? (1.0 - 4.0 * ROUND_U) * sqrt(least) : 0.0;
}
