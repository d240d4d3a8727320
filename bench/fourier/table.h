/* SPDX-License-Identifier: BSD-3-Clause */
/* The way of the paper: the turned body's spectrum as a table on the frequencies' own lattice, looked up between its
 * points by tricubic (Catmull-Rom) interpolation for each pose. And the floor under any way: the sum alone, for a body
 * that never turns. */
#ifndef CPROX_BENCH_FOURIER_TABLE_H
#define CPROX_BENCH_FOURIER_TABLE_H

#include <math.h>

#include "fourier/gap.h"

#define TAU 6.28318530717958647693

/* What is compiled for the widths of the machines at hand, as the gap's own sum is; here with fused multiplication,
 * too. */
#if defined(__GNUC__) && defined(__x86_64__)
#define WIDTH_512 __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
#define WIDTH_256 __attribute__((target("avx2,fma")))
#else
#define WIDTH_512
#define WIDTH_256
#endif

/* exp(i k theta), k = 0 … N, of the three axes. */
typedef struct phases {
  double re[3][KERNEL_MOST_N + 1], im[3][KERNEL_MOST_N + 1];
} phases;

static inline void fill_phases(phases *p, int N, double step, vec3 x) {
  const double angle[3] = {step * x.x, step * x.y, step * x.z};
  for (int j = 0; j < 3; j++) {
    p->re[j][0] = 1.0, p->im[j][0] = 0.0;
    p->re[j][1] = cos(angle[j]), p->im[j][1] = sin(angle[j]);
    for (int k = 2; k <= N; k++) {
      const int a = k / 2, b = k - a;
      p->re[j][k] = p->re[j][a] * p->re[j][b] - p->im[j][a] * p->im[j][b];
      p->im[j][k] = p->re[j][a] * p->im[j][b] + p->im[j][a] * p->re[j][b];
    }
  }
}

typedef struct table table;

/* What a sum tells, in units of the threshold: the gradients in the fixed solid's frame by position, in the turned
 * one's by rotation. */
typedef struct table_answer {
  double value;
  vec3 position, rotation;
} table_answer;

/* A table for the gap's turned solid, `finer` points for each of the lattice along an axis; `complex`: of any body,
 * otherwise of one whose spectrum is real, like a box about its centre. NULL: out of memory. */
table *table_create(const cprox_gap *gap, int finer, bool complex);
void table_free(table *t);
size_t table_bytes(const table *t);
size_t table_terms(const table *t);

/* Value and gradients by the table. turn: the turned solid's axes in the fixed frame, row-major. */
table_answer table_look_up(const table *t, const double turn[9], vec3 x);

/* The same from the formula for a box, a term at a time: what the others are held against. */
table_answer table_exact(const table *t, const double turn[9], vec3 x);

/* Value and gradient by position of a body that does not turn. */
typedef struct table_floor table_floor;
table_floor *table_floor_create(const cprox_gap *gap);
void table_floor_free(table_floor *f);
table_answer table_floor_sum(table_floor *f, vec3 x);

#endif
