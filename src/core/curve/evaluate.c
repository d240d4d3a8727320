/* SPDX-License-Identifier: BSD-3-Clause */
/* Points and derivatives of a Bézier piece, and the tables of its degree. */
#include "curve/curve.h"
#include "simd/dispatch.h"

enum { LANES = 4, FEW = 5 };

size_t curve_tables_size(size_t degree) {
  return (degree < 2 ? 0 : degree - 1) + (degree + 1);
}

void curve_fill_tables(size_t degree, double *tables) {
  /* C(m, k) by Pascal's rule: exact up to m = 56, one rounding a number beyond */
  double *binomial = tables;
  for (size_t row = 0; row + 2 <= degree; row++) {
    binomial[row] = 1.0;
    for (size_t k = row; k-- > 1;) binomial[k] += binomial[k - 1];
  }

  /* 1 / C(2n, k) from the nearer end: two roundings a step, so at most n u each, and u for the reciprocal */
  double *per_twice = tables + (degree < 2 ? 0 : degree - 1), number = 1.0;
  for (size_t k = 0; k <= degree; k++) {
    per_twice[k] = 1.0 / number;
    number = number * (double)(2 * degree - k) / (double)(k + 1);
  }
}

static const double low_1[] = {1, 1.0 / 2}, low_2[] = {1, 1, 1.0 / 4, 1.0 / 6},
                    low_3[] = {1, 1, 1, 1.0 / 6, 1.0 / 15, 1.0 / 20},
                    low_4[] = {1, 2, 1, 1, 1.0 / 8, 1.0 / 28, 1.0 / 56, 1.0 / 70},
                    low_5[] = {1, 3, 3, 1, 1, 1.0 / 10, 1.0 / 45, 1.0 / 120, 1.0 / 210, 1.0 / 252};
const double *const curve_low_tables[CURVE_LOW_DEGREE + 1] = {NULL, low_1, low_2, low_3, low_4, low_5};

/* With m = n - 2, the last three de Casteljau points are Q_j = sum_k B_k^m(s) P_(k+j), j = 0, 1, 2: nine sums of m + 1
 * products, four terms at a time. */
SIMD_CLONES
static void last_three(const double *x, const double *y, const double *z, size_t m, const double *binomial, double s,
                       vec3 q[3]) {
  /* powers of r = 1 - s; the last group may begin before the array's first */
  const double r = 1.0 - s, r2 = r * r, r4 = r2 * r2, s2 = s * s, s4 = s2 * s2;
  double powers[CPROX_MAX_DEGREE + LANES], *falling = powers + LANES - 1;
  double run[LANES] = {1.0, r, r2, r2 * r};
  for (size_t k = 0; k <= m; k += LANES) {
    double *last = falling + m - k;
    for (int l = 0; l < LANES; l++) {
      last[-l] = run[l];
      run[l] *= r4;
    }
  }

  double sum[9][LANES] = {{0}}, rising[LANES] = {1.0, s, s2, s2 * s}, weight[LANES];
  size_t k = 0;
  for (; k + LANES <= m + 1; k += LANES) {
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      weight[l] = binomial[k + (size_t)l] * falling[k + (size_t)l] * rising[l];
      rising[l] *= s4;
    }
    for (size_t j = 0; j < 3; j++) {
      const double *restrict px = x + k + j, *restrict py = y + k + j, *restrict pz = z + k + j;
#pragma omp simd
      for (int l = 0; l < LANES; l++) {
        sum[j][l] += weight[l] * px[l];
        sum[3 + j][l] += weight[l] * py[l];
        sum[6 + j][l] += weight[l] * pz[l];
      }
    }
  }
  for (int l = 0; k <= m; k++, l++) {
    const double w = binomial[k] * falling[k] * rising[l];
    for (size_t j = 0; j < 3; j++) {
      sum[j][l] += w * x[k + j];
      sum[3 + j][l] += w * y[k + j];
      sum[6 + j][l] += w * z[k + j];
    }
  }
  for (int j = 0; j < 3; j++) {
    q[j].x = (sum[j][0] + sum[j][1]) + (sum[j][2] + sum[j][3]);
    q[j].y = (sum[3 + j][0] + sum[3 + j][1]) + (sum[3 + j][2] + sum[3 + j][3]);
    q[j].z = (sum[6 + j][0] + sum[6 + j][1]) + (sum[6 + j][2] + sum[6 + j][3]);
  }
}

/* The same of low degrees, where the sums are so short that registers of four would stay half empty. */
static inline void last_three_of_few(const double *x, const double *y, const double *z, size_t stride, size_t m,
                                     const double *binomial, double s, vec3 q[3]) {
  const double r = 1.0 - s;
  double falling[FEW], rising = 1.0;
  falling[m] = 1.0;
  for (size_t k = m; k > 0; k--) falling[k - 1] = falling[k] * r;
  vec3 a = vec(0, 0, 0), b = a, c = a;
  for (size_t k = 0; k <= m; k++) {
    const double w = binomial[k] * falling[k] * rising;
    const double *px = x + k * stride, *py = y + k * stride, *pz = z + k * stride;
    a = vec_add(a, vec_scale(w, vec(px[0], py[0], pz[0])));
    b = vec_add(b, vec_scale(w, vec(px[stride], py[stride], pz[stride])));
    c = vec_add(c, vec_scale(w, vec(px[2 * stride], py[2 * stride], pz[2 * stride])));
    rising *= s;
  }
  q[0] = a, q[1] = b, q[2] = c;
}

/*   value = (1-s)² Q_0 + 2 s(1-s) Q_1 + s² Q_2,   first = n ((1-s)(Q_1 - Q_0) + s (Q_2 - Q_1)),
 *   second = n(n-1)((Q_2 - Q_1) - (Q_1 - Q_0)).
 *
 * Error: r = 1 - s has one rounding, so r^(m-k) has 2(m-k) - 1 however the factors are grouped, s^k has k - 1, the
 * binomial two (from degree 59 on), their two products two: a weight has at most 2m + 2. A term of Q_j has one more for
 * its product and at most m for its sums, in whatever order: 3m + 3 = 3n - 3. The last step adds 3 for r², 1 for the
 * product and 2 for the sums: 3n + 3; of degree 1 there are 3. All weights are positive and sum to 1, so this times u
 * max|P| bounds the error in every direction at once. Powers that underflow are off by less than 2^-1074, times a
 * binomial below 2^55: far below u; products that underflow (|P| below 1e-290) add up to 200 times 2^-1074. At s = 0
 * and s = 1 one weight is 1 and the others are 0: the ends are exact. */
void curve_bezier_evaluate(const double *x, const double *y, const double *z, size_t stride, size_t degree,
                           const double *binomial, double s, vec3 *value, vec3 *first, vec3 *second) {
  const double r = 1.0 - s;
  if (degree < 2) {
    const vec3 a = vec(x[0], y[0], z[0]), b = vec(x[stride], y[stride], z[stride]);
    if (value) *value = vec_lerp(a, b, s);
    if (first) *first = vec_sub(b, a);
    if (second) *second = vec(0, 0, 0);
    return;
  }

  vec3 q[3];
  if (stride == 1 && degree == 3) { /* the usual ones, whose loops are unrolled */
    last_three_of_few(x, y, z, 1, 1, binomial, s, q);
  } else if (stride == 1 && degree == 5) {
    last_three_of_few(x, y, z, 1, 3, binomial, s, q);
  } else if (degree - 2 < FEW) {
    last_three_of_few(x, y, z, stride, degree - 2, binomial, s, q);
  } else if (stride == 1) {
    last_three(x, y, z, degree - 2, binomial, s, q);
  } else {
    double apart[3][CPROX_MAX_DEGREE + 1];
    for (size_t i = 0; i <= degree; i++) {
      apart[0][i] = x[i * stride];
      apart[1][i] = y[i * stride];
      apart[2][i] = z[i * stride];
    }
    last_three(apart[0], apart[1], apart[2], degree - 2, binomial, s, q);
  }

  const vec3 d0 = vec_sub(q[1], q[0]), d1 = vec_sub(q[2], q[1]);
  const double n = (double)degree;
  if (value) *value = vec_axpy(vec_axpy(vec_scale(r * r, q[0]), 2.0 * s * r, q[1]), s * s, q[2]);
  if (first) *first = vec_scale(n, vec_lerp(d0, d1, s));
  if (second) *second = vec_scale(n * (n - 1.0), vec_sub(d1, d0));
}
