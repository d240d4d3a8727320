/* SPDX-License-Identifier: BSD-3-Clause */
#include "libraries.h"

enum { MOST_POINTS = 64 };

const curve_peer *const curve_libraries[MOST_LIBRARIES + 1] = {
#ifdef CPROX_BENCH_OCCT
    &curve_peer_occt,
#endif
#ifdef CPROX_BENCH_SISL
    &curve_peer_sisl,
#endif
    NULL};

void libraries_make(const vec3 *points, size_t n, size_t degree, const double *knots, void *own[MOST_LIBRARIES]) {
  double plain[MOST_POINTS][3];
  for (size_t i = 0; i < n && i < MOST_POINTS; i++)
    plain[i][0] = points[i].x, plain[i][1] = points[i].y, plain[i][2] = points[i].z;
  for (size_t k = 0; curve_libraries[k]; k++)
    own[k] = n <= MOST_POINTS ? curve_libraries[k]->make((const double(*)[3])plain, n, degree, knots) : NULL;
}

void libraries_drop(void *own[MOST_LIBRARIES]) {
  for (size_t k = 0; curve_libraries[k]; k++)
    if (own[k]) curve_libraries[k]->drop(own[k]);
}
