/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds a bounding-volume hierarchy: eight boxes a node, elements in packs of eight. One of two builders decides how
 * elements are grouped: by surface area (build_area.c) or along Morton's curve (build_morton.c). Triangles then get the
 * slabs of their nodes (slabs.c). */
#include "bvh/build.h"

#include <stdlib.h>
#include <string.h>

#include "bvh/kernels.h"

/* Gives back what was reserved for the worst case. */
static void *shrink(void *memory, size_t bytes) {
  void *smaller = aligned_alloc(64, tree_whole_lines(bytes));
  if (!smaller) return memory;
  memcpy(smaller, memory, bytes);
  free(memory);
  return smaller;
}

static void shrink_all(tree *t) {
  t->nodes = shrink(t->nodes, t->n_nodes * sizeof *t->nodes);
  t->packs = shrink(t->packs, t->n_packs * tree_pack_size(t->kind) * sizeof *t->packs);
  t->ids = shrink(t->ids, t->n_packs * TREE_LANES * sizeof *t->ids);
}

tree *tree_create(const tree_source *source, tree_build build) {
  tree *t = calloc(1, sizeof *t);
  if (!t) return NULL;
  const size_t packs = tree_most_packs(source->n, build), nodes = tree_most_nodes(source->n, build);
  t->kind = source->kind;
  t->n = source->n;
  const bool made = tree_allocate(t, packs, nodes) &&
                    (build == TREE_BY_AREA ? tree_build_by_area(t, source) : tree_build_by_morton(t, source));
  if (!made) {
    tree_free(t);
    return NULL;
  }
  if (build == TREE_BY_AREA) shrink_all(t);
  tree_find_scale(t);
  if (t->kind == TREE_TRIANGLES && !tree_lay_slabs(t)) {
    tree_free(t);
    return NULL;
  }
  t->kernel = tree_kernel_at(simd_of_machine());
  return t;
}
