/* SPDX-License-Identifier: BSD-3-Clause */
/* How deep a point is inside a shape whose nearest() only proves that it is inside. */
#ifndef CPROX_CONVEX_DEPTH_H
#define CPROX_CONVEX_DEPTH_H

#include "convex/convex.h"
#include "convex/pair.h"

/* Signed distance of y, as nearest() would give it if it could: minus a depth that is proven and within `width` of the
 * true one, the normal of the nearest way out. Where rounding hides all depth the distance is 0. */
void depth_of_point(const convex *shape, vec3 y, double width, convex_near *near);

/* A depth of y that is proven, where the search by simplices could not tell; 0 where none is. */
double depth_proven(const convex *shape, vec3 y);

/* near(), completed: where it only proves that y is inside, or cannot tell, the nearest point of the surface. A plain
 * evaluation, within near_rounding of the kind for polytopes; it allocates memory for those of many vertices. */
void depth_complete(const convex *shape, vec3 y, convex_near *near);

/* How the distance near y behaves, from what its nearest point lies on; near's point, normal and distance are known. */
void depth_describe(const pair_feature *feature, double margin, vec3 y, convex_near *near);

#endif
