/* SPDX-License-Identifier: BSD-3-Clause */
/* What both ways to build a tree share. */
#ifndef CPROX_BVH_BUILD_H
#define CPROX_BVH_BUILD_H

#include "bvh/bvh.h"

typedef struct box {
  vec3 low, high;
} box;

box box_empty(void);
void box_add(box *b, const box *other);

/* The box of an element, about the centre. */
box tree_element_box(const tree_source *source, uint32_t element);

/* Writes elements into the next pack, the last one repeated; returns the pack's box. The tree has room for it. */
box tree_append_pack(tree *t, const tree_source *source, const uint32_t *elements, size_t n);

/* The box round a pack's elements. */
box tree_pack_box(tree_kind kind, const double *pack);

/* Fills lanes 0 … n-1 of a node, and repeats the last. */
void tree_fill_node(tree_node *node, const box *boxes, const uint32_t *children, size_t n);

box tree_node_box(const tree_node *node);

/* Memory for so many packs and nodes; false where it is out, and what there is then is tree_free()'s. */
bool tree_allocate(tree *t, size_t packs, size_t nodes);

/* A size in whole cache lines, which aligned memory comes in. */
size_t tree_whole_lines(size_t bytes);

/* How far the elements reach, by the root's boxes. */
void tree_find_scale(tree *t);

/* The slabs of a tree of triangles that is built, its scale known; false where memory is out. */
bool tree_lay_slabs(tree *t);

/* The elements in the order of Morton's curve. memory: room for 2 n. */
struct tree_keyed {
  uint64_t key;
  uint32_t element;
};
void tree_morton_order(const tree_source *source, struct tree_keyed *memory, uint32_t *order);

/* Elements that are worked on between two looks at the stop function: a few milliseconds. */
enum { TREE_STOP_INTERVAL = 1 << 14 };

/* Both fill a tree with room for all; false where memory is out, or the source's workspace stops. */
bool tree_build_by_area(tree *t, const tree_source *source);
bool tree_build_by_morton(tree *t, const tree_source *source);

#endif
