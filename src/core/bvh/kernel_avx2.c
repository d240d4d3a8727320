/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/kernels.h"

#ifdef SIMD_HAS_LEVELS
#define TREE_TARGET SIMD_TARGET_AVX2
#define TREE_KERNEL tree_kernel_avx2
#include "bvh/kernel.h"
#endif
