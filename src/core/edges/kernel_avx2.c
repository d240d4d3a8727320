/* SPDX-License-Identifier: BSD-3-Clause */
#include "simd/dispatch.h"

#ifdef SIMD_HAS_LEVELS
#define EDGE_TARGET SIMD_TARGET_AVX2
#define EDGE_AVX2
#define EDGE_KERNEL edge_kernel_avx2
#include "edges/kernel.h"
#endif
