/* SPDX-License-Identifier: BSD-3-Clause */
/* Continuous collision detection of a vertex and a face, and of two edges: steps that miss, and steps that hit. */
#ifndef CPROX_BENCH_PAIRS_CCD_H
#define CPROX_BENCH_PAIRS_CCD_H

#include "curve_proximity/cprox/base.h"
#include "support/measure.h"

void pairs_ccd(const bench_size *size, cprox_workspace *workspace);

#endif
