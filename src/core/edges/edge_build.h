/* SPDX-License-Identifier: BSD-3-Clause */
/* What both sides of a model are built with. */
#ifndef CPROX_EDGES_EDGE_BUILD_H
#define CPROX_EDGES_EDGE_BUILD_H

#include <math.h>

#include "edges/edge_model.h"

static inline float edge_float_above(double x) {
  const float f = (float)x;
  return (double)f >= x ? f : nextafterf(f, INFINITY);
}

static inline float edge_float_below(double x) {
  return -edge_float_above(-x);
}

static inline uint64_t *edge_row_of(const edge_rows *rows, size_t geometry) {
  return rows->bits + geometry * rows->words;
}

static inline bool edge_is_noted(const edge_rows *rows, int32_t geometry, size_t bit) {
  return edge_row_of(rows, (size_t)geometry)[bit / 64] >> (bit % 64) & 1u;
}

static inline bool edge_asks_about(const edge_rows *rows, int32_t geometry, size_t obstacle) {
  return edge_is_noted(rows, geometry, rows->all ? 0 : obstacle);
}

static inline size_t edge_blocks_of(size_t points) {
  return (points + EDGE_BLOCK - 1) / EDGE_BLOCK;
}

/* Point i of a hull; points are set in order. */
static inline void edge_set_point(float *points, size_t i, vec3 p) {
  for (size_t k = i; k == i || k % EDGE_BLOCK != 0; k++) {
    float *to = points + edge_point_place(k);
    to[0] = (float)p.x, to[EDGE_BLOCK] = (float)p.y, to[2 * EDGE_BLOCK] = (float)p.z;
  }
}

static inline vec3 edge_point(const float *points, size_t i) {
  const float *p = points + edge_point_place(i);
  return vec((double)p[0], (double)p[EDGE_BLOCK], (double)p[2 * EDGE_BLOCK]);
}

/* Arrays in one block; without a block their sizes are added up. */
typedef struct edge_arena {
  char *at;
  size_t bytes;
} edge_arena;

static inline void *edge_take(edge_arena *a, size_t n, size_t size) {
  void *here = a->at ? a->at + a->bytes : NULL;
  a->bytes += (n * size + 15) / 16 * 16;
  return here;
}

/* Entries of a rotation as they go into lanes; whether only coordinates are exchanged: column k is then `sign` times the
 * coordinate `from`. */
bool edge_snap(const double r[9], float out[9], int32_t from[3], float sign[3]);

/* A ball about the middle of their box that all points of a hull are in. */
void edge_enclose_points(edge_hull *hull, const float *points);

/* Whether two geometries of a robot are asked about each other where no list says so: two joints or more are between
 * them. */
bool edge_is_worth_asking(const cprox_robot *robot, size_t geometry, size_t other);

#endif
