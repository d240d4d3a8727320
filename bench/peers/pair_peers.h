/* SPDX-License-Identifier: BSD-3-Clause */
/* Libraries that answer about two standing bodies, each where it is there. */
#ifndef CPROX_BENCH_PAIR_PEERS_H
#define CPROX_BENCH_PAIR_PEERS_H

#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One library. Bodies and starts are its own. */
typedef struct pair_peer {
  const char *name;
  size_t number; /* of its copies of bodies, below PAIR_PEERS_MOST */
  /* Sizes as cprox_body_create_*() takes them: edges; semi-axes; height and radius. */
  void *(*make)(cprox_body_kind kind, const double size[3]);
  void *(*make_polytope)(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m);
  void *(*make_mesh)(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m);
  void (*free)(void *body);
  /* NAN where it throws. */
  double (*distance)(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);
  /* Whether they touch, by its defaults: 0 or 1; -1 where it throws. */
  int (*collides)(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb);
  /* As distance(), for n places of b in turn, each search begun where the last one ended; the distances go to `found`.
   * NULL: it has no such thing. */
  void (*follow)(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb, size_t n, double *found);
} pair_peer;

enum { PAIR_PEERS_MOST = 2 };

/* How many there are, and which. */
size_t pair_peers(const pair_peer *peers[PAIR_PEERS_MOST]);

#ifdef __cplusplus
}
#endif
#endif
