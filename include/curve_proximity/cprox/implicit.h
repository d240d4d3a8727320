/* SPDX-License-Identifier: BSD-3-Clause */
/** Implicit bodies: superquadrics, hyperquadrics, quadrics, planes and their intersections, under any invertible affine
 *  map.
 *
 *  They are bodies like any other (movers, obstacles, compounds, pairs).
 *  Source: Chakraborty, Peng, Akella and Mitchell 2008, as doc/implicit.md carries it out. */
#ifndef CURVE_PROXIMITY_CPROX_IMPLICIT_H
#define CURVE_PROXIMITY_CPROX_IMPLICIT_H

#include <curve_proximity/cprox/base.h>
#include <curve_proximity/cprox/body.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The superquadric sum |x_i/semi_axis_i|^exponent_i <= 1 about the origin.
 *
 *  semi_axes  [m] between 1e-12 and 1e10, the largest at most 1e9 times the least
 *  exponents  1 (a corner) … 2 (round) … 1000 (all but a box)
 */
CPROX_API cprox_status cprox_body_create_superquadric(cprox_vec3 semi_axes, cprox_vec3 exponents,
                                                      cprox_workspace *workspace, cprox_body **body);

/** The set sum over its terms of |a x + b y + c z + d|^exponent <= 1. */
typedef struct cprox_hyperquadric {
  /** each a, b, c [1/m], d, exponent (1 … 1000); a, b, c not all 0 */
  const double (*terms)[5];
  /** 1 … 64 */
  size_t n_terms;
} cprox_hyperquadric;

/** The intersection of what is listed, or another body deformed; each array NULL where its count is 0. At most 1024
 *  constraints and terms in all. Set all members to 0, then those that are needed. */
typedef struct cprox_implicit_description {
  /** Hyperquadrics, or NULL. */
  const cprox_hyperquadric *hyperquadrics;
  /** Their number. */
  size_t n_hyperquadrics;
  /** each b1, b2, b3, c: b·x + c <= 0 */
  const double (*planes)[4];
  /** The number of planes. */
  size_t n_planes;
  /** each q11, q12, q13, q22, q23, q33, b1, b2, b3, c: x'Qx + b·x + c <= 0, Q symmetric (x'Qx counts q12, q13, q23
   *  twice) and positive semidefinite */
  const double (*quadrics)[10];
  /** The number of quadrics. */
  size_t n_quadrics;
  /** NULL, or the superquadric or implicit body of whose constraints the set is made; then none is listed. Cheaper than
   *  making the body anew: what a map does to centre and size is known. For bodies that deform from query to query. */
  const cprox_body *deformed;
  /** of the deformed body: one for each term in the order of its description (a superquadric's x, y, z), 1 … 1000;
   *  NULL: as they are */
  const double *exponents;
  /** The number of exponents, that of the body's terms. */
  size_t n_exponents;
} cprox_implicit_description;

/** The map x -> linear x + translation: rotation, scale, shear. */
typedef struct cprox_affine {
  /** row-major, determinant not 0 */
  double linear[9];
  /** [m] added after the linear part. */
  cprox_vec3 translation;
} cprox_affine;

/** The image of the described set under a map (NULL: the set itself), which works in the frame of the body.
 *
 *  The set must be bounded (within 1e10 m of the origin) and have an interior (a ball of 1e-9 of its size). The map is
 *  applied to the coefficients in twice the precision of double; the body is that of the coefficients so rounded.
 *  CPROX_INVALID names the plane, quadric or term that is at fault: not finite, an exponent below 1, not positive
 *  semidefinite, out of range; an empty interior; an unbounded set and the axis along which it is; a singular map. */
CPROX_API cprox_status cprox_body_create_implicit(const cprox_implicit_description *description,
                                                  const cprox_affine *map, cprox_workspace *workspace,
                                                  cprox_body **body);

/** Evaluates a convex function f at point[3]: returns its value, and writes its gradient and its Hessian (xx, xy, xz,
 *  yy, yz, zz). In the plane z is 0, and what is written for z is not read. */
typedef double (*cprox_convex_fn)(const void *user, const double point[3], double gradient[3], double hessian[6]);

/** The convex body of all x with f(x) <= 0. */
typedef struct cprox_convex_function {
  /** f: convex and twice continuously differentiable within the radius; values in any unit */
  cprox_convex_fn evaluate;
  /** handed to `evaluate`, kept by reference: must outlive the body */
  const void *user;
  /** [m] a point with f < 0 */
  cprox_vec3 interior;
  /** [m] the body lies within it of the interior point, > 0 */
  double radius;
  /** how far a value may be from f, in its unit, >= 0 */
  double error;
  /** f is a function of x and y, and the body is flat, at z = 0 */
  bool planar;
} cprox_convex_function;

/** A convex body that is known by its function alone, enlarged by a margin [m] >= 0. A body of kind CPROX_BODY_SUPPORT.
 *
 *  Answers are certified for a convex f with the gradient that it is said to have, relative to `error`: each support
 *  point lies inside, and a tangent of f proves how much it may be short of the farthest one. That is measured when the
 *  body is made, at most 1e-6 of the radius, and widens every interval; a wrong Hessian costs time alone.
 *  CPROX_INVALID: f >= 0 at the interior point; f <= 0 at the radius; a value that is not finite; 97 places of which
 * one lies below the tangent of another, which are named. The same in a query: CPROX_INVALID. What no sample shows is
 * not caught. Cost: about 100 values of f a support point. Thread safety: as the callback's. Source: doc/implicit.md.
 */
CPROX_API cprox_status cprox_body_create_convex_function(const cprox_convex_function *function, double margin,
                                                         cprox_workspace *workspace, cprox_body **body);

#ifdef __cplusplus
}
#endif
#endif
