/* SPDX-License-Identifier: BSD-3-Clause */
/* The constants of the rounding analysis in doc/rounding.md; every slack in the core is one of these times a size. */
#ifndef CPROX_BASE_ROUNDING_H
#define CPROX_BASE_ROUNDING_H

/* Unit roundoff of double, round to nearest: u = 2^-53. */
#define ROUND_U 1.1102230246251565e-16

/* Covers the second-order terms of every first-order bound written here, and the rounding of the slack itself. */
#define ROUND_UP 1.000000001

/* |R(q) - computed R(q)| and the product with a vector: per unit of |v| (doc/rounding.md, T3). */
#define ROUND_ROTATION 26.0

/* A computed support value of a convex core in its own frame, for a direction of norm 1: per unit of its scale. */
#define ROUND_SUPPORT 8.0

/* Counts that recur, rounded up to a power of two, of all lengths that enter; doc/rounding.md, Counts that recur. */
#define ROUND_LENGTH 8.0   /* the norm of a difference, and a few operations with it */
#define ROUND_BALLS 64.0   /* a distance of bounding spheres, of boxes round them or from a chord */
#define ROUND_NORMAL 4.0   /* n counts as a unit vector where |n|² is so near to 1 */
#define ROUND_TOWARDS 8.0  /* the part of a velocity along a normal, of the speed */
#define ROUND_WITNESS 16.0 /* a distance of two witness points, one of them turned and moved */

/* No length that takes part in a query is longer [m]: the searches multiply up to four of them. */
#define LENGTH_MOST 1e60

#endif
