/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve against the triangles of a mesh, points or boxes: a tree of pairs of a part of the curve and a range of
 * elements, in preorder. A leaf's direction separates the part from the hull of the range. */
#include "certificate/partition.h"

enum { MAX_DEPTH = 200 };

/* What is proven, and who proves it. */
typedef struct elements_cover {
  cover *c;
  element_order order;
  frame f;
} elements_cover;

typedef struct pair {
  reach_part part;
  element_range range;
} pair;

/* What became of a pair: whether it is one leaf, and of what normal. */
typedef struct proven {
  cprox_status status;
  bool is_leaf;
  vec3 n;
} proven;

static bool separates(const elements_cover *e, const pair *p, vec3 n) {
  if (vec_norm2(n) == 0.0) return false;
  const reach_direction direction = reach_along(n);
  const reach_value reach = reach_of_elements(&e->c->set, &direction, &e->order, &p->range);
  return reach_separates(e->c->curve, e->c->radius, p->part, &direction, &reach, e->c->delta);
}

static proven write_leaf(const elements_cover *e, vec3 n) {
  certificate_byte(e->c->certificate, COVER_LEAF);
  certificate_normal(e->c->certificate, n);
  return (proven){.status = CPROX_OK, .is_leaf = true, .n = n};
}

static vec3 world_normal(const elements_cover *e, vec3 own) {
  return certificate_round(e->c->certificate, frame_turn_to_world(&e->f, own));
}

/* No point of the part is farther from its middle, or so. */
static double half_length(const cprox_curve *curve, reach_part part, vec3 middle) {
  return fmax(vec_norm(vec_sub(partition_point(curve, part.from), middle)),
              vec_norm(vec_sub(partition_point(curve, part.to), middle)));
}

static proven prove(const elements_cover *e, const pair *p, vec3 inherited, int depth);

/* Both halves; two leaves that one normal can serve become one. */
static proven prove_halves(const elements_cover *e, const pair *p, const pair half[2], unsigned char tag, double cut,
                           vec3 n, int depth) {
  cprox_certificate *to = e->c->certificate;
  const size_t place = to->size;
  certificate_byte(to, tag);
  certificate_number(to, cut);
  const proven left = prove(e, &half[0], n, depth + 1);
  if (left.status != CPROX_OK) return left;
  const proven right = prove(e, &half[1], left.is_leaf ? left.n : n, depth + 1);
  if (right.status != CPROX_OK || !left.is_leaf || !right.is_leaf) return (proven){.status = right.status};
  const vec3 either[2] = {left.n, right.n};
  for (int i = 0; i < 2; i++) {
    if (!separates(e, p, either[i])) continue;
    to->size = place;
    return write_leaf(e, either[i]);
  }
  return (proven){.status = CPROX_OK};
}

/* A longer part of the curve is cut first, a larger range of elements where the curve's middle is too near its hull. */
static proven prove_cut(const elements_cover *e, const pair *p, bool too_near, double length, vec3 n, int depth) {
  const element_box box = elements_box(&e->order, &p->range);
  pair half[2] = {*p, *p};
  element_range ranges[2];
  const bool many = elements_cut(&e->order, p->range, ranges);
  if (depth >= MAX_DEPTH || (too_near && !many)) return (proven){.status = CPROX_PRECISION};
  if (many && (too_near || length < vec_norm(element_box_half(&box)))) {
    half[0].range = ranges[0], half[1].range = ranges[1];
    return prove_halves(e, p, half, COVER_CUT_SECOND, (double)ranges[1].begin, n, depth);
  }
  const double cut = partition_cut(e->c, p->part, e->c->witness);
  if (isnan(cut)) return (proven){.status = CPROX_PRECISION};
  half[0].part.to = half[1].part.from = cut;
  return prove_halves(e, p, half, COVER_CUT_FIRST, cut, n, depth);
}

static proven prove(const elements_cover *e, const pair *p, vec3 inherited, int depth) {
  cover *c = e->c;
  if (c->budget == 0) return (proven){.status = CPROX_BUDGET};
  c->budget--;

  /* the normal of the parent, of the best point, from the box to the middle of the part */
  const vec3 middle = partition_point(c->curve, p->part.from + 0.5 * (p->part.to - p->part.from));
  double error = 0.0;
  const vec3 y = frame_to_local(&e->f, middle, &error);
  const element_box box = elements_box(&e->order, &p->range);
  const vec3 trials[3] = {inherited, c->normal, world_normal(e, element_box_way(&box, y))};
  for (int i = 0; i < 3; i++)
    if (separates(e, p, trials[i])) return write_leaf(e, trials[i]);

  /* that of the hull */
  element_hull hull;
  elements_hull(&hull, &e->order, p->range);
  convex_near near;
  hull.shape.ops->nearest(&hull.shape, y, NULL, &near);
  const bool too_near = !(near.distance > c->delta + c->set.offset);
  const vec3 n = near.distance > 0.0 ? world_normal(e, near.normal) : vec(0, 0, 0);
  if (!too_near && separates(e, p, n)) return write_leaf(e, n);
  return prove_cut(e, p, too_near, half_length(c->curve, p->part, middle), n, depth);
}

cprox_status partition_elements(cover *c) {
  const tree *t = c->set.body->tree;
  uint32_t *first = workspace_reserve(c->workspace, WORKSPACE_COVER_ELEMENTS, t->n_packs * sizeof *first);
  if (!first) return CPROX_MEMORY;
  const elements_cover e = {c, elements_order(t, first), frame_create(&c->pose, c->set.body->centre)};
  certificate_byte(c->certificate, SECTION_ELEMENTS);
  c->normal = certificate_round(c->certificate, c->normal);
  const pair whole = {{c->from, c->until}, elements_all(&e.order)};
  return prove(&e, &whole, vec(0, 0, 0), 0).status;
}
