/* SPDX-License-Identifier: BSD-3-Clause */
/* Points that move: of a tree along Morton's curve the blocks that they are in are boxed anew, or sorted anew where
 * that is no longer good enough, the others copied, or, where an older tree of the family gives its memory, left as
 * they are. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/build.h"
#include "bvh/family.h"

enum { BLOCK_PACKS = TREE_BLOCK / TREE_LANES, BLOCK_LEVELS = 3, MOST_LEVELS = 12 };

/* A block is sorted when the areas of its packs' boxes have grown by so much since it was sorted last. */
static const double WORN_OUT = 1.5;

/* ---- levels ---- */

/* Where the levels of nodes begin, the lowest first, and how many nodes they have; the last one is the root's. */
typedef struct levels {
  size_t n, at[MOST_LEVELS], count[MOST_LEVELS];
} levels;

static levels levels_of(const tree *t) {
  levels l = {.n = 0};
  size_t count = t->n_packs, end = t->n_nodes;
  do {
    count = (count + TREE_LANES - 1) / TREE_LANES;
    end -= count;
    l.at[l.n] = end;
    l.count[l.n++] = count;
  } while (count > 1 && l.n < MOST_LEVELS);
  return l;
}

/* Nodes first … last - 1 of a level above the lowest, from the nodes below. */
static void refresh(tree *t, const levels *l, size_t level, size_t first, size_t last) {
  const size_t below = l->at[level - 1], count = l->count[level - 1];
  for (size_t i = first; i < last; i++) {
    box boxes[TREE_LANES];
    uint32_t children[TREE_LANES];
    size_t n = 0;
    for (; n < TREE_LANES && i * TREE_LANES + n < count; n++) {
      const size_t child = below + i * TREE_LANES + n;
      boxes[n] = tree_node_box(&t->nodes[child]);
      children[n] = (uint32_t)child;
    }
    tree_fill_node(&t->nodes[l->at[level] + i], boxes, children, n);
  }
}

/* ---- blocks ---- */

typedef struct span {
  size_t first, last;
} span;

/* Of `count` things, of which a block has `each`. */
static span span_of(size_t block, size_t each, size_t count) {
  const size_t first = block * each < count ? block * each : count;
  return (span){first, first + each < count ? first + each : count};
}

static void copy_block(tree *t, const tree *from, const levels *l, size_t block) {
  const size_t size = tree_pack_size(t->kind);
  const span p = span_of(block, BLOCK_PACKS, t->n_packs);
  memcpy(t->packs + p.first * size, from->packs + p.first * size, (p.last - p.first) * size * sizeof *t->packs);
  memcpy(t->ids + p.first * TREE_LANES, from->ids + p.first * TREE_LANES,
         (p.last - p.first) * TREE_LANES * sizeof *t->ids);
  for (size_t level = 0, each = BLOCK_PACKS / TREE_LANES; level < BLOCK_LEVELS && level < l->n; level++) {
    const span s = span_of(block, each, l->count[level]);
    memcpy(t->nodes + l->at[level] + s.first, from->nodes + l->at[level] + s.first,
           (s.last - s.first) * sizeof *t->nodes);
    each /= TREE_LANES;
  }
  t->blocks->state[block] = from->blocks->state[block];
  t->blocks->area[block] = from->blocks->area[block];
}

/* Of the boxes round a block's packs, which the lowest nodes have. */
static double area_of(const tree *t, const levels *l, size_t block) {
  const span s = span_of(block, BLOCK_PACKS / TREE_LANES, l->count[0]);
  double sum = 0.0;
  for (size_t i = s.first; i < s.last; i++) {
    const tree_node *node = &t->nodes[l->at[0] + i];
    for (int k = 0; k < TREE_LANES; k++) {
      const double x = node->high[0][k] - node->low[0][k], y = node->high[1][k] - node->low[1][k],
                   z = node->high[2][k] - node->low[2][k];
      sum += x * y + y * z + z * x;
    }
  }
  return sum;
}

/* The nodes of a block, from the boxes of its packs. */
static void raise_block(tree *t, const levels *l, size_t block, const box *boxes) {
  const span p = span_of(block, BLOCK_PACKS, t->n_packs), s = span_of(block, BLOCK_PACKS / TREE_LANES, l->count[0]);
  for (size_t i = s.first; i < s.last; i++) {
    uint32_t children[TREE_LANES];
    size_t k = 0;
    for (; k < TREE_LANES && i * TREE_LANES + k < p.last; k++) children[k] = (uint32_t)(i * TREE_LANES + k) | TREE_LEAF;
    tree_fill_node(&t->nodes[l->at[0] + i], boxes + (i - s.first) * TREE_LANES, children, k);
  }
  for (size_t level = 1, each = BLOCK_PACKS / TREE_LANES / TREE_LANES; level < BLOCK_LEVELS && level < l->n; level++) {
    const span above = span_of(block, each, l->count[level]);
    refresh(t, l, level, above.first, above.last);
    each /= TREE_LANES;
  }
}

/* One block's elements and where they stand now. */
typedef struct gathered {
  uint32_t id[TREE_BLOCK], order[TREE_BLOCK];
  vec3 at[TREE_BLOCK];
  struct tree_keyed memory[2 * TREE_BLOCK];
} gathered;

/* Sorts a block anew, from what was gathered. */
static void rebuild_block(tree *t, const levels *l, size_t block, gathered *g, size_t n) {
  const tree_source source = {.kind = t->kind, .n = n, .points = g->at};
  tree_morton_order(&source, g->memory, g->order);
  const span p = span_of(block, BLOCK_PACKS, t->n_packs);
  box boxes[BLOCK_PACKS];
  const size_t packs = t->n_packs;
  t->n_packs = p.first;
  for (size_t i = 0; i < p.last - p.first; i++) {
    const size_t first = i * TREE_LANES, left = n - first;
    boxes[i] = tree_append_pack(t, &source, g->order + first, left < TREE_LANES ? left : TREE_LANES);
  }
  t->n_packs = packs;
  for (size_t i = p.first * TREE_LANES; i < p.last * TREE_LANES; i++) t->ids[i] = g->id[t->ids[i]];

  raise_block(t, l, block, boxes);
  t->blocks->area[block] = area_of(t, l, block);
}

/* ---- updates ---- */

static tree *allocate_like(const tree *previous) {
  tree *t = calloc(1, sizeof *t);
  if (!t) return NULL;
  *t = *previous;
  t->nodes = NULL, t->packs = NULL, t->ids = NULL;
  t->blocks = tree_blocks_allocate(t->n);
  if (tree_allocate(t, t->n_packs, t->n_nodes) && t->blocks) {
    t->blocks->family = previous->blocks->family;
    atomic_fetch_add(&t->blocks->family->members, 1);
    memcpy(t->blocks->block_of, previous->blocks->block_of, t->n * sizeof *t->blocks->block_of);
    for (size_t b = 0; b < t->blocks->n; b++) t->blocks->state[b] = UINT64_MAX; /* nothing yet */
    return t;
  }
  tree_free(t);
  return NULL;
}

/* By block, and within a block as they came: the last place of an element counts. */
typedef struct change {
  uint32_t block, which;
} change;

/* A block's changes lie together: counted, then dealt out. */
static void deal(const tree *t, const uint32_t *changed, size_t n, change *list, size_t *start) {
  const uint32_t *block_of = t->blocks->block_of;
  for (size_t i = 0; i < n; i++) start[block_of[changed[i]] + 1]++;
  for (size_t b = 0; b < t->blocks->n; b++) start[b + 1] += start[b];
  for (size_t i = 0; i < n; i++) {
    const uint32_t block = block_of[changed[i]];
    list[start[block]++] = (change){block, (uint32_t)i};
  }
  for (size_t b = t->blocks->n; b > 0; b--) start[b] = start[b - 1];
  start[0] = 0;
}

/* The elements of a block as they stood, then as they changed. `local` finds one by its number. */
static size_t gather(const tree *previous, size_t block, const change *list, size_t n_changes, const uint32_t *changed,
                     const vec3 *points, vec3 centre, uint32_t *local, gathered *g) {
  const span e = span_of(block, TREE_BLOCK, previous->n);
  for (size_t i = e.first; i < e.last; i++) {
    const double *pack = previous->packs + i / TREE_LANES * tree_pack_size(previous->kind) + i % TREE_LANES;
    const size_t k = i - e.first;
    g->id[k] = previous->ids[i];
    g->at[k] = vec(pack[0], pack[TREE_LANES], pack[2 * TREE_LANES]);
    local[g->id[k]] = (uint32_t)k;
  }
  for (size_t i = 0; i < n_changes; i++) g->at[local[changed[list[i].which]]] = vec_sub(points[list[i].which], centre);
  return e.last - e.first;
}

/* Moves a block's points where they are in its packs, whose boxes follow. `local` finds an element by its number. */
static void refit_block(tree *t, const levels *l, size_t block, const change *list, size_t n_changes,
                        const uint32_t *changed, const vec3 *points, vec3 centre, uint32_t *local) {
  const size_t size = tree_pack_size(t->kind);
  const span e = span_of(block, TREE_BLOCK, t->n), p = span_of(block, BLOCK_PACKS, t->n_packs);
  for (size_t i = e.first; i < e.last; i++) local[t->ids[i]] = (uint32_t)i;
  for (size_t i = 0; i < n_changes; i++) {
    const size_t at = local[changed[list[i].which]];
    double *to = t->packs + at / TREE_LANES * size + at % TREE_LANES;
    const vec3 x = vec_sub(points[list[i].which], centre);
    to[0] = x.x, to[TREE_LANES] = x.y, to[2 * TREE_LANES] = x.z;
  }
  /* a pack that is not full repeats its last element */
  for (size_t i = e.last; i < p.last * TREE_LANES; i++) {
    double *to = t->packs + i / TREE_LANES * size + i % TREE_LANES;
    for (int k = 0; k < 3; k++, to += TREE_LANES) to[0] = to[-1];
  }
  box boxes[BLOCK_PACKS];
  for (size_t i = p.first; i < p.last; i++) boxes[i - p.first] = tree_pack_box(t->kind, t->packs + i * size);
  raise_block(t, l, block, boxes);
}

tree *tree_update(const tree *previous, const uint32_t *changed, const vec3 *points, size_t n, vec3 centre,
                  tree *retired) {
  change *list = malloc((n + 1) * sizeof *list);
  size_t *start = calloc(previous->blocks->n + 2, sizeof *start);
  uint32_t *local = malloc(previous->n * sizeof *local);
  gathered *g = malloc(sizeof *g);
  tree *t = list && start && local && g ? (retired ? retired : allocate_like(previous)) : NULL;
  if (t) {
    const levels l = levels_of(t);
    const uint64_t now = atomic_fetch_add(&t->blocks->family->next, 1);
    deal(previous, changed, n, list, start);
    for (size_t b = 0; b < t->blocks->n; b++) {
      if (start[b + 1] > start[b]) {
        const change *block = list + start[b];
        const size_t changes = start[b + 1] - start[b];
        if (t->blocks->state[b] != previous->blocks->state[b]) copy_block(t, previous, &l, b);
        if (!(t->blocks->area[b] > 0.0)) t->blocks->area[b] = area_of(previous, &l, b);
        refit_block(t, &l, b, block, changes, changed, points, centre, local);
        if (!(area_of(t, &l, b) <= WORN_OUT * t->blocks->area[b])) {
          const size_t count = gather(previous, b, block, changes, changed, points, centre, local, g);
          rebuild_block(t, &l, b, g, count);
        }
        t->blocks->state[b] = now;
      } else if (t->blocks->state[b] != previous->blocks->state[b]) {
        copy_block(t, previous, &l, b);
      }
    }
    for (size_t level = BLOCK_LEVELS; level < l.n; level++) refresh(t, &l, level, 0, l.count[level]);
    tree_find_scale(t);
  }
  free(list), free(start), free(local), free(g);
  return t;
}
