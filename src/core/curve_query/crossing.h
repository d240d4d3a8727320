/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve that passes through a body without an inside: no point of it need be a double. Its two sides prove it.
 * doc/curve-bound.md. */
#ifndef CPROX_CURVE_QUERY_CROSSING_H
#define CPROX_CURVE_QUERY_CROSSING_H

#include "curve_query/curve_convex.h"

/* Whether the curve certainly passes through the body near a sight, which then becomes that of the place: sight->s is a parameter
 * before which, or at which, they have met, sight->y the point where they meet but for rounding. False also of bodies that have an
 * inside. */
bool crossing_prove(curve_convex *o, curve_sight *sight);

#endif
