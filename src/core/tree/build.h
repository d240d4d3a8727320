/* SPDX-License-Identifier: BSD-3-Clause */
/* What both ways to build a tree share. */
#ifndef CPROX_TREE_BUILD_H
#define CPROX_TREE_BUILD_H

#include "tree/tree.h"

typedef struct box {
  vec3 low, high;
} box;

box box_empty(void);
void box_add(box *b, const box *other);

/* The box of an element, about the centre. */
box element_box(const tree_source *source, uint32_t element);

/* Writes elements into the next pack, the last one repeated; returns the pack's box. The tree has room for it. */
box tree_append_pack(tree *t, const tree_source *source, const uint32_t *elements, size_t n);

/* Fills lanes 0 … n-1 of a node, and repeats the last. */
void tree_fill_node(tree_node *node, const box *boxes, const uint32_t *children, size_t n);

/* Both fill a tree with room for all; false where memory is out. */
bool tree_build_by_area(tree *t, const tree_source *source);
bool tree_build_by_morton(tree *t, const tree_source *source);

#endif
