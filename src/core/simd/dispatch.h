/* SPDX-License-Identifier: BSD-3-Clause */
/* Which instruction sets the core is compiled for, and which one runs. Two ways to use them:
 *
 * - A loop over arrays is marked SIMD_CLONES. It is compiled for AVX2 and for what every machine has, and chosen when
 * the library is loaded.
 * - A kernel of many functions is compiled once for each simd_level, with SIMD_TARGET_*, and chosen by
 * simd_of_machine(). A test can run every level that the machine has.
 *
 * The compiler may not fuse or reorder sums (-ffp-contract=off, no -ffast-math), so that all give the same results. */
#ifndef CPROX_SIMD_DISPATCH_H
#define CPROX_SIMD_DISPATCH_H

#include <stdlib.h> /* tells glibc, whose loader does the choosing */

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SIMD_CLONES
#endif

/* In ascending order: on x86-64 two doubles at a time (SSE2), four, eight. Elsewhere SIMD_BASE alone exists. */
typedef enum simd_level { SIMD_BASE, SIMD_AVX2, SIMD_AVX512 } simd_level;

#if defined(__GNUC__) && defined(__x86_64__)
#define SIMD_HAS_LEVELS 1
#define SIMD_TARGET_AVX2 __attribute__((target("avx2")))
#if defined(__clang__) /* it takes no preferred width, and would take nothing else with one */
#define SIMD_TARGET_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
#else
#define SIMD_TARGET_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")))
#endif
#endif

/* The highest level that this machine runs. */
simd_level simd_of_machine(void);

#endif
