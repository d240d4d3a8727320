/* SPDX-License-Identifier: BSD-3-Clause */
/* Eight floats at once. Sums, products, roots and comparisons are those of IEEE 754 on every machine, in the order
 * that is written: results are the same with every instruction set. The including page defines EDGE_TARGET, the
 * attribute of its functions, and EDGE_AVX2 where that is AVX2's: its instructions have names of gcc's own. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "edges/edge_bound.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi" /* every function here is inlined: there is no call whose ABI could change */
#endif

#define EDGE_INLINE EDGE_TARGET static inline __attribute__((always_inline))

typedef float lane __attribute__((vector_size(32)));
typedef int32_t lane_bits __attribute__((vector_size(32)));

typedef struct lane3 {
  lane x, y, z;
} lane3;

EDGE_INLINE lane lane_all(float x) {
  return (lane){x, x, x, x, x, x, x, x};
}

EDGE_INLINE lane lane_abs(lane a) {
  const lane_bits sign = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX};
  return (lane)((lane_bits)a & sign);
}

#if defined(EDGE_AVX2) && !defined(__clang__)
/* All bits of an element of `first` are the same. */
EDGE_INLINE lane lane_choose(lane_bits first, lane a, lane b) {
  return __builtin_ia32_blendvps256(b, a, (lane)first);
}

EDGE_INLINE lane lane_max(lane a, lane b) {
  return __builtin_ia32_maxps256(a, b);
}

EDGE_INLINE lane lane_min(lane a, lane b) {
  return __builtin_ia32_minps256(a, b);
}

EDGE_INLINE lane lane_sqrt(lane a) {
  return __builtin_ia32_sqrtps256(a);
}

/* A bit for each lane. */
EDGE_INLINE uint32_t lane_mask(lane_bits m) {
  return (uint32_t)__builtin_ia32_movmskps256((lane)m);
}
#else
EDGE_INLINE lane lane_choose(lane_bits first, lane a, lane b) {
  return (lane)(((lane_bits)a & first) | ((lane_bits)b & ~first));
}

EDGE_INLINE lane lane_max(lane a, lane b) {
  return lane_choose((lane_bits)(a > b), a, b);
}

EDGE_INLINE lane lane_min(lane a, lane b) {
  return lane_choose((lane_bits)(a < b), a, b);
}

EDGE_INLINE lane lane_sqrt(lane a) {
  for (int i = 0; i < EDGE_LANES; i++) a[i] = sqrtf(a[i]);
  return a;
}

EDGE_INLINE uint32_t lane_mask(lane_bits m) {
  uint32_t mask = 0;
  for (int i = 0; i < EDGE_LANES; i++) mask |= (uint32_t)(m[i] < 0) << i;
  return mask;
}
#endif

/* The elements whose bits are set. */
EDGE_INLINE lane_bits lane_those(uint32_t mask) {
  const int32_t m = (int32_t)mask;
  const lane_bits bit = {1, 2, 4, 8, 16, 32, 64, 128}, all = {m, m, m, m, m, m, m, m};
  return (all & bit) != 0;
}

EDGE_INLINE lane lane_load(const float *from) {
  lane a;
  memcpy(&a, from, sizeof a);
  return a;
}

/* Eight doubles, rounded. */
EDGE_INLINE lane lane_narrow(const double *from) {
  float a[EDGE_LANES];
  for (int i = 0; i < EDGE_LANES; i++) a[i] = (float)from[i];
  return lane_load(a);
}

#if defined(__clang__)
#define LANE_SHUFFLED(a, ...) __builtin_shufflevector(a, a, __VA_ARGS__)
#else
#define LANE_SHUFFLED(a, ...) __builtin_shuffle(a, (lane_bits){__VA_ARGS__})
#endif

/* The least element, in all elements. */
EDGE_INLINE lane lane_least(lane a) {
  a = lane_min(a, LANE_SHUFFLED(a, 4, 5, 6, 7, 0, 1, 2, 3));
  a = lane_min(a, LANE_SHUFFLED(a, 2, 3, 0, 1, 6, 7, 4, 5));
  return lane_min(a, LANE_SHUFFLED(a, 1, 0, 3, 2, 5, 4, 7, 6));
}

EDGE_INLINE lane3 lane3_add(lane3 a, lane3 b) {
  return (lane3){a.x + b.x, a.y + b.y, a.z + b.z};
}

EDGE_INLINE lane3 lane3_sub(lane3 a, lane3 b) {
  return (lane3){a.x - b.x, a.y - b.y, a.z - b.z};
}

EDGE_INLINE lane3 lane3_cross(lane3 a, lane3 b) {
  return (lane3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

EDGE_INLINE lane lane3_dot(lane3 a, lane3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

EDGE_INLINE lane lane3_norm2(lane3 a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

/* Within 4 u each of sine and cosine of any x up to 40 (doc/rounding.md, Edges). The quarter turns are taken off in
 * three parts, the first two products being exact. */
EDGE_INLINE void lane_sincos(lane x, lane *sine, lane *cosine) {
  const lane magic = lane_all(12582912.0f); /* 1.5 2^23: the sum's last bits are the nearest integer */
  const lane shifted = x * lane_all(0.63661977236f) + magic, k = shifted - magic;
  const lane_bits n = (lane_bits)shifted;
  const lane r =
      x - k * lane_all(1.5703125f) - k * lane_all(4.837512969970703125e-4f) - k * lane_all(7.549789948768648e-8f);
  const lane z = r * r;
  const lane s =
      ((lane_all(-1.9515295891e-4f) * z + lane_all(8.3321608736e-3f)) * z + lane_all(-1.6666654611e-1f)) * z * r + r;
  const lane c =
      ((lane_all(2.443315711809948e-5f) * z + lane_all(-1.388731625493765e-3f)) * z + lane_all(4.166664568298827e-2f)) *
          z * z -
      lane_all(0.5f) * z + lane_all(1.0f);
  const lane_bits odd = -(n & 1);
  const lane a = lane_choose(odd, c, s), b = lane_choose(odd, s, c);
  *sine = (lane)((lane_bits)a ^ ((n & 2) << 30));
  *cosine = (lane)((lane_bits)b ^ (((n + 1) & 2) << 30));
}
