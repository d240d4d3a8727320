/* SPDX-License-Identifier: BSD-3-Clause */
/* Inside or outside of a closed mesh by its winding number: the solid angle that the triangles subtend, summed up; far
 * ones count together as a dipole (Barill, Dickson, Schmidt, Levin, Jacobson, "Fast winding numbers for soups and
 * clouds", 2018). */
#ifndef CPROX_BVH_WINDING_H
#define CPROX_BVH_WINDING_H

#include "bvh/bvh.h"

typedef struct winding winding;

/* Of a tree of triangles; NULL where memory is out. winding_free() frees. */
winding *winding_create(const tree *t);
void winding_free(winding *w);

size_t winding_bytes_needed(size_t n_nodes);
size_t winding_bytes(const winding *w);

/* Whether a closed mesh winds round x. Means something where x is farther from the surface than rounding. */
bool winding_is_inside(const winding *w, const tree *t, vec3 x);

#endif
