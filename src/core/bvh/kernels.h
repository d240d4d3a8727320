/* SPDX-License-Identifier: BSD-3-Clause */
/* The loops over lanes by instruction set. */
#ifndef CPROX_BVH_KERNELS_H
#define CPROX_BVH_KERNELS_H

#include "bvh/bvh.h"

typedef struct tree_kernel {
  void (*measure)(const tree *t, uint32_t at, uint32_t wanted, const tree_segment *segment, tree_lanes *lanes);
  tree_hit (*nearest)(const tree *t, vec3 x, double bound);
} tree_kernel;

/* Two lanes at a time on x86-64 (SSE2), and whatever the compiler makes of it elsewhere; four (AVX2); eight (AVX-512). The
 * last two exist on x86-64 alone. */
extern const tree_kernel tree_kernel_plain;
#if defined(__x86_64__)
extern const tree_kernel tree_kernel_avx2, tree_kernel_avx512;
#endif

/* How many kernels this machine can run, and the i-th of them, the widest last. */
int tree_kernel_count(void);
const tree_kernel *tree_kernel_at(int i);

#endif
