/* SPDX-License-Identifier: BSD-3-Clause */
/* FCL's distance of two triangle meshes, whose traversal is PQP's. */
#ifndef CPROX_BENCH_MESH_FCL_H
#define CPROX_BENCH_MESH_FCL_H

#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

void *mesh_fcl_make(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m);
void mesh_fcl_free(void *mesh);

/* NAN where it throws. */
double mesh_fcl_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);

/* Whether they touch, by its defaults: 0 or 1; -1 where it throws. */
int mesh_fcl_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);

#ifdef __cplusplus
}
#endif
#endif
