/* SPDX-License-Identifier: BSD-3-Clause */
/* One query, one answer: the union of some of its obstacles, searched nearest ball first. */
#ifndef CPROX_SOLVE_SOLVE_H
#define CPROX_SOLVE_SOLVE_H

#include "problem/candidates.h"

/* The answer against the union of obstacles first … last - 1. Distances beyond `cutoff` are of no interest: the search
 * ends when lower has come that far, and upper is then infinity or any distance measured on the way. */
cprox_status solve_query(const query *q, size_t first, size_t last, double cutoff, cprox_result *result);

/* The same against each obstacle by itself, into each[0 … q->n - 1], and the union of these. */
cprox_status solve_each(const query *q, cprox_result *nearest, cprox_result *each);

#endif
