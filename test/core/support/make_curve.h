/* SPDX-License-Identifier: BSD-3-Clause */
/* Descriptions of curves in one line each, for tests and benches: curve_from(describe_bezier(points, n, 0, 1), ws,
 * &curve). */
#ifndef CPROX_TEST_MAKE_CURVE_H
#define CPROX_TEST_MAKE_CURVE_H

#include "curve_proximity/cprox/curve.h"

static inline cprox_status curve_from(cprox_curve_description description, cprox_workspace *workspace,
                                      cprox_curve **made) {
  return cprox_curve_create(&description, workspace, made);
}

static inline void curve_weights(cprox_curve_description description, double t, double *weights) {
  cprox_curve_weights(&description, t, weights);
}

static inline cprox_curve_description describe_sum(cprox_curve_kind of, const cprox_vec3 *points, size_t n, double t0,
                                                   double t1) {
  return (cprox_curve_description){.kind = of, .points = points, .n = n, .t0 = t0, .t1 = t1};
}

static inline cprox_curve_description describe_bezier(const cprox_vec3 *points, size_t n, double t0, double t1) {
  return describe_sum(CPROX_CURVE_BEZIER, points, n, t0, t1);
}

static inline cprox_curve_description describe_bspline(const cprox_vec3 *points, size_t n, size_t degree,
                                                       const double *knots, size_t n_knots, double t0, double t1) {
  cprox_curve_description d = describe_sum(CPROX_CURVE_BSPLINE, points, n, t0, t1);
  d.degree = degree, d.knots = knots, d.n_knots = n_knots;
  return d;
}

static inline cprox_curve_description describe_polynomial(const cprox_vec3 *coefficients, size_t n, double t0,
                                                          double t1) {
  return describe_sum(CPROX_CURVE_POLYNOMIAL, coefficients, n, t0, t1);
}

static inline cprox_curve_description describe_legendre(const cprox_vec3 *coefficients, size_t n, double t0,
                                                        double t1) {
  return describe_sum(CPROX_CURVE_LEGENDRE, coefficients, n, t0, t1);
}

static inline cprox_curve_description describe_lagrange(const cprox_vec3 *points, const double *nodes, size_t n,
                                                        double t0, double t1) {
  cprox_curve_description d = describe_sum(CPROX_CURVE_LAGRANGE, points, n, t0, t1);
  d.knots = nodes, d.n_knots = n;
  return d;
}

static inline cprox_curve_description describe_trigonometric(const cprox_vec3 *coefficients, size_t n, double t0,
                                                             double t1) {
  return describe_sum(CPROX_CURVE_TRIGONOMETRIC, coefficients, n, t0, t1);
}

static inline cprox_curve_description describe_clothoid(cprox_vec3 start, double heading, double curvature,
                                                        double curvature_rate, double t0, double t1) {
  return (cprox_curve_description){.kind = CPROX_CURVE_CLOTHOID,
                                   .start = start,
                                   .heading = heading,
                                   .curvature = curvature,
                                   .curvature_rate = curvature_rate,
                                   .t0 = t0,
                                   .t1 = t1};
}

static inline cprox_curve_description describe_dubins(cprox_vec3 start, double start_heading, cprox_vec3 end,
                                                      double end_heading, double radius, cprox_dubins_word word) {
  return (cprox_curve_description){.kind = CPROX_CURVE_DUBINS,
                                   .start = start,
                                   .end = end,
                                   .heading = start_heading,
                                   .end_heading = end_heading,
                                   .radius = radius,
                                   .word = word};
}

static inline cprox_curve_description describe_involute(cprox_vec3 centre, double radius, double angle, double t0,
                                                        double t1) {
  return (cprox_curve_description){
      .kind = CPROX_CURVE_INVOLUTE, .start = centre, .radius = radius, .heading = angle, .t0 = t0, .t1 = t1};
}

static inline cprox_curve_description describe_pythagorean_hodograph(cprox_vec3 start, const cprox_quat *preimage,
                                                                     size_t n, double t0, double t1) {
  return (cprox_curve_description){
      .kind = CPROX_CURVE_PYTHAGOREAN_HODOGRAPH, .start = start, .preimage = preimage, .n = n, .t0 = t0, .t1 = t1};
}

/* ends: NULL, or n + 1 of them. */
static inline cprox_curve_description describe_piecewise(const cprox_curve *const *curves, size_t n, const double *ends,
                                                         double gap) {
  return (cprox_curve_description){
      .kind = CPROX_CURVE_PIECEWISE, .curves = curves, .n = n, .knots = ends, .n_knots = ends ? n + 1 : 0, .gap = gap};
}

static inline cprox_curve_description describe_rational_bezier(const cprox_vec3 *points, const double *weights,
                                                               size_t n, double t0, double t1) {
  cprox_curve_description d = describe_sum(CPROX_CURVE_RATIONAL_BEZIER, points, n, t0, t1);
  d.weights = weights;
  return d;
}

static inline cprox_curve_description describe_nurbs(const cprox_vec3 *points, const double *weights, size_t n,
                                                     size_t degree, const double *knots, size_t n_knots, double t0,
                                                     double t1) {
  cprox_curve_description d = describe_bspline(points, n, degree, knots, n_knots, t0, t1);
  d.kind = CPROX_CURVE_NURBS, d.weights = weights;
  return d;
}

/* at: NULL for the identity. The pointer to the whole is read while the part is made. */
static inline cprox_curve_description describe_part(const cprox_curve *const *whole, double t0, double t1,
                                                    const cprox_pose *at) {
  return (cprox_curve_description){.kind = CPROX_CURVE_PART, .curves = whole, .n = 1, .t0 = t0, .t1 = t1, .pose = at};
}

static inline cprox_curve_description describe_smooth(const cprox_smooth_curve *functions, double t0, double t1) {
  return (cprox_curve_description){.kind = CPROX_CURVE_SMOOTH, .smooth = functions, .t0 = t0, .t1 = t1};
}

static inline cprox_curve_description describe_rectifiable(const cprox_rectifiable_curve *functions, double t0,
                                                           double t1) {
  return (cprox_curve_description){.kind = CPROX_CURVE_RECTIFIABLE, .rectifiable = functions, .t0 = t0, .t1 = t1};
}

#endif
