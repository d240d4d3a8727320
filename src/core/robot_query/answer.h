/* SPDX-License-Identifier: BSD-3-Clause */
/* What the verbs do where a robot moves. */
#ifndef CPROX_ROBOT_QUERY_ANSWER_H
#define CPROX_ROBOT_QUERY_ANSWER_H

#include "problem/candidates.h"

/* Distance and verdicts over [q->t0, q->t1], as question_answer() has them. In a question about the robot itself there are no
 * targets. */
cprox_status robot_answer(const question *q, size_t first, size_t last, double ceiling, cprox_result *result);

/* First contact over the whole motion. */
cprox_status robot_first_contact(const question *q, cprox_result *result);

#endif
