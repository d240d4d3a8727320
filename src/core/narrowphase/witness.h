/* SPDX-License-Identifier: BSD-3-Clause */
/* Where two placed bodies are nearest to each other: what a search for a carried body reports in the end. */
#ifndef CPROX_NARROWPHASE_WITNESS_H
#define CPROX_NARROWPHASE_WITNESS_H

#include "base/vec.h"
#include "curve_proximity/cprox/query.h"

/* In the world, on either surface. Overlapping: one point of both, unless the depth was asked for. */
typedef struct pair_witness {
  vec3 on_a, on_b;
  vec3 normal; /* from b to a; (0,0,0) where there is none */
} pair_witness;

/* CPROX_OK, or a negative status with its reason in the workspace. Of these parts of the two (0 where the body is no
 * compound), which are not both halfspaces. */
cprox_status pair_witness_of(const cprox_obstacle *a, size_t part_a, const cprox_obstacle *b, size_t part_b,
                             cprox_lod finest, bool depth, cprox_workspace *workspace, pair_witness *witness);

#endif
