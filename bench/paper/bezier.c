/* SPDX-License-Identifier: BSD-3-Clause */
/* A Bézier curve and the integral of its squared speed, both by a Horner scheme in Bernstein form. */
#include "paper.h"

#include <math.h>

static double binomial(size_t n, size_t k) {
  double c = 1.0;
  for (size_t i = 1; i <= k; i++) c = c * (double)(n - k + i) / (double)i;
  return c;
}

/* sum_i B_i^n(s) c_i */
static double bernstein(const double *c, size_t n, double s) {
  const double r = 1.0 - s;
  double power = 1.0, count = 1.0, value = c[0] * r;
  for (size_t i = 1; i < n; i++) {
    power *= s;
    count = count * (double)(n - i + 1) / (double)i;
    value = (value + power * count * c[i]) * r;
  }
  return n == 0 ? c[0] : value + power * s * c[n];
}

static vec3 point(const void *self, double s) {
  const paper_bezier *b = self;
  const size_t n = b->degree;
  const double r = 1.0 - s;
  double power = 1.0, count = 1.0;
  vec3 value = vec_scale(r, b->points[0]);
  for (size_t i = 1; i < n; i++) {
    power *= s;
    count = count * (double)(n - i + 1) / (double)i;
    value = vec_scale(r, vec_axpy(value, power * count, b->points[i]));
  }
  return vec_axpy(value, power * s, b->points[n]);
}

static double energy(const void *self, double s) {
  const paper_bezier *b = self;
  return bernstein(b->energy, 2 * b->degree - 1, s);
}

void paper_bezier_make(const vec3 *points, size_t degree, paper_bezier *b) {
  b->degree = degree;
  for (size_t i = 0; i <= degree; i++) b->points[i] = points[i];

  /* |psi'|² has degree 2 (n - 1); its integral's coefficients are sums of its own over 2n - 1 */
  const size_t m = degree - 1;
  double speed2[2 * PAPER_MAX_DEGREE] = {0};
  for (size_t i = 0; i <= m; i++) {
    for (size_t j = 0; j <= m; j++) {
      const vec3 d = vec_sub(points[i + 1], points[i]), e = vec_sub(points[j + 1], points[j]);
      const double weight = binomial(m, i) * binomial(m, j) / binomial(2 * m, i + j);
      speed2[i + j] += (double)(degree * degree) * weight * vec_dot(d, e);
    }
  }
  b->energy[0] = 0.0;
  for (size_t k = 0; k <= 2 * m; k++) b->energy[k + 1] = b->energy[k] + speed2[k] / (double)(2 * m + 1);
}

paper_curve paper_bezier_curve(const paper_bezier *b, bool planar) {
  return (paper_curve){.t0 = 0.0, .t1 = 1.0, .planar = planar, .self = b, .point = point, .energy = energy};
}
