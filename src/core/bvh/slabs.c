/* SPDX-License-Identifier: BSD-3-Clause */
/* Two planes about what is in a lane, across the mean normal of its triangles. */
#include <stdlib.h>

#include "base/rounding.h"
#include "bvh/build.h"

/* The packs below a node or pack: both ways to build leave them side by side. */
typedef struct pack_range {
  size_t first, last;
} pack_range;

static vec3 corner_at(const double *pack, int corner, int lane) {
  const double *v = pack + 3 * TREE_LANES * corner + lane;
  return vec(v[0], v[TREE_LANES], v[2 * TREE_LANES]);
}

/* The normals added up, each turned to the side of those before it: soups of triangles have no side. */
static vec3 mean_normal(const tree *t, pack_range packs) {
  vec3 sum = vec(0, 0, 0);
  for (size_t i = packs.first; i < packs.last; i++) {
    const double *pack = t->packs + i * tree_pack_size(TREE_TRIANGLES);
    for (int l = 0; l < TREE_LANES; l++) {
      const vec3 a = corner_at(pack, 0, l), b = corner_at(pack, 1, l), c = corner_at(pack, 2, l);
      const vec3 m = vec_cross(vec_sub(b, a), vec_sub(c, b));
      sum = vec_axpy(sum, vec_dot(sum, m) < 0.0 ? -1.0 : 1.0, m);
    }
  }
  const double length = vec_norm(sum);
  return length > 1e-100 && isfinite(length) ? vec_scale(1.0 / length, sum) : vec(0, 0, 1);
}

/* Any s will do; the products are widened by their rounding, so that the slab holds the corners as they are stored. */
static void lay_slab(const tree *t, pack_range packs, tree_slabs *slabs, int lane) {
  const vec3 s = mean_normal(t, packs);
  double low = INFINITY, high = -INFINITY;
  for (size_t i = packs.first; i < packs.last; i++) {
    const double *pack = t->packs + i * tree_pack_size(TREE_TRIANGLES);
    for (int k = 0; k < 3; k++) {
      for (int l = 0; l < TREE_LANES; l++) {
        const double at = vec_dot(s, corner_at(pack, k, l));
        low = at < low ? at : low;
        high = at > high ? at : high;
      }
    }
  }
  const double rounding = 4.0 * ROUND_U * t->scale;
  slabs->s[0][lane] = s.x, slabs->s[1][lane] = s.y, slabs->s[2][lane] = s.z;
  slabs->low[lane] = low - rounding;
  slabs->high[lane] = high + rounding;
}

static pack_range lay_below(tree *t, uint32_t at) {
  if (at & TREE_LEAF) return (pack_range){at & ~TREE_LEAF, (at & ~TREE_LEAF) + 1};
  const tree_node *node = &t->nodes[at];
  pack_range all = {SIZE_MAX, 0}, one = all;
  for (int l = 0; l < TREE_LANES; l++) {
    if (l == 0 || node->child[l] != node->child[l - 1]) one = lay_below(t, node->child[l]);
    lay_slab(t, one, &t->slabs[at], l);
    all.first = one.first < all.first ? one.first : all.first;
    all.last = one.last > all.last ? one.last : all.last;
  }
  return all;
}

bool tree_lay_slabs(tree *t) {
  t->slabs = aligned_alloc(_Alignof(tree_slabs), t->n_nodes * sizeof *t->slabs);
  if (t->slabs) lay_below(t, 0);
  return t->slabs != NULL;
}
