/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of meshes, a part of the group pairs. */
#ifndef CPROX_BENCH_PAIRS_MESHES_H
#define CPROX_BENCH_PAIRS_MESHES_H

#include "curve_proximity/cprox.h"
#include "support/measure.h"

void pairs_meshes(const bench_size *size, cprox_workspace *workspace);

#endif
