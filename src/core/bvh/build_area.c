/* SPDX-License-Identifier: BSD-3-Clause */
/* Top down by the surface area heuristic (Wald 2007, binned): a range of elements is cut, the largest part again, until
 * a node has its eight children. */
#include <stdlib.h>

#include "base/workspace.h"
#include "bvh/build.h"

enum { BINS = 16, DEEPEST_BY_AREA = 24 };

/* A box as its low corner and its high one negated: the smaller number is always the wider one, so that two boxes are
 * united without asking which corner a number belongs to. */
typedef struct bounds {
  double at[6];
} bounds;

/* An element on its way into the tree. */
typedef struct item {
  bounds b;
  uint32_t element;
} item;

typedef struct builder {
  tree *t;
  const tree_source *source;
  item *items; /* a range for each subtree */
  bool stopped;
} builder;

static inline bounds bounds_empty(void) {
  return (bounds){{INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY}};
}

static inline void grow(bounds *b, const bounds *other) {
  for (int k = 0; k < 6; k++) b->at[k] = other->at[k] < b->at[k] ? other->at[k] : b->at[k];
}

/* Twice the middle of an element's box. */
static inline double middle2(const item *i, int axis) {
  return i->b.at[axis] - i->b.at[3 + axis];
}

static double area_of(const bounds *b) {
  const double x = -b->at[3] - b->at[0], y = -b->at[4] - b->at[1], z = -b->at[5] - b->at[2];
  return x * y + y * z + z * x;
}

/* ---- where to cut ---- */

/* A bin boundary across an axis. */
typedef struct cut {
  int axis, bin;
  double low, scale;
  double cost;
} cut;

static int bin_of(const item *i, const cut *c) {
  const int bin = (int)((middle2(i, c->axis) - c->low) * c->scale);
  return bin < BINS ? bin : BINS - 1;
}

static double packs_for(size_t n) {
  const size_t packs = (n + TREE_LANES - 1) / TREE_LANES;
  return (double)packs;
}

/* The cheapest boundary across one axis. */
static void try_axis(const builder *b, size_t first, size_t last, int axis, double low, double high, cut *best) {
  cut c = {.axis = axis, .low = low, .scale = (double)BINS / (high - low)};
  if (!isfinite(c.scale)) return;
  bounds boxes[BINS], right[BINS];
  size_t count[BINS] = {0}, behind[BINS];
  for (int i = 0; i < BINS; i++) boxes[i] = bounds_empty();
  for (size_t i = first; i < last; i++) {
    const int bin = bin_of(&b->items[i], &c);
    grow(&boxes[bin], &b->items[i].b);
    count[bin]++;
  }
  right[BINS - 1] = boxes[BINS - 1];
  behind[BINS - 1] = count[BINS - 1];
  for (int i = BINS - 1; i-- > 0;) {
    right[i] = right[i + 1];
    grow(&right[i], &boxes[i]);
    behind[i] = behind[i + 1] + count[i];
  }
  bounds left = bounds_empty();
  size_t before = 0;
  for (int i = 0; i + 1 < BINS; i++) {
    before += count[i];
    grow(&left, &boxes[i]);
    /* a side with less than half a pack would waste memory, more than was reserved */
    if (before < TREE_LANES / 2 || behind[i + 1] < TREE_LANES / 2) continue;
    c.bin = i;
    c.cost = area_of(&left) * packs_for(before) + area_of(&right[i + 1]) * packs_for(behind[i + 1]);
    if (c.cost < best->cost) *best = c;
  }
}

/* Moves the elements on the left of the cut to the front. */
static size_t partition(builder *b, size_t first, size_t last, const cut *c) {
  size_t m = first;
  for (size_t i = first; i < last; i++) {
    if (bin_of(&b->items[i], c) > c->bin) continue;
    const item moved = b->items[i];
    b->items[i] = b->items[m];
    b->items[m++] = moved;
  }
  return m;
}

/* Brings the m-th element of a range, by its middle along the axis, to place m, the lesser before it (Hoare's FIND). */
static void select_middle(builder *b, size_t first, size_t last, size_t m, int axis) {
  ptrdiff_t low = (ptrdiff_t)first, high = (ptrdiff_t)last - 1;
  const ptrdiff_t wanted = (ptrdiff_t)m;
  while (low < high) {
    const double pivot = middle2(&b->items[wanted], axis);
    ptrdiff_t i = low, j = high;
    while (i <= j) {
      while (middle2(&b->items[i], axis) < pivot) i++;
      while (pivot < middle2(&b->items[j], axis)) j--;
      if (i > j) break;
      const item moved = b->items[i];
      b->items[i++] = b->items[j];
      b->items[j--] = moved;
    }
    if (j < wanted) low = i;
    if (wanted < i) high = j;
  }
}

/* Cuts a range of more than a pack in two, neither empty; returns where. */
static size_t cut_range(builder *b, size_t first, size_t last, int depth) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t i = first; i < last; i++)
    for (int axis = 0; axis < 3; axis++) {
      const double middle = middle2(&b->items[i], axis);
      low[axis] = middle < low[axis] ? middle : low[axis];
      high[axis] = middle > high[axis] ? middle : high[axis];
    }
  const vec3 extent = vec(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  if (last - first > 2 * TREE_LANES && depth < DEEPEST_BY_AREA) {
    cut best = {.cost = INFINITY};
    for (int axis = 0; axis < 3; axis++)
      if (high[axis] > low[axis]) try_axis(b, first, last, axis, low[axis], high[axis], &best);
    if (isfinite(best.cost)) return partition(b, first, last, &best);
  }
  /* near the middle of the longest axis: at a whole pack, where that leaves at least half a one */
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const size_t n = last - first, whole = (n / 2 + TREE_LANES - 1) / TREE_LANES * TREE_LANES;
  const size_t m = first + (whole + TREE_LANES / 2 <= n ? whole : n / 2);
  select_middle(b, first, last, m, axis);
  return m;
}

/* ---- nodes ---- */

static uint32_t build_range(builder *b, size_t first, size_t last, int depth, box *all) {
  if (last - first <= TREE_LANES) {
    const uint32_t pack = (uint32_t)b->t->n_packs;
    uint32_t elements[TREE_LANES];
    for (size_t i = first; i < last; i++) elements[i - first] = b->items[i].element;
    *all = tree_append_pack(b->t, b->source, elements, last - first);
    return pack | TREE_LEAF;
  }
  size_t at[TREE_LANES + 1] = {first, last}, n = 1;
  while (n < TREE_LANES) {
    if (last - first > TREE_STOP_INTERVAL && !b->stopped) b->stopped = workspace_stops(b->source->workspace);
    if (b->stopped) break;
    size_t widest = 0;
    for (size_t i = 1; i < n; i++)
      if (at[i + 1] - at[i] > at[widest + 1] - at[widest]) widest = i;
    if (at[widest + 1] - at[widest] <= TREE_LANES) break;
    const size_t m = cut_range(b, at[widest], at[widest + 1], depth);
    for (size_t i = ++n; i > widest + 1; i--) at[i] = at[i - 1];
    at[widest + 1] = m;
  }
  *all = box_empty();
  if (b->stopped) return TREE_LEAF; /* nobody will look at it */
  const uint32_t node = (uint32_t)b->t->n_nodes++;
  box boxes[TREE_LANES];
  uint32_t children[TREE_LANES];
  for (size_t i = 0; i < n; i++) {
    children[i] = build_range(b, at[i], at[i + 1], depth + 1, &boxes[i]);
    box_add(all, &boxes[i]);
  }
  tree_fill_node(&b->t->nodes[node], boxes, children, n);
  return node;
}

bool tree_build_by_area(tree *t, const tree_source *source) {
  builder b = {.t = t, .source = source};
  b.items = malloc(source->n * sizeof *b.items);
  bool made = b.items != NULL;
  if (made) {
    for (size_t i = 0; i < source->n; i++) {
      const box of = tree_element_box(source, (uint32_t)i);
      b.items[i] =
          (item){.b = {{of.low.x, of.low.y, of.low.z, -of.high.x, -of.high.y, -of.high.z}}, .element = (uint32_t)i};
    }
    box all;
    const uint32_t root = build_range(&b, 0, source->n, 0, &all);
    made = !b.stopped;
    /* a single pack hangs from a node of its own */
    if (made && root & TREE_LEAF) tree_fill_node(&t->nodes[t->n_nodes++], &all, &root, 1);
  }
  free(b.items);
  return made;
}
