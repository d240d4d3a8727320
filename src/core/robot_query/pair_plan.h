/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pairs a robot's query asks about, listed once and before anything is placed: those of a class of starts, as far
 * as they may come near enough to matter. */
#ifndef CPROX_ROBOT_QUERY_PAIR_PLAN_H
#define CPROX_ROBOT_QUERY_PAIR_PLAN_H

#include "problem/problem.h"
#include "robot_query/element.h"
#include "robot_query/starts.h"

/* A part that moves and an obstacle, or of a pair with itself another part. */
typedef struct planned_pair {
  int32_t moving, standing;
  double apart; /* the two are never nearer, by their sweeps; -infinity: that is not known */
} planned_pair;

typedef struct pair_plan {
  const query *q;
  const start_class *starts; /* only pairs of this class; NULL: all, as if all starts were known */
  planned_pair *pairs;       /* in the workspace: */
  size_t n_against;          /* so many against obstacles, */
  size_t n;                  /* then those with itself; all together */
  double reach;              /* pairs with itself that stay farther apart than this are left out, */
  double beyond;             /* which all stay farther apart than this */
} pair_plan;

/* Whether pairs of the robot with itself are asked about; so many of them there are at most. */
static inline bool pair_plan_has_self(const cprox_mover *mover) {
  return mover_is_self(mover) || mover_is_whole(mover);
}
size_t pair_plan_count_self(const cprox_mover *mover);

/* Lists the pairs: q, starts and reach are given. obstacles: those of one obstacle side by side, in the order of the
 * obstacles; grouped: pairs of the robot with itself are left to groups of parts. False where memory is out. */
bool pair_plan_list(pair_plan *plan, const robot_body *obstacles, size_t n_obstacles, bool grouped);

/* The pair with itself that may come nearest, or NULL. */
const planned_pair *pair_plan_nearest(const pair_plan *plan);

/* A reach that was found later. */
void pair_plan_leave_out(pair_plan *plan, double reach);

#endif
