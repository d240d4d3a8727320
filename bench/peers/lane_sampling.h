/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges by samples, eight states at once, with the kinematics and the distances of the core's own lanes. */
#ifndef CPROX_BENCH_LANE_SAMPLING_H
#define CPROX_BENCH_LANE_SAMPLING_H

#include "edges/kernels.h"

/* False where the machine does not run it. */
bool lane_sampling_exists(void);

/* Whether any of the states collides; `per_radian` of them for each radian of the edge's length. The memory is that of
 * edge_lanes_size() and edge_motion_size(). */
bool lane_sampling_hits(const cprox_edge_checker *checker, const double *from, const double *to, double per_radian,
                        char *lanes, char *motion);

#endif
