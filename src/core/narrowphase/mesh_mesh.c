/* SPDX-License-Identifier: BSD-3-Clause */
#include "narrowphase/mesh_mesh.h"

#include "base/rounding.h"
#include "bvh/bvh.h"
#include "bvh/winding.h"
#include "narrowphase/convex_mesh.h"

/* Lanes of a node or a pack of b that may still be nearest to something in a box of a. */
typedef struct tree_entry {
  uint32_t at, lanes;
} tree_entry;

/* Depth first through a; every box of it has the list of what in b still matters to it, which its children go through again. */
typedef struct dual {
  const pair_side *a, *b;
  const pair_placement *place; /* b, seen from a */
  pair_goal goal;
  double margins, rounding;
  cprox_workspace *workspace;
  pair_answer best;
  double lower; /* the least bound of what was left out */
  bool out_of_memory;
} dual;

static vec3 turn(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
             r[6] * v.x + r[7] * v.y + r[8] * v.z);
}

static vec3 turn_back(const double r[9], vec3 v) {
  return vec(r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
             r[2] * v.x + r[5] * v.y + r[8] * v.z);
}

static vec3 to_b(const dual *d, vec3 p) {
  return turn_back(d->place->r, vec_sub(p, d->place->t));
}

static bool is_over(const dual *d) {
  return d->best.overlap || d->best.fault || d->out_of_memory || d->best.steps > d->goal.max_steps;
}

/* ---- two elements ----------------------------------------------------------------------------------------------------- */

static void measure(dual *d, tree_place at, tree_place there) {
  convex shape[2];
  double vertices[2][3][TREE_LANES];
  const vec3 own = pair_element_shape(d->a->body->tree, at, vertices[0], &shape[0]);
  const vec3 other = pair_element_shape(d->b->body->tree, there, vertices[1], &shape[1]);
  pair_placement place = *d->place;
  const vec3 turned = turn(place.r, other);
  place.t = vec_sub(vec_add(place.t, turned), own);
  place.error +=
      ROUND_UP * ROUND_U *
      (2.0 * ROUND_ROTATION * vec_norm(other) + 4.0 * (vec_norm(d->place->t) + vec_norm(own) + vec_norm(place.t)) +
       2.0 * (shape[0].scale + shape[1].scale));
  pair_answer answer;
  pair_separate(&shape[0], d->a->margin, &shape[1], d->b->margin, &place, &d->goal, &answer);
  answer.steps += d->best.steps;
  answer.supports += d->best.supports;
  answer.exhausted = answer.exhausted || d->best.exhausted;
  d->lower = fmin(d->lower, answer.lower);
  if (!(answer.overlap || answer.fault || answer.upper < d->best.upper)) {
    d->best.steps = answer.steps, d->best.supports = answer.supports, d->best.exhausted = answer.exhausted;
    return;
  }
  d->best = answer;
  d->best.on_a = vec_add(answer.on_a, own);
  d->best.on_b = vec_add(answer.on_b, own);
  d->best.common = vec_add(answer.common, own);
}

/* ---- lists ------------------------------------------------------------------------------------------------------------ */

/* What of the list from first to last may come nearer to the hull of the corners (of a box or an element of a) than the best; appended
 * behind it. `whole`: down to elements, else as far as boxes are wider than that. */
static bool filter(dual *d, const vec3 *corner, size_t n, bool whole, size_t first, size_t *last) {
  const tree *b = d->b->body->tree;
  tree_entry open[TREE_LANES * TREE_DEEPEST];
  tree_stretch stretch = {.n = n, .beyond = d->best.upper - d->goal.epsilon + d->margins + d->rounding};
  vec3 low = to_b(d, corner[0]), high = low, p[8];
  for (size_t k = 0; k < n; k++) {
    p[k] = to_b(d, corner[k]);
    low = vec(fmin(low.x, p[k].x), fmin(low.y, p[k].y), fmin(low.z, p[k].z));
    high = vec(fmax(high.x, p[k].x), fmax(high.y, p[k].y), fmax(high.z, p[k].z));
  }
  stretch.x = vec_axpy(vec_scale(0.5, low), 0.5, high);
  const double wide2 = whole ? -1.0 : vec_norm2(vec_sub(high, low));
  for (size_t k = 0; k < n; k++) {
    const vec3 q = vec_sub(p[k], stretch.x);
    stretch.p[0][k] = q.x, stretch.p[1][k] = q.y, stretch.p[2][k] = q.z;
  }
  size_t count = 0, end = *last;
  tree_entry *list = workspace_reserve(d->workspace, WORKSPACE_LISTS, end * sizeof *list);
  for (size_t i = first; count > 0 || i < *last;) {
    const tree_entry entry = count > 0 ? open[--count] : list[i++];
    const bool leaf = (entry.at & TREE_LEAF) != 0;
    tree_lanes lanes;
    tree_measure(b, entry.at, entry.lanes, &stretch, &lanes);
    d->lower = fmin(d->lower, lanes.rest - d->margins - d->rounding);
    uint32_t kept = 0;
    for (uint32_t left = lanes.live; left; left &= left - 1) {
      const uint32_t l = (uint32_t)__builtin_ctz(left);
      if (leaf || !(lanes.width2[l] > wide2)) {
        kept |= 1u << l;
        continue;
      }
      const uint32_t child = b->nodes[entry.at].child[l];
      open[count++] = (tree_entry){child, child & TREE_LEAF ? TREE_ALL_LANES : b->nodes[child].lanes};
    }
    if (!kept) continue;
    list = workspace_reserve(d->workspace, WORKSPACE_LISTS, (end + 1) * sizeof *list);
    if (!list) return false;
    list[end++] = (tree_entry){entry.at, kept};
  }
  *last = end;
  return true;
}

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

static size_t corners_of_box(vec3 low, vec3 high, vec3 corner[8]) {
  for (unsigned k = 0; k < 8; k++)
    corner[k] = vec(k & 1u ? high.x : low.x, k & 2u ? high.y : low.y, k & 4u ? high.z : low.z);
  return 8;
}

/* ---- the descent ------------------------------------------------------------------------------------------------------ */

static void visit_element(dual *d, tree_place at, size_t first, size_t last) {
  vec3 given[3], corner[8];
  size_t n = (size_t)tree_corners(d->a->body->tree, at, given), end = last;
  if (d->a->body->tree->kind == TREE_BOXES)
    n = corners_of_box(given[0], given[1], corner);
  else
    for (size_t k = 0; k < n; k++) corner[k] = given[k];
  if (!filter(d, corner, n, true, first, &end)) {
    d->out_of_memory = true;
    return;
  }
  for (size_t i = last; i < end && !is_over(d); i++) {
    const tree_entry *list = workspace_reserve(d->workspace, WORKSPACE_LISTS, end * sizeof *list);
    const tree_entry entry = list[i];
    const uint32_t pack = entry.at & ~TREE_LEAF;
    for (uint32_t left = entry.lanes; left && !is_over(d); left &= left - 1) {
      const uint32_t l = (uint32_t)__builtin_ctz(left);
      if (!is_repeated(d->b->body->tree, pack, l)) measure(d, at, (tree_place){pack, l});
    }
  }
}

/* A child of a's tree with the list of what may be near it: its elements, or its lanes, the nearest to the best point first. */
static void visit(dual *d, uint32_t at, size_t first, size_t last) {
  const tree *a = d->a->body->tree;
  if (at & TREE_LEAF) {
    for (uint32_t l = 0; l < TREE_LANES && !is_over(d); l++)
      if (!is_repeated(a, at & ~TREE_LEAF, l)) visit_element(d, (tree_place){at & ~TREE_LEAF, l}, first, last);
    return;
  }
  const tree_node *node = &a->nodes[at];
  uint32_t order[TREE_LANES], n = 0;
  double far[TREE_LANES];
  for (uint32_t l = 0; l < TREE_LANES && (node->lanes >> l & 1u); l++) {
    const vec3 m =
        vec(node->low[0][l] + node->high[0][l], node->low[1][l] + node->high[1][l], node->low[2][l] + node->high[2][l]);
    const double distance = vec_norm2(vec_axpy(m, -2.0, d->best.on_b));
    uint32_t i = n++;
    for (; i > 0 && far[i - 1] > distance; i--) order[i] = order[i - 1], far[i] = far[i - 1];
    order[i] = l, far[i] = distance;
  }
  for (uint32_t i = 0; i < n && !is_over(d); i++) {
    const uint32_t l = order[i];
    vec3 corner[8];
    corners_of_box(vec(node->low[0][l], node->low[1][l], node->low[2][l]),
                   vec(node->high[0][l], node->high[1][l], node->high[2][l]), corner);
    size_t end = last;
    if (!filter(d, corner, 8, false, first, &end)) d->out_of_memory = true;
    if (end > last && !d->out_of_memory) visit(d, node->child[l], last, end);
  }
}

/* An element of a that is near b, and one of b that is near that. */
static void seed(dual *d) {
  const tree_hit hit = tree_nearest(d->a->body->tree, d->place->t, INFINITY);
  vec3 v[3];
  tree_corners(d->a->body->tree, hit.at, v);
  const tree_hit there = tree_nearest(d->b->body->tree, to_b(d, v[0]), INFINITY);
  measure(d, hit.at, there.at);
}

/* Less than minus any depth: to move one out of the other altogether. */
static double least_of(const dual *d) {
  return -(2.0 * (d->a->body->tree->scale + d->b->body->tree->scale) + d->margins);
}

static void overlap(const dual *d, vec3 common, pair_answer *answer) {
  answer->overlap = true;
  answer->upper = 0.0;
  answer->lower = least_of(d);
  answer->on_a = answer->on_b = answer->common = common;
  answer->normal = vec(0, 0, 0);
}

/* Surfaces that do not meet: one inside of the other, where that is solid, or each outside of the other. */
static bool holds(const pair_side *solid, vec3 point) {
  return solid->body->winding && winding_is_inside(solid->body->winding, solid->body->tree, point);
}

bool pair_trees(const pair_side *a, const pair_side *b, const pair_goal *goal, cprox_workspace *workspace,
                pair_answer *answer) {
  const pair_placement place = pair_place(a, b);
  const tree *x = a->body->tree, *y = b->body->tree;
  dual d = {.a = a, .b = b, .place = &place, .goal = *goal, .margins = a->margin + b->margin, .workspace = workspace};
  d.rounding = ROUND_UP * (place.error + (2.0 * ROUND_ROTATION + 2.0 * TREE_ROUND) * ROUND_U *
                                             (vec_norm(place.t) + x->scale + y->scale + d.margins));
  d.goal.wants_depth = false;
  d.goal.epsilon = fmax(goal->epsilon - 4.0 * d.rounding, 0.0);
  d.best = (pair_answer){.upper = INFINITY};
  d.lower = INFINITY;
  tree_entry *list = workspace_reserve(workspace, WORKSPACE_LISTS, sizeof *list);
  if (!list) return false;
  list[0] = (tree_entry){0, y->nodes[0].lanes};
  seed(&d);
  if (!is_over(&d)) visit(&d, 0, 0, 1);
  if (d.out_of_memory) return false;
  *answer = d.best;
  if (answer->fault) return true;
  if (answer->overlap) {
    overlap(&d, d.best.common, answer);
    return true;
  }
  if (d.best.steps > d.goal.max_steps) {
    answer->exhausted = true;
    d.lower = least_of(&d); /* what was not looked at */
  }
  answer->rounding = fmax(answer->rounding, d.rounding);
  answer->lower = fmin(d.lower, answer->upper);
  vec3 own[3], other[3];
  tree_corners(x, (tree_place){0, 0}, own);
  tree_corners(y, (tree_place){0, 0}, other);
  const vec3 there = vec_add(turn(place.r, other[0]), place.t);
  if (answer->lower + d.margins > d.rounding && (holds(b, to_b(&d, own[0])) || holds(a, there)))
    overlap(&d, holds(a, there) ? there : own[0], answer);
  return true;
}
