/* SPDX-License-Identifier: BSD-3-Clause */
/* A query about a section of the mover's curve. */
#ifndef CPROX_PROBLEM_SECTION_H
#define CPROX_PROBLEM_SECTION_H

#include "problem/problem.h"

/* Asks about [t0, t1], which is in one piece, rounded outward. */
void query_ask_section(query *q, size_t piece, double t0, double t1);

/* A point that is farther out than asked may be that much nearer: the curve is no faster than the ends of its
 * hodograph. */
double section_outward(const cprox_curve *curve, size_t piece);

#endif
