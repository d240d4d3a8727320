/* SPDX-License-Identifier: BSD-3-Clause */
/* The libraries for curves that are installed, and a curve's copies in their own terms. */
#ifndef CPROX_BENCH_LIBRARIES_H
#define CPROX_BENCH_LIBRARIES_H

#include "base/vec.h"
#include "curve_peers.h"

enum { MOST_LIBRARIES = 2 };

/* Ends with NULL. */
extern const curve_peer *const curve_libraries[MOST_LIBRARIES + 1];

/* own[k]: library k's copy. */
void libraries_make(const vec3 *points, size_t n, size_t degree, const double *knots, void *own[MOST_LIBRARIES]);
void libraries_drop(void *own[MOST_LIBRARIES]);

#endif
