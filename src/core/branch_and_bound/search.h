/* SPDX-License-Identifier: BSD-3-Clause */
/* The one branch-and-bound engine. It knows intervals and bounds; what they are bounds of is its oracle's affair.
 *
 * Every interval that leaves the search leaves its lower bound in a running minimum, so that the interval returned is
 * true whenever the search ends: converged, decided, out of budget or stopped. */
#ifndef CPROX_BRANCH_AND_BOUND_SEARCH_H
#define CPROX_BRANCH_AND_BOUND_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

#include "curve_proximity/cprox/base.h"

/* What an oracle knows of a node: the parameters that it covers, and what is left to look at. The engine copies it and
 * never looks into it; each oracle has a struct of its own for it, which begins at `bytes`. */
typedef union search_payload {
  unsigned char bytes[72];
  double aligned;
} search_payload;

/* A part of the parameter range, or of two ranges at once. */
typedef struct search_node {
  double lower; /* the distance over the node is at least this, rounding included */
  double slack; /* how much of that was given away to rounding: no bound on this node gets nearer than this */
  double start; /* left to right: the parameter at which the node begins */
  search_payload payload;
} search_node;

enum { SEARCH_MAX_CHILDREN = 8 };

/* The best point found so far. */
typedef struct search_best {
  double upper; /* the distance is at most this, rounding included */
  double slack; /* how much of it is rounding */
  double at;    /* left to right: the parameter where it was measured */
} search_best;

typedef struct search_oracle {
  void *self;

  /* The work done so far beside the nodes themselves: one for each distance query, and for what costs as much. */
  const uint32_t *work;

  /* A lower bound over the node from normals already known; never computes a new distance. `goal` is what would settle
   * it. */
  double (*filter)(void *self, search_node *node, double goal);

  /* Measures the distance somewhere in the node, unless the best point lies inside already; improves *best and
   * node->lower. CPROX_OK, or a negative status. */
  cprox_status (*probe)(void *self, search_node *node, search_best *best);

  /* Cuts a node into 2 to SEARCH_MAX_CHILDREN that inherit its bound; the node's storage passes on to them. Their
   * number, or 0 where the interval is as short as double allows (then the node is still the caller's to release), or a
   * negative status. */
  int (*split)(void *self, search_node *node, search_node *child);

  /* Gives back a node's storage. */
  void (*release)(void *self, const search_node *node);
} search_oracle;

/* Left to right finds the first parameter at which the distance comes within epsilon of the limit. Its oracle keeps
 * node->start, and its best point is the leftmost one within epsilon of the limit; while there is none, any. */
typedef enum search_order { SEARCH_BEST_FIRST, SEARCH_DEPTH_FIRST, SEARCH_LEFT_TO_RIGHT } search_order;

/* When a node needs no more work. A distance search works on nodes that could hold less than the best point by more
 * than the width; a verdict search (limit >= 0) on nodes that could come as close as the limit. */
typedef struct search_goal {
  search_order order;
  double limit;   /* verdicts: delta; distance: -1 */
  bool is_signed; /* distance: bounds below 0 are not as good as 0 */
  double cutoff;  /* distance: an upper bound known from elsewhere, or infinity */
  double beyond;  /* distance: nodes that come within this of the best point are worked on, too; 0: they are not */
  double (*share)(void *user, double upper); /* distance: tells ours, returns the least one of all who share; or NULL */
  void *share_user;
  double time_cutoff; /* left to right: parameters from here on are of no interest; infinity: all are */
  double epsilon, relative_epsilon;
  uint32_t max_nodes; /* of nodes and the oracle's work together; the first node is always worked on */
  bool (*stop)(void *user);
  void *stop_user;
  uint64_t next_look; /* the oracle's work at which it asks `stop` next */
  cprox_status ended; /* CPROX_BUDGET, CPROX_STOPPED: what an oracle saw within a node */
} search_goal;

typedef struct search_outcome {
  double lower;
  double free_until; /* left to right: the distance is above the limit at every smaller parameter; infinity: at all */
  search_best best;
  uint32_t nodes;
} search_outcome;

/* How hard an oracle tries to better what it measures. */
typedef struct search_effort {
  uint32_t newton_after; /* nodes before Newton is allowed to look for better points */
  bool is_signed;        /* depths are measured, to a tenth of epsilon */
  double good_enough;    /* an upper bound at or below this needs no refinement */
  double epsilon;
} search_effort;

/* For oracles whose nodes take long: whether the search must end within the node at hand, after so much work, nodes
 * included. What is not bounded yet then stays as it is. */
bool search_must_end(search_goal *goal, uint64_t work);

/* The lower bound from which on a node needs no more work, the best point being `upper` away. */
double search_pruning_bound(const search_goal *goal, double upper);

/* Whether a lower bound says that. */
bool search_is_pruned(const search_goal *goal, double upper, double lower);

/* A lower bound that is neither above the limit nor able to say more: closer to the best point than epsilon (verdicts)
 * or than rounding. slack: how much of the bound is rounding. */
bool search_is_unresolved(const search_goal *goal, const search_best *best, double lower, double slack);

/* The best point alone ends the search: it violates the limit, or it is as close to 0 as was asked. */
bool search_is_answered(const search_goal *goal, double upper);

/* Searches from the root on; *outcome is always filled, and true, when the status is not negative. Where bounds are
 * shared goal->cutoff falls meanwhile. */
cprox_status search_run(search_goal *goal, const search_oracle *oracle, search_node root, cprox_workspace *workspace,
                        search_outcome *outcome);

#endif
