/* SPDX-License-Identifier: BSD-3-Clause */
/* The problem, stated once: what moves, what stands, which query, which options; and what an interval means for it. */
#ifndef CPROX_PROBLEM_PROBLEM_H
#define CPROX_PROBLEM_PROBLEM_H

#include "base/workspace.h"
#include "branch_and_bound/search.h"
#include "curve/curve_side.h"
#include "curve_proximity/cprox/query.h"
#include "problem/validate.h"

/* Which pairs of a robot are asked about: all; those whose sides the motion does not move against each other, whose
 * distance is the same at all times; or the others. Of a state: all. */
typedef enum pair_choice { PAIRS_ALL, PAIRS_STANDING, PAIRS_MOVING } pair_choice;

/* What every query asks. */
typedef struct query {
  cprox_mover mover;
  const cprox_obstacle *obstacles;
  size_t n;
  double limit;     /* verdicts: delta, 0 for collision; distance: -1 */
  bool is_signed;   /* distance: overlaps are measured, too */
  bool is_bare;     /* a robot's verdict: what is proven clear without a measurement needs no witness */
  bool is_repeated; /* the last query of the workspace was this one, but for the state of the robot */
  cprox_options options;
  cprox_workspace *workspace;
  curve_interval part; /* of the mover's curve: the whole of it, or some of one piece */
  curve_capsule reach; /* contains that part */
  double t0, t1;       /* that part by the curve's parameter */
  const struct obstacle_bvh
      *set; /* a robot's query: the set that the obstacles are, by whose boxes they are found; or NULL */
  pair_choice choice;
  struct robot_errors *errors; /* a robot's: it answers for all executions within them (kinematics/errors.h); NULL */
} query;

/* Asks about the whole curve; the arguments must have been checked. */
void query_ask_whole(query *q);

static inline bool query_wants_verdict(const query *q) {
  return q->limit >= 0.0;
}

/* When a search in this order has what is asked for; `cutoff`: an upper bound known from elsewhere, or infinity. */
search_goal query_goal(const query *q, search_order order, double cutoff);

/* The order in which distances, or verdicts, are searched. */
static inline search_order query_order(const query *q) {
  return query_wants_verdict(q) ? SEARCH_DEPTH_FIRST : SEARCH_BEST_FIRST;
}

/* A robot against itself. */
static inline bool mover_is_self(const cprox_mover *mover) {
  return mover->kind == CPROX_MOVER_ROBOT_SELF;
}

/* A robot against obstacles and itself at once. */
static inline bool mover_is_whole(const cprox_mover *mover) {
  return mover->kind == CPROX_MOVER_ROBOT_WHOLE;
}

/* options NULL: the default. Nothing is checked. */
query query_create(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double limit,
                   const cprox_options *options, cprox_workspace *workspace);

/* Forgets the last error, checks all arguments, and asks about the whole curve or motion. CPROX_OK, or a negative
 * status.
 */
cprox_status query_begin(query *q, arguments_query asked);

/* What a status above CPROX_OK means to the caller. */
const char *query_shortfall(cprox_status status);

/* An upper bound from elsewhere with which a search ends, unless it finds something nearer, with lower > distance. */
double query_cutoff_beyond(const query *q, double distance);

/* The verdict that the result's interval gives; undecided for distances. */
cprox_verdict query_verdict(const query *q, const cprox_result *r);

/* Whether the interval is what was asked for, whatever happened on the way. */
bool query_is_satisfied(const query *q, double cutoff, const cprox_result *r);

/* Against nothing: infinitely far. */
cprox_result query_nothing(void);

/* Adds the answer against another set to the union's: the least of both ends, with the witness of the upper one. */
void query_join(cprox_result *all, const cprox_result *one);

/* Room in the workspace for the results of up to n obstacles, so that the caller's array is written only when the query
 * has succeeded. NULL where memory is out. */
cprox_result *query_reserve_results(const query *q, size_t n);

/* Puts a result where it belongs among the k nearest so far, ascending by upper; *others falls to the lower bound of
 * one that is dropped. */
void query_rank(cprox_result *nearest, size_t *count, size_t k, const cprox_result *r, double *others);

/* The union is complete: its status (`failure` is the last that a search had), verdict and reason. */
cprox_status query_conclude(const query *q, double cutoff, cprox_status failure, cprox_result *all);

#endif
