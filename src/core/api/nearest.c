/* SPDX-License-Identifier: BSD-3-Clause */
/* The k closest obstacles, and all obstacles within a distance: distance searches that end where an obstacle is out of
 * query. */
#include <math.h>
#include <string.h>

#include "problem/validate.h"
#include "solve/list.h"
#include "solve/solve.h"

static cprox_status worse(cprox_status a, cprox_status b) {
  return a != CPROX_OK ? a : b;
}

/* The obstacles by their nearest ball; part is not used. NULL where memory is out. */
static candidate *rank_obstacles(const query *q) {
  candidate *rank = workspace_reserve(q->workspace, WORKSPACE_RANKING, (q->n + 1) * sizeof *rank);
  if (!rank) return NULL;
  for (size_t i = 0; i < q->n; i++) {
    size_t n;
    if (q->mover.motion) { /* its search ranks by itself */
      rank[i] = (candidate){.lower = q->is_signed ? -INFINITY : 0.0, .obstacle = (int32_t)i};
      continue;
    }
    const candidate *parts = candidates_list(q, i, i + 1, true, &n);
    if (!parts) return NULL;
    rank[i] = parts[0];
  }
  candidates_sort(rank, q->n);
  return rank;
}

cprox_status list_nearest(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, size_t k,
                          const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                          cprox_listed *listed) {
  query q = query_create(mover, obstacles, n, -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  const cprox_status begun = query_begin(
      &q, (arguments_query){"the nearest obstacles", ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_RADIUS});
  if (begun != CPROX_OK) return begun;
  if (k == 0) return workspace_fail(workspace, CPROX_INVALID, "k is 0: ask for at least one obstacle");
  const candidate *rank = rank_obstacles(&q);
  if (!rank) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a list of obstacles");
  cprox_result *kept = query_reserve_results(&q, n);
  if (!kept) return CPROX_MEMORY;

  size_t found = 0, i = 0;
  double others = INFINITY;
  cprox_status failure = CPROX_OK;
  for (; i < n && failure != CPROX_STOPPED; i++) {
    const double cutoff = found == k ? kept[k - 1].upper : INFINITY;
    if (rank[i].lower > cutoff) break;
    cprox_result r;
    const size_t obstacle = (size_t)rank[i].obstacle;
    workspace_forget_work(workspace);
    const cprox_status status = solve_query(&q, obstacle, obstacle + 1, cutoff, &r);
    if (status < 0) return status;
    failure = worse(failure, status);
    if (r.obstacle_index < 0) r.obstacle_index = rank[i].obstacle; /* stopped before anything was measured */
    query_rank(kept, &found, k, &r, &others);
  }
  if (i < n) others = fmin(rank[i].lower, others); /* sorted */
  if (found > 0) memcpy(nearest, kept, found * sizeof *kept);
  *listed = (cprox_listed){found, q.is_signed ? others : fmax(others, 0.0)};
  if (failure != CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}

cprox_status list_within(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                         const cprox_options *options, cprox_workspace *workspace, cprox_result *near,
                         cprox_listed *listed) {
  const cprox_status usable = validate_delta(delta, workspace);
  if (usable != CPROX_OK) return usable;
  query q = query_create(mover, obstacles, n, -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  const cprox_status begun = query_begin(
      &q, (arguments_query){"the obstacles within a distance", ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_RADIUS});
  if (begun != CPROX_OK) return begun;
  cprox_result *kept = query_reserve_results(&q, n);
  if (!kept) return CPROX_MEMORY;

  const double cutoff = query_cutoff_beyond(&q, delta);
  size_t found = 0, i = 0;
  double others = INFINITY;
  cprox_status failure = CPROX_OK;
  for (; i < n && failure != CPROX_STOPPED; i++) {
    cprox_result r;
    workspace_forget_work(workspace);
    const cprox_status status = solve_query(&q, i, i + 1, cutoff, &r);
    if (status < 0) return status;
    if (r.lower > delta) {
      others = fmin(r.lower, others);
      continue;
    }
    failure = worse(failure, status);
    if (r.obstacle_index < 0) r.obstacle_index = (int32_t)i;
    r.verdict = r.upper <= delta ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_UNDECIDED;
    kept[found++] = r;
  }
  if (i < n) others = q.is_signed ? -INFINITY : 0.0;
  if (found > 0) memcpy(near, kept, found * sizeof *kept);
  *listed = (cprox_listed){found, others};
  if (failure != CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
