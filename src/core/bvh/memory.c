/* SPDX-License-Identifier: BSD-3-Clause */
/* The memory of a tree. */
#include <stdlib.h>

#include "bvh/build.h"
#include "bvh/family.h"

size_t tree_most_packs(size_t n, tree_build build) {
  /* by area, every cut leaves both sides at least half a pack */
  return build == TREE_BY_MORTON ? (n + TREE_LANES - 1) / TREE_LANES : 2 * n / TREE_LANES + 1;
}

size_t tree_most_nodes(size_t n, tree_build build) {
  /* by Morton's curve nodes are full but for one a level; by area they have at least two children */
  size_t packs = tree_most_packs(n, build);
  if (build == TREE_BY_AREA) return packs;
  size_t nodes = 0;
  do {
    packs = (packs + TREE_LANES - 1) / TREE_LANES;
    nodes += packs;
  } while (packs > 1);
  return nodes;
}

static size_t node_bytes(tree_kind kind) {
  return sizeof(tree_node) + (kind == TREE_TRIANGLES ? sizeof(tree_slabs) : 0);
}

size_t tree_bytes_needed(tree_kind kind, size_t n, tree_build build) {
  const size_t pack = tree_pack_size(kind) * sizeof(double) + TREE_LANES * sizeof(uint32_t);
  return sizeof(tree) + tree_most_packs(n, build) * pack + tree_most_nodes(n, build) * node_bytes(kind);
}

size_t tree_bytes(const tree *t) {
  const size_t pack = tree_pack_size(t->kind) * sizeof(double) + TREE_LANES * sizeof(uint32_t);
  return sizeof *t + t->n_packs * pack + t->n_nodes * node_bytes(t->kind) + (t->blocks ? tree_blocks_bytes(t->n) : 0);
}

size_t tree_whole_lines(size_t bytes) {
  return (bytes + 63) / 64 * 64;
}

bool tree_allocate(tree *t, size_t packs, size_t nodes) {
  t->nodes = aligned_alloc(64, tree_whole_lines(nodes * sizeof *t->nodes));
  t->packs = aligned_alloc(64, tree_whole_lines(packs * tree_pack_size(t->kind) * sizeof *t->packs));
  t->ids = aligned_alloc(64, tree_whole_lines(packs * TREE_LANES * sizeof *t->ids));
  return t->nodes && t->packs && t->ids;
}

void tree_free(tree *t) {
  if (!t) return;
  free(t->nodes);
  free(t->slabs);
  free(t->packs);
  free(t->ids);
  tree_blocks_free(t->blocks);
  free(t);
}
