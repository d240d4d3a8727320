/* SPDX-License-Identifier: BSD-3-Clause */
/* Inside or outside of a closed mesh by its winding number: the signed crossings of a ray; where rays come too near to
 * edges, the solid angle that the triangles subtend, summed up, far ones together as a dipole (Barill, Dickson,
 * Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018). */
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

/* WINDING_NEAR: too near to the surface to tell. */
typedef enum winding_side { WINDING_OUTSIDE, WINDING_NEAR, WINDING_INSIDE } winding_side;

/* On which side a point is that is known to within `error`. */
winding_side winding_side_of(const winding *w, const tree *t, vec3 x, double error);

/* Elements of another tree, seen from the closed mesh: their points x are at r x + at, to within `error`. */
typedef struct winding_guest {
  const tree *elements;
  double r[9];
  vec3 at;
  double error;
} winding_guest;

/* WINDING_INSIDE: *point, of one of the elements and in their own frame, is inside. WINDING_OUTSIDE: of every element
 * that does not cross the surface all is outside. */
winding_side winding_find_inside(const winding *w, const tree *t, const winding_guest *guest, vec3 *point);

#endif
