/* SPDX-License-Identifier: BSD-3-Clause */
/* Sampling, the usual substitute for a query: the least distance of evenly spaced points of a curve to a polytope, by
 * FCL. It has no error bound; the column `error` of the rows is what it was off. */
#ifndef CPROX_BENCH_SAMPLES_H
#define CPROX_BENCH_SAMPLES_H

#include "support/measure.h"
#include "support/problems.h"

/* One query: a curve against an obstacle, or against a second curve. */
typedef struct sampled_query {
  const cprox_curve *curve, *second; /* second: or NULL */
  const obstacle *obstacle;
  void *peer; /* of the obstacle; samples_measure() makes and frees it */
} sampled_query;

/* Rows of n queries with 100, 1000 and 10000 points of each curve (of two curves as many pairs of points), `prefix`
 * before the parameter's "samples 100". Nothing where a polytope is asked about and FCL is not installed. */
void samples_measure(const bench_size *size, const char *group, const char *workload, const char *prefix,
                     sampled_query *queries, size_t n, const double *truth);

#endif
