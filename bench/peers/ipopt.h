/* SPDX-License-Identifier: BSD-3-Clause */
/* The same problems by Ipopt, a general interior point solver, on the paper's own formulation: six variables, no
 * lifting. */
#ifndef CPROX_BENCH_PEERS_IPOPT_H
#define CPROX_BENCH_PEERS_IPOPT_H

#include <stdbool.h>

#include "implicit/implicit.h"

typedef struct ipopt_answer {
  bool solved;
  double distance;
  int iterations;
} ipopt_answer;

/* From the centres, to a tolerance. */
ipopt_answer ipopt_pair(const implicit_query *query, double tolerance);

#endif
