/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over arrays that wider vectors make faster: compiled for AVX2 and for what every machine has, chosen when the library is
 * loaded. The compiler may not fuse or reorder sums (-ffp-contract=off, no -ffast-math), so that both give the same results. */
#ifndef CPROX_SIMD_DISPATCH_H
#define CPROX_SIMD_DISPATCH_H

#include <stdlib.h> /* tells glibc, whose loader does the choosing */

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LANES_DISPATCHED __attribute__((target_clones("avx2", "default")))
#else
#define LANES_DISPATCHED
#endif

#endif
