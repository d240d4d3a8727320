/* SPDX-License-Identifier: BSD-3-Clause */
/* Three-vectors: small inline functions on cprox_vec3, no more than the rooms above use. */
#ifndef CPROX_BASE_VEC_H
#define CPROX_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

#include "curve_proximity/cprox/base.h"

typedef cprox_vec3 vec3;

/* As fmin and fmax, but without a call, and with b where one is not a number. */
static inline double lesser(double a, double b) {
  return a < b ? a : b;
}

static inline double greater(double a, double b) {
  return a > b ? a : b;
}

/* How wide the interval of an answer may be: epsilon, or the fraction `relative` of its upper end where that is more. A
 * fraction of an unknown end, infinity, is nothing. */
static inline double width_allowed(double epsilon, double relative, double upper) {
  const double part = relative * (upper < 0.0 ? -upper : upper);
  return part > epsilon && part < (double)INFINITY ? part : epsilon;
}

static inline vec3 vec(double x, double y, double z) {
  return (vec3){x, y, z};
}

static inline vec3 vec_add(vec3 a, vec3 b) {
  return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline vec3 vec_sub(vec3 a, vec3 b) {
  return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline vec3 vec_scale(double s, vec3 a) {
  return vec(s * a.x, s * a.y, s * a.z);
}

/* a + s b */
static inline vec3 vec_axpy(vec3 a, double s, vec3 b) {
  return vec(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

/* (1 - s) a + s b: returns a at s = 0 and b at s = 1, which a + s (b - a) does not. */
static inline vec3 vec_lerp(vec3 a, vec3 b, double s) {
  const double r = 1.0 - s;
  return vec(r * a.x + s * b.x, r * a.y + s * b.y, r * a.z + s * b.z);
}

static inline vec3 vec_neg(vec3 a) {
  return vec(-a.x, -a.y, -a.z);
}

static inline double vec_dot(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec_cross(vec3 a, vec3 b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec_norm2(vec3 a) {
  return vec_dot(a, a);
}

static inline double vec_norm(vec3 a) {
  return sqrt(vec_dot(a, a));
}

/* How far p is from the segment between a and b. */
static inline double vec_to_segment(vec3 p, vec3 a, vec3 b) {
  const vec3 ab = vec_sub(b, a), ap = vec_sub(p, a);
  const double length2 = vec_norm2(ab), along = vec_dot(ap, ab);
  const double s = length2 > 0.0 ? lesser(greater(along / length2, 0.0), 1.0) : 0.0;
  return vec_norm(vec_sub(p, vec_lerp(a, b, s)));
}

static inline bool vec_equal(vec3 a, vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

static inline bool vec_finite(vec3 a) {
  return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
