/* SPDX-License-Identifier: BSD-3-Clause */
/* What the queries do where a robot moves. */
#ifndef CPROX_ROBOT_QUERY_ANSWER_H
#define CPROX_ROBOT_QUERY_ANSWER_H

#include "problem/candidates.h"
#include "robot_query/oracle.h"

/* Distance and verdicts over [q->t0, q->t1], as solve_query() has them. In a query about the robot itself there are no
 * obstacles. */
cprox_status robot_answer(const query *q, size_t first, size_t last, double cutoff, cprox_result *result);

/* The same of all obstacles. travel: a bound on how far the pair that came nearest moves towards or away from each
 * other between any two times of the interval; infinity where nothing was measured. */
cprox_status robot_answer_and_travel(const query *q, cprox_result *result, double *travel);

/* Where the best distance of a search was measured, what that cost, and by which models. */
void robot_search_report(const robot_search *o, cprox_result *result);

/* Time of contact over the whole motion. */
cprox_status robot_time_of_contact(const query *q, cprox_result *result);

#endif
