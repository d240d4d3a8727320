/* SPDX-License-Identifier: BSD-3-Clause */
/* The textbook's method on the paper's formulation, for comparison: feasible primal-dual interior point steps in x and
 * y with the constraints as they are, no lifted variables, one set of settings, no certificate. */
#ifndef CPROX_BENCH_PEERS_NAIVE_H
#define CPROX_BENCH_PEERS_NAIVE_H

#include "implicit/implicit.h"

typedef struct naive_answer {
  bool converged; /* by its residuals */
  double distance;
  int iterations;
} naive_answer;

naive_answer naive_pair(const implicit_query *query, double tolerance);

#endif
