/* SPDX-License-Identifier: BSD-3-Clause */
/* What eight capsules of a curve's tree say at once, in vector registers. */
#ifndef CPROX_CURVE_PACK_H
#define CPROX_CURVE_PACK_H

#include "curve/curve.h"

/* How far each reaches along n: the least n·(x - from) over a capsule. Of a lane without pieces it means nothing. */
void curve_pack_reach(const curve_pack *pack, vec3 n, vec3 from, double least[CURVE_PACK]);

/* Which of the lanes [first, end), whose first has pieces, has the chord that is nearest to a point, but for rounding, and where on that
 * chord, from 0 to 1. */
size_t curve_pack_nearest(const curve_pack *pack, size_t first, size_t end, vec3 point, double *along);

#endif
