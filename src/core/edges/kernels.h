/* SPDX-License-Identifier: BSD-3-Clause */
/* The search of one edge in lanes: eight time intervals at once. One kernel for each instruction set; all give the same
 * answers, bit by bit. */
#ifndef CPROX_EDGES_KERNELS_H
#define CPROX_EDGES_KERNELS_H

#include "edges/edge_bound.h"
#include "simd/dispatch.h"

/* What lanes left open: a part and an obstacle (by its place in `near`), or a pair of parts (n_near and its number). */
typedef struct edge_open {
  uint32_t *pairs;
  uint32_t n;
  uint32_t *seen; /* of each, the number of the edge that noted it last; there are n_near + n_lane_pairs */
  uint32_t edge;
  float from, to; /* of the edge's parameter, seen from its middle */
} edge_open;

/* Memory of a search, aligned to 32 bytes: edge_lanes_size() bytes for at least n_near. */
typedef struct edge_lanes {
  char *memory;
  edge_open open;
  uint32_t most_batches; /* more are left open; 0: as many as there may be */
  bool measures;         /* edge_found.least is wanted */
  bool suspects;         /* the first batch that leaves a pair open though nothing moves is the last one */
} edge_lanes;

typedef struct edge_found {
  cprox_verdict verdict; /* undecided: what is open decides, or all where there was too much */
  bool too_much;
  cprox_edge_level level;
  uint32_t intervals, batches;
  float at;                /* violated: there, seen from the middle of the edge, */
  int32_t geometry, other; /* by this geometry and this obstacle, or */
  bool self;               /* this other geometry */
  bool is_suspect;         /* undecided, and a measurement there may prove contact of these: nothing else is known */
  float depth;             /* of it */
  /* if it measures: nothing that is not open comes nearer than clear_beyond and this; the pair of which that was found,
   * as edge_open has it, or UINT32_MAX, and where */
  float least;
  uint32_t nearest;
  float nearest_at;
} edge_found;

typedef void edge_kernel(const cprox_edge_checker *checker, const edge_motion *motion, edge_lanes *lanes,
                         edge_found *found);

size_t edge_lanes_size(const cprox_edge_checker *checker, size_t n_near);

edge_kernel edge_kernel_plain, edge_kernel_avx2;
edge_kernel *edge_kernel_at(simd_level level);

#endif
