/* SPDX-License-Identifier: BSD-3-Clause */
/* What eight capsules of a curve's tree say at once, in vector registers. */
#ifndef CPROX_CURVE_PACK_H
#define CPROX_CURVE_PACK_H

#include "curve/curve.h"

/* How far each reaches along n: the least n·(x - from) over a capsule. Of a lane without pieces it means nothing. */
void curve_pack_reach(const curve_pack *pack, vec3 n, vec3 from, double least[CURVE_PACK]);

/* How far each chord is from from + to, and where on it that is, 0 … 1: the distance is that of a point of the chord,
 * so that it is not below the least one but for rounding, and s is within rounding of the best. */
void curve_pack_distance(const curve_pack *pack, vec3 from, vec3 to, double distance[CURVE_PACK], double s[CURVE_PACK]);

#endif
