/* SPDX-License-Identifier: BSD-3-Clause */
/* The growth distance of two bodies, for callers that ask it at many places. */
#ifndef CPROX_NARROWPHASE_GROWTH_H
#define CPROX_NARROWPHASE_GROWTH_H

#include "convex/ray.h"
#include "curve_proximity/cprox/translation.h"
#include "narrowphase/relative_pose.h"

/* Centres that are as near, in sizes of the bodies, coincide. */
#define GROWING_COINCIDE 1e-12

/* The radius of a ball about the origin that lies in a bounded shape; 0: none is known. */
double growing_inner_radius(const convex *shape);

/* Why the optimum has no gradient; NULL where it has one. */
const char *growing_tie(const ray_answer *ray);

/* Two bodies that grow. */
typedef struct growing {
  cprox_obstacle a, b;
  cprox_options asked;
  pair_side x, y;
  pair_placement place;
  double inner_a, inner_b; /* radii of balls about the centres that lie in the bodies, > 0 */
} growing;

/* Checks the bodies and the options, and places them. CPROX_OK or a negative status. */
cprox_status growing_begin(growing *g, const cprox_options *options, cprox_workspace *workspace);

/* To be called after the poses of a or b have changed. */
void growing_place(growing *g);

/* The value, by the ray where that is as narrow as asked for, else by pairs; *ray says whether the ray was found, and
 * its derivatives where they are wanted. A status of growth, or a negative one. */
cprox_status growing_measure(const growing *g, bool wants_derivatives, cprox_workspace *workspace, cprox_growth *growth,
                             ray_answer *ray);

/* The derivatives of a measured value. Why there is no gradient, NULL where there is one. */
const char *growing_differentiate(const growing *g, const cprox_growth *growth, const ray_answer *ray,
                                  cprox_growth_derivatives *derivatives);

#endif
