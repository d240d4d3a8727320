/* SPDX-License-Identifier: BSD-3-Clause */
/* A row-major rotation matrix and a vector. */
#ifndef CPROX_CONVEX_TURN_H
#define CPROX_CONVEX_TURN_H

#include "base/vec.h"

static inline vec3 turn(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
             r[6] * v.x + r[7] * v.y + r[8] * v.z);
}

static inline vec3 turn_back(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
             r[2] * v.x + r[5] * v.y + r[8] * v.z);
}

#endif
