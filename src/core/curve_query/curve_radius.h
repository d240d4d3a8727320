/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball whose radius changes along its curve against one convex body. doc/curve-bound.md derives it. */
#ifndef CPROX_CURVE_QUERY_CURVE_RADIUS_H
#define CPROX_CURVE_QUERY_CURVE_RADIUS_H

#include "curve_query/curve_convex.h"

typedef struct curve_radius {
  curve_convex base; /* measures the ball at a parameter; its offset is that of the last measurement */
  cprox_curve centres, radii;
  curve_side radius; /* along `radii`, whose pieces are those of base.side */
  double offset;     /* what does not change: the margin of the body, and the constant part of the radius */
} curve_radius;

/* Takes over a base that is ready, with the curves along which it runs: both are aligned, relative_curve.h. */
void curve_radius_begin(curve_radius *o, const cprox_curve *centres, const cprox_curve *radii);

search_node curve_radius_root(const curve_radius *o);
search_oracle curve_radius_oracle(curve_radius *o);

#endif
