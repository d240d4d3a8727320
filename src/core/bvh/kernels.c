/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/kernels.h"

const tree_kernel *tree_kernel_at(simd_level level) {
#ifdef SIMD_HAS_LEVELS
  if (level == SIMD_AVX512) return &tree_kernel_avx512;
  if (level == SIMD_AVX2) return &tree_kernel_avx2;
#endif
  (void)level;
  return &tree_kernel_plain;
}
