/* SPDX-License-Identifier: BSD-3-Clause */
/* Many obstacles: the handle, and which of its parts answers a query. */
#include "problem/obstacles.h"

#include <stdlib.h>
#include <string.h>

#include "api/obstacle_bvh.h"
#include "base/workspace.h"
#include "batch/batch.h"
#include "problem/validate.h"
#include "solve/list.h"

cprox_status cprox_obstacles_create(const cprox_obstacle *list, size_t n, cprox_obstacle_index index,
                                    cprox_workspace *workspace, cprox_obstacles **obstacles) {
  WORKSPACE_USE(workspace);
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!obstacles)
    return workspace_fail(workspace, CPROX_INVALID, "obstacles is NULL: there is no place for the handle");
  if ((unsigned)index > CPROX_INDEX_BATCH)
    return workspace_fail(workspace, CPROX_INVALID, "%d is no kind of index", (int)index);
  cprox_status status = validate_obstacles(list, n, workspace);
  if (status != CPROX_OK) return status;
  cprox_obstacles *made = calloc(1, sizeof *made);
  cprox_obstacle *copy = n > 0 ? malloc(n * sizeof *copy) : NULL;
  if (!made || (n > 0 && !copy)) {
    free(made);
    free(copy);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for %zu obstacles", n);
  }
  if (n > 0) memcpy(copy, list, n * sizeof *copy);
  made->obstacles = copy;
  made->n = n;
  if (index == CPROX_INDEX_BVH) status = obstacle_bvh_create(copy, n, workspace, &made->bvh);
  if (index == CPROX_INDEX_BATCH) status = obstacle_batch_create(copy, n, workspace, &made->batch);
  if (status != CPROX_OK) {
    cprox_obstacles_free(made);
    return status;
  }
  *obstacles = made;
  return CPROX_OK;
}

void cprox_obstacles_free(cprox_obstacles *obstacles) {
  if (!obstacles) return;
  obstacle_bvh_free(obstacles->bvh);
  obstacle_batch_free(obstacles->batch);
  free(obstacles->obstacles);
  free(obstacles);
}

cprox_obstacles_info cprox_obstacles_get_info(const cprox_obstacles *obstacles) {
  cprox_obstacles_info info = {.n = obstacles_count(obstacles), .index = CPROX_INDEX_NONE};
  if (obstacles && obstacles->bvh) info.index = CPROX_INDEX_BVH;
  if (obstacles && obstacles->batch) info.index = CPROX_INDEX_BATCH;
  return info;
}

/* ---- one mover ---- */

static const obstacle_bvh *bvh_of(const cprox_obstacles *obstacles) {
  return obstacles ? obstacles->bvh : NULL;
}

cprox_status cprox_obstacles_distance(const cprox_obstacles *obstacles, cprox_mover mover, const cprox_options *options,
                                      cprox_workspace *workspace, cprox_result *result, cprox_result *each) {
  WORKSPACE_USE(workspace);
  const obstacle_bvh *bvh = bvh_of(obstacles);
  if (bvh && !each) return bvh_distance(bvh, mover, options, workspace, result);
  return list_distance(mover, obstacles_list(obstacles), obstacles_count(obstacles), options, workspace, result, each);
}

cprox_status cprox_obstacles_tolerance(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                       const cprox_options *options, cprox_workspace *workspace, cprox_result *result,
                                       cprox_result *each) {
  WORKSPACE_USE(workspace);
  const obstacle_bvh *bvh = bvh_of(obstacles);
  if (bvh && !each) return bvh_tolerance(bvh, mover, delta, options, workspace, result);
  return list_tolerance(mover, obstacles_list(obstacles), obstacles_count(obstacles), delta, options, workspace, result,
                        each);
}

cprox_status cprox_obstacles_collision(const cprox_obstacles *obstacles, cprox_mover mover,
                                       const cprox_options *options, cprox_workspace *workspace, cprox_result *result,
                                       cprox_result *each) {
  WORKSPACE_USE(workspace);
  const obstacle_bvh *bvh = bvh_of(obstacles);
  if (bvh && !each) return bvh_collision(bvh, mover, options, workspace, result);
  return list_collision(mover, obstacles_list(obstacles), obstacles_count(obstacles), options, workspace, result, each);
}

cprox_status cprox_obstacles_time_of_contact(const cprox_obstacles *obstacles, cprox_mover mover,
                                             const cprox_options *options, cprox_workspace *workspace,
                                             cprox_result *result) {
  WORKSPACE_USE(workspace);
  const obstacle_bvh *bvh = bvh_of(obstacles);
  if (bvh) return bvh_time_of_contact(bvh, mover, options, workspace, result);
  return list_time_of_contact(mover, obstacles_list(obstacles), obstacles_count(obstacles), options, workspace, result);
}

cprox_status cprox_obstacles_nearest(const cprox_obstacles *obstacles, cprox_mover mover, size_t k,
                                     const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                     cprox_listed *listed) {
  WORKSPACE_USE(workspace);
  const obstacle_bvh *bvh = bvh_of(obstacles);
  if (bvh) return bvh_nearest(bvh, mover, k, options, workspace, nearest, listed);
  return list_nearest(mover, obstacles_list(obstacles), obstacles_count(obstacles), k, options, workspace, nearest,
                      listed);
}

cprox_status cprox_obstacles_within(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                    const cprox_options *options, cprox_workspace *workspace, cprox_result *near,
                                    cprox_listed *listed) {
  WORKSPACE_USE(workspace);
  return list_within(mover, obstacles_list(obstacles), obstacles_count(obstacles), delta, options, workspace, near,
                     listed);
}

cprox_status cprox_obstacles_nearest_pairs(const cprox_obstacles *obstacles, cprox_mover mover, size_t k, double delta,
                                           const cprox_options *options, cprox_workspace *workspace,
                                           cprox_result *nearest, cprox_listed *listed) {
  WORKSPACE_USE(workspace);
  return list_nearest_pairs(mover, obstacles_list(obstacles), obstacles_count(obstacles), k, delta, options, workspace,
                            nearest, listed);
}

cprox_status cprox_obstacles_profile(const cprox_obstacles *obstacles, cprox_mover mover, const double *breaks,
                                     size_t n_intervals, double horizon, const cprox_options *options,
                                     cprox_workspace *workspace, cprox_profile_interval *intervals) {
  WORKSPACE_USE(workspace);
  return list_profile(mover, obstacles_list(obstacles), obstacles_count(obstacles), breaks, n_intervals, horizon,
                      options, workspace, intervals);
}

cprox_status cprox_obstacles_violations(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                        double resolution, const cprox_options *options, cprox_workspace *workspace,
                                        cprox_violations *violations) {
  WORKSPACE_USE(workspace);
  return list_violations(mover, obstacles_list(obstacles), obstacles_count(obstacles), delta, resolution, options,
                         workspace, violations);
}

/* ---- many movers ---- */

/* NULL, and the error message set, where there is no such index. */
static const obstacle_batch *batch_of(const cprox_obstacles *obstacles, cprox_workspace *workspace) {
  if (obstacles && obstacles->batch) return obstacles->batch;
  workspace_fail(workspace, CPROX_INVALID, "%s: batches need obstacles with CPROX_INDEX_BATCH",
                 obstacles ? "the obstacles have another index" : "obstacles is NULL");
  return NULL;
}

cprox_status cprox_obstacles_distance_batch(const cprox_obstacles *obstacles, const cprox_mover *movers, size_t first,
                                            size_t last, const cprox_options *options, cprox_workspace *workspace,
                                            cprox_result *results) {
  WORKSPACE_USE(workspace);
  const obstacle_batch *batch = batch_of(obstacles, workspace);
  return batch ? batch_distance(batch, movers, first, last, options, workspace, results) : CPROX_INVALID;
}

cprox_status cprox_obstacles_tolerance_batch(const cprox_obstacles *obstacles, const cprox_mover *movers, size_t first,
                                             size_t last, double delta, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_result *results) {
  WORKSPACE_USE(workspace);
  const obstacle_batch *batch = batch_of(obstacles, workspace);
  return batch ? batch_tolerance(batch, movers, first, last, delta, options, workspace, results) : CPROX_INVALID;
}
