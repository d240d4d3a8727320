/* SPDX-License-Identifier: BSD-3-Clause */
/* Answers to hold the core against, in long double (unit roundoff 2^-64 on x86-64, 2^-113 on ARM), each by the plainest
 * method there is and by none that the core uses. Slow on purpose. */
#ifndef CPROX_TEST_REFERENCE_H
#define CPROX_TEST_REFERENCE_H

#include <math.h>
#include <stddef.h>

#include "base/frame.h"
#include "base/vec.h"

typedef struct vec3l {
  long double x, y, z;
} vec3l;

static inline vec3l ref_vec(vec3 a) {
  return (vec3l){a.x, a.y, a.z};
}

static inline vec3l ref_add(vec3l a, vec3l b) {
  return (vec3l){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3l ref_sub(vec3l a, vec3l b) {
  return (vec3l){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3l ref_scale(long double s, vec3l a) {
  return (vec3l){s * a.x, s * a.y, s * a.z};
}

static inline long double ref_dot(vec3l a, vec3l b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3l ref_cross(vec3l a, vec3l b) {
  return (vec3l){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline long double ref_norm(vec3l a) {
  return sqrtl(ref_dot(a, a));
}

/* |exact - computed|. */
long double ref_error(vec3l exact, vec3 computed);

/* max|p[i]|. */
double ref_largest(const vec3 *p, size_t n);

/* ---- curves ---- */

/* The derivative of the given order (0: the point) of a Bézier curve at s, by de Casteljau. degree <= 60. */
vec3l ref_bezier(const vec3 *p, size_t degree, long double s, size_t order);

/* The control points of the part [s0, s1] of a Bézier curve, by two cuts. */
void ref_bezier_section(const vec3 *p, size_t degree, long double s0, long double s1, vec3l *section);

/* The derivative of the given order of span r of a B-spline (its polynomial, wherever t is), by the Cox-de Boor basis
 * functions over the control points of the derivative. */
vec3l ref_bspline(const vec3 *p, size_t degree, const double *knots, size_t r, long double t, size_t order);

/* ---- poses ---- */

/* R^T (p - position) and R p + position, for a quaternion of any norm but 0. */
vec3l ref_to_local(const cprox_pose *pose, vec3l p);
vec3l ref_to_world(const cprox_pose *pose, vec3l p);

/* ---- distances of a point, 0 inside ---- */

long double ref_point_segment(vec3l p, vec3l a, vec3l b);
long double ref_point_triangle(vec3l p, vec3l a, vec3l b, vec3l c);

/* A filled convex polygon in the plane z = 0, in either orientation (its vertices' z is not read). */
long double ref_point_polygon(vec3l p, const vec3 *vertex, size_t n);

/* The box |x| <= half.x, |y| <= half.y, |z| <= half.z. */
long double ref_point_box(vec3l p, vec3 half);

/* The convex hull of the vertices, by all their triangles and tetrahedra: O(n^4), for a dozen vertices. */
long double ref_point_hull(vec3l p, const vec3 *vertex, size_t n);

#endif
