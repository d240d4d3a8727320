/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificate/element_order.h"

#include "base/rounding.h"

const cprox_body *elements_body(const cprox_body *body) {
  const cprox_body *finest = body && body->mesh ? body->mesh : body;
  return finest && finest->tree ? finest : NULL;
}

/* ---- the order ---- */

static bool is_pack(uint32_t at) {
  return (at & TREE_LEAF) != 0;
}

/* A pack that is not full repeats its last element. */
static uint32_t lanes_of(const tree *t, uint32_t at) {
  if (!is_pack(at)) return (uint32_t)__builtin_popcount(t->nodes[at].lanes);
  const uint32_t *ids = t->ids + (size_t)(at & ~TREE_LEAF) * TREE_LANES;
  uint32_t n = 1;
  while (n < TREE_LANES && ids[n] != ids[n - 1]) n++;
  return n;
}

static void count_packs(const tree *t, uint32_t at, uint32_t *first, uint32_t *n) {
  if (is_pack(at)) {
    first[at & ~TREE_LEAF] = *n;
    *n += lanes_of(t, at);
    return;
  }
  for (uint32_t l = 0; l < lanes_of(t, at); l++) count_packs(t, t->nodes[at].child[l], first, n);
}

element_order elements_order(const tree *t, uint32_t *first) {
  uint32_t n = 0;
  count_packs(t, 0, first, &n);
  return (element_order){t, first};
}

element_range elements_all(const element_order *order) {
  return (element_range){0, 0, lanes_of(order->t, 0), 0, (uint32_t)order->t->n};
}

static uint32_t first_of(const element_order *order, uint32_t at) {
  while (!is_pack(at)) at = order->t->nodes[at].child[0];
  return order->first[at & ~TREE_LEAF];
}

static uint32_t first_of_lane(const element_order *order, uint32_t at, uint32_t lane) {
  return is_pack(at) ? order->first[at & ~TREE_LEAF] + lane : first_of(order, order->t->nodes[at].child[lane]);
}

bool elements_cut(const element_order *order, element_range range, element_range half[2]) {
  while (range.to - range.from == 1) {
    if (is_pack(range.at)) return false;
    range.at = order->t->nodes[range.at].child[range.from];
    range.from = 0;
    range.to = lanes_of(order->t, range.at);
  }
  const uint32_t middle = (range.from + range.to) / 2, at = first_of_lane(order, range.at, middle);
  half[0] = half[1] = range;
  half[0].to = half[1].from = middle;
  half[0].end = half[1].begin = at;
  return true;
}

uint32_t elements_lane(const tree *t, tree_place at) {
  const uint32_t last = lanes_of(t, at.pack | TREE_LEAF) - 1;
  return at.lane < last ? at.lane : last;
}

/* ---- vertices ---- */

int elements_vertices(const tree *t, tree_place at, vec3 v[8]) {
  vec3 corner[3];
  const int n = tree_corners(t, at, corner);
  if (t->kind != TREE_BOXES) {
    for (int k = 0; k < n; k++) v[k] = corner[k];
    return n;
  }
  for (int k = 0; k < 8; k++) v[k] = vec(corner[k & 1].x, corner[k >> 1 & 1].y, corner[k >> 2].z);
  return 8;
}

void elements_each(const element_order *order, const element_range *range, void (*visit)(void *self, tree_place at),
                   void *self) {
  for (uint32_t l = range->from; l < range->to; l++) {
    if (is_pack(range->at)) {
      visit(self, (tree_place){range->at & ~TREE_LEAF, l});
      continue;
    }
    const uint32_t child = order->t->nodes[range->at].child[l];
    const element_range inner = {.at = child, .to = lanes_of(order->t, child)};
    elements_each(order, &inner, visit, self);
  }
}

/* ---- how far it reaches ---- */

static element_box lane_box(const tree *t, uint32_t at, uint32_t l) {
  if (!is_pack(at)) {
    const tree_node *node = &t->nodes[at];
    return (element_box){vec(node->low[0][l], node->low[1][l], node->low[2][l]),
                         vec(node->high[0][l], node->high[1][l], node->high[2][l])};
  }
  vec3 v[8];
  const int n = elements_vertices(t, (tree_place){at & ~TREE_LEAF, l}, v);
  element_box b = {v[0], v[0]};
  for (int k = 1; k < n; k++) {
    b.low = vec(fmin(b.low.x, v[k].x), fmin(b.low.y, v[k].y), fmin(b.low.z, v[k].z));
    b.high = vec(fmax(b.high.x, v[k].x), fmax(b.high.y, v[k].y), fmax(b.high.z, v[k].z));
  }
  return b;
}

element_box elements_box(const element_order *order, const element_range *range) {
  element_box all = lane_box(order->t, range->at, range->from);
  for (uint32_t l = range->from + 1; l < range->to; l++) {
    const element_box b = lane_box(order->t, range->at, l);
    all.low = vec(fmin(all.low.x, b.low.x), fmin(all.low.y, b.low.y), fmin(all.low.z, b.low.z));
    all.high = vec(fmax(all.high.x, b.high.x), fmax(all.high.y, b.high.y), fmax(all.high.z, b.high.z));
  }
  return all;
}

/* Lanes whose boxes do not reach beyond the best one are left out; rounding keeps the order. */
static void reach_lanes(const tree *t, uint32_t at, uint32_t from, uint32_t to, vec3 d, double *most, vec3 *where) {
  if (is_pack(at)) {
    for (uint32_t l = from; l < to; l++) {
      vec3 v[8];
      const int n = elements_vertices(t, (tree_place){at & ~TREE_LEAF, l}, v);
      for (int k = 0; k < n; k++) {
        const double h = vec_dot(d, v[k]);
        if (h > *most) *most = h, *where = v[k];
      }
    }
    return;
  }
  if (from >= to) return;
  double bound[TREE_LANES];
  uint32_t farthest = from;
  for (uint32_t l = from; l < to; l++) {
    const element_box b = lane_box(t, at, l);
    bound[l] = element_box_reach(&b, d);
    if (bound[l] > bound[farthest]) farthest = l;
  }
  for (uint32_t i = from; i < to + 1; i++) { /* the farthest one first */
    const uint32_t l = i == from ? farthest : i - 1, child = t->nodes[at].child[l];
    if ((i > from && l == farthest) || !(bound[l] > *most)) continue;
    reach_lanes(t, child, 0, lanes_of(t, child), d, most, where);
  }
}

double elements_reach(const element_order *order, const element_range *range, vec3 d, vec3 *at) {
  double most = -INFINITY;
  vec3 where = vec(0, 0, 0);
  reach_lanes(order->t, range->at, range->from, range->to, d, &most, &where);
  if (at) *at = where;
  return most;
}

/* ---- shapes ---- */

static void hull_support(const void *self, const double direction[3], double point[3]) {
  const element_hull *hull = self;
  vec3 at;
  elements_reach(&hull->order, &hull->range, vec(direction[0], direction[1], direction[2]), &at);
  point[0] = at.x, point[1] = at.y, point[2] = at.z;
}

void elements_hull(element_hull *hull, const element_order *order, element_range range) {
  const double scale = order->t->scale;
  hull->order = *order;
  hull->range = range;
  hull->shape = (convex){.ops = &convex_support_callback,
                         .size = {scale},
                         .scale = scale,
                         .slack = 4.0 * ROUND_U * scale,
                         .callback = hull_support,
                         .user = hull};
}

void elements_one(element_body *one, const tree *t, tree_place at) {
  vec3 v[8];
  const int n = elements_vertices(t, at, v);
  for (int k = 0; k < 8; k++) {
    const vec3 p = v[k < n ? k : n - 1];
    one->x[k] = p.x, one->y[k] = p.y, one->z[k] = p.z;
  }
  one->body = (cprox_body){.kind = CPROX_BODY_POLYTOPE,
                           .shape = {.ops = &convex_polytope, .scale = t->scale, .n = n, .padded = 8}};
  one->body.shape.x = one->x, one->body.shape.y = one->y, one->body.shape.z = one->z;
}
