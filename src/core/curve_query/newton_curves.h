/* SPDX-License-Identifier: BSD-3-Clause */
/* Where two curves, or their chords, come closest: suggestions only, no bound rests on them. */
#ifndef CPROX_CURVE_QUERY_NEWTON_CURVES_H
#define CPROX_CURVE_QUERY_NEWTON_CURVES_H

#include "curve_query/curve_curve.h"

/* The nearest points of two segments as fractions of them, and the unit direction from the second to the first; where
 * the segments meet, one that is orthogonal to both, or (0,0,0). */
vec3 newton_curves_of_chords(const vec3 first[2], const vec3 second[2], double fraction[2]);

/* Newton on |x(s) - y(t)|²/2 over the pieces of the meeting, which must be the loaded ones, in steps of at most `step`.
 * Moves the meeting's points and parameters; false where they did not move. Where a body is carried, `shift` is not
 * NULL, and it is the distance of x(s) - y(t) + shift from the feature of meeting->near; where the first side has a
 * radius, |x(s) - y(t)| or that less the radius. */
bool newton_curves_descend(curve_side side[2], const vec3 *shift, curve_meeting *meeting, double step);

#endif
