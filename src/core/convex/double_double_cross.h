/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic in sums of two doubles (Dekker 1971), for the few places where a rounding error outweighs the result. */
#ifndef CPROX_CONVEX_DOUBLE_DOUBLE_CROSS_H
#define CPROX_CONVEX_DOUBLE_DOUBLE_CROSS_H

#include "base/vec.h"

/* (p - corner) x (q - corner), or its opposite: the normal of a triangle, each component within a few u of itself and
 * u² of the product of the edges. */
vec3 double_double_cross(vec3 corner, vec3 p, vec3 q);

#endif
