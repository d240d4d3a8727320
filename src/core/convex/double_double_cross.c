/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/double_double_cross.h"

typedef struct double_double {
  double high, low;
} double_double;

/* a - b exactly. */
static double_double difference(double a, double b) {
  const double high = a - b, back = high - a;
  return (double_double){high, (a - (high - back)) - (b + back)};
}

/* The upper half of the digits. */
static double upper_half(double a) {
  const double c = 134217729.0 * a; /* 2^27 + 1 */
  return c - (c - a);
}

/* a b exactly. */
static double_double product(double a, double b) {
  const double high = a * b, ah = upper_half(a), bh = upper_half(b), al = a - ah, bl = b - bh;
  return (double_double){high, ((ah * bh - high) + ah * bl + al * bh) + al * bl};
}

static double_double multiply(double_double a, double_double b) {
  const double_double p = product(a.high, b.high);
  return (double_double){p.high, p.low + (a.high * b.low + a.low * b.high)};
}

/* a b - c d */
static double determinant(double_double a, double_double b, double_double c, double_double d) {
  const double_double p = multiply(a, b), q = multiply(c, d), high = difference(p.high, q.high);
  return high.high + (high.low + (p.low - q.low));
}

vec3 double_double_cross(vec3 corner, vec3 p, vec3 q) {
  const double_double px = difference(p.x, corner.x), py = difference(p.y, corner.y), pz = difference(p.z, corner.z);
  const double_double qx = difference(q.x, corner.x), qy = difference(q.y, corner.y), qz = difference(q.z, corner.z);
  return vec(determinant(py, qz, pz, qy), determinant(pz, qx, px, qz), determinant(px, qy, py, qx));
}
