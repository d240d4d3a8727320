/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/kernels.h"

#if defined(__x86_64__)

int tree_kernel_count(void) {
  if (!__builtin_cpu_supports("avx2")) return 1;
  const int wide =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return wide ? 3 : 2;
}

const tree_kernel *tree_kernel_at(int i) {
  return i == 0 ? &tree_kernel_plain : i == 1 ? &tree_kernel_avx2 : &tree_kernel_avx512;
}

#else

int tree_kernel_count(void) {
  return 1;
}

const tree_kernel *tree_kernel_at(int i) {
  (void)i;
  return &tree_kernel_plain;
}

#endif
