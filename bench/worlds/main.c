/* SPDX-License-Identifier: BSD-3-Clause */
/* Quintic Bézier curves against meshes of 1,352 to 81,608 triangles, 10^5 points and octree cells, and sets of 10 to
 * 10^4 bodies; FCL at 100 points of the curve beside, and asked about single balls. The truth is our own interval at
 * epsilon 1e-12, which tests hold against long double. Rows "build …" have the time of one construction, and in the
 * column nodes the bytes that an element takes. */
#include <stdio.h>
#include <stdlib.h>

#include "worlds/worlds.h"

enum { CLOUD = 100000 };
static const double CELL = 0.05;

static void ask_meshes(const bench_size *size, worlds_asked *q) {
  static const uint32_t cuts[] = {13, 26, 51, 101};
  static const char *const names[] = {"triangles 1352", "triangles 5408", "triangles 20808", "triangles 81608"};
  for (int k = 0; k < 4; k++) {
    worlds_mesh m = worlds_mesh_make(cuts[k]);
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])m.triangles;
    cprox_body *body = NULL;
    const double start = worlds_now();
    worlds_check(
        cprox_body_create_mesh(m.vertices, m.n, triangles, m.m, CPROX_MESH_FILL_SURFACE, SIZE_MAX, q->ws, &body),
        q->ws);
    if (bench_wanted(size, "build mesh")) worlds_say_build("mesh", m.m, worlds_now() - start, body);
    world_peer *peer = NULL;
#ifdef CPROX_BENCH_FCL
    peer = world_peer_mesh(m.vertices, m.n, triangles, m.m);
#endif
    rng r = rng_seed(301);
    const worlds_scene scene = {
        .what = "mesh", .parameter = names[k], .body = body, .peer = peer, .half = {1.8, 1.8, 1.8}, .scale = 1.5};
    worlds_ask_body(&scene, &r, size, q);
#ifdef CPROX_BENCH_FCL
    world_peer_free(peer);
#endif
    cprox_body_free(body);
    free(m.vertices), free(m.triangles);
  }
}

static void ask_clouds(const bench_size *size, worlds_asked *q) {
  rng r = rng_seed(303);
  vec3 *points = worlds_get(CLOUD * sizeof *points), *high = worlds_get(CLOUD * sizeof *high);
  for (size_t i = 0; i < CLOUD; i++) points[i] = worlds_in_room(&r);
  cprox_body *body = NULL;
  double start = worlds_now();
  worlds_check(cprox_body_create_points(points, CLOUD, 0.01, SIZE_MAX, q->ws, &body), q->ws);
  if (bench_wanted(size, "build points")) worlds_say_build("points", CLOUD, worlds_now() - start, body);
  worlds_scene scene = {.what = "points",
                        .parameter = "points 100000",
                        .body = body,
                        .centre = {0, 0, 1.5},
                        .half = {4.5, 4.5, 1.2},
                        .scale = 2.5};
  worlds_ask_body(&scene, &r, size, q);
  cprox_body_free(body);

  const size_t n = worlds_cells_make(&r, CLOUD, CELL, points);
  world_peer *peer = NULL;
#ifdef CPROX_BENCH_FCL
  peer = world_peer_octree(points, n, CELL);
#endif
  for (size_t i = 0; i < n; i++) {
    high[i] = vec_add(points[i], vec(0.5 * CELL, 0.5 * CELL, 0.5 * CELL));
    points[i] = vec_sub(points[i], vec(0.5 * CELL, 0.5 * CELL, 0.5 * CELL));
  }
  body = NULL;
  start = worlds_now();
  worlds_check(cprox_body_create_boxes(points, high, n, SIZE_MAX, q->ws, &body), q->ws);
  if (bench_wanted(size, "build octree")) worlds_say_build("octree", n, worlds_now() - start, body);
  char name[32];
  snprintf(name, sizeof name, "cells %zu", n);
  scene.what = "octree", scene.parameter = name, scene.body = body, scene.peer = peer;
  worlds_ask_body(&scene, &r, size, q);
#ifdef CPROX_BENCH_FCL
  world_peer_free(peer);
#endif
  cprox_body_free(body);
  free(points), free(high);
}

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  worlds_asked q = {.ws = cprox_workspace_create()};
  if (!q.ws) return 1;
  worlds_ask_sets(&size, &q);
  ask_meshes(&size, &q);
  ask_clouds(&size, &q);
  worlds_ask_updates(&size, &q);
  cprox_workspace_free(q.ws);
  return 0;
}
