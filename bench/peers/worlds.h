/* SPDX-License-Identifier: BSD-3-Clause */
/* What samples a curve against a mesh or an octree: FCL at points of the curve, where it is installed. */
#ifndef CPROX_BENCH_PEER_WORLDS_H
#define CPROX_BENCH_PEER_WORLDS_H

#include <stdbool.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct world_peer world_peer;

/* A tree of OBBRSS over the triangles. */
world_peer *world_peer_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m);

/* An octomap of the resolution with these cells occupied; NULL where octomap is not there. */
world_peer *world_peer_octree(const cprox_vec3 *centres, size_t n, double resolution);

void world_peer_free(world_peer *w);

/* The least distance of a Bézier curve's points at n parameters; of one point where n is 1. */
double world_peer_distance(const world_peer *w, const cprox_vec3 *points, size_t n_points, size_t n);

/* The distance of a ball, asked as a ball: FCL's boxes go round it. */
double world_peer_ball(const world_peer *w, cprox_vec3 centre, double radius);

/* Whether a ball at one of them touches. */
bool world_peer_collides(const world_peer *w, const cprox_vec3 *points, size_t n_points, double radius, size_t n);

#ifdef __cplusplus
}
#endif
#endif
