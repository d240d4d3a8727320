/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex sets about their centres, in doubles: how far they reach. */
#ifndef CHECK_SPAN_H
#define CHECK_SPAN_H

#include "ball.h"
#include "problem.h"

/* max n·x over the set about its centre, without margin; a halfspace only along its own normal. */
num span_along(const set *s, double radius, const vec *n);

/* No point is farther from the centre; a halfspace: the distance of its plane. */
double span_radius(const set *s);

/* A box round it, or of what is rounded by a ball (spheres, capsules, hulls with an excess) round the rest; only to
 * choose by. */
void span_box(const set *s, double middle[3], double half[3]);

#endif
