/* SPDX-License-Identifier: BSD-3-Clause */
/** Parametric curves: psi(t) for t in [t0, t1], made from a description, then immutable.
 *
 *  A constructor compiles the curve once into Bézier pieces. (One kind has none and keeps the functions of its caller:
 *  CPROX_CURVE_RECTIFIABLE.) Any number of threads may share a curve. */
#ifndef CURVE_PROXIMITY_CPROX_CURVE_H
#define CURVE_PROXIMITY_CPROX_CURVE_H

#include <curve_proximity/cprox/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The highest degree of a curve. */
#define CPROX_MAX_DEGREE 60

/** A curve. */
typedef struct cprox_curve cprox_curve;

/** The kinds of curves. Each line of the comments names the members of cprox_curve_description that the kind reads. */
typedef enum cprox_curve_kind {
  /** A Bézier curve: psi(t) = sum_i B_i^m(s) points[i], s = (t - t0)/(t1 - t0), m = n - 1.
   *
   *  points, n    [m] 2 … CPROX_MAX_DEGREE + 1 control points. They may coincide (a curve that stands still).
   *  t0, t1       the parameter range. It reparametrises: the curve begins at t0 and ends at t1. CPROX_CURVE_PART
   *               restricts. */
  CPROX_CURVE_BEZIER,
  /** A B-spline curve, restricted to [t0, t1].
   *
   *  points, n       [m] n > degree control points.
   *  degree          1 … CPROX_MAX_DEGREE.
   *  knots, n_knots  n + degree + 1 knots, non-decreasing. At an inner knot of multiplicity degree + 1 the curve may
   *                  jump; both one-sided limits belong to it.
   *  t0, t1          inside [knots[degree], knots[n]], the interval on which the spline is defined.
   *
   *  The pieces are the polynomial spans of the spline, by blossoming. The rounding of this conversion is bounded and
   *  is part of every interval. Cost: O(spans degree³). Source: L. Ramshaw, "Blossoms are polar forms", 1989;
   *  doc/rounding.md. */
  CPROX_CURVE_BSPLINE,
  /** A polynomial by its powers: psi(t) = sum_k points[k] t^k.
   *
   *  points, n    [m] 1 … CPROX_MAX_DEGREE + 1 coefficients of t^k, ascending. One alone is a curve that stands still.
   *  t0, t1       the parameter range. Terms |points[k]| max(|t0|, |t1|)^k far beyond 1e130 m are refused.
   *
   *  The conversion to Bézier pieces runs in double-double arithmetic: cprox_curve_info.error is about 1e-16 of the
   *  size of the curve. It is more only where the terms are more than 1e13 times as large as the curve.
   *  Cost: O(n³). Source: doc/rounding.md, "Other bases". */
  CPROX_CURVE_POLYNOMIAL,
  /** A series of Legendre polynomials: psi(t) = sum_k points[k] P_k(x), x = (2t - t0 - t1)/(t1 - t0) in [-1, 1].
   *
   *  points, n    [m] 1 … CPROX_MAX_DEGREE + 1 coefficients of P_k, ascending.
   *  t0, t1       the parameter range. It reparametrises, as that of a Bézier curve.
   *
   *  The conversion is that of a polynomial: the error is about 1e-16 of the size of the curve up to degree 40, and
   *  below 2e-12 times the sum of |points| at degree 60. High degrees become several pieces. Source: R. T. Farouki,
   *  "Legendre-Bernstein basis transformations", 2000; doc/rounding.md. */
  CPROX_CURVE_LEGENDRE,
  /** The polynomial of least degree through points, psi(knots[i]) = points[i], restricted to [t0, t1].
   *
   *  points, n       [m] 1 … CPROX_MAX_DEGREE + 1 points. One alone is a curve that stands still.
   *  knots, n_knots  n nodes in any order, no two alike.
   *  t0, t1          the parameter range. The polynomial continues beyond the outermost nodes.
   *
   *  The error is about 1e-16 of the size of the curve for nodes that suit their number (evenly spaced up to degree 20,
   *  Chebyshev nodes beyond). For other nodes it grows as the curve does between its nodes. High degrees become several
   *  pieces. Cost: at most O(n⁴). Source: doc/rounding.md. */
  CPROX_CURVE_LAGRANGE,
  /** A trigonometric series: psi(t) = points[0] + sum over k of points[2k-1] cos(kt) + points[2k] sin(kt).
   *
   *  points, n    [m] 2 degree + 1 coefficients: constant, cos t, sin t, cos 2t, sin 2t, …; degree
   *               1 … CPROX_MAX_DEGREE. Those of cos and sin are at most 1e75 m long.
   *  t0, t1       [rad] any number of turns. Ranges that need more than 65536 pieces are refused.
   *
   *  The pieces are quintics. Their remainder, K6 h⁶/46080, is about 1e-13 of the size of the terms (or the rounding of
   *  the constant, where that is larger). Every interval contains it: an epsilon below it ends with CPROX_PRECISION. A
   *  circle takes 155 pieces. The accuracy rests on cos() and sin() that are within 2^-52. Cost: O(pieces degree).
   *  Source: doc/rounding.md, "Other bases". */
  CPROX_CURVE_TRIGONOMETRIC,
  /** A clothoid (Euler spiral): a planar curve whose curvature is linear in arc length. t is arc length [m].
   *  psi'(t) = (cos, sin, 0) of heading + curvature t + curvature_rate t²/2, psi(0) = start.
   *
   *  start            [m] the point at t = 0, which may lie outside the range; z is constant.
   *  heading          [rad] about z, from x, at t = 0.
   *  curvature, curvature_rate  [1/m], [1/m²], any sign. Both 0: a line. The rate 0: an arc.
   *  t0, t1           [m] the parameter range. Turning by more than 1e12 rad between 0 and an end of the range is
   *                   refused, and so are ranges that need more than 65536 pieces.
   *
   *  The pieces are quintics; the remainder is about 2e-14 of the length t1 - t0 (or the rounding of the start, where
   *  that is larger). Source: doc/rounding.md, "Compiled curves". */
  CPROX_CURVE_CLOTHOID,
  /** A Dubins path: the shortest planar curve between two poses with a least turning radius. The range is [0, length],
   *  t is arc length [m]. cprox_curve_info.dubins says what the path consists of.
   *
   *  start, end            [m] points with the same z.
   *  heading, end_heading  [rad] about z, from x, at most 1e6 in size.
   *  radius                [m] > 0, of all turns; the poses are at most 1e12 radii apart.
   *  word                  CPROX_DUBINS_SHORTEST, or the one that is wanted: CPROX_INVALID where it cannot join the
   *                        poses.
   *
   *  The path begins at the start pose. It reaches the end pose to about 1e-14 of its length and radius, because turns
   *  below 1e-15 (8 + |headings|) rad are left out. Poses that are the same have no path: CPROX_INVALID. Source: L. E.
   *  Dubins 1957; A. M. Shkel, V. Lumelsky, "Classification of the Dubins set", 2001. */
  CPROX_CURVE_DUBINS,
  /** The involute of a circle: psi(t) = start + radius R (cos t + t sin t, sin t - t cos t, 0), R the turn by `heading`
   *  about z.
   *
   *  start            [m] the centre of the circle.
   *  radius           [m] > 0, of the circle; at most 1e75.
   *  heading          [rad] the curve leaves the circle at t = 0 in that direction.
   *  t0, t1           [rad] the parameter range; at t < 0 the curve is the mirror image, wound clockwise.
   *
   *  The pieces are quintics with a remainder of about 1e-13 radius (1 + max|t|). */
  CPROX_CURVE_INVOLUTE,
  /** A Pythagorean-hodograph curve by its preimage, a polynomial of quaternions A(s) = sum_i B_i^m(s) preimage[i],
   *  s = (t - t0)/(t1 - t0), m = n - 1.
   *
   *  dpsi/ds = A i A* = (w² + x² - y² - z², 2(wz + xy), 2(xz - wy)), so that |dpsi/ds| = |A|². A planar curve with the
   *  complex preimage a + ib, dpsi/ds = (a + ib)², has the quaternions (a, 0, 0, b).
   *
   *  start          [m] psi(t0).
   *  preimage, n    [m^1/2] 1 … 30 coefficients, at most 1e75 long; 3 make the usual quintics.
   *  t0, t1         the parameter range. It reparametrises, as that of a Bézier curve.
   *
   *  The curve is a polynomial of degree 2m + 1: the error is about 1e-16 of its size. Source: R. T. Farouki,
   *  "Pythagorean-Hodograph Curves", 2008. */
  CPROX_CURVE_PYTHAGOREAN_HODOGRAPH,
  /** Curves of any kinds but CPROX_CURVE_RECTIFIABLE end to end, as one curve.
   *
   *  curves, n       n >= 1 curves, in order; their pieces are copied.
   *  knots, n_knots  NULL: each curve keeps its own range, which must begin where the range before it ends. Else n + 1
   *                  ascending parameters: curve i runs over [knots[i], knots[i+1]], at a scaled speed.
   *  gap             [m] >= 0: the largest distance between the end of a curve and the beginning of the next. INFINITY:
   *                  the curve may jump, and both one-sided limits belong to it. 0: the curves must join as exactly as
   *                  their errors allow.
   *
   *  All pieces get the highest degree among them, which rounds their points. CPROX_INVALID names the joint that does
   *  not fit. */
  CPROX_CURVE_PIECEWISE,
  /** A smooth curve by functions of the caller, within K6 h^6/46080 of quintic pieces, K6 the bound of its sixth
   *  derivative.
   *
   *  smooth         the functions; they are called while the curve is made and never again.
   *  t0, t1         the parameter range. Ranges that need more than 65536 pieces are refused.
   *
   *  Intervals are as true as the stated bounds. The constructor detects a false bound, and names the parameter, where
   *  the middle of a piece is farther from its quintic than the bound allows. It does not detect a derivative that is
   *  larger than stated on a small part of a piece alone. Cost: two evaluations and a few bounds a piece.
   *  Source: doc/rounding.md, "Compiled curves". */
  CPROX_CURVE_SMOOTH,
  /** A curve that is known by its points and the lengths of its parts only; it need not be smooth.
   *
   *  rectifiable    the functions; the struct is copied, what it refers to is kept by reference.
   *  t0, t1         the parameter range.
   *
   *  A part of the curve lies in the ellipsoid whose foci are the ends of the part and whose axis is its length.
   *  Queries bound distances by these ellipsoids and need about ten times as many nodes. The degree is 0. There are no
   *  control points and no second derivative. Intervals are as true as the functions. Queries, and the constructor at
   *  65 parameters, detect a point that is not finite, and two points that are farther apart than the length between
   *  them: CPROX_INVALID, with the parameter. They cannot detect a length that is too small and yet longer than the
   *  chord. Source: A. Lakshmanan et al. 2019, Lemma 1 and Theorem 1; doc/rounding.md, "Ellipsoids". */
  CPROX_CURVE_RECTIFIABLE,
  /** A rational Bézier curve: psi(t) = sum_i w_i B_i^m(s) points[i] / sum_i w_i B_i^m(s), s = (t - t0)/(t1 - t0),
   *  m = n - 1. Degree 2 makes all conics: an arc of a circle is one of them.
   *
   *  points, n    [m] 2 … CPROX_MAX_DEGREE + 1 control points.
   *  weights      n positive numbers; the largest is at most 1e6 times the least.
   *  t0, t1       the parameter range, 1e-30 … 1e30 long. It reparametrises: the curve begins at t0 and ends at t1.
   *
   *  The pieces are quintics; the remainder is about 1e-13 of the size of the curve. The bound of the sixth derivative
   *  is that of the homogeneous control points. A quarter of a circle takes about 60 pieces. Ranges that need more than
   *  65536 pieces are refused. Source: doc/rounding.md, "Rational curves". */
  CPROX_CURVE_RATIONAL_BEZIER,
  /** A NURBS curve: a rational B-spline, restricted to [t0, t1].
   *
   *  points, n, degree, knots, n_knots, t0, t1   as of a B-spline; spans are 1e-30 … 1e30 long.
   *  weights                                     as of a rational Bézier curve. */
  CPROX_CURVE_NURBS,
  /** A part of a curve of any kind, at a pose: psi(t) = R curves[0](t) + x for t in [t0, t1].
   *
   *  curves, n    one curve, n = 1; its pieces are copied.
   *  t0, t1       inside the range of that curve. It restricts every kind: a point keeps its parameter.
   *  pose         NULL: none. R and x; CPROX_CURVE_RECTIFIABLE has none.
   *
   *  Cutting and turning cost a few roundings, which cprox_curve_info.error contains. Of a CPROX_CURVE_RECTIFIABLE it
   *  is a curve of that kind. */
  CPROX_CURVE_PART
} cprox_curve_kind;

/** The words of Dubins paths: left and right turns and straight lines. */
typedef enum cprox_dubins_word {
  /** the shortest of all */
  CPROX_DUBINS_SHORTEST,
  CPROX_DUBINS_LSL,
  CPROX_DUBINS_LSR,
  CPROX_DUBINS_RSL,
  CPROX_DUBINS_RSR,
  CPROX_DUBINS_RLR,
  CPROX_DUBINS_LRL
} cprox_dubins_word;

/** What a Dubins path consists of. */
typedef struct cprox_dubins_path {
  /** never CPROX_DUBINS_SHORTEST */
  cprox_dubins_word word;
  /** [m] the arc length at which each of its three parts ends; ends[2] is the length of the path */
  double ends[3];
} cprox_dubins_path;

/** Functions of a smooth curve: see CPROX_CURVE_SMOOTH. */
typedef struct cprox_smooth_curve {
  /** Writes psi(t), psi'(t), psi''(t) to jet[0], jet[1], jet[2]. What is not finite is refused, and t named. */
  void (*evaluate)(void *user, double t, cprox_vec3 jet[3]);
  /** Returns at least |psi^(6)| everywhere on [a, b], >= 0; it should be less on a part of it. INFINITY: the
   *  constructor asks about a part. */
  double (*sixth)(void *user, double a, double b);
  /** handed to both */
  void *user;
  /** >= 0: how far jet[k] may be from the exact derivative [m/(unit of t)^k] */
  double error[3];
  /** [m] > 0: the remainder to aim at; the number of pieces grows with its power of -1/6 */
  double accuracy;
} cprox_smooth_curve;

/** Functions of a curve of finite length: see CPROX_CURVE_RECTIFIABLE. Every query with the curve calls them, from its
 *  own thread; they must return the same value for the same arguments. */
typedef struct cprox_rectifiable_curve {
  /** Writes psi(t) [m]. */
  void (*point)(void *user, double t, cprox_vec3 *point);
  /** Returns at least the arc length [m] over [a, b], its own rounding included: in closed form the u_psi of Lemma 1,
   *  sqrt((b - a) times the integral of |psi'|²). NULL: the length is computed from the velocity. */
  double (*length)(void *user, double a, double b);
  /** Writes psi'(t) [m/(unit of t)]; used where `length` is NULL, and by cprox_curve_evaluate(). May be NULL beside a
   *  length. */
  void (*velocity)(void *user, double t, cprox_vec3 *velocity);
  /** handed to all three; it must live as long as the curve */
  void *user;
  /** [m] >= 0: how far a point may be from the exact one */
  double error;
  /** >= 0: how far a velocity may be from the exact one */
  double velocity_error;
  /** >= 0: the relative error of the integral of |psi'|² by the 15 points of Gauss and Kronrod, over any part of a
   *  64th of the range; 0 where |psi'|² is a polynomial of degree 22 or less */
  double quadrature_error;
} cprox_rectifiable_curve;

/** What a curve is made of. Set all members to 0, then those that the kind reads: cprox_curve_kind lists them. All
 *  numbers are finite. Arrays are copied. */
typedef struct cprox_curve_description {
  /** which members are read */
  cprox_curve_kind kind;
  /** of a Dubins path */
  cprox_dubins_word word;
  /** the start of the parameter range; not read for Dubins paths and piecewise curves */
  double t0;
  /** the end of the parameter range, above t0; not read where t0 is not */
  double t1;
  /** [m] control points, coefficients, or points to pass */
  const cprox_vec3 *points;
  /** one a point, for rational curves */
  const double *weights;
  /** quaternions, for Pythagorean-hodograph curves */
  const cprox_quat *preimage;
  /** curves to join, for piecewise curves; one, for a part */
  const cprox_curve *const *curves;
  /** the number of points, of quaternions, or of curves */
  size_t n;
  /** of a B-spline */
  size_t degree;
  /** knots of a B-spline, nodes of a Lagrange polynomial, or ends of the ranges of a piecewise curve */
  const double *knots;
  /** the number of knots, nodes or ends */
  size_t n_knots;
  /** [m] where planar curves and Pythagorean-hodograph curves start; the centre of an involute's circle */
  cprox_vec3 start;
  /** [m] the end of a Dubins path */
  cprox_vec3 end;
  /** [rad] about z, from x: at the start */
  double heading;
  /** [rad] about z, from x: at the end of a Dubins path */
  double end_heading;
  /** [1/m] of a clothoid at its start */
  double curvature;
  /** [1/m²] of a clothoid: the change of its curvature by arc length */
  double curvature_rate;
  /** [m] of the turns of a Dubins path, of the circle of an involute */
  double radius;
  /** [m] the largest distance between the curves of a piecewise curve */
  double gap;
  /** of a part; NULL: the identity */
  const cprox_pose *pose;
  /** functions of a smooth curve */
  const cprox_smooth_curve *smooth;
  /** functions of a curve that is known by its arc length */
  const cprox_rectifiable_curve *rectifiable;
} cprox_curve_description;

/** Makes a curve.
 *
 *  description  checked once; what is wrong, and where, stands in the error message of the workspace.
 *  workspace    may be NULL: then there is no error message.
 *  curve        receives the handle, owned by the caller: cprox_curve_free(). Untouched on failure.
 *
 *  Returns CPROX_OK, CPROX_INVALID or CPROX_MEMORY. */
CPROX_API cprox_status cprox_curve_create(const cprox_curve_description *description, cprox_workspace *workspace,
                                          cprox_curve **curve);

/** The weights of the coefficients at t: psi(t) = sum of weights[i] points[i].
 *
 *  description  of a Bézier curve, B-spline, polynomial, Legendre series, Lagrange polynomial, trigonometric series,
 *               rational Bézier curve or NURBS, as for cprox_curve_create(), but unchecked and without its points.
 *  weights      receives description->n numbers. Accuracy: a few n 2^-53 of the sum of |weights|.
 *
 *  Returns CPROX_INVALID for other kinds, and then writes nothing. With cprox_gradient.mover the weights are the
 *  derivatives of a distance by the coefficients. */
CPROX_API cprox_status cprox_curve_weights(const cprox_curve_description *description, double t, double *weights);

/** The derivatives of psi(t) by the numbers that define the curve beside its points: the columns of a Jacobian matrix.
 *
 *  description  as for cprox_curve_create(), but unchecked. columns receives, in this order:
 *    CPROX_CURVE_CLOTHOID               by heading, curvature, curvature_rate: 3 columns
 *    CPROX_CURVE_DUBINS                 by heading, end_heading, radius, start.x, start.y, end.x, end.y: 7. The word
 *                                       is kept. At the end of the path, psi(t) is the end point, which moves with it.
 *    CPROX_CURVE_INVOLUTE               by heading, radius: 2
 *    CPROX_CURVE_PYTHAGOREAN_HODOGRAPH  by w, x, y, z of preimage[0], of preimage[1], …: 4 n
 *    CPROX_CURVE_RATIONAL_BEZIER, _NURBS  by the weights: n
 *  t            held fixed, in the range of the curve.
 *
 *  By `start`, where a column does not stand for it, the derivative is 1: all of the curve moves with it.
 *  With cprox_gradient.mover n, at its t, the derivatives of a distance are n · columns[i] (J. M. Danskin, 1967). Those
 *  by the range of t are cprox_gradient.t0 and t1. Accuracy: about 1e-13 of the size of the largest column.
 *
 *  Returns CPROX_OK. CPROX_INVALID for other kinds, for t that is not finite, for a clothoid that turns too often
 *  between 0 and t, and for a Dubins path that does not exist or has no derivative (its circles coincide or touch).
 *  Then it writes nothing.
 *  Cost: O(n²) for a preimage, O(n degree) for weights, O(turns) for a clothoid. Source: doc/curve-bound.md,
 *  "By what defines a curve". */
CPROX_API cprox_status cprox_curve_jacobian(const cprox_curve_description *description, double t, cprox_vec3 *columns);

/** Frees a curve; NULL is allowed. No query may be using it. */
CPROX_API void cprox_curve_free(cprox_curve *curve);

/** What is known of a curve. */
typedef struct cprox_curve_info {
  /** the kind that the curve was created as */
  cprox_curve_kind kind;
  /** the start of the parameter range */
  double t0;
  /** the end of the parameter range */
  double t1;
  /** of the polynomial pieces; 0 for a curve that is known by its arc length */
  size_t degree;
  /** the number of polynomial pieces */
  size_t n_pieces;
  /** [m] how far the curve as it was given may be from its computed pieces, at most: the rounding of their conversion,
   *  and of a compiled curve the remainder. 0 for a Bézier curve. Every interval contains it. */
  double error;
  /** [m] the lowest corner of an axis-aligned box that contains the curve, rounding included */
  cprox_vec3 lowest;
  /** [m] the highest corner of that box */
  cprox_vec3 highest;
  /** what a Dubins path consists of; zeros for other kinds */
  cprox_dubins_path dubins;
} cprox_curve_info;

/** What is known of a curve. Cost: O(pieces degree), for the box. */
CPROX_API cprox_curve_info cprox_curve_get_info(const cprox_curve *curve);

/** psi(t), and its first and second derivative by t, each NULL if not needed.
 *
 *  t          inside [t0, t1], else CPROX_INVALID. At a joint of two pieces the right one answers (the left one at t1).
 *  Accuracy:  the point is within (6 degree + 20) 2^-53 max|control point| of the exact one, on a B-spline within
 *             (12 degree + 20), on the other bases within cprox_curve_info.error more: a plain evaluation for drawing
 *             and sampling. Certified answers come from the queries.
 */
CPROX_API cprox_status cprox_curve_evaluate(const cprox_curve *curve, double t, cprox_workspace *workspace,
                                            cprox_vec3 *point, cprox_vec3 *derivative, cprox_vec3 *second_derivative);

/** The Bézier control points of the curve restricted to [a, b], which must lie within one polynomial piece.
 *
 *  points     receives cprox_curve_info.degree + 1 control points [m]; of a whole piece without rounding.
 *  CPROX_INVALID if a >= b, if [a, b] leaves the domain, or if a joint lies strictly inside it.
 */
CPROX_API cprox_status cprox_curve_control_points(const cprox_curve *curve, double a, double b,
                                                  cprox_workspace *workspace, cprox_vec3 *points);

/** An ellipsoid of revolution: all x with |x - foci[0]| + |x - foci[1]| <= axis. */
typedef struct cprox_curve_ellipsoid {
  /** [m] the ends of the part, as they are computed */
  cprox_vec3 foci[2];
  /** [m] at least the arc length of the part, and what its ends may be off */
  double axis;
  /** [m] half the minor axis: the ellipsoid lies within this of the segment between the foci */
  double radius;
} cprox_curve_ellipsoid;

/** An ellipsoid that contains the curve's points over [a, b] (Lakshmanan et al. 2019, Theorem 1).
 *
 *  The axis is a bound of the arc length: of a curve that is known by its arc length what its function says, or u_psi
 * of Lemma 1; of any other the length of its control polygon. Hulls of control points are smaller: queries use those
 * where there are any. CPROX_INVALID if a >= b, if [a, b] leaves the domain, or where a function of the curve fails. */
CPROX_API cprox_status cprox_curve_get_ellipsoid(const cprox_curve *curve, double a, double b,
                                                 cprox_workspace *workspace, cprox_curve_ellipsoid *ellipsoid);

/** What is known of one polynomial piece of a curve. */
typedef struct cprox_curve_piece_info {
  /** the start of the piece */
  double t0;
  /** the end of the piece */
  double t1;
  /** [m] how far the curve as it was given may be from the computed piece, at most */
  double error;
  /** [m] the lowest corner of an axis-aligned box that contains the piece, rounding included */
  cprox_vec3 lowest;
  /** [m] the highest corner of that box */
  cprox_vec3 highest;
} cprox_curve_piece_info;

/** What is known of one polynomial piece: 0 <= piece < cprox_curve_info.n_pieces, in the order of the parameter. */
CPROX_API cprox_curve_piece_info cprox_curve_get_piece_info(const cprox_curve *curve, size_t piece);

#ifdef __cplusplus
}
#endif
#endif
