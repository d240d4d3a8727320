/* SPDX-License-Identifier: BSD-3-Clause */
/* The loops over lanes by instruction set. */
#ifndef CPROX_BVH_KERNELS_H
#define CPROX_BVH_KERNELS_H

#include "bvh/bvh.h"
#include "simd/dispatch.h"

typedef struct tree_kernel {
  void (*measure)(const tree *t, uint32_t at, uint32_t wanted, const tree_segment *segment, tree_lanes *lanes);
  tree_hit (*nearest)(const tree *t, vec3 x, double bound);
  double (*farthest)(const tree *t, vec3 d, vec3 *at);
} tree_kernel;

extern const tree_kernel tree_kernel_plain;
#ifdef SIMD_HAS_LEVELS
extern const tree_kernel tree_kernel_avx2, tree_kernel_avx512;
#endif

/* The kernel of a level that this machine runs. */
const tree_kernel *tree_kernel_at(simd_level level);

#endif
