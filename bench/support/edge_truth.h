/* SPDX-License-Identifier: BSD-3-Clause */
/* What is true of an edge of a robot of balls, in double precision, without any of the core's bounds: closed forms of
 * the distances of the balls' centres, at times that are as close to each other as these distances demand. */
#ifndef CPROX_BENCH_EDGE_TRUTH_H
#define CPROX_BENCH_EDGE_TRUTH_H

#include "support/robot_case.h"

typedef enum edge_truth { EDGE_TRUTH_CLEAR, EDGE_TRUTH_HITS, EDGE_TRUTH_UNKNOWN } edge_truth;

/* Unknown: within 1e-7 m of contact without touching, not a robot of balls on revolute joints, or obstacles other than
 * boxes, spheres, capsules and cylinders. */
edge_truth edge_truth_of(const robot_case *model, const cprox_obstacle *targets, size_t n_targets, const double *from,
                         const double *to);

#endif
