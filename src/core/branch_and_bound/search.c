/* SPDX-License-Identifier: BSD-3-Clause */
/* Branch and bound over a parameter interval (A. Land, A. Doig, Econometrica 28, 1960).
 *
 *   1. Take the open node with the least lower bound (or the first in time, or the last one entered).
 *   2. Drop it if its bound says that it cannot matter; else the oracle improves the bound from known normals.
 *   3. The oracle measures the distance somewhere in the node: this improves the best point and the node's bound.
 *   4. End if the best point answers the question; drop the node if its bound now says so.
 *   5. Else split it into 2 to 8 nodes.
 *
 * Departure: the bound of each node that leaves is kept in a running minimum, so the interval is true whenever the
 * search ends. A node whose gap is below its rounding leaves as unresolved: then the status says that precision ends
 * here. */
#include "branch_and_bound/search.h"

#include "base/vec.h"
#include "base/workspace.h"

enum { STOP_POLL_INTERVAL = 16 };

/* ---- what a goal leaves to do ---- */

bool search_must_end(search_goal *goal, uint64_t work) {
  enum { WORK_BETWEEN_LOOKS = 64 };
  if (goal->ended != CPROX_OK) return true;
  if (work >= goal->max_nodes) {
    goal->ended = CPROX_BUDGET;
  } else if (goal->stop && work >= goal->next_look) {
    goal->next_look = work + WORK_BETWEEN_LOOKS;
    if (goal->stop(goal->stop_user)) goal->ended = CPROX_STOPPED;
  }
  return goal->ended != CPROX_OK;
}

/* The width that the goal allows at this upper bound. */
static double search_width(const search_goal *goal, double upper) {
  return width_allowed(goal->epsilon, goal->relative_epsilon, upper);
}

double search_pruning_bound(const search_goal *goal, double upper) {
  if (goal->limit >= 0.0) return goal->limit;
  const double known = lesser(upper, goal->cutoff);
  return goal->beyond > 0.0 ? known + goal->beyond : known - search_width(goal, known);
}

bool search_is_pruned(const search_goal *goal, double upper, double lower) {
  return goal->limit >= 0.0 ? lower > goal->limit : lower >= search_pruning_bound(goal, upper);
}

bool search_is_unresolved(const search_goal *goal, const search_best *best, double lower, double slack) {
  const double gap = lesser(best->upper, goal->cutoff) + goal->beyond - lower;
  return gap <= 2.0 * (slack + best->slack) || (goal->limit >= 0.0 && gap <= goal->epsilon);
}

bool search_is_answered(const search_goal *goal, double upper) {
  if (goal->order == SEARCH_LEFT_TO_RIGHT || goal->is_signed) return false;
  if (goal->limit >= 0.0) return upper <= goal->limit;
  return upper <= (goal->beyond > 0.0 ? 0.0 : search_width(goal, upper));
}

/* ---- open nodes ---- */

/* Open nodes: a binary heap on `lower` (best first) or `start` (left to right), or a stack (depth first), in the
 * workspace. */
typedef struct frontier {
  cprox_workspace *workspace;
  search_node *nodes;
  size_t count;
  search_order order;
} frontier;

static double key_of(const frontier *f, const search_node *node) {
  return f->order == SEARCH_BEST_FIRST ? node->lower : node->start;
}

static bool frontier_push(frontier *f, const search_node *node) {
  f->nodes = workspace_reserve(f->workspace, WORKSPACE_NODES, (f->count + 1) * sizeof *f->nodes);
  if (!f->nodes) return false;
  size_t i = f->count++;
  while (f->order != SEARCH_DEPTH_FIRST && i > 0) {
    const size_t parent = (i - 1) / 2;
    if (key_of(f, &f->nodes[parent]) <= key_of(f, node)) break;
    f->nodes[i] = f->nodes[parent];
    i = parent;
  }
  f->nodes[i] = *node;
  return true;
}

static search_node frontier_pop(frontier *f) {
  const bool stack = f->order == SEARCH_DEPTH_FIRST;
  const search_node top = stack ? f->nodes[f->count - 1] : f->nodes[0];
  f->count--;
  if (stack || f->count == 0) return top;
  const search_node moved = f->nodes[f->count];
  size_t i = 0;
  for (size_t child = 1; child < f->count; child = 2 * i + 1) {
    if (child + 1 < f->count && key_of(f, &f->nodes[child + 1]) < key_of(f, &f->nodes[child])) child++;
    if (key_of(f, &f->nodes[child]) >= key_of(f, &moved)) break;
    f->nodes[i] = f->nodes[child];
    i = child;
  }
  f->nodes[i] = moved;
  return top;
}

/* ---- the search ---- */

static double known_upper(const search_goal *goal, const search_best *best) {
  return lesser(best->upper, goal->cutoff);
}

/* Left to right: from here on nothing is asked any more, since contact came before. */
static double time_cutoff(const search_goal *goal, const search_best *best) {
  return best->upper <= goal->limit + goal->epsilon ? lesser(best->at, goal->time_cutoff) : goal->time_cutoff;
}

typedef enum node_state { NODE_OPEN, NODE_PRUNED, NODE_UNRESOLVED, NODE_BEYOND } node_state;

static node_state state_of(const search_goal *goal, const search_best *best, const search_node *node) {
  if (search_is_pruned(goal, best->upper, node->lower)) return NODE_PRUNED;
  if (goal->order == SEARCH_LEFT_TO_RIGHT) return node->start >= time_cutoff(goal, best) ? NODE_BEYOND : NODE_OPEN;
  return search_is_unresolved(goal, best, node->lower, node->slack) ? NODE_UNRESOLVED : NODE_OPEN;
}

/* One node: re-bound, probe, re-bound, split. Sets *state to why it left the search, or NODE_OPEN if its children
 * entered it. */
static cprox_status work_on(const search_goal *goal, const search_oracle *oracle, search_node *node, frontier *open,
                            search_outcome *outcome, node_state *state) {
  outcome->nodes++;

  /* measure, unless the best point lies inside */
  const cprox_status probed = oracle->probe(oracle->self, node, &outcome->best);
  if (probed < 0) return probed;
  *state = state_of(goal, &outcome->best, node);
  if (*state != NODE_OPEN || search_is_answered(goal, outcome->best.upper)) return CPROX_OK;

  /* cut at the best point where it lies inside, else in the middle */
  search_node child[SEARCH_MAX_CHILDREN];
  const int children = oracle->split(oracle->self, node, child);
  if (children < 0) return (cprox_status)children;
  if (children == 0) {
    *state = NODE_UNRESOLVED;
    return CPROX_OK;
  }

  /* the most promising child is looked at first */
  int first = 0;
  for (int k = 1; k < children; k++)
    if (child[k].lower <= child[first].lower) first = k;
  for (int i = 0; i < children; i++) {
    const search_node *entering = &child[i + 1 == children ? first : i < first ? i : i + 1];
    if (!search_is_pruned(goal, outcome->best.upper, entering->lower)) {
      if (!frontier_push(open, entering)) return CPROX_MEMORY;
      continue;
    }
    outcome->lower = lesser(entering->lower, outcome->lower); /* settled at birth */
    oracle->release(oracle->self, entering);
  }
  return CPROX_OK;
}

cprox_status search_run(search_goal *goal, const search_oracle *oracle, search_node root, cprox_workspace *workspace,
                        search_outcome *outcome) {
  frontier open = {.workspace = workspace, .order = goal->order};
  const bool best_first = goal->order == SEARCH_BEST_FIRST;
  cprox_status status = CPROX_OK;
  /* outcome->lower: the least bound of the nodes that left the search */
  *outcome = (search_outcome){.lower = INFINITY, .free_until = INFINITY, .best = {.upper = INFINITY, .at = INFINITY}};
  if (!frontier_push(&open, &root)) return CPROX_MEMORY;

  for (size_t looks = 0; open.count > 0; looks++) {
    search_node node = frontier_pop(&open);
    if (goal->share) goal->cutoff = lesser(goal->cutoff, goal->share(goal->share_user, outcome->best.upper));

    /* what is known already may settle it, or make another node the more promising one */
    const bool pruned_all =
        best_first && search_is_pruned(goal, outcome->best.upper, node.lower); /* the others lie higher still */
    if (state_of(goal, &outcome->best, &node) == NODE_OPEN) {
      const double bound = oracle->filter(oracle->self, &node, search_pruning_bound(goal, outcome->best.upper));
      if (bound > node.lower) node.lower = bound;
    }
    node_state state = state_of(goal, &outcome->best, &node);
    if (state == NODE_OPEN && best_first && open.count > 0 && node.lower > open.nodes[0].lower) {
      if (!frontier_push(&open, &node)) return CPROX_MEMORY;
      continue;
    }

    /* nodes that leave take their time as well; with the last one the answer is complete */
    const bool ends = pruned_all || (state != NODE_OPEN && open.count == 0);
    const bool poll = goal->stop && looks % STOP_POLL_INTERVAL == 0 && !ends;
    if (goal->ended != CPROX_OK && !ends) {
      status = goal->ended;
    } else if (poll && goal->stop(goal->stop_user)) {
      status = CPROX_STOPPED;
    } else if (state == NODE_OPEN) {
      if (outcome->nodes > 0 && outcome->nodes + (uint64_t)*oracle->work >= goal->max_nodes) {
        status = CPROX_BUDGET;
      } else {
        const cprox_status worked = work_on(goal, oracle, &node, &open, outcome, &state);
        if (worked < 0) return worked;
        if (state == NODE_OPEN && !search_is_answered(goal, outcome->best.upper)) continue;
        if (state == NODE_UNRESOLVED) status = goal->ended;
      }
    }

    /* the node leaves */
    outcome->lower = lesser(node.lower, outcome->lower);
    if (state != NODE_PRUNED) outcome->free_until = lesser(outcome->free_until, node.start);
    oracle->release(oracle->self, &node);
    if (status != CPROX_OK || pruned_all || search_is_answered(goal, outcome->best.upper)) break;
  }

  /* what is still open counts too */
  for (size_t i = 0; i < open.count; i++) {
    outcome->lower = lesser(open.nodes[i].lower, outcome->lower);
    outcome->free_until = lesser(outcome->free_until, open.nodes[i].start);
  }
  workspace_add_work(workspace, outcome->nodes + (uint64_t)*oracle->work);
  if (goal->order == SEARCH_LEFT_TO_RIGHT)
    outcome->free_until = lesser(outcome->free_until, time_cutoff(goal, &outcome->best));
  if (status == CPROX_OK && goal->limit < 0.0) {
    const double upper = known_upper(goal, &outcome->best);
    const double left = outcome->lower;
    if ((goal->is_signed ? left : greater(left, 0.0)) < upper - search_width(goal, upper)) status = CPROX_PRECISION;
  }
  return status;
}
