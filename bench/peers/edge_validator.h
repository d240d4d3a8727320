/* SPDX-License-Identifier: BSD-3-Clause */
/* A planner's own validator of straight edges, in a library that was compiled apart: CPROX_BENCH_EDGE_VALIDATOR names
 * the file, which defines these functions. Without it edge_validator_none.c does. */
#ifndef CPROX_BENCH_EDGE_VALIDATOR_H
#define CPROX_BENCH_EDGE_VALIDATOR_H

#include <stdbool.h>

#include "curve_proximity/cprox/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* NULL: there is none, and nothing else below does anything. */
const char *edge_validator_name(void);

/* NULL where the robot is not known. */
typedef struct edge_validator edge_validator;
edge_validator *edge_validator_create(const char *robot);
void edge_validator_free(edge_validator *v);

/* What stands: half extents; radius and half height of the segment along z. */
void edge_validator_add_box(edge_validator *v, cprox_pose pose, cprox_vec3 half);
void edge_validator_add_capsule(edge_validator *v, cprox_pose pose, double radius, double half_height);
void edge_validator_add_sphere(edge_validator *v, cprox_pose pose, double radius);
void edge_validator_ready(edge_validator *v);

/* Whether any sample of the edge collides; `per_radian` of them, 4, 8, …, 512, for each radian of its length. */
bool edge_validator_hits(const edge_validator *v, const double *from, const double *to, int per_radian);

#ifdef __cplusplus
}
#endif
#endif
