/* SPDX-License-Identifier: BSD-3-Clause */
/* Bottom up along Morton's curve: elements are sorted by the interleaved bits of their middles, packed eight by eight,
 * and the packs likewise, level by level. */
#include <stdlib.h>
#include <string.h>

#include "base/workspace.h"
#include "bvh/build.h"

enum { KEY_BITS = 21, RADIX_BITS = 11, RADIX = 1 << RADIX_BITS, FIRST_BIT = 3 * KEY_BITS - 4 * RADIX_BITS };

/* How many packs ahead the elements are fetched. */
enum { AHEAD = 4 };

typedef struct tree_keyed keyed;

/* Two zero bits behind each of the lowest 21. */
static uint64_t spread(uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

static vec3 middle2(const tree_source *source, uint32_t element) {
  if (source->kind == TREE_POINTS) return vec_scale(2.0, vec_sub(source->points[element], source->centre));
  const box b = tree_element_box(source, element);
  return vec_add(b.low, b.high);
}

static void make_keys(const tree_source *source, keyed *list) {
  box all = box_empty();
  for (size_t i = 0; i < source->n; i++) {
    const vec3 m = middle2(source, (uint32_t)i);
    box_add(&all, &(box){m, m});
  }
  const vec3 extent = vec_sub(all.high, all.low);
  const double widest = fmax(extent.x, fmax(extent.y, extent.z));
  const double scale = widest > 1e-250 ? (double)((1 << KEY_BITS) - 1) / widest : 0.0;
  for (size_t i = 0; i < source->n; i++) {
    const vec3 m = vec_scale(scale, vec_sub(middle2(source, (uint32_t)i), all.low));
    list[i] = (keyed){spread((uint64_t)m.x) | spread((uint64_t)m.y) << 1 | spread((uint64_t)m.z) << 2, (uint32_t)i};
  }
}

/* By the upper 44 bits of the key, in four passes; 22 of them, in two, tell the elements of one block apart. Ends in
 * `list`. False where the workspace stops. */
static bool sort_keys(keyed *list, keyed *other, size_t n, cprox_workspace *workspace) {
  enum { PASSES = 4 };
  size_t start[PASSES][RADIX + 1] = {{0}};
  const int first = n > TREE_BLOCK ? 0 : PASSES / 2;
  for (size_t i = 0; i < n; i++) {
    uint64_t digits = list[i].key >> (FIRST_BIT + first * RADIX_BITS);
    for (int pass = first; pass < PASSES; pass++, digits >>= RADIX_BITS) start[pass][(digits & (RADIX - 1)) + 1]++;
  }
  for (int pass = first; pass < PASSES; pass++) {
    if (n > TREE_STOP_INTERVAL && workspace_stops(workspace)) return false;
    const int shift = FIRST_BIT + pass * RADIX_BITS;
    size_t *to = start[pass];
    for (int i = 0; i < RADIX; i++) to[i + 1] += to[i];
    for (size_t i = 0; i < n; i++) other[to[(list[i].key >> shift) & (RADIX - 1)]++] = list[i];
    keyed *swap = list;
    list = other;
    other = swap;
  }
  return true;
}

void tree_morton_order(const tree_source *source, keyed *memory, uint32_t *order) {
  make_keys(source, memory);
  sort_keys(memory, memory + source->n, source->n, NULL);
  for (size_t i = 0; i < source->n; i++) order[i] = memory[i].element;
}

box tree_node_box(const tree_node *node) {
  box all = box_empty();
  for (int l = 0; l < TREE_LANES; l++)
    box_add(&all, &(box){vec(node->low[0][l], node->low[1][l], node->low[2][l]),
                         vec(node->high[0][l], node->high[1][l], node->high[2][l])});
  return all;
}

/* One level over `count` children, which are packs, or the nodes from `first_child` on. */
static void build_level(tree *t, size_t at, size_t count, size_t first_child, const box *packs) {
  for (size_t i = 0; i * TREE_LANES < count; i++) {
    box boxes[TREE_LANES];
    uint32_t children[TREE_LANES];
    size_t n = 0;
    for (; n < TREE_LANES && i * TREE_LANES + n < count; n++) {
      const size_t child = i * TREE_LANES + n;
      boxes[n] = packs ? packs[child] : tree_node_box(&t->nodes[first_child + child]);
      children[n] = packs ? (uint32_t)child | TREE_LEAF : (uint32_t)(first_child + child);
    }
    tree_fill_node(&t->nodes[at + i], boxes, children, n);
  }
}

static void build_levels(tree *t, const box *packs) {
  /* the root comes first, the lowest level last */
  size_t below = 0, count = t->n_packs, end = tree_most_nodes(t->n, TREE_BY_MORTON);
  t->n_nodes = end;
  do {
    const size_t nodes = (count + TREE_LANES - 1) / TREE_LANES, at = end - nodes;
    build_level(t, at, count, below, count == t->n_packs && below == 0 ? packs : NULL);
    below = at, count = nodes, end = at;
  } while (count > 1);
}

static void prefetch(const tree_source *source, uint32_t element) {
  if (source->kind == TREE_TRIANGLES) return;
  __builtin_prefetch(&source->points[element]);
  if (source->kind == TREE_BOXES) __builtin_prefetch(&source->high[element]);
}

bool tree_build_by_morton(tree *t, const tree_source *source) {
  const size_t n = source->n, packs = tree_most_packs(n, TREE_BY_MORTON);
  keyed *list = malloc(2 * n * sizeof *list);
  box *boxes = malloc(packs * sizeof *boxes);
  bool made = list && boxes;
  if (made) {
    make_keys(source, list);
    made = sort_keys(list, list + n, n, source->workspace);
    for (size_t p = 0; p < packs && made; p++) {
      if (p * TREE_LANES % TREE_STOP_INTERVAL == 0 && p > 0) made = !workspace_stops(source->workspace);
      /* elements that are near in space may be anywhere in memory */
      for (size_t i = (p + AHEAD) * TREE_LANES; i < (p + AHEAD + 1) * TREE_LANES && i < n; i++)
        prefetch(source, list[i].element);
      uint32_t elements[TREE_LANES];
      size_t count = 0;
      for (; count < TREE_LANES && p * TREE_LANES + count < n; count++)
        elements[count] = list[p * TREE_LANES + count].element;
      boxes[p] = tree_append_pack(t, source, elements, count);
    }
    if (made) build_levels(t, boxes);
  }
  free(list);
  free(boxes);
  return made;
}
