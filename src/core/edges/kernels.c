/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/kernels.h"

edge_kernel *edge_kernel_at(simd_level level) {
#ifdef SIMD_HAS_LEVELS
  if (level >= SIMD_AVX2) return edge_kernel_avx2;
#endif
  (void)level;
  return edge_kernel_plain;
}

/* 21 rows of lanes a frame with its velocities and errors, 6 a part, 3 a ball, one a distance; and a mark a part. */
size_t edge_lanes_size(const cprox_edge_checker *c, size_t n_near) {
  return (21 * c->n_frames + 6 * c->n_parts + 3 * c->n_balls + n_near) * EDGE_LANES * sizeof(float) +
         c->n_parts * sizeof(uint32_t);
}
