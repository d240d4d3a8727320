/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/pack.h"

#include "simd/dispatch.h"

void curve_pack_fill(const cprox_curve *c, size_t first, size_t n, curve_pack *pack) {
  for (size_t k = 0; k < CURVE_PACK; k++) {
    const size_t node = first + (k < n ? k : n - 1);
    const curve_ends ends = curve_ends_at(c, node);
    pack->ax[k] = ends.a->x, pack->ay[k] = ends.a->y, pack->az[k] = ends.a->z;
    pack->bx[k] = ends.b->x, pack->by[k] = ends.b->y, pack->bz[k] = ends.b->z;
    pack->radius[k] = curve_radius_at(c, node);
  }
}

SIMD_CLONES
void curve_pack_reach(const curve_pack *pack, vec3 n, vec3 from, double least[CURVE_PACK]) {
  const double *restrict ax = pack->ax, *restrict ay = pack->ay, *restrict az = pack->az;
  const double *restrict bx = pack->bx, *restrict by = pack->by, *restrict bz = pack->bz;
  double *restrict out = least;
#pragma omp simd
  for (int k = 0; k < CURVE_PACK; k++) {
    const double a = n.x * (ax[k] - from.x) + n.y * (ay[k] - from.y) + n.z * (az[k] - from.z);
    const double b = n.x * (bx[k] - from.x) + n.y * (by[k] - from.y) + n.z * (bz[k] - from.z);
    out[k] = (a < b ? a : b) - pack->radius[k];
  }
}

SIMD_CLONES
void curve_pack_distance(const curve_pack *pack, vec3 from, vec3 to, double distance[CURVE_PACK],
                         double along[CURVE_PACK]) {
  const double *restrict ax = pack->ax, *restrict ay = pack->ay, *restrict az = pack->az;
  const double *restrict bx = pack->bx, *restrict by = pack->by, *restrict bz = pack->bz;
  double *restrict d = distance, *restrict at = along;
#pragma omp simd
  for (int k = 0; k < CURVE_PACK; k++) {
    const double x = bx[k] - ax[k], y = by[k] - ay[k], z = bz[k] - az[k];
    const double px = (ax[k] - from.x) - to.x, py = (ay[k] - from.y) - to.y, pz = (az[k] - from.z) - to.z;
    const double length2 = x * x + y * y + z * z;
    double s = -(px * x + py * y + pz * z) / (length2 > 0.0 ? length2 : 1.0);
    s = s < 0.0 ? 0.0 : s;
    s = s > 1.0 ? 1.0 : s;
    const double dx = px + s * x, dy = py + s * y, dz = pz + s * z;
    at[k] = s;
    d[k] = sqrt(dx * dx + dy * dy + dz * dz);
  }
}
