/* SPDX-License-Identifier: BSD-3-Clause */
/* What the verbs do where a robot moves. */
#ifndef CPROX_QUERY_ROBOT_ANSWER_H
#define CPROX_QUERY_ROBOT_ANSWER_H

#include "query/candidates.h"

/* CPROX_OK, or CPROX_INVALID with a sentence: of a mover with a motion, and its targets. */
cprox_status robot_check(const cprox_mover *mover, const cprox_target *targets, size_t n, cprox_workspace *workspace);

/* Asks about the whole motion. */
void robot_ask_whole(question *q);

/* Distance and verdicts over [q->t0, q->t1], as question_answer() has them. In a question about the robot itself there are no
 * targets. */
cprox_status robot_answer(const question *q, size_t first, size_t last, double ceiling, cprox_result *result);

/* First contact over the whole motion. */
cprox_status robot_first_contact(const question *q, cprox_result *result);

#endif
