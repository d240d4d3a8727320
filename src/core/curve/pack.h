/* SPDX-License-Identifier: BSD-3-Clause */
/* What eight capsules of a curve's tree say at once, in vector registers. */
#ifndef CPROX_CURVE_PACK_H
#define CPROX_CURVE_PACK_H

#include "curve/curve.h"

/* Eight capsules of the tree, one array a number. */
typedef struct curve_pack {
  double ax[CURVE_PACK], ay[CURVE_PACK], az[CURVE_PACK], bx[CURVE_PACK], by[CURVE_PACK], bz[CURVE_PACK];
  double radius[CURVE_PACK];
} curve_pack;

/* Those of the nodes from `first` on, n <= CURVE_PACK; the other lanes repeat the last one. */
void curve_pack_fill(const cprox_curve *c, size_t first, size_t n, curve_pack *pack);

/* How far each reaches along n: the least n·(x - from) over a capsule. */
void curve_pack_reach(const curve_pack *pack, vec3 n, vec3 from, double least[CURVE_PACK]);

/* How far each chord is from from + to, and where on it that is, 0 … 1: the distance is that of a point of the chord,
 * so that it is not below the least one but for rounding, and s is within rounding of the best. */
void curve_pack_distance(const curve_pack *pack, vec3 from, vec3 to, double distance[CURVE_PACK], double s[CURVE_PACK]);

#endif
