/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries against a list of obstacles in one call, for tests: each makes a handle without an index, asks, and frees it.
 */
#ifndef CPROX_TEST_OF_LIST_H
#define CPROX_TEST_OF_LIST_H

#include <math.h>

#include "curve_proximity/cprox.h"

/* The status of the handle where it cannot be made, else that of the query. */
#define OF_LIST(targets, n, ws, query)                                                                          \
  cprox_obstacles *obstacles = NULL;                                                                            \
  const cprox_status made_of_list = cprox_obstacles_create((targets), (n), CPROX_INDEX_NONE, (ws), &obstacles); \
  if (made_of_list != CPROX_OK) return made_of_list;                                                            \
  const cprox_status asked_of_list = (query);                                                                   \
  cprox_obstacles_free(obstacles);                                                                              \
  return asked_of_list

static inline cprox_status distance_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                            const cprox_options *options, cprox_workspace *workspace,
                                            cprox_result *nearest, cprox_result *each) {
  OF_LIST(targets, n, workspace, cprox_obstacles_distance(obstacles, moving, options, workspace, nearest, each));
}

static inline cprox_status tolerance_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, double delta,
                                             const cprox_options *options, cprox_workspace *workspace,
                                             cprox_result *nearest, cprox_result *each) {
  OF_LIST(targets, n, workspace,
          cprox_obstacles_tolerance(obstacles, moving, delta, options, workspace, nearest, each));
}

static inline cprox_status collision_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                             const cprox_options *options, cprox_workspace *workspace,
                                             cprox_result *nearest, cprox_result *each) {
  OF_LIST(targets, n, workspace, cprox_obstacles_collision(obstacles, moving, options, workspace, nearest, each));
}

static inline cprox_status time_of_contact_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                                   const cprox_options *options, cprox_workspace *workspace,
                                                   cprox_result *result) {
  OF_LIST(targets, n, workspace, cprox_obstacles_time_of_contact(obstacles, moving, options, workspace, result));
}

static inline cprox_status nearest_of_list_and_others(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                                      size_t k, const cprox_options *options,
                                                      cprox_workspace *workspace, cprox_result *nearest,
                                                      cprox_listed *listed) {
  OF_LIST(targets, n, workspace, cprox_obstacles_nearest(obstacles, moving, k, options, workspace, nearest, listed));
}

static inline cprox_status nearest_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, size_t k,
                                           const cprox_options *options, cprox_workspace *workspace,
                                           cprox_result *nearest, size_t *count) {
  cprox_listed listed = {0, 0.0};
  const cprox_status status = nearest_of_list_and_others(moving, targets, n, k, options, workspace, nearest, &listed);
  if (status >= 0) *count = listed.count;
  return status;
}

static inline cprox_status within_of_list_and_others(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                                     double delta, const cprox_options *options,
                                                     cprox_workspace *workspace, cprox_result *near,
                                                     cprox_listed *listed) {
  OF_LIST(targets, n, workspace, cprox_obstacles_within(obstacles, moving, delta, options, workspace, near, listed));
}

static inline cprox_status within_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, double delta,
                                          const cprox_options *options, cprox_workspace *workspace, cprox_result *near,
                                          size_t *count) {
  cprox_listed listed = {0, 0.0};
  const cprox_status status = within_of_list_and_others(moving, targets, n, delta, options, workspace, near, &listed);
  if (status >= 0) *count = listed.count;
  return status;
}

static inline cprox_status nearest_pairs_of_list_and_others(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                                            size_t k, double delta, const cprox_options *options,
                                                            cprox_workspace *workspace, cprox_result *nearest,
                                                            cprox_listed *listed) {
  OF_LIST(targets, n, workspace,
          cprox_obstacles_nearest_pairs(obstacles, moving, k, delta, options, workspace, nearest, listed));
}

static inline cprox_status nearest_pairs_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, size_t k,
                                                 double delta, const cprox_options *options, cprox_workspace *workspace,
                                                 cprox_result *nearest, size_t *count) {
  cprox_listed listed = {0, 0.0};
  const cprox_status status =
      nearest_pairs_of_list_and_others(moving, targets, n, k, delta, options, workspace, nearest, &listed);
  if (status >= 0) *count = listed.count;
  return status;
}

static inline cprox_status profile_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n,
                                           const double *breaks, size_t n_intervals, const cprox_options *options,
                                           cprox_workspace *workspace, cprox_profile_interval *intervals) {
  OF_LIST(targets, n, workspace,
          cprox_obstacles_profile(obstacles, moving, breaks, n_intervals, INFINITY, options, workspace, intervals));
}

static inline cprox_status violations_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, double delta,
                                              double resolution, const cprox_options *options,
                                              cprox_workspace *workspace, cprox_violations *violations) {
  OF_LIST(targets, n, workspace,
          cprox_obstacles_violations(obstacles, moving, delta, resolution, options, workspace, violations));
}

static inline cprox_status certify_of_list(cprox_mover moving, const cprox_obstacle *targets, size_t n, double delta,
                                           const cprox_result *answer, const cprox_options *options,
                                           cprox_workspace *workspace, cprox_certificate *certificate) {
  OF_LIST(targets, n, workspace, cprox_certify(moving, obstacles, delta, answer, options, workspace, certificate));
}

static inline size_t describe_mover_of_list(const cprox_mover *moving, const cprox_obstacle *targets, size_t n,
                                            const char *id, cprox_workspace *workspace, char *text, size_t size) {
  cprox_obstacles *obstacles = NULL;
  if (cprox_obstacles_create(targets, n, CPROX_INDEX_NONE, workspace, &obstacles) != CPROX_OK) return 0;
  const size_t length = cprox_mover_describe(moving, obstacles, id, workspace, text, size);
  cprox_obstacles_free(obstacles);
  return length;
}

#endif
