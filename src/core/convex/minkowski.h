/* SPDX-License-Identifier: BSD-3-Clause */
/* The Minkowski difference of a shape that stands and one that is carried along without turning: a point of the curve
 * is as far from it as the carried shape, put there, is from the standing one. */
#ifndef CPROX_CONVEX_MINKOWSKI_H
#define CPROX_CONVEX_MINKOWSKI_H

#include "convex/convex.h"

/* Makes the difference in the standing shape's frame, where r turns the carried one, each about its own origin. It
 * keeps both by reference. `turned`: r is not exactly the identity. `carried` is no halfspace and no ball; false where
 * its support callback misbehaved. */
bool minkowski_make(const convex *standing, const convex *carried, const double r[9], bool turned, convex *difference);

#endif
