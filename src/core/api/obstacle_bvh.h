/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries that find obstacles by their BVH. */
#ifndef CPROX_API_OBSTACLE_BVH_H
#define CPROX_API_OBSTACLE_BVH_H

#include "broadphase/obstacle_set.h"
#include "curve_proximity/cprox/obstacles.h"
#include "problem/problem.h"

/* query_begin() for the obstacles of a set. */
cprox_status bvh_begin(const obstacle_bvh *set, query *q, arguments_query asked);

cprox_status bvh_distance(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                          cprox_workspace *workspace, cprox_result *result);
cprox_status bvh_tolerance(const obstacle_bvh *set, cprox_mover mover, double delta, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *result);
cprox_status bvh_collision(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *result);
cprox_status bvh_time_of_contact(const obstacle_bvh *set, cprox_mover mover, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *result);
cprox_status bvh_nearest(const obstacle_bvh *set, cprox_mover mover, size_t k, const cprox_options *options,
                         cprox_workspace *workspace, cprox_result *nearest, cprox_listed *listed);

#endif
