/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries about a robot: lanes first where a verdict is wanted, then the search for what they leave open. */
#ifndef CPROX_SOLVE_ROBOT_VERDICT_H
#define CPROX_SOLVE_ROBOT_VERDICT_H

#include "problem/problem.h"

/* As robot_answer() has it. */
cprox_status robot_verdict(const query *q, size_t first, size_t last, double cutoff, cprox_result *result);

#endif
