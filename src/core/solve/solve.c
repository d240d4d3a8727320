/* SPDX-License-Identifier: BSD-3-Clause */
#include "solve/solve.h"

#include <math.h>

#include "curve_query/search_candidate.h"
#include "solve/robot_verdict.h"

cprox_status solve_query(const query *q, size_t first, size_t last, double cutoff, cprox_result *result) {
  if (q->mover.motion) return robot_verdict(q, first, last, cutoff, result);
  size_t n = 0;
  candidate *list = NULL;
  if (last > first) {
    /* a distance from one thing alone is searched whatever its ball says */
    list = candidates_list(q, first, last, query_wants_verdict(q) || isfinite(cutoff), &n);
    if (!list) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of obstacles");
  }

  cprox_result all = query_nothing();
  cprox_status failure = CPROX_OK;
  size_t i = 0;
  while (i < n) {
    /* sorted: when one ball is too far to matter, so are the rest */
    const bool too_far = query_wants_verdict(q) ? list[i].lower > q->limit : list[i].lower > lesser(all.upper, cutoff);
    const bool answered = !q->is_signed && all.upper <= greater(q->limit, 0.0);
    if (too_far || answered || failure == CPROX_STOPPED) break;

    /* with nothing to compare with, a mesh waits until it is the nearest by its hull */
    const bool unknown = !query_wants_verdict(q) && isinf(lesser(all.upper, cutoff));
    if (unknown && i + 1 < n && candidate_may_refine(q, &list[i])) {
      const cprox_status ranked = candidate_rank(q, &list[i], &all.nodes, &all.distance_queries);
      if (ranked < 0) return ranked;
      const candidate moved = list[i]; /* back to where its bound belongs */
      size_t k = i;
      for (; k + 1 < n && list[k + 1].lower < moved.lower; k++) list[k] = list[k + 1];
      list[k] = moved;
      continue;
    }
    cprox_result one = query_nothing();
    const cprox_status status = candidate_search(q, &list[i++], lesser(all.upper, cutoff), &one);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
    query_join(&all, &one);
  }

  /* the rest is at least as far as the first ball of it */
  if (i < n) all.lower = fmin(all.lower, q->is_signed ? list[i].lower : fmax(list[i].lower, 0.0));
  if (i == 0 && n > 0) all.lod = CPROX_LOD_SPHERE;
  query_conclude(q, cutoff, failure, &all);
  *result = all;
  return all.status;
}

cprox_status solve_each(const query *q, cprox_result *nearest, cprox_result *each) {
  cprox_result all = query_nothing();
  cprox_status failure = CPROX_OK;
  for (size_t i = 0; i < q->n; i++) {
    cprox_result one = query_nothing();
    workspace_forget_work(q->workspace);
    const cprox_status status = solve_query(q, i, i + 1, INFINITY, &one);
    if (status < 0) return status;
    /* where the union falls short, it is for the one that is not known to be farther */
    if (!(one.lower >= all.lower)) failure = status;
    query_join(&all, &one);
    if (one.obstacle_index < 0) one.obstacle_index = (int32_t)i;
    each[i] = one;
  }
  *nearest = all;
  if (query_conclude(q, INFINITY, failure, nearest) == CPROX_OK) workspace_clear(q->workspace);
  return nearest->status;
}
