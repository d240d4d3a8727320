/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of a robot before they are searched one by one: which seem near, and how far each is at least. */
#ifndef CPROX_ROBOT_QUERY_RANK_H
#define CPROX_ROBOT_QUERY_RANK_H

#include "problem/problem.h"

typedef struct pair_rank {
  double lower; /* over all that is asked about the pair comes no nearer */
  double near;  /* so near its boxes come where they were looked at: only to choose by */
  size_t pair;  /* its number among those given */
} pair_rank;

/* Ranks the pairs that the mover gives, those that seem nearest first, by their balls and boxes and by how far they
 * move over a few pieces of the motion. NULL where memory is out. */
pair_rank *robot_rank_pairs(const query *q);

#endif
