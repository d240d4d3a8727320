/* SPDX-License-Identifier: BSD-3-Clause */
#include "pair_peers.h"

#ifdef CPROX_BENCH_FCL
#include "mesh_fcl.h"
#include "pair_fcl.h"
static const pair_peer FCL = {
    "FCL", 0, pair_fcl_make, pair_fcl_make_polytope, mesh_fcl_make, pair_fcl_free, pair_fcl_distance, pair_fcl_collides,
    NULL};
#endif
#ifdef CPROX_BENCH_COAL
#include "pair_coal.h"
static const pair_peer COAL = {"coal",
                               1,
                               pair_coal_make,
                               pair_coal_make_polytope,
                               pair_coal_make_mesh,
                               pair_coal_free,
                               pair_coal_distance,
                               pair_coal_collides,
                               pair_coal_follow};
#endif

size_t pair_peers(const pair_peer *peers[PAIR_PEERS_MOST]) {
  size_t n = 0;
#ifdef CPROX_BENCH_FCL
  peers[n++] = &FCL;
#endif
#ifdef CPROX_BENCH_COAL
  peers[n++] = &COAL;
#endif
  (void)peers;
  return n;
}
