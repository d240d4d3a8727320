/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries of many movers at once. */
#ifndef CPROX_BATCH_BATCH_H
#define CPROX_BATCH_BATCH_H

#include "batch/obstacle_batch.h"

cprox_status batch_distance(const obstacle_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                            const cprox_options *options, cprox_workspace *workspace, cprox_result *results);
cprox_status batch_tolerance(const obstacle_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                             double delta, const cprox_options *options, cprox_workspace *workspace,
                             cprox_result *results);

#endif
