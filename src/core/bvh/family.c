/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/family.h"

#include <stdlib.h>

static size_t blocks_for(size_t n) {
  return (n + TREE_BLOCK - 1) / TREE_BLOCK;
}

void tree_blocks_free(struct tree_blocks *blocks) {
  if (!blocks) return;
  if (blocks->family && atomic_fetch_sub(&blocks->family->members, 1) == 1) free(blocks->family);
  free(blocks->block_of);
  free(blocks->state);
  free(blocks->area);
  free(blocks);
}

struct tree_blocks *tree_blocks_allocate(size_t n) {
  struct tree_blocks *made = calloc(1, sizeof *made);
  if (!made) return NULL;
  made->n = blocks_for(n);
  made->block_of = malloc(n * sizeof *made->block_of);
  made->state = calloc(made->n, sizeof *made->state);
  made->area = calloc(made->n, sizeof *made->area);
  if (made->block_of && made->state && made->area) return made;
  tree_blocks_free(made);
  return NULL;
}

bool tree_begin_family(tree *t) {
  t->blocks = tree_blocks_allocate(t->n);
  if (!t->blocks) return false;
  t->blocks->family = calloc(1, sizeof *t->blocks->family);
  if (!t->blocks->family) return false;
  atomic_init(&t->blocks->family->next, 1);
  atomic_init(&t->blocks->family->members, 1);
  for (size_t i = 0; i < t->n; i++) t->blocks->block_of[t->ids[i]] = (uint32_t)(i / TREE_BLOCK);
  return true;
}

size_t tree_blocks_bytes(size_t n) {
  return sizeof(struct tree_blocks) + n * sizeof(uint32_t) + blocks_for(n) * (sizeof(uint64_t) + sizeof(double));
}

bool tree_is_family(const tree *a, const tree *b) {
  return a->blocks && b->blocks && a->blocks->family == b->blocks->family;
}
