/* SPDX-License-Identifier: BSD-3-Clause */
/* The first level of every verdict about a robot: lanes, and what they leave to the search. doc/robot-edges.md */
#ifndef CPROX_EDGES_FIRST_LEVEL_H
#define CPROX_EDGES_FIRST_LEVEL_H

#include "curve_proximity/cprox/robot.h"
#include "problem/problem.h"

/* Pairs of geometries and obstacles, and of geometries, over a part of the motion. */
typedef struct edge_rest {
  const cprox_robot_pair *pairs, *self_pairs; /* in the workspace, until the next query */
  size_t n_pairs, n_self_pairs;
  size_t first, last; /* among these obstacles */
  double from, to;    /* [s] */
} edge_rest;

typedef struct edge_first {
  /* clear: proven; violated: so lanes say of the one pair of `rest` at the time rest.from, and a measurement can prove
   * it; undecided: only the rest is open */
  cprox_verdict verdict;
  bool is_suspect; /* violated: lanes only cannot tell that pair apart there, and have not looked at all else */
  /* all that is not open stays farther apart than this [m] */
  double lower;
  edge_rest rest;
  /* where the nearest pair was seen that is not open, a part of the rest in its form; n_pairs + n_self_pairs = 0: none
   * was */
  edge_rest nearest;
} edge_first;

/* Asks lanes about obstacles first … last - 1 of a verdict about a robot. With `suspects` they end where they cannot
 * tell a pair apart. False: they cannot tell, or memory is out, and all of it is open. */
bool edge_first_level(const query *q, size_t first, size_t last, bool suspects, edge_first *found);

#endif
