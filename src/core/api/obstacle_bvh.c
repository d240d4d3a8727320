/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries that find obstacles by their BVH. */
#include "api/obstacle_bvh.h"

#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
#include "solve/list.h"
#include "solve/solve.h"
#include "solve/time_of_contact.h"

/* The coarser a model, the farther it may reach out of the boxes. */
static bool boxes_hold(const query *q) {
  return q->options.max_lod == CPROX_LOD_MESH;
}

cprox_status bvh_begin(const obstacle_bvh *set, query *q, arguments_query asked) {
  /* the obstacles were checked when the set was made, but for what the mover must go with */
  const bool robot = q->mover.motion && (set->has_curves || set->has_fields || mover_is_self(&q->mover) ||
                                         mover_is_whole(&q->mover) || q->mover.pairs);
  const bool by_hulls = q->mover.body || (q->mover.motion && q->options.signed_distance);
  const bool all = set->has_clock || (by_hulls && set->has_elements) || robot;
  q->obstacles = all ? set->obstacles : NULL;
  q->n = all ? set->n : 0;
  const cprox_status begun = query_begin(q, asked);
  q->obstacles = set->obstacles;
  q->n = set->n;
  if (q->mover.motion && !q->mover.pairs && boxes_hold(q)) q->set = set;
  return begun;
}

static cprox_status out_of_memory(const query *q) {
  return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of obstacles");
}

static cprox_status answer(const obstacle_bvh *set, query *q, const char *name, cprox_result *result) {
  const unsigned others = ARGUMENTS_INTERVAL | (query_wants_verdict(q) ? 0 : ARGUMENTS_SIGNED | ARGUMENTS_SHARE);
  const cprox_status begun =
      bvh_begin(set, q, (arguments_query){name, ARGUMENTS_SEARCH | ARGUMENTS_WHOLE | ARGUMENTS_RADIUS | others});
  if (begun != CPROX_OK) return begun;
  if (q->mover.motion || !boxes_hold(q)) return solve_query(q, 0, q->n, INFINITY, result);
  set_traversal walk;
  if (!traversal_begin(&walk, set, q)) return out_of_memory(q);
  cprox_result all = query_nothing();
  cprox_status failure = CPROX_OK;
  double rest = INFINITY;
  for (;;) {
    const bool answered = (!q->is_signed && all.upper <= fmax(q->limit, 0.0)) || failure == CPROX_STOPPED;
    const double most = answered ? -INFINITY : query_wants_verdict(q) ? q->limit : all.upper;
    uint32_t obstacle;
    if (!traversal_next(&walk, most, &obstacle, &rest)) return out_of_memory(q);
    if (obstacle == UINT32_MAX || answered) break;
    cprox_result one = {0};
    const cprox_status status = solve_query(q, obstacle, (size_t)obstacle + 1, all.upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
    query_join(&all, &one);
  }
  all.lower = fmin(all.lower, q->is_signed ? rest : fmax(rest, 0.0));
  if (all.lod == CPROX_LOD_NONE && q->n > 0) all.lod = CPROX_LOD_SPHERE;
  query_conclude(q, INFINITY, failure, &all);
  *result = all;
  return all.status;
}

cprox_status bvh_distance(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                          cprox_workspace *workspace, cprox_result *result) {
  query q = query_create(mover, NULL, 0, -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  return answer(set, &q, "the distance to a set", result);
}

cprox_status bvh_tolerance(const obstacle_bvh *set, cprox_mover mover, double delta, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *result) {
  const cprox_status checked = validate_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  query q = query_create(mover, NULL, 0, delta, options, workspace);
  return answer(set, &q, "tolerance of a set", result);
}

cprox_status bvh_collision(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *result) {
  query q = query_create(mover, NULL, 0, 0.0, options, workspace);
  return answer(set, &q, "collision with a set", result);
}

cprox_status bvh_time_of_contact(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *result) {
  query q = query_create(mover, NULL, 0, 0.0, options, workspace);
  const cprox_status begun =
      bvh_begin(set, &q,
                (arguments_query){"time of contact with a set", ARGUMENTS_STOP | ARGUMENTS_LOD | ARGUMENTS_WHOLE |
                                                                    ARGUMENTS_INTERVAL | ARGUMENTS_RADIUS});
  if (begun != CPROX_OK) return begun;
  if (q.set) return robot_time_of_contact(&q, result);
  if (q.mover.motion || !boxes_hold(&q))
    return list_time_of_contact(mover, set->obstacles, set->n, &q.options, workspace, result);
  set_traversal walk;
  if (!traversal_begin(&walk, set, &q)) return out_of_memory(&q);
  time_of_contact met = time_of_contact_begin();
  double rest;
  for (;;) {
    uint32_t obstacle;
    if (!traversal_next(&walk, 0.0, &obstacle, &rest)) return out_of_memory(&q);
    if (obstacle == UINT32_MAX) break;
    const cprox_status status = time_of_contact_with(&met, &q, obstacle, (size_t)obstacle + 1);
    if (status < 0) return status;
  }
  met.lower = fmin(met.lower, rest);
  return time_of_contact_conclude(&met, &q, result);
}

cprox_status bvh_nearest(const obstacle_bvh *set, cprox_mover mover, size_t k, const cprox_options *options,
                         cprox_workspace *workspace, cprox_result *nearest, cprox_listed *listed) {
  query q = query_create(mover, NULL, 0, -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  const arguments_query asked = {"the nearest obstacles of a set",
                                 ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_RADIUS};
  const cprox_status begun = bvh_begin(set, &q, asked);
  if (begun != CPROX_OK) return begun;
  if (k == 0) return workspace_fail(workspace, CPROX_INVALID, "k is 0: ask for at least one obstacle");
  if (q.mover.motion || !boxes_hold(&q))
    return list_nearest(mover, set->obstacles, set->n, k, &q.options, workspace, nearest, listed);
  set_traversal walk;
  cprox_result *kept = query_reserve_results(&q, set->n);
  if (!kept) return CPROX_MEMORY;
  if (!traversal_begin(&walk, set, &q)) return out_of_memory(&q);
  size_t found = 0;
  double others = INFINITY, rest = INFINITY;
  cprox_status failure = CPROX_OK;
  for (;;) {
    const double cutoff = failure == CPROX_STOPPED ? -INFINITY : found == k ? kept[k - 1].upper : INFINITY;
    uint32_t obstacle;
    if (!traversal_next(&walk, cutoff, &obstacle, &rest)) return out_of_memory(&q);
    if (obstacle == UINT32_MAX || failure == CPROX_STOPPED) break;
    cprox_result r;
    workspace_forget_work(workspace);
    const cprox_status status = solve_query(&q, obstacle, (size_t)obstacle + 1, cutoff, &r);
    if (status < 0) return status;
    if (failure == CPROX_OK) failure = status;
    if (r.obstacle_index < 0) r.obstacle_index = (int32_t)obstacle; /* stopped before anything was measured */
    query_rank(kept, &found, k, &r, &others);
  }
  if (found > 0) memcpy(nearest, kept, found * sizeof *kept);
  others = fmin(others, rest);
  *listed = (cprox_listed){found, q.is_signed ? others : fmax(others, 0.0)};
  if (failure != CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
