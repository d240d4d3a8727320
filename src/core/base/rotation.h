/* SPDX-License-Identifier: BSD-3-Clause */
/* Row-major rotation matrices and vectors, and where something stands. */
#ifndef CPROX_BASE_ROTATION_H
#define CPROX_BASE_ROTATION_H

#include "base/vec.h"

static inline vec3 rotate(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
             r[6] * v.x + r[7] * v.y + r[8] * v.z);
}

/* By the transposed matrix. */
static inline vec3 rotate_back(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
             r[2] * v.x + r[5] * v.y + r[8] * v.z);
}

/* out = a b */
static inline void rotation_compose(const double a[9], const double b[9], double out[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/* Where something is: x_world = r x + p. */
typedef struct placement {
  double r[9]; /* row-major */
  vec3 p;
} placement;

static inline vec3 placement_turn(const placement *at, vec3 v) {
  return rotate(at->r, v);
}

static inline vec3 placement_turn_back(const placement *at, vec3 v) {
  return rotate_back(at->r, v);
}

static inline vec3 placement_apply(const placement *at, vec3 v) {
  return vec_add(placement_turn(at, v), at->p);
}

#endif
