/* SPDX-License-Identifier: BSD-3-Clause */
/** Parametric curves: psi(t) for t in [t0, t1], compiled once into Bézier pieces, then immutable. (One kind has none
 *  and keeps its caller's functions: cprox_curve_create_rectifiable().)
 *
 *  A curve may be shared by any number of threads. Constructors copy what they are given and check it once; they return
 *  CPROX_INVALID with a sentence in the workspace (which may be NULL: then without the sentence), or CPROX_MEMORY, and
 *  leave *curve untouched on failure. */
#ifndef CURVE_PROXIMITY_CPROX_CURVE_H
#define CURVE_PROXIMITY_CPROX_CURVE_H

#include <curve_proximity/cprox/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The highest degree of a curve. */
#define CPROX_MAX_DEGREE 60

typedef struct cprox_curve cprox_curve;

/** A Bézier curve on [t0, t1]: psi(t) = sum_i B_i^n(s) points[i], s = (t - t0)/(t1 - t0), n = n_points - 1.
 *
 *  points     [m] n_points of them, 2 … CPROX_MAX_DEGREE + 1, finite; they may coincide (a curve that stands still).
 *  t0 < t1    finite.
 *  curve      receives the handle, owned by the caller: cprox_curve_free().
 */
CPROX_API cprox_status cprox_curve_create_bezier(const cprox_vec3 *points, size_t n_points, double t0, double t1,
                                                 cprox_workspace *workspace, cprox_curve **curve);

/** A B-spline curve, restricted to [t0, t1].
 *
 *  points     [m] n_points > degree of them, finite.
 *  degree     1 … CPROX_MAX_DEGREE.
 *  knots      n_points + degree + 1 of them, finite and non-decreasing. Any multiplicity: at an inner knot of
 * multiplicity degree + 1 the curve may jump, and both one-sided limits belong to it. t0 < t1    inside [knots[degree],
 * knots[n_points]], the interval on which the spline is defined.
 *
 *  The pieces are the spline's polynomial spans, by blossoming; the rounding of that conversion is bounded and belongs
 * to every interval answered with this curve. Cost: O(spans degree³) once. Source: L. Ramshaw, "Blossoms are polar
 * forms", 1989; doc/rounding.md.
 */
CPROX_API cprox_status cprox_curve_create_bspline(const cprox_vec3 *points, size_t n_points, size_t degree,
                                                  const double *knots, size_t n_knots, double t0, double t1,
                                                  cprox_workspace *workspace, cprox_curve **curve);

/** A polynomial curve by its powers: psi(t) = sum_k coefficients[k] t^k, t in [t0, t1].
 *
 *  coefficients  [m] of t^k, ascending; n_coefficients of them, 1 … CPROX_MAX_DEGREE + 1, finite. One alone is a curve
 *                that stands still.
 *  t0 < t1       finite. Terms |coefficients[k]| max(|t0|, |t1|)^k far beyond 1e130 m are refused.
 *
 *  Converted once to Bézier pieces in double-double arithmetic: cprox_curve_error() is about 1e-16 of the curve's size,
 *  and more only where the terms are more than 1e13 times as large as the curve. Every interval answered carries it.
 *  Cost: O(degree³) once. Source: doc/rounding.md, "Other bases".
 */
CPROX_API cprox_status cprox_curve_create_polynomial(const cprox_vec3 *coefficients, size_t n_coefficients, double t0,
                                                     double t1, cprox_workspace *workspace, cprox_curve **curve);

/** A series of Legendre polynomials: psi(t) = sum_k coefficients[k] P_k(x), x = (2t - t0 - t1)/(t1 - t0) in [-1, 1].
 *
 *  coefficients  [m] of P_k, ascending; n_coefficients of them, 1 … CPROX_MAX_DEGREE + 1, finite. One alone is a curve
 *                that stands still.
 *  t0 < t1       finite.
 *
 *  Converted as a polynomial is: cprox_curve_error() is about 1e-16 of the curve's size up to degree 40, and less than
 *  2e-12 times the sum of |coefficients| at degree 60. High degrees become several pieces. Source: R. T. Farouki,
 *  "Legendre-Bernstein basis transformations", 2000; doc/rounding.md.
 */
CPROX_API cprox_status cprox_curve_create_legendre(const cprox_vec3 *coefficients, size_t n_coefficients, double t0,
                                                   double t1, cprox_workspace *workspace, cprox_curve **curve);

/** The polynomial of least degree through points, psi(nodes[i]) = points[i], restricted to [t0, t1].
 *
 *  points, nodes  [m] n_points of both, 1 … CPROX_MAX_DEGREE + 1, finite; the nodes in any order, no two alike. One
 *                 point alone is a curve that stands still.
 *  t0 < t1        finite; beyond the outermost nodes the polynomial goes on.
 *
 *  Converted as a polynomial is, from the Lagrange form: cprox_curve_error() is about 1e-16 of the curve's size for
 *  nodes that suit their number (evenly spaced up to degree 20, Chebyshev's beyond); for others it grows as the curve
 *  does between its nodes. High degrees become several pieces. Cost: O(degree⁴) at most, once. Source: doc/rounding.md.
 */
CPROX_API cprox_status cprox_curve_create_lagrange(const cprox_vec3 *points, const double *nodes, size_t n_points,
                                                   double t0, double t1, cprox_workspace *workspace,
                                                   cprox_curve **curve);

/** A trigonometric series: psi(t) = c[0] + sum over k of c[2k-1] cos(kt) + c[2k] sin(kt), t in [t0, t1], radians.
 *
 *  coefficients  [m] constant, cos t, sin t, cos 2t, sin 2t, …; n_coefficients = 2 degree + 1 of them, degree
 *                1 … CPROX_MAX_DEGREE, finite; those of cos and sin no longer than 1e75 m.
 *  t0 < t1       finite; any number of turns. Ranges that would need more than 65536 pieces are refused.
 *
 *  Compiled once to quintic pieces whose remainder, K6 h⁶/46080, is about 1e-13 of the size of the terms (the rounding
 *  of the constant, where that is larger). It is part of cprox_curve_error(), and every interval answered carries it: ε
 *  below it ends with CPROX_PRECISION. A circle takes 155 pieces. The accuracy rests on cos() and sin() that are within
 *  2^-52. Cost: O(pieces degree) once. Source: doc/rounding.md, "Other bases".
 */
CPROX_API cprox_status cprox_curve_create_trigonometric(const cprox_vec3 *coefficients, size_t n_coefficients,
                                                        double t0, double t1, cprox_workspace *workspace,
                                                        cprox_curve **curve);

/** A clothoid (Euler spiral): a planar curve whose curvature is linear in arc length.
 *
 *  psi'(t) = (cos, sin, 0) of heading + curvature t + curvature_rate t²/2, psi(0) = start; t is arc length [m].
 *
 *  start            [m] where the curve is at t = 0, which need not lie in its range; z stays as it is.
 *  heading          [rad] about z, from x, at t = 0.
 *  curvature, curvature_rate  [1/m], [1/m²], finite, any sign: 0 and 0 are a line, 0 alone for the rate an arc.
 *  t0 < t1          finite. Turning by more than 1e12 rad between 0 and an end of the range is refused, and so are
 *                   ranges that would need more than 65536 pieces.
 *
 *  Compiled once to quintic pieces, as a trigonometric series is; the remainder aimed at is 2e-14 of the length t1 - t0
 *  (the rounding of the start, where that is larger). The point, a Fresnel integral, is summed by Gauss' rule with a
 *  bounded remainder. Source: doc/rounding.md, "Compiled curves".
 */
CPROX_API cprox_status cprox_curve_create_clothoid(cprox_vec3 start, double heading, double curvature,
                                                   double curvature_rate, double t0, double t1,
                                                   cprox_workspace *workspace, cprox_curve **curve);

/** The words of Dubins paths: left and right turns and straight lines. */
typedef enum cprox_dubins_word {
  CPROX_DUBINS_SHORTEST, /**< the shortest of all */
  CPROX_DUBINS_LSL,
  CPROX_DUBINS_LSR,
  CPROX_DUBINS_RSL,
  CPROX_DUBINS_RSR,
  CPROX_DUBINS_RLR,
  CPROX_DUBINS_LRL
} cprox_dubins_word;

/** What a Dubins path consists of. */
typedef struct cprox_dubins_path {
  cprox_dubins_word word; /**< never CPROX_DUBINS_SHORTEST */
  double ends[3];         /**< [m] the arc length at which each of its three parts ends; ends[2] is the path's length */
} cprox_dubins_path;

/** A Dubins path: the shortest planar curve between two poses that never turns more sharply than a radius allows.
 *
 *  start, end     [m] points with the same z.
 *  start_heading, end_heading  [rad] about z, from x, at most 1e6 in size.
 *  radius         [m] > 0, of all turns; the poses are at most 1e12 radii apart.
 *  word           CPROX_DUBINS_SHORTEST, or the one that is wanted: CPROX_INVALID where it cannot join the poses.
 *  path           receives what the path consists of, NULL if not needed.
 *
 *  The curve runs over [0, length], t is arc length [m]. It is the path that begins at the start pose and turns as
 *  *path says, and cprox_curve_error() speaks of that one; it reaches the end pose to about 1e-14 of its length and
 *  radius, turns below 1e-15 (8 + |headings|) rad being left out.
 *  Poses that are the same have no path: CPROX_INVALID. Compiled as a clothoid is. Source: L. E. Dubins 1957; A. M.
 *  Shkel, V. Lumelsky, "Classification of the Dubins set", 2001.
 */
CPROX_API cprox_status cprox_curve_create_dubins(cprox_vec3 start, double start_heading, cprox_vec3 end,
                                                 double end_heading, double radius, cprox_dubins_word word,
                                                 cprox_workspace *workspace, cprox_dubins_path *path,
                                                 cprox_curve **curve);

/** The involute of a circle: psi(t) = centre + radius R (cos t + t sin t, sin t - t cos t, 0), R the turn by `angle`
 *  about z.
 *
 *  radius         [m] > 0, of the circle; at most 1e75.
 *  angle          [rad] finite; the curve leaves the circle at t = 0 in that direction.
 *  t0 < t1        [rad] finite; at t < 0 it is the mirror image, wound clockwise.
 *
 *  Compiled as a trigonometric series is, with a remainder of about 1e-13 radius (1 + max|t|).
 */
CPROX_API cprox_status cprox_curve_create_involute(cprox_vec3 centre, double radius, double angle, double t0, double t1,
                                                   cprox_workspace *workspace, cprox_curve **curve);

/** A Pythagorean-hodograph curve by its preimage: a polynomial of quaternions, A(s) = sum_i B_i^m(s) preimage[i], s =
 *  (t - t0)/(t1 - t0).
 *
 *  dpsi/ds = A i A* = (w² + x² - y² - z², 2(wz + xy), 2(xz - wy)), so that |dpsi/ds| = |A|². A planar curve with the
 *  complex preimage a + ib, dpsi/ds = (a + ib)², has the quaternions (a, 0, 0, b).
 *
 *  start          [m] psi(t0), finite.
 *  preimage       [m^1/2] n_preimage = m + 1 coefficients, 1 … 30 of them, at most 1e75 long; 3 make the usual
 *                 quintics.
 *  t0 < t1        finite.
 *
 *  The curve is a polynomial of degree 2m + 1, converted as a polynomial is: cprox_curve_error() is about 1e-16 of its
 *  size. Source: R. T. Farouki, "Pythagorean-Hodograph Curves", 2008.
 */
CPROX_API cprox_status cprox_curve_create_pythagorean_hodograph(cprox_vec3 start, const cprox_quat *preimage,
                                                                size_t n_preimage, double t0, double t1,
                                                                cprox_workspace *workspace, cprox_curve **curve);

/** Curves of any kinds end to end, as one.
 *
 *  curves         n_curves >= 1 of them, in order; their pieces are copied.
 *  ends           NULL: every curve keeps its own range, which must begin where the one before ends. Else n_curves + 1
 *                 ascending parameters: curve i runs over [ends[i], ends[i+1]], at a speed that is scaled to fit.
 *  gap            [m] >= 0: how far apart the end of a curve and the beginning of the next may be. INFINITY: it may
 *                 jump, and both one-sided limits belong to it; 0: it must join as exactly as the curves' errors can
 *                 tell.
 *
 *  All pieces get the highest degree among them, which costs a rounding of their points. CPROX_INVALID names the joint
 *  that is at fault.
 */
CPROX_API cprox_status cprox_curve_create_piecewise(const cprox_curve *const *curves, size_t n_curves,
                                                    const double *ends, double gap, cprox_workspace *workspace,
                                                    cprox_curve **curve);

/** A smooth curve by functions of the caller's. They are called while the curve is made and never again. */
typedef struct cprox_smooth_curve {
  /** Writes psi(t), psi'(t), psi''(t) to jet[0], jet[1], jet[2]. What is not finite is refused, and t named. */
  void (*evaluate)(void *user, double t, cprox_vec3 jet[3]);
  /** At least |psi^(6)| everywhere on [a, b], >= 0; it should be less on a part of it. INFINITY: ask about a part. */
  double (*sixth)(void *user, double a, double b);
  void *user;      /**< handed to both */
  double error[3]; /**< >= 0: how far jet[k] may be from the exact derivative [m/(unit of t)^k] */
  double accuracy; /**< [m] > 0: the remainder to aim at; the number of pieces grows with its power of -1/6 */
} cprox_smooth_curve;

/** A smooth curve, compiled once to quintic pieces within K6 h^6/46080 of it, K6 the bound of its sixth derivative.
 *
 *  functions      kept no longer than the call.
 *  t0 < t1        finite. Ranges that would need more than 65536 pieces are refused.
 *
 *  cprox_curve_error() is the remainder, the errors stated and the rounding; every interval answered carries it.
 *  Intervals are as true as the bounds are: a bound that is false is detected, and refused with the parameter, where
 *  the middle of a piece is farther from its quintic than it allows (for a curve whose sixth derivative is about the
 *  same over a piece: always, unless the errors stated hide it), and not where the derivative is larger than stated on
 *  a small part of a piece alone. Cost: two evaluations and a few bounds a piece. Source: doc/rounding.md, "Compiled
 *  curves".
 */
CPROX_API cprox_status cprox_curve_create_smooth(const cprox_smooth_curve *functions, double t0, double t1,
                                                 cprox_workspace *workspace, cprox_curve **curve);

/** A curve of finite length by functions of the caller's: its points, and how long its parts are at most. Every query
 *  with the curve calls them, from its own thread; they must give the same answer to the same query. */
typedef struct cprox_rectifiable_curve {
  /** Writes psi(t) [m]. */
  void (*point)(void *user, double t, cprox_vec3 *point);
  /** At least the arc length [m] over [a, b], its own rounding included: in closed form the u_psi of Lemma 1,
   *  sqrt((b - a) times the integral of |psi'|²). NULL: from the velocity. */
  double (*length)(void *user, double a, double b);
  /** Writes psi'(t) [m/(unit of t)]; used where `length` is NULL, and by cprox_curve_evaluate(). May be NULL beside a
   *  length. */
  void (*velocity)(void *user, double t, cprox_vec3 *velocity);
  void *user;            /**< handed to all three; it must live as long as the curve */
  double error;          /**< [m] >= 0: how far a point may be from the exact one */
  double velocity_error; /**< >= 0: how far a velocity may be from the exact one */
  /** >= 0: the relative error of the integral of |psi'|² by the 15 points of Gauss and Kronrod, over any part of a
   *  64th of the range; 0 where |psi'|² is a polynomial of degree 22 or less */
  double quadrature_error;
} cprox_rectifiable_curve;

/** A curve that is only known by its points and the lengths of its parts; it need not be smooth.
 *
 *  functions      copied; what they refer to is kept by reference.
 *  t0 < t1        finite.
 *
 *  A part of it lies in the ellipsoid whose foci are its ends and whose axis is its length: each query bounds distances
 *  by that, in the same search as every other curve's, and needs some ten times as many nodes. cprox_curve_degree() is
 *  0, it has no control points, cprox_curve_evaluate() gives no second derivative. Intervals are as true as what the
 *  functions state. What contradicts itself is detected where a query (or this call, at 65 parameters) comes by: a
 *  point that is not finite, two points farther apart than the length between them; the call then fails with
 *  CPROX_INVALID and says where. A length that is too small and yet longer than the chord cannot be told from a true
 *  one. Source: A. Lakshmanan et al. 2019, Lemma 1 and Theorem 1; doc/rounding.md, "Ellipsoids".
 */
CPROX_API cprox_status cprox_curve_create_rectifiable(const cprox_rectifiable_curve *functions, double t0, double t1,
                                                      cprox_workspace *workspace, cprox_curve **curve);

/** Frees a curve; NULL is allowed. No query may be using it. */
CPROX_API void cprox_curve_free(cprox_curve *curve);

/** The ends of the parameter range. */
CPROX_API void cprox_curve_domain(const cprox_curve *curve, double *t0, double *t1);

/** The degree of the curve's polynomial pieces; 0 for a curve that is known by its arc length. */
CPROX_API size_t cprox_curve_degree(const cprox_curve *curve);

/** The number of polynomial pieces. */
CPROX_API size_t cprox_curve_pieces(const cprox_curve *curve);

/** [m] How far the curve as it was given may be from its computed pieces, at most: the rounding of their conversion; of
 *  a compiled curve the remainder too. 0 for a Bézier curve. Every interval answered accounts for it. */
CPROX_API double cprox_curve_error(const cprox_curve *curve);

/** psi(t), and its first and second derivative by t, each NULL if not needed.
 *
 *  t          inside [t0, t1], else CPROX_INVALID. At a joint of two pieces the right one answers (the left one at t1).
 *  Accuracy:  the point is within (6 degree + 20) 2^-53 max|control point| of the exact one, on a B-spline within
 *             (12 degree + 20), on the other bases within cprox_curve_error() more: a plain evaluation for drawing and
 *             sampling. Certified answers come from the queries.
 */
CPROX_API cprox_status cprox_curve_evaluate(const cprox_curve *curve, double t, cprox_workspace *workspace,
                                            cprox_vec3 *point, cprox_vec3 *derivative, cprox_vec3 *second_derivative);

/** The Bézier control points of the curve restricted to [a, b], which must lie within one polynomial piece.
 *
 *  points     receives cprox_curve_degree() + 1 control points [m].
 *  CPROX_INVALID if a >= b, if [a, b] leaves the domain, or if a joint lies strictly inside it.
 */
CPROX_API cprox_status cprox_curve_control_points(const cprox_curve *curve, double a, double b,
                                                  cprox_workspace *workspace, cprox_vec3 *points);

/** An axis-aligned box that contains the curve, rounding included. */
CPROX_API void cprox_curve_bounds(const cprox_curve *curve, cprox_vec3 *lowest, cprox_vec3 *highest);

/** The same of one polynomial piece, 0 <= piece < cprox_curve_pieces(); pieces are in the order of the parameter. */
CPROX_API void cprox_curve_piece_bounds(const cprox_curve *curve, size_t piece, cprox_vec3 *lowest,
                                        cprox_vec3 *highest);

#ifdef __cplusplus
}
#endif
#endif
