/* SPDX-License-Identifier: BSD-3-Clause */
/* The pairs of a robot that come closest: a search for each, which ends where the pair is out of query. */
#include "api/nearest_pairs.h"

#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "kinematics/motion.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
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
    if (!mover_is_self(&q->mover) && !motion_moves_link(motion, a->link)) continue;
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

/* Puts a result where it belongs among the best so far, of which the last is dropped when there are k already. */
static void insert(cprox_result *nearest, size_t *count, size_t k, const cprox_result *r) {
  size_t i = *count < k ? (*count)++ : k - 1;
  for (; i > 0 && nearest[i - 1].upper > r->upper; i--) nearest[i] = nearest[i - 1];
  nearest[i] = *r;
}

static cprox_status ask_pairs(query *q, const cprox_robot_pair *pairs, size_t n, size_t k, double delta,
                              cprox_result *nearest, size_t *count) {
  /* a search that ends at the cutoff has a lower bound of at least cutoff - width: above delta */
  const double width = fmax(q->options.epsilon, q->options.relative_epsilon * delta);
  const double within = (delta + 2.0 * width) * (1.0 + 4.0 * (q->options.relative_epsilon + 1e-15));
  cprox_status failure = CPROX_OK;
  for (size_t i = 0; i < n && failure != CPROX_STOPPED; i++) {
    const double cutoff = *count == k ? fmin(nearest[k - 1].upper, within) : within;
    q->mover.pairs = &pairs[i], q->mover.n_pairs = 1;
    const size_t first = mover_is_self(&q->mover) ? 0 : (size_t)pairs[i].other,
                 last = mover_is_self(&q->mover) ? 0 : first + 1;
    cprox_result r;
    const cprox_status status = robot_answer(q, first, last, cutoff, &r);
    if (status < 0) return status;
    if (r.lower > delta || (*count == k && r.upper >= nearest[k - 1].upper)) continue;
    if (status != CPROX_OK) failure = status;
    r.mover_part = pairs[i].geometry, r.obstacle_index = pairs[i].other;
    insert(nearest, count, k, &r);
  }
  return failure;
}

cprox_status list_nearest_pairs(cprox_mover mover, const cprox_obstacle *targets, size_t n, size_t k, double delta,
                                const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                size_t *count) {
  query q = query_create(mover, targets, n, -1.0, false, options, workspace);
  const cprox_status begun = query_begin(&q, (arguments_query){"the nearest pairs", ARGUMENTS_SEARCH});
  if (begun != CPROX_OK) return begun;
  if (!mover.motion)
    return workspace_fail(workspace, CPROX_INVALID, "pairs are those of a robot's motion, and the mover is none");
  if (k == 0) return workspace_fail(workspace, CPROX_INVALID, "k is 0: ask for at least one pair");
  if (!(delta >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "delta is %g, must be 0 or more, or infinity", delta);

  const cprox_robot_pair *pairs = mover.pairs;
  size_t n_pairs = mover.n_pairs;
  if (!pairs) {
    n_pairs = robot_pairs_list(&q, NULL);
    cprox_robot_pair *listed = workspace_reserve(workspace, WORKSPACE_RANKING, (n_pairs + 1) * sizeof *listed);
    if (!listed) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a list of pairs");
    robot_pairs_list(&q, listed);
    pairs = listed;
  }
  cprox_result *kept = query_reserve_results(&q, n_pairs);
  if (!kept) return CPROX_MEMORY;
  size_t found = 0;
  const cprox_status failure = ask_pairs(&q, pairs, n_pairs, k, delta, kept, &found);
  if (failure < 0) return failure;
  if (found > 0) memcpy(nearest, kept, found * sizeof *kept);
  *count = found;
  if (failure > CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
