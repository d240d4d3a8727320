/* SPDX-License-Identifier: BSD-3-Clause */
/* Boxes, packs of elements and nodes: what building and updating a tree write. */
#include "bvh/build.h"

/* ---- boxes ---- */

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

box tree_element_box(const tree_source *source, uint32_t element) {
  vec3 corner[3];
  const int n = corners_of(source, element, corner);
  box b = {corner[0], corner[0]};
  for (int k = 1; k < n; k++) box_add(&b, &(box){corner[k], corner[k]});
  return b;
}

/* ---- packs and nodes ---- */

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
