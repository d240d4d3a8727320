/* SPDX-License-Identifier: BSD-3-Clause */
/* A radius that changes along a curve: the first coordinate of another curve at the same parameter. */
#ifndef CPROX_PROBLEM_RADIUS_H
#define CPROX_PROBLEM_RADIUS_H

#include "curve/curve.h"
#include "curve_proximity/cprox/query.h"

/* Whether the radius of either changes. */
static inline bool radius_changes(const cprox_mover *mover, const cprox_obstacle *target) {
  return mover->radius_curve || (target && target->radius_curve);
}

/* CPROX_OK, or CPROX_INVALID with an error message that `whose` begins: its parameters are those of `curve`, and with
 * `constant` added it is never negative. */
cprox_status radius_check(const char *whose, const cprox_curve *radius, double constant, const cprox_curve *curve,
                          cprox_workspace *workspace);

/* It is never larger than this; 0 where there is none. */
double radius_most(const cprox_curve *radius);

/* What it is at t, of the piece before a joint if from_left is set; 0 where there is none. */
double radius_at(const cprox_curve *radius, double t, bool from_left, cprox_workspace *workspace);

#endif
