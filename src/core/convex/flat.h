/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes without an inside: where they lie, and what of their plane they certainly cover. */
#ifndef CPROX_CONVEX_FLAT_H
#define CPROX_CONVEX_FLAT_H

#include "convex/convex.h"

/* The plane in which a core lies but for `thickness` on either side; e, f and normal are orthonormal. */
typedef struct flat_shape {
  vec3 origin, e, f, normal;
  int dimension; /* 0, 1, 2; 3: it has an inside, and the rest says nothing */
  double thickness;
} flat_shape;

/* By a dozen supports. */
void flat_describe(const convex *shape, flat_shape *flat);

enum { FLAT_MOST_CORNERS = 64 };

/* Points of the core, each by its place along e and f, in the order in which they surround a region of the plane that
 * the core covers. */
typedef struct flat_region {
  double x[FLAT_MOST_CORNERS], y[FLAT_MOST_CORNERS];
  int n;
  double thickness; /* all are as near to the plane as this, rounding included */
} flat_region;

void flat_region_begin(const convex *shape, const flat_shape *flat, flat_region *region);

/* Whether the core certainly covers the hull of n points of the plane, each known but for `room`. The region grows
 * where that helps. */
bool flat_region_covers(const convex *shape, const flat_shape *flat, flat_region *region, const double *x,
                        const double *y, size_t n, double room);

#endif
