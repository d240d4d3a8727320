/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries against a list of obstacles, one tested after another: as cprox/obstacles.h has them, the list unchecked.
 */
#ifndef CPROX_SOLVE_LIST_H
#define CPROX_SOLVE_LIST_H

#include "curve_proximity/cprox/obstacles.h"

cprox_status list_distance(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *nearest, cprox_result *each);
cprox_status list_tolerance(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                            const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                            cprox_result *each);
cprox_status list_collision(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *nearest, cprox_result *each);
cprox_status list_time_of_contact(cprox_mover mover, const cprox_obstacle *obstacles, size_t n,
                                  const cprox_options *options, cprox_workspace *workspace, cprox_result *result);
cprox_status list_nearest(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, size_t k,
                          const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                          cprox_listed *listed);
cprox_status list_within(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                         const cprox_options *options, cprox_workspace *workspace, cprox_result *near,
                         cprox_listed *listed);
cprox_status list_nearest_pairs(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, size_t k, double delta,
                                const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                cprox_listed *listed);
cprox_status list_profile(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const double *breaks,
                          size_t n_intervals, double horizon, const cprox_options *options, cprox_workspace *workspace,
                          cprox_profile_interval *intervals);
cprox_status list_violations(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                             double resolution, const cprox_options *options, cprox_workspace *workspace,
                             cprox_violations *violations);

#endif
