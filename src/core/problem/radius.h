/* SPDX-License-Identifier: BSD-3-Clause */
/* A radius that changes along a curve: the first coordinate of another curve at the same parameter. */
#ifndef CPROX_PROBLEM_RADIUS_H
#define CPROX_PROBLEM_RADIUS_H

#include "curve/curve.h"
#include "curve_proximity/cprox/query.h"
#include "problem/validate.h"

/* Whether the radius of either changes. */
static inline bool radius_changes(const cprox_mover *mover, const cprox_obstacle *obstacle) {
  return mover->radius_curve || (obstacle && obstacle->radius_curve);
}

/* Checks the mover's radius, which changes (obstacle NULL), or what radii that change ask of an obstacle: the query
 * knows them, their parameters are those of the curve, and they are never negative. CPROX_OK, or CPROX_INVALID with an
 * error message. */
cprox_status radius_check(const cprox_mover *mover, const cprox_obstacle *obstacle, size_t index, arguments_query asked,
                          cprox_workspace *workspace);

/* It is never larger than this; 0 where there is none. */
static inline double radius_most(const cprox_curve *radius) {
  if (!radius) return 0.0;
  const curve_capsule whole = curve_whole(radius), *all = &whole;
  return ROUND_UP * (fmax(fabs(all->a.x), fabs(all->b.x)) + all->radius);
}

/* What it is at t, of the piece before a joint if from_left is set; 0 where there is none. */
double radius_at(const cprox_curve *radius, double t, bool from_left, cprox_workspace *workspace);

#endif
