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

/* Entries of rotations below this are 0. */
#define EDGE_SNAP 1e-9

/* Entries of a rotation as they go into lanes; whether only coordinates are exchanged: column k is then `sign` times
 * the coordinate `from`. */
static inline bool edge_snap(const double r[9], float out[9], int32_t from[3], float sign[3]) {
  bool exchanges = true;
  for (int k = 0; k < 9; k++) {
    const double x = fabs(r[k]) < EDGE_SNAP ? 0.0 : fabs(fabs(r[k]) - 1.0) < EDGE_SNAP ? copysign(1.0, r[k]) : r[k];
    out[k] = (float)x;
    exchanges = exchanges && (x == 0.0 || fabs(x) == 1.0);
  }
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      if (out[3 * k + c] != 0.0f) from[c] = k, sign[c] = out[3 * k + c];
  return exchanges;
}

/* A rotation that takes the z axis to the unit vector z. */
static inline placement edge_turn_to(vec3 z) {
  const vec3 side = fabs(z.x) < 0.6 ? vec(1, 0, 0) : vec(0, 1, 0);
  vec3 x = vec_axpy(side, -vec_dot(side, z), z);
  x = vec_scale(1.0 / vec_norm(x), x);
  const vec3 y = vec_cross(z, x);
  return (placement){.r = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}};
}

/* What turns the axes of a frame in lanes, whose z is its joint's, to those of the joint. */
static inline placement edge_turn_of_axis(const robot_axis *axis) {
  static const placement HERE = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  return axis->along == 2 && axis->z.z > 0.0 ? HERE : edge_turn_to(axis->z);
}

/* A ball about the middle of their box that all points of a hull are in. */
static inline void edge_enclose_points(edge_hull *hull, const float *points) {
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < hull->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const float x = points[edge_point_place(i) + k * EDGE_BLOCK];
      low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
    }
  for (int k = 0; k < 3; k++) hull->centre[k] = 0.5f * low[k] + 0.5f * high[k];
  double core2 = 0.0;
  const vec3 centre = vec((double)hull->centre[0], (double)hull->centre[1], (double)hull->centre[2]);
  for (uint32_t i = 0; i < hull->n; i++) {
    const vec3 apart = vec_sub(edge_point(points, i), centre);
    core2 = greater(vec_dot(apart, apart), core2);
  }
  hull->core = edge_float_above(sqrt(core2) * (1.0 + 0x1p-40));
}

#endif
