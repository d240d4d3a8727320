/* SPDX-License-Identifier: BSD-3-Clause */
/** Two convex bodies that move without turning, each at a constant velocity: how close they come, and when they first
 *  touch; and the least scaling at which two bodies touch.
 *
 *  Along polylines and splines a body is carried by cprox_body_along(). Source: Chakraborty et al. 2008, Eq. 13 and 14,
 *  by the methods of doc/implicit.md. */
#ifndef CURVE_PROXIMITY_CPROX_TRANSLATION_H
#define CURVE_PROXIMITY_CPROX_TRANSLATION_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A body that starts at the obstacle's pose and moves on at the velocity [m/s], world frame. */
typedef struct cprox_translating {
  /** The body at time 0. */
  cprox_obstacle from;
  /** [m/s] world frame. */
  cprox_vec3 velocity;
} cprox_translating;

/** The least distance over the times 0 … duration [s], duration > 0, of two convex bodies (no compounds).
 *
 *  lower <= the least distance <= upper; t: when upper was attained; the points stand where the bodies are then. 0
 *  where they touch or overlap at some time: verdict violated where a common point is proven, clear where lower > 0.
 *  Returns as cprox_pair(), and CPROX_INVALID for other kinds of bodies. Cost: of superquadrics and implicit bodies one
 *  interior point search; of other kinds about ten pairs. */
CPROX_API cprox_status cprox_translating_distance(cprox_translating a, cprox_translating b, double duration,
                                                  const cprox_options *options, cprox_workspace *workspace,
                                                  cprox_result *result);

/** When two convex bodies (no compounds) that translate first touch.
 *
 *  t_contact_lower  no contact at any time < t_contact_lower, certified
 *  verdict          violated: a common point at t is proven, the time of contact lies in [t_contact_lower, t].
 *                   clear: they do not touch up to the duration. undecided: contact is not proven; at
 *                   t = t_contact_lower the distance is at most epsilon [m], unless the status is not CPROX_OK.
 *  lower, upper, points: of the signed distance at t, as in cprox_pair(). Where contact is found on the way upper = 0,
 *  both points are a common one, and lower is no more than a bound. Where they overlap already at 0: t =
 *  t_contact_lower = 0. Returns as cprox_pair(). Cost: about four pairs; of two superquadrics
 *  about two. */
CPROX_API cprox_status cprox_translating_contact(cprox_translating a, cprox_translating b, double duration,
                                                 const cprox_options *options, cprox_workspace *workspace,
                                                 cprox_result *result);

/** The growth distance: the least factor by which both bodies, each scaled about its centre, touch. */
typedef struct cprox_growth {
  /** As the call returned it. */
  cprox_status status;
  /** certified: not above the true value; > 1 apart, < 1 overlapping, 0 where the centres coincide */
  double lower;
  /** certified: not below the true value */
  double upper;
  /** unit, world frame, from b to a, of the planes between which the scaled bodies just fit */
  cprox_vec3 normal;
  /** what it cost: pairs of bodies answered */
  uint32_t pairs;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_growth;

/** The growth distance of two convex bodies, to a relative width of options->epsilon (default 1e-6). Each is bounded
 * and has its centre inside (a polytope's: the middle of its box).
 *
 *  It measures penetration where there is some: the bodies overlap if and only if it is below 1. The centre is that of
 *  cprox_body_get_info(); margin is not scaled and must be 0. Returns as cprox_pair(). */
CPROX_API cprox_status cprox_growth_distance(cprox_obstacle a, cprox_obstacle b, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_growth *growth);

/** The derivatives of a growth distance by the poses of both bodies. Those by rotations are by a small rotation vector
 *  w that turns the body about its position, world axes: R becomes exp([w]) R. */
typedef struct cprox_growth_derivatives {
  /** the growth distance is differentiable here; false: it is not, or cannot be told to be. The reason is in the
   *  workspace; the numbers are those of one of the optima, or 0 */
  bool valid;
  /** it is differentiable by positions, at least: the bodies may touch in more than one point, as with faces that are
   *  parallel */
  bool valid_position;
  /** hessian is known */
  bool bends;
  /** [1/m] by the position of a, world axes */
  cprox_vec3 a_position;
  /** [1/rad] */
  cprox_vec3 a_rotation;
  /** [1/m] by the position of b: minus a_position */
  cprox_vec3 b_position;
  /** [1/rad] */
  cprox_vec3 b_rotation;
  /** where the scaled bodies touch, world frame; NaN where that is not known */
  cprox_vec3 touch;
  /** [1/m²] the second derivative by the position of a, or of b, world axes: xx, xy, xz, yy, yz, zz; minus that by one
   *  of each. Else NaN */
  double hessian[6];
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_growth_derivatives;

/** The growth distance and its derivatives, by one search. They are as smooth in contact and deep inside as apart.
 *
 *  growth       receives what cprox_growth_distance() answers.
 *  derivatives  by the envelope theorem: with the plane between the scaled bodies, and the point where they touch.
 *
 *  valid is false
 *    where the bodies touch in more than one point: both are flat there along one direction (faces that are parallel,
 *    an edge along a face). Flat is what moves its extreme point by more than 1e-3 sizes as the normal turns by
 *    1e-5 rad,
 *    where more than one plane fits between them (an edge on an edge that is parallel, a corner on a corner, and where
 *    the nearest of two faces changes): turned by 1e-5 rad a plane bounds the growth as well within 2e-14,
 *    where the centres coincide, and where the optimum was not found narrowly enough.
 *  The derivatives are exact but for rounding. Faces of superquadrics that are all but flat leave an error of 1e-5.
 *  The support functions of implicit bodies of more than one constraint come from a solver, which leaves 1e-4; those
 *  and callbacks have no hessian, and count as flat by 0.1 sizes and 1e-3 rad.
 *
 *  Along a motion the derivative by time is a_position·v + a_rotation·w for the velocity v and the angular velocity w
 *  of a, and likewise for b.
 *
 *  Returns as cprox_growth_distance(), also where valid is false. Cost: 1.2 to 1.8 growth distances
 *  (doc/implicit.md, Growth distance). */
CPROX_API cprox_status cprox_growth_gradient(cprox_obstacle a, cprox_obstacle b, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_growth *growth,
                                             cprox_growth_derivatives *derivatives);

/** The least growth distance of a body that a curve carries without turning it, from one that stands.
 *
 *  a            its pose is relative to the curve's point; its orientation stays.
 *  curve        any curve. It may be freed once the call has returned.
 *  growth       lower <= the least growth distance along the curve <= upper; to a relative width of options->epsilon,
 *               or 1e-3 of that where the value is below 1e-3. normal and upper are of the place at *t; pairs: places
 *               that were measured.
 *  t            receives the curve's parameter where `upper` was measured.
 *  derivatives  NULL, or receives those at the minimiser, by the envelope theorem. a_position is by the curve's point
 *               at *t (by a coefficient of the curve: its weight there, cprox_curve_weights(), times that), a_rotation
 *               by a turn of a about its position. valid is false also where the value is as small elsewhere, within
 *               1e-9 of itself, and along curves that are known by their arc length (CPROX_CURVE_RECTIFIABLE).
 *
 *  Both bodies as in cprox_growth_distance(). Returns as cprox_distance(): CPROX_BUDGET after options->max_nodes nodes
 *  and places, CPROX_STOPPED, CPROX_PRECISION. Cost: 10 to 40 growth distances, with derivatives 30 to 100
 *  (doc/implicit.md, Growth distance). */
CPROX_API cprox_status cprox_growth_along(cprox_obstacle a, const cprox_curve *curve, cprox_obstacle b,
                                          const cprox_options *options, cprox_workspace *workspace,
                                          cprox_growth *growth, double *t, cprox_growth_derivatives *derivatives);

#ifdef __cplusplus
}
#endif
#endif
