/* SPDX-License-Identifier: BSD-3-Clause */
/* coal, which scripts/bench_peers builds; the members of pair_peer. */
#ifndef CPROX_BENCH_PAIR_COAL_H
#define CPROX_BENCH_PAIR_COAL_H

#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

void *pair_coal_make(cprox_body_kind kind, const double size[3]);
void *pair_coal_make_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m);
void *pair_coal_make_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m);
void pair_coal_free(void *body);
double pair_coal_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);
int pair_coal_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);
void pair_coal_follow(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb, size_t n,
                      double *found);

#ifdef __cplusplus
}
#endif
#endif
