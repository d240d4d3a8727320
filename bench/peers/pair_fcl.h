/* SPDX-License-Identifier: BSD-3-Clause */
/* FCL's distance of two convex bodies. */
#ifndef CPROX_BENCH_PAIR_FCL_H
#define CPROX_BENCH_PAIR_FCL_H

#include <stddef.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes as cprox_body_create_*() takes them: edges; semi-axes; height and radius. */
void *pair_fcl_make(cprox_body_kind kind, const double size[3]);
void *pair_fcl_make_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m);
void pair_fcl_free(void *geometry);

/* To a tolerance of 1e-10; NAN where it throws. */
double pair_fcl_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);

/* Whether they touch, by its defaults: 0 or 1; -1 where it throws. */
int pair_fcl_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);

#ifdef __cplusplus
}
#endif
#endif
