/* SPDX-License-Identifier: BSD-3-Clause */
/* The pairs of a robot that come closest: all are ranked at once by their balls and boxes. Those that could be among
 * the nearest are searched, the likeliest first; a search ends where its pair is out of query. */
#include "api/nearest_pairs.h"

#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "kinematics/motion.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
#include "robot_query/rank.h"
#include "solve/list.h"
#include "solve/solve.h"

/* The parts of a geometry stand together. */
size_t robot_pairs_list(const query *q, cprox_robot_pair *pairs) {
  const cprox_motion *motion = q->mover.motion;
  const cprox_robot *robot = motion->robot;
  size_t n = 0;
  for (size_t i = 0; i < robot->n_parts; i++) {
    const robot_part *a = &robot->parts[i];
    if (i > 0 && robot->parts[i - 1].geometry == a->geometry) continue;
    for (size_t k = 0; !mover_is_self(&q->mover) && k < q->n; k++, n++)
      if (pairs) pairs[n] = (cprox_robot_pair){.geometry = a->geometry, .other = (int32_t)k};
    for (size_t k = 0; mover_is_self(&q->mover) && k < i; k++) {
      const robot_part *b = &robot->parts[k];
      if (k > 0 && robot->parts[k - 1].geometry == b->geometry) continue;
      if (!motion_relates_links(motion, a->link, b->link)) continue;
      if (pairs) pairs[n] = (cprox_robot_pair){.geometry = a->geometry, .other = b->geometry};
      n++;
    }
  }
  return n;
}

/* Nearest first; of pairs that are as near in the order of their numbers. */
static bool is_behind(const cprox_result *a, const cprox_result *b) {
  if (a->upper != b->upper) return a->upper > b->upper;
  return a->mover_part != b->mover_part ? a->mover_part > b->mover_part : a->obstacle_index > b->obstacle_index;
}

/* The best so far, and what else could be among them. */
typedef struct ranked_pairs {
  const query *q; /* of all pairs */
  const pair_rank *rank;
  size_t k;
  double delta, within; /* a search that ends at `within` has a lower bound above delta */
  cprox_result *nearest;
  size_t count;
  double others; /* a bound of those that were left out */
} ranked_pairs;

static void leave_out(ranked_pairs *p, double lower) {
  p->others = fmin(lower, p->others);
}

/* Puts a result where it belongs among the best so far, of which the last is dropped when there are k already. */
static void insert(ranked_pairs *p, const cprox_result *r) {
  cprox_result *nearest = p->nearest;
  if (p->count == p->k) leave_out(p, nearest[p->k - 1].lower);
  size_t i = p->count < p->k ? p->count++ : p->k - 1;
  for (; i > 0 && is_behind(&nearest[i - 1], r); i--) nearest[i] = nearest[i - 1];
  nearest[i] = *r;
}

/* What is farther than this is not among them. */
static double cutoff_of(const ranked_pairs *p) {
  return p->count == p->k ? fmin(p->nearest[p->k - 1].upper, p->within) : p->within;
}

static bool is_out(const ranked_pairs *p, double lower) {
  return lower > p->delta || (p->count == p->k && lower >= p->nearest[p->k - 1].upper);
}

static const cprox_robot_pair *pair_at(const ranked_pairs *p, size_t i) {
  return &p->q->mover.pairs[p->rank[i].pair];
}

/* Some of the pairs in one search. */
static cprox_status ask(const ranked_pairs *p, const cprox_robot_pair *pairs, size_t n, cprox_result *r) {
  query q = *p->q;
  q.mover.pairs = pairs, q.mover.n_pairs = n;
  const bool self = mover_is_self(&q.mover);
  const size_t first = self || n > 1 ? 0 : (size_t)pairs->other, last = self ? 0 : n > 1 ? q.n : first + 1;
  workspace_forget_work(q.workspace);
  return robot_answer(&q, first, last, cutoff_of(p), r);
}

static bool is_found(const ranked_pairs *p, const cprox_robot_pair *pair) {
  for (size_t i = 0; i < p->count; i++)
    if (p->nearest[i].mover_part == pair->geometry && p->nearest[i].obstacle_index == pair->other) return true;
  return false;
}

/* Each of them from place i on, until the boxes of the next ones say that these are out; `every`: to the last, but for
 * those that are found already. */
static cprox_status ask_one_by_one(ranked_pairs *p, size_t *i, bool every) {
  cprox_status failure = CPROX_OK;
  for (; *i < p->q->mover.n_pairs && failure != CPROX_STOPPED; ++*i) {
    if (!every && p->rank[*i].near >= cutoff_of(p)) break;
    if (every && is_found(p, pair_at(p, *i))) continue;
    if (is_out(p, p->rank[*i].lower)) {
      leave_out(p, p->rank[*i].lower);
      continue;
    }
    cprox_result r;
    const cprox_status status = ask(p, pair_at(p, *i), 1, &r);
    if (status < 0) return status;
    const bool out = is_out(p, r.lower);
    if (!out && status != CPROX_OK) failure = status; /* even where its upper bound is out, it may be nearer */
    if (out || (p->count == p->k && r.upper >= p->nearest[p->k - 1].upper)) {
      leave_out(p, r.lower);
      continue;
    }
    r.mover_part = pair_at(p, *i)->geometry, r.obstacle_index = pair_at(p, *i)->other;
    insert(p, &r);
  }
  return failure;
}

static void take_out(cprox_robot_pair *pairs, size_t *n, const cprox_result *r) {
  size_t i = 0;
  while (i + 1 < *n && (pairs[i].geometry != r->mover_part || pairs[i].other != r->obstacle_index)) i++;
  pairs[i] = pairs[--*n];
}

/* Those from place i on at once, as long as the nearest of the rest is among the nearest. The status of the last
 * search: where it is not CPROX_OK not all is known of the rest. */
static cprox_status ask_at_once(ranked_pairs *p, size_t i) {
  const size_t room = p->q->mover.n_pairs - i + 1;
  cprox_robot_pair *rest = workspace_reserve(p->q->workspace, WORKSPACE_ROBOT_REST, room * sizeof *rest);
  if (!rest) return workspace_fail(p->q->workspace, CPROX_MEMORY, "no memory for a list of pairs");
  size_t n = 0;
  for (; i < p->q->mover.n_pairs; i++) {
    if (is_out(p, p->rank[i].lower))
      leave_out(p, p->rank[i].lower);
    else
      rest[n++] = *pair_at(p, i);
  }
  while (n > 0) {
    cprox_result r;
    const cprox_status status = ask(p, rest, n, &r);
    if (status != CPROX_OK) return status;
    if (is_out(p, r.lower) || is_out(p, r.upper)) {
      leave_out(p, r.lower);
      break;
    }
    insert(p, &r);
    take_out(rest, &n, &r);
  }
  return CPROX_OK;
}

cprox_status list_nearest_pairs(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, size_t k, double delta,
                                const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                cprox_listed *listed) {
  query q = query_create(mover, obstacles, n, -1.0, options, workspace);
  const cprox_status begun =
      query_begin(&q, (arguments_query){"the nearest pairs", ARGUMENTS_SEARCH | ARGUMENTS_INTERVAL});
  if (begun != CPROX_OK) return begun;
  if (!mover.motion)
    return workspace_fail(workspace, CPROX_INVALID, "pairs are those of a robot's motion, and the mover is none");
  if (k == 0) return workspace_fail(workspace, CPROX_INVALID, "k is 0: ask for at least one pair");
  if (!(delta >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "delta is %g, must be 0 or more, or infinity", delta);

  if (!mover.pairs) {
    const size_t n_pairs = robot_pairs_list(&q, NULL);
    cprox_robot_pair *pairs = workspace_reserve(workspace, WORKSPACE_RANKING, (n_pairs + 1) * sizeof *pairs);
    if (!pairs) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a list of pairs");
    robot_pairs_list(&q, pairs);
    q.mover.pairs = pairs, q.mover.n_pairs = n_pairs;
  }
  const pair_rank *rank = robot_rank_pairs(&q);
  if (!rank) return workspace_fail(workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  cprox_result *kept = query_reserve_results(&q, q.mover.n_pairs);
  if (!kept) return CPROX_MEMORY;
  ranked_pairs p = {.q = &q, .rank = rank, .k = k, .delta = delta, .nearest = kept, .others = INFINITY};
  p.within = query_cutoff_beyond(&q, delta);
  size_t i = 0;
  const cprox_status likely = ask_one_by_one(&p, &i, false);
  cprox_status rest = likely;
  if (likely >= 0 && likely != CPROX_STOPPED) rest = ask_at_once(&p, i);
  if (rest > CPROX_OK && rest != CPROX_STOPPED) rest = ask_one_by_one(&p, &i, true);
  if (rest < 0) return rest;
  const cprox_status failure = likely != CPROX_OK ? likely : rest;
  /* of those that nobody came to, the ranking alone tells anything */
  for (i = 0; failure == CPROX_STOPPED && i < q.mover.n_pairs; i++)
    if (!is_found(&p, pair_at(&p, i))) leave_out(&p, rank[i].lower);
  if (p.count > 0) memcpy(nearest, kept, p.count * sizeof *kept);
  *listed = (cprox_listed){p.count, fmax(p.others, 0.0)};
  if (failure > CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
