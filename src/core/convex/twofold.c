/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/twofold.h"

typedef struct twofold {
  double high, low;
} twofold;

/* a - b exactly. */
static twofold difference(double a, double b) {
  const double high = a - b, back = high - a;
  return (twofold){high, (a - (high - back)) - (b + back)};
}

/* The upper half of the digits. */
static double upper_half(double a) {
  const double c = 134217729.0 * a; /* 2^27 + 1 */
  return c - (c - a);
}

/* a b exactly. */
static twofold product(double a, double b) {
  const double high = a * b, ah = upper_half(a), bh = upper_half(b), al = a - ah, bl = b - bh;
  return (twofold){high, ((ah * bh - high) + ah * bl + al * bh) + al * bl};
}

static twofold multiply(twofold a, twofold b) {
  const twofold p = product(a.high, b.high);
  return (twofold){p.high, p.low + (a.high * b.low + a.low * b.high)};
}

/* a b - c d */
static double determinant(twofold a, twofold b, twofold c, twofold d) {
  const twofold p = multiply(a, b), q = multiply(c, d), high = difference(p.high, q.high);
  return high.high + (high.low + (p.low - q.low));
}

vec3 twofold_cross(vec3 corner, vec3 p, vec3 q) {
  const twofold px = difference(p.x, corner.x), py = difference(p.y, corner.y), pz = difference(p.z, corner.z);
  const twofold qx = difference(q.x, corner.x), qy = difference(q.y, corner.y), qz = difference(q.z, corner.z);
  return vec(determinant(py, qz, pz, qy), determinant(pz, qx, px, qz), determinant(px, qy, py, qx));
}
