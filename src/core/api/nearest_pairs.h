/* SPDX-License-Identifier: BSD-3-Clause */
/* The pairs that a robot is asked about one by one. */
#ifndef CPROX_API_NEAREST_PAIRS_H
#define CPROX_API_NEAREST_PAIRS_H

#include "curve_proximity/cprox/robot.h"
#include "problem/problem.h"

/* Lists the pairs of geometries, or of geometries and obstacles, that are asked about where none are given; counts them
 * where there is no room (NULL). */
size_t robot_pairs_list(const query *q, cprox_robot_pair *pairs);

#endif
