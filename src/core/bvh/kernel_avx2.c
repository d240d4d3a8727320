/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/kernels.h"

#if defined(__x86_64__)
#define TREE_TARGET __attribute__((target("avx2")))
#define TREE_KERNEL tree_kernel_avx2
#include "bvh/kernel.h"
#endif
