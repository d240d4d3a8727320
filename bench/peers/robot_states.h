/* SPDX-License-Identifier: BSD-3-Clause */
/* The robots of the saved cases as FCL sees them, at one state after the other. */
#ifndef CPROX_BENCH_ROBOT_STATES_H
#define CPROX_BENCH_ROBOT_STATES_H

#include "peers/robot_fcl.h"
#include "support/robot_case.h"

/* The scene stands, the robot is its meshes, the pairs are those of the case. */
robot_fcl *robot_states_fcl(const robot_case *c);
/* The least distance to the scene, or of the pairs, over samples between which no joint moves farther than `step`. */
double robot_states_distance(robot_fcl *fcl, const robot_case *c, double step, bool of_pairs, uint32_t *states);

void robot_states_place(robot_fcl *fcl, const robot_case *c, const double *values);

#endif
