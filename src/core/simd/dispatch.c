/* SPDX-License-Identifier: BSD-3-Clause */
#include "simd/dispatch.h"

simd_level simd_of_machine(void) {
#ifdef SIMD_HAS_LEVELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return SIMD_AVX512;
  if (__builtin_cpu_supports("avx2")) return SIMD_AVX2;
#endif
  return SIMD_BASE;
}
