/* SPDX-License-Identifier: BSD-3-Clause */
/* What the kinds share: safe lengths and units, the local shapes a distance field can have, covers of vertex sets. */
#ifndef CPROX_CONVEX_FEATURE_H
#define CPROX_CONVEX_FEATURE_H

#include "convex/convex.h"

/* Squares outside this range may have lost digits to underflow, or all of them to overflow. */
#define FEATURE_LEAST_SQUARE 1e-280
#define FEATURE_MOST_SQUARE 1e280

/* sqrt(x² + y²), accurate at every magnitude, cheap at the usual ones. */
static inline double feature_hypot(double x, double y) {
  const double square = x * x + y * y;
  if (square > FEATURE_LEAST_SQUARE && square < FEATURE_MOST_SQUARE) return sqrt(square);
  return hypot(x, y);
}

/* |v|, and v/|v| ((0,0,0) where v is), accurate at every magnitude: a normal that is not a unit vector would break
 * every bound that is computed with it. */
static inline double feature_unit(vec3 v, vec3 *unit) {
  const double square = vec_norm2(v);
  if (square > FEATURE_LEAST_SQUARE && square < FEATURE_MOST_SQUARE) {
    const double norm = sqrt(square);
    *unit = vec(v.x / norm, v.y / norm, v.z / norm);
    return norm;
  }
  const double most = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  if (!(most > 0.0)) {
    *unit = vec(0, 0, 0);
    return most;
  }
  const vec3 scaled = vec(v.x / most, v.y / most, v.z / most);
  const double norm = vec_norm(scaled);
  *unit = vec(scaled.x / norm, scaled.y / norm, scaled.z / norm);
  return most * norm;
}

/* Two unit vectors that make a right-handed orthonormal basis with the unit vector n. */
static inline void feature_tangents(vec3 n, vec3 *e, vec3 *f) {
  /* the axis least along n crosses it well */
  const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
  const vec3 axis = x <= y && x <= z ? vec(1, 0, 0) : y <= z ? vec(0, 1, 0) : vec(0, 0, 1);
  feature_unit(vec_cross(axis, n), e);
  *f = vec_cross(n, *e);
}

/* x·(h y) for a symmetric matrix h: xx, xy, xz, yy, yz, zz. */
static inline double feature_quadratic(const double h[6], vec3 x, vec3 y) {
  return x.x * (h[0] * y.x + h[1] * y.y + h[2] * y.z) + x.y * (h[1] * y.x + h[3] * y.y + h[4] * y.z) +
         x.z * (h[2] * y.x + h[4] * y.y + h[5] * y.z);
}

/* distance = |y - origin| - offset: a vertex, the centre of a ball. */
void feature_vertex(convex_near *near, vec3 origin, double offset);

/* distance = |part of y - origin orthogonal to the unit axis| - offset: an edge, the axis of a cylinder. */
void feature_edge(convex_near *near, vec3 origin, vec3 axis, double offset);

/* distance = signed height over the plane through near->point with the unit normal near->normal, e and f its tangents.
 */
void feature_face(convex_near *near, vec3 e, vec3 f);

/* A distance that depends on z and rho = hypot(x, y) only: its gradient (radial, axial) at (x, y), its second
 * derivative in the meridian plane; round the axis it is radial/rho. */
void feature_axial(convex_near *near, double x, double y, double radial, double axial, double in_meridian);

/* The ball (at a vertex) or cylinder (at an edge) of doc/convex-pairs.md that touches the hull of the vertices at
 * near->point. Its radius is measured over all vertices and rounded up, so that it contains them whatever near says. */
bool feature_cover(const convex_near *near, int32_t n, const double *x, const double *y, const double *z, double scale,
                   convex_cover *cover);

#endif
