/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/build.h"

#include <stdlib.h>
#include <string.h>

#include "bvh/kernels.h"

/* ---- boxes ------------------------------------------------------------------------------------------------------------ */

box box_empty(void) {
  return (box){vec(INFINITY, INFINITY, INFINITY), vec(-INFINITY, -INFINITY, -INFINITY)};
}

static double least(double a, double b) {
  return a < b ? a : b;
}

static double most(double a, double b) {
  return a > b ? a : b;
}

void box_add(box *b, const box *other) {
  b->low = vec(least(b->low.x, other->low.x), least(b->low.y, other->low.y), least(b->low.z, other->low.z));
  b->high = vec(most(b->high.x, other->high.x), most(b->high.y, other->high.y), most(b->high.z, other->high.z));
}

/* The corners that stand for an element, about the centre. Returns how many. */
static int corners_of(const tree_source *source, uint32_t element, vec3 corner[3]) {
  if (source->kind == TREE_TRIANGLES) {
    for (int k = 0; k < 3; k++) corner[k] = vec_sub(source->points[source->triangles[element][k]], source->centre);
    return 3;
  }
  corner[0] = vec_sub(source->points[element], source->centre);
  if (source->kind == TREE_POINTS) return 1;
  corner[1] = vec_sub(source->high[element], source->centre);
  return 2;
}

box element_box(const tree_source *source, uint32_t element) {
  vec3 corner[3];
  const int n = corners_of(source, element, corner);
  box b = {corner[0], corner[0]};
  for (int k = 1; k < n; k++) box_add(&b, &(box){corner[k], corner[k]});
  return b;
}

/* ---- packs and nodes -------------------------------------------------------------------------------------------------- */

box tree_append_pack(tree *t, const tree_source *source, const uint32_t *elements, size_t n) {
  double *pack = t->packs + t->n_packs * tree_pack_size(t->kind);
  uint32_t *ids = t->ids + t->n_packs * TREE_LANES;
  t->n_packs++;
  for (size_t l = 0; l < TREE_LANES; l++) {
    const uint32_t element = elements[l < n ? l : n - 1];
    vec3 corner[3];
    const int corners = corners_of(source, element, corner);
    for (int k = 0; k < corners; k++) {
      double *at = pack + 3 * TREE_LANES * k + l;
      at[0] = corner[k].x, at[TREE_LANES] = corner[k].y, at[2 * TREE_LANES] = corner[k].z;
    }
    ids[l] = element;
  }
  return tree_pack_box(t->kind, pack);
}

box tree_pack_box(tree_kind kind, const double *pack) {
  const size_t corners = tree_pack_size(kind) / (3 * (size_t)TREE_LANES);
  double low[3], high[3];
  for (size_t k = 0; k < 3; k++) {
    double below = INFINITY, above = -INFINITY;
    for (size_t j = 0; j < corners; j++) {
      const double *x = pack + TREE_LANES * (3 * j + k);
#pragma omp simd reduction(min : below) reduction(max : above)
      for (int l = 0; l < TREE_LANES; l++) {
        below = x[l] < below ? x[l] : below;
        above = x[l] > above ? x[l] : above;
      }
    }
    low[k] = below, high[k] = above;
  }
  return (box){vec(low[0], low[1], low[2]), vec(high[0], high[1], high[2])};
}

void tree_fill_node(tree_node *node, const box *boxes, const uint32_t *children, size_t n) {
  for (size_t l = 0; l < TREE_LANES; l++) {
    const box *b = &boxes[l < n ? l : n - 1];
    node->low[0][l] = b->low.x, node->low[1][l] = b->low.y, node->low[2][l] = b->low.z;
    node->high[0][l] = b->high.x, node->high[1][l] = b->high.y, node->high[2][l] = b->high.z;
    node->child[l] = children[l < n ? l : n - 1];
  }
  node->lanes = (uint32_t)((1u << n) - 1u);
}

/* ---- trees ------------------------------------------------------------------------------------------------------------ */

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

/* The largest |x| of a corner of the root's boxes, rounded up. */
void tree_find_scale(tree *t) {
  const tree_node *root = &t->nodes[0];
  double most2 = 0.0;
  for (int l = 0; l < TREE_LANES; l++) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
      const double reach = most(fabs(root->low[k][l]), fabs(root->high[k][l]));
      sum += reach * reach;
    }
    most2 = most(most2, sum);
  }
  t->scale = sqrt(most2) * (1.0 + 1e-15) + 1e-100;
}

static size_t whole_lines(size_t bytes) {
  return (bytes + 63) / 64 * 64;
}

/* Gives back what was reserved for the worst case. */
static void *shrink(void *memory, size_t bytes) {
  void *smaller = aligned_alloc(64, whole_lines(bytes));
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

bool tree_allocate(tree *t, size_t packs, size_t nodes) {
  t->nodes = aligned_alloc(64, whole_lines(nodes * sizeof *t->nodes));
  t->packs = aligned_alloc(64, whole_lines(packs * tree_pack_size(t->kind) * sizeof *t->packs));
  t->ids = aligned_alloc(64, whole_lines(packs * TREE_LANES * sizeof *t->ids));
  return t->nodes && t->packs && t->ids;
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
  t->kernel = tree_kernel_at(tree_kernel_count() - 1);
  return t;
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
