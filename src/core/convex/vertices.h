/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes stored as vertices, one array a coordinate. */
#ifndef CPROX_CONVEX_VERTICES_H
#define CPROX_CONVEX_VERTICES_H

#include "convex/convex.h"

/* The vertex farthest along d: a scan over all of them. *most, where not NULL, receives its d·x. */
int32_t vertices_extreme(const convex *shape, vec3 d, double *most);

static inline vec3 vertices_at(const convex *shape, int32_t i) {
  return vec(shape->x[i], shape->y[i], shape->z[i]);
}

double vertices_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at);
bool vertices_cover(const convex *shape, const convex_near *near, convex_cover *cover);

#endif
