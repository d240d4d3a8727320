/* SPDX-License-Identifier: BSD-3-Clause */
/* The group of robots: its files. */
#ifndef CPROX_BENCH_ROBOTS_H
#define CPROX_BENCH_ROBOTS_H

#include "support/measure.h"
#include "support/robot_case.h"

/* Among 10 to 10,000 obstacles, against 6 to 96 links of its own, two arms beside each other. */
void bench_robot_scale(const robot_case *arm, const bench_size *size, cprox_workspace *workspace);

/* One straight motion with 2 to 100,000 waypoints. */
void bench_robot_waypoints(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *workspace);

/* Distances with their gradients, beside distances alone. */
void bench_robot_gradients(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *workspace);

/* The share of the pairs looked at whose distance is measured. */
void bench_robot_pairs(const robot_case *cases, size_t n, cprox_workspace *workspace);

/* Arms against themselves by their own meshes, beside FCL at .05 rad. */
void bench_robot_links(const bench_size *size, cprox_workspace *workspace);

/* States without a motion, beside FCL. */
void bench_robot_states(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *workspace);

/* Verdicts and scales for all executions within bounds of their errors, beside plain verdicts. */
void bench_robot_errors(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *workspace);

/* Straight edges, beside samples by the same lanes. */
void bench_robot_edges(const robot_case *cases, size_t n, const bench_size *size, cprox_workspace *workspace);

#endif
