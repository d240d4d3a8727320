/* SPDX-License-Identifier: BSD-3-Clause */
/* Few vertices of a polyhedron, about which the others lie closely. */
#ifndef CPROX_CONVEX_FEW_POINTS_H
#define CPROX_CONVEX_FEW_POINTS_H

#include "convex/convex.h"

enum { FEW_POINTS_MOST = 48 };

typedef struct few_points {
  double left;   /* all vertices are within this of the hull of these points; from above */
  double radius; /* the largest distance of a vertex from the origin */
  size_t n;
  vec3 point[];
} few_points;

/* Of a polytope by its vertices. The caller frees it; NULL: memory is out. */
few_points *few_points_of(const convex *polytope);

#endif
