/* SPDX-License-Identifier: BSD-3-Clause */
/* Newton's method on the distance along one piece, with the nearest feature of the body held fixed between
 * measurements. */
#ifndef CPROX_CURVE_QUERY_NEWTON_CONVEX_H
#define CPROX_CURVE_QUERY_NEWTON_CONVEX_H

#include "curve_query/curve_convex.h"

/* A point of the piece and its derivatives by s. */
typedef struct curve_jet {
  vec3 x, d1, d2;
} curve_jet;

/* At s of the loaded root piece `points`. */
curve_jet newton_jet(const curve_convex *o, const double *points, double s);

/* Improves o->best, which must lie on the loaded root piece `points`, in steps of at most `step` of the piece's
 * parameter. It only ever replaces the best point by a measured better one: where Newton fails, nothing is lost. *jet
 * is the one there. */
cprox_status newton_refine(curve_convex *o, const double *points, curve_jet *jet, double step);

#endif
