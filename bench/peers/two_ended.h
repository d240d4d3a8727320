/* SPDX-License-Identifier: BSD-3-Clause */
/* What certified answers for robots cost without this library's bounds, on its own kinematics and distances: half the
 * sum of the distances at both ends minus how far the joints can carry the part between (constant levers), best first;
 * and samples. */
#ifndef CPROX_BENCH_TWO_ENDED_H
#define CPROX_BENCH_TWO_ENDED_H

#include "curve_proximity/cprox/robot.h"

typedef struct peer_answer {
  double lower, upper;
  uint32_t nodes, distance_queries;
  bool complete; /* within the budget */
} peer_answer;

void two_ended_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, double epsilon,
                        uint32_t max_nodes, cprox_workspace *workspace, peer_answer *answer);

/* Best first by the distance in the middle of an interval and one bound: of first order (2: M2), by a plane that stands
 * still to second (3: M3) or third order (4: M4). */
void central_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, int order, double epsilon,
                      uint32_t max_nodes, cprox_workspace *workspace, peer_answer *answer);

/* Into how many steps a segment falls where no joint moves farther than `step` in one. */
int sampled_steps(const cprox_motion *motion, size_t segment, double step);

/* The least distance of samples between which no joint moves farther than `step`. With `first_hit` it ends at the first
 * sample at distance 0. */
void sampled_distance(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, double step, bool first_hit,
                      cprox_workspace *workspace, peer_answer *answer);

#endif
