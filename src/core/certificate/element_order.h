/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements of a tree in the order that certificates count them in: a node's lanes one after the other. Groups of
 * elements are ranges of this order. */
#ifndef CPROX_CERTIFICATE_ELEMENT_ORDER_H
#define CPROX_CERTIFICATE_ELEMENT_ORDER_H

#include "base/workspace.h"
#include "bvh/bvh.h"
#include "shape/body.h"

/* The tree of a mesh, points or boxes, of a level-of-detail body that of the finest model; NULL of other bodies. */
const cprox_body *elements_body(const cprox_body *body);

typedef struct element_order {
  const tree *t;
  const uint32_t *first; /* the number of each pack's first element */
} element_order;

/* Elements begin ... end - 1: lanes from ... to - 1 of a node, or of a pack with TREE_LEAF. */
typedef struct element_range {
  uint32_t at, from, to, begin, end;
} element_range;

/* Counts the elements in `first`, room for t->n_packs. */
element_order elements_order(const tree *t, uint32_t *first);

element_range elements_all(const element_order *order);

/* Cuts a range in two where the tree cuts it; false: it is a single element. */
bool elements_cut(const element_order *order, element_range range, element_range half[2]);

/* How far a range reaches along d, about the tree's origin, and a vertex that does; within 4 u |d| scale. */
double elements_reach(const element_order *order, const element_range *range, vec3 d, vec3 *at);

typedef struct element_box {
  vec3 low, high;
} element_box;

/* The box round the vertices of a range. */
element_box elements_box(const element_order *order, const element_range *range);

/* The middle and the half edges of a box, each rounded once. */
static inline vec3 element_box_middle(const element_box *b) {
  return vec(0.5 * (b->low.x + b->high.x), 0.5 * (b->low.y + b->high.y), 0.5 * (b->low.z + b->high.z));
}

static inline vec3 element_box_half(const element_box *b) {
  return vec(0.5 * (b->high.x - b->low.x), 0.5 * (b->high.y - b->low.y), 0.5 * (b->high.z - b->low.z));
}

/* From the box to a point, from each side that the point is beyond; 0 in the box. */
static inline vec3 element_box_way(const element_box *b, vec3 y) {
  const vec3 z = vec_sub(y, element_box_middle(b)), h = element_box_half(b);
  return vec(copysign(fmax(fabs(z.x) - h.x, 0.0), z.x), copysign(fmax(fabs(z.y) - h.y, 0.0), z.y),
             copysign(fmax(fabs(z.z) - h.z, 0.0), z.z));
}

static inline double element_box_reach(const element_box *b, vec3 d) {
  return vec_dot(
      d, vec(d.x > 0.0 ? b->high.x : b->low.x, d.y > 0.0 ? b->high.y : b->low.y, d.z > 0.0 ? b->high.z : b->low.z));
}

/* The hull of a range as a convex shape about the tree's origin, known by its support function. */
typedef struct element_hull {
  element_order order;
  element_range range;
  convex shape;
} element_hull;

/* The shape refers to the hull, which must stay where it is. */
void elements_hull(element_hull *hull, const element_order *order, element_range range);

/* The lane of a pack that counts: a pack that is not full repeats its last element. */
uint32_t elements_lane(const tree *t, tree_place at);

/* One element as a body of its vertices, about the tree's origin. */
typedef struct element_body {
  cprox_body body;
  double x[8], y[8], z[8];
} element_body;

/* The body refers to itself. */
void elements_one(element_body *one, const tree *t, tree_place at);

/* The vertices of an element: 3 of a triangle, 1, or 8. */
int elements_vertices(const tree *t, tree_place at, vec3 v[8]);

/* Calls for every element in the order of a range. */
void elements_each(const element_order *order, const element_range *range, void (*visit)(void *self, tree_place at),
                   void *self);

#endif
