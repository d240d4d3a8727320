/* SPDX-License-Identifier: BSD-3-Clause */
#include "narrowphase/mesh_mesh.h"

#include "base/check.h"
#include "base/rotation.h"
#include "base/rounding.h"
#include "bvh/bvh.h"
#include "bvh/winding.h"
#include "convex/feature.h"
#include "narrowphase/convex_mesh.h"

/* A box or an element of one of the two trees: a lane of a node, or of a pack (TREE_LEAF). */
typedef struct dual_side {
  uint32_t at, lane;
} dual_side;

/* Lanes of a node or a pack of one tree, held against a box or an element of the other one by their own normals. Those
 * that may be nearest are looked at first, of equals the nearest by the middle, of those again the latest. */
typedef struct dual_entry {
  double lower, far2;
  dual_side other;
  uint32_t at, lanes;
  uint64_t number;
  uint8_t which; /* tree the lanes are of */
  bool by_both;  /* two elements: the normals of both were tried */
} dual_entry;

/* Best first through both trees at once. */
typedef struct dual {
  const pair_side *side[2];
  const pair_placement *place; /* the second, seen from the first */
  pair_goal goal;
  double margins, rounding, least; /* least: of what is under margins and rounding, no bound is lower */
  cprox_workspace *workspace;
  pair_answer best;
  double lower; /* the least bound of what was left out */
  size_t count; /* of the heap in the workspace */
  uint64_t entries, visits;
  bool out_of_memory;
  vec3 normal; /* unit, from the second to the first: of the best so far, at first of the hulls; (0,0,0): none */
} dual;

static const tree *tree_of(const dual *d, int which) {
  return d->side[which]->body->tree;
}

/* A point of one tree's frame, seen in the other's. */
static vec3 across(const dual *d, int from, vec3 p) {
  if (from == 1) return vec_add(rotate(d->place->r, p), d->place->t);
  return rotate_back(d->place->r, vec_sub(p, d->place->t));
}

/* ---- the heap ---- */

static bool is_before(const dual_entry *a, const dual_entry *b) {
  if (a->lower != b->lower) return a->lower < b->lower;
  if (a->far2 != b->far2) return a->far2 < b->far2;
  return a->number > b->number;
}

static dual_entry *heap_of(const dual *d, size_t n) {
  return workspace_reserve(d->workspace, WORKSPACE_LISTS, n * sizeof(dual_entry));
}

static void push(dual *d, dual_entry entry) {
  dual_entry *heap = heap_of(d, d->count + 1);
  if (!heap) {
    d->out_of_memory = true;
    return;
  }
  size_t i = d->count++;
  for (; i > 0 && is_before(&entry, &heap[(i - 1) / 2]); i = (i - 1) / 2) heap[i] = heap[(i - 1) / 2];
  heap[i] = entry;
}

static dual_entry pop(dual *d) {
  dual_entry *heap = heap_of(d, d->count);
  const dual_entry top = heap[0], moved = heap[--d->count];
  size_t i = 0;
  for (size_t child = 1; child < d->count; child = 2 * i + 1) {
    if (child + 1 < d->count && is_before(&heap[child + 1], &heap[child])) child++;
    if (!is_before(&heap[child], &moved)) break;
    heap[i] = heap[child];
    i = child;
  }
  heap[i] = moved;
  return top;
}

/* ---- two elements ---- */

/* As exactly as doubles allow, whatever is asked for: so the order of the search does not depend on that. */
static void measure(dual *d, tree_place at, tree_place there) {
  convex shape[2];
  double vertices[2][3][TREE_LANES];
  const vec3 own = convex_mesh_element_shape(tree_of(d, 0), at, vertices[0], &shape[0]);
  const vec3 other = convex_mesh_element_shape(tree_of(d, 1), there, vertices[1], &shape[1]);
  pair_placement place = *d->place;
  const vec3 turned = rotate(place.r, other);
  place.t = vec_sub(vec_add(place.t, turned), own);
  place.error +=
      ROUND_UP * ROUND_U *
      (2.0 * ROUND_ROTATION * vec_norm(other) + 4.0 * (vec_norm(d->place->t) + vec_norm(own) + vec_norm(place.t)) +
       2.0 * (shape[0].scale + shape[1].scale));
  const pair_goal exactly = {.max_steps = d->goal.max_steps};
  pair_answer answer;
  pair_separate(&shape[0], d->side[0]->margin, &shape[1], d->side[1]->margin, &place, &exactly, &answer);
  answer.steps += d->best.steps;
  answer.supports += d->best.supports;
  answer.exhausted = answer.exhausted || d->best.exhausted;
  d->lower = lesser(d->lower, answer.lower);
  if (!(answer.overlap || answer.support_failed || answer.upper < d->best.upper)) {
    d->best.steps = answer.steps, d->best.supports = answer.supports, d->best.exhausted = answer.exhausted;
    return;
  }
  d->best = answer;
  if (vec_norm2(answer.normal) > 0.0) d->normal = answer.normal;
  d->best.on_a = vec_add(answer.on_a, own);
  d->best.on_b = vec_add(answer.on_b, own);
  d->best.common = vec_add(answer.common, own);
}

/* ---- boxes ---- */

static bool is_element(dual_side s) {
  return (s.at & TREE_LEAF) != 0;
}

static tree_place place_of(dual_side s) {
  return (tree_place){s.at & ~TREE_LEAF, s.lane};
}

/* The box of a lane, or of an element. */
static void box_of(const tree *t, dual_side s, vec3 *low, vec3 *high) {
  if (!is_element(s)) {
    const tree_node *node = &t->nodes[s.at];
    *low = vec(node->low[0][s.lane], node->low[1][s.lane], node->low[2][s.lane]);
    *high = vec(node->high[0][s.lane], node->high[1][s.lane], node->high[2][s.lane]);
    return;
  }
  vec3 corner[3];
  const int n = tree_corners(t, place_of(s), corner);
  *low = *high = corner[0];
  for (int k = 1; k < n; k++) {
    *low = vec(lesser(low->x, corner[k].x), lesser(low->y, corner[k].y), lesser(low->z, corner[k].z));
    *high = vec(greater(high->x, corner[k].x), greater(high->y, corner[k].y), greater(high->z, corner[k].z));
  }
}

static double width2_of(const tree *t, dual_side s) {
  vec3 low, high;
  box_of(t, s, &low, &high);
  return vec_norm2(vec_sub(high, low));
}

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

/* What is farther than this does not matter: to a distance the best, to a verdict its limit, too. */
static double farthest(const dual *d) {
  return d->goal.verdict ? lesser(d->best.upper, nextafter(d->goal.limit, INFINITY)) : d->best.upper;
}

/* How much lower than the best a bound must be to matter. */
static double worth(const dual *d) {
  if (d->goal.verdict && d->best.upper <= d->goal.limit) return -INFINITY;
  return lesser(d->best.upper - width_allowed(d->goal.epsilon, d->goal.relative_epsilon, d->best.upper), farthest(d));
}

/* The best normal parts many more: along it a lane's slab counts, not its box alone. */
static void add_normal(const dual *d, int which, dual_side other, tree_segment *segment) {
  segment->known = vec_norm2(d->normal) > 0.0;
  if (!segment->known) return;
  vec3 across_second; /* the normal in the frame of the second */
  feature_unit(rotate_back(d->place->r, d->normal), &across_second);
  segment->normal = which == 0 ? vec_neg(d->normal) : across_second;
  segment->along = INFINITY;
  for (size_t k = 0; k < segment->n; k++)
    segment->along =
        lesser(vec_dot(segment->normal, vec(segment->p[0][k], segment->p[1][k], segment->p[2][k])), segment->along);
  if (is_element(other)) return;
  const double reach =
      tree_lane_reach(tree_of(d, 1 - which), other.at, other.lane, which == 0 ? across_second : vec_neg(d->normal));
  segment->along =
      greater(segment->along, -reach - vec_dot(d->normal, d->place->t) - vec_dot(segment->normal, segment->x));
}

/* The corners of a box, about its middle, in the frame of tree `which`. */
static void turn_box(const dual *d, int which, vec3 low, vec3 high, tree_segment *segment) {
  const double *r = d->place->r;
  const vec3 h = vec_scale(0.5, vec_sub(high, low));
  const vec3 x = which == 0 ? vec(r[0], r[3], r[6]) : vec(r[0], r[1], r[2]);
  const vec3 y = which == 0 ? vec(r[1], r[4], r[7]) : vec(r[3], r[4], r[5]);
  const vec3 z = which == 0 ? vec(r[2], r[5], r[8]) : vec(r[6], r[7], r[8]);
  segment->x = across(d, 1 - which, vec_axpy(vec_scale(0.5, low), 0.5, high));
  segment->n = 8;
  for (unsigned k = 0; k < 8; k++) {
    const vec3 q =
        vec_axpy(vec_axpy(vec_scale(k & 1u ? h.x : -h.x, x), k & 2u ? h.y : -h.y, y), k & 4u ? h.z : -h.z, z);
    segment->p[0][k] = q.x, segment->p[1][k] = q.y, segment->p[2][k] = q.z;
  }
}

/* A point, or the corners of a triangle, about the middle of their box. */
static void turn_corners(const dual *d, int which, dual_side other, tree_segment *segment) {
  vec3 corner[3];
  segment->n = (size_t)tree_corners(tree_of(d, 1 - which), place_of(other), corner);
  vec3 low = across(d, 1 - which, corner[0]), high = low;
  for (size_t k = 0; k < segment->n; k++) {
    const vec3 q = corner[k] = across(d, 1 - which, corner[k]);
    low = vec(lesser(low.x, q.x), lesser(low.y, q.y), lesser(low.z, q.z));
    high = vec(greater(high.x, q.x), greater(high.y, q.y), greater(high.z, q.z));
  }
  segment->x = vec_axpy(vec_scale(0.5, low), 0.5, high);
  for (size_t k = 0; k < segment->n; k++) {
    const vec3 q = vec_sub(corner[k], segment->x);
    segment->p[0][k] = q.x, segment->p[1][k] = q.y, segment->p[2][k] = q.z;
  }
}

/* What is in a lane of tree 1 - which, as a segment in the frame of tree `which`. */
static void interval_of(const dual *d, int which, dual_side other, tree_segment *segment) {
  const tree *t = tree_of(d, 1 - which);
  if (is_element(other) && t->kind != TREE_BOXES) {
    turn_corners(d, which, other, segment);
  } else {
    vec3 low, high;
    box_of(t, other, &low, &high);
    turn_box(d, which, low, high, segment);
  }
  segment->radius = segment->thickest = 0.0;
  segment->thick = NULL;
  segment->stepping = false;
  segment->beyond = farthest(d) + d->margins + d->rounding;
  add_normal(d, which, other, segment);
}

/* Lanes of a node or a pack of tree `which` against a box or an element of the other one: what of them may matter
 * enters the heap, two elements each by itself. What is left out does not depend on epsilon, and neither does the order
 * in which all is looked at. */
static void spread(dual *d, int which, uint32_t at, uint32_t wanted, dual_side other, double above) {
  const tree *t = tree_of(d, which);
  tree_segment segment;
  interval_of(d, which, other, &segment);
  const bool leaf = (at & TREE_LEAF) != 0;
  tree_lanes lanes;
  tree_measure(t, at, wanted, &segment, &lanes);
  d->lower = lesser(d->lower, greater(lanes.rest - d->margins - d->rounding, above));
  d->best.steps++;
  dual_entry entry = {.lower = INFINITY, .far2 = INFINITY, .other = other, .at = at, .which = (uint8_t)which};
  for (uint32_t left = lanes.live; left; left &= left - 1) {
    const uint32_t l = (uint32_t)__builtin_ctz(left);
    if (leaf && is_repeated(t, at & ~TREE_LEAF, l)) continue;
    const bool alone = leaf && is_element(other);
    if (alone)
      entry = (dual_entry){.lower = INFINITY, .far2 = INFINITY, .other = other, .at = at, .which = entry.which};
    entry.lower = lesser(entry.lower, greater(lanes.bound[l] - d->margins - d->rounding, above));
    entry.far2 = lesser(entry.far2, lanes.distance2[l]);
    entry.lanes |= 1u << l;
    entry.number = d->entries + l;
    if (alone) push(d, entry);
  }
  if (entry.lanes && !(leaf && is_element(other))) push(d, entry);
  d->entries += TREE_LANES;
}

/* ---- the descent ---- */

static uint32_t lanes_of(const tree *t, uint32_t at) {
  return at & TREE_LEAF ? TREE_ALL_LANES : t->nodes[at].lanes;
}

/* What is in each of the lanes, instead of them. */
static void open_lanes(dual *d, const dual_entry *e) {
  const tree *t = tree_of(d, e->which);
  for (uint32_t left = e->lanes; left; left &= left - 1) {
    const uint32_t in = t->nodes[e->at].child[__builtin_ctz(left)];
    spread(d, e->which, in, lanes_of(t, in), e->other, e->lower);
  }
}

/* What is in the other box, instead of it. */
static void open_other(dual *d, const dual_entry *e) {
  const tree *t = tree_of(d, 1 - e->which);
  const uint32_t in = t->nodes[e->other.at].child[e->other.lane];
  for (uint32_t left = lanes_of(t, in); left; left &= left - 1) {
    const uint32_t l = (uint32_t)__builtin_ctz(left);
    if (!(in & TREE_LEAF) || !is_repeated(t, in & ~TREE_LEAF, l))
      spread(d, e->which, e->at, e->lanes, (dual_side){in, l}, e->lower);
  }
}

/* The same, but by the normals of what is in it. */
static void exchange(dual *d, const dual_entry *e) {
  const tree *t = tree_of(d, 1 - e->which);
  const uint32_t in = t->nodes[e->other.at].child[e->other.lane];
  for (uint32_t left = e->lanes; left; left &= left - 1)
    spread(d, 1 - e->which, in, lanes_of(t, in), (dual_side){e->at, (uint32_t)__builtin_ctz(left)}, e->lower);
}

/* Two elements: once more by the normals of the other one; true where they wait for that. */
static bool waits(dual *d, const dual_entry *e, dual_side own) {
  if (e->by_both) return false;
  const int which = 1 - e->which;
  tree_segment segment;
  interval_of(d, which, own, &segment);
  tree_lanes lanes;
  tree_measure(tree_of(d, which), e->other.at, 1u << e->other.lane, &segment, &lanes);
  d->best.steps++;
  dual_entry again = *e;
  again.lower = lanes.bound[e->other.lane] - d->margins - d->rounding;
  again.by_both = true;
  if (!(again.lower > e->lower)) return false;
  push(d, again);
  return true;
}

/* Two elements are measured. Else the wider side is opened: so what is wide ends as lanes, which part what is small
 * from them by normals of their own. */
static void visit(dual *d, const dual_entry *e) {
  const bool leaf = (e->at & TREE_LEAF) != 0;
  if (leaf && is_element(e->other)) {
    const dual_side own = {e->at, (uint32_t)__builtin_ctz(e->lanes)};
    if (waits(d, e, own)) return;
    measure(d, place_of(e->which == 0 ? own : e->other), place_of(e->which == 0 ? e->other : own));
    return;
  }
  double widest2 = 0.0;
  for (uint32_t left = e->lanes; left; left &= left - 1)
    widest2 = greater(widest2, width2_of(tree_of(d, e->which), (dual_side){e->at, (uint32_t)__builtin_ctz(left)}));
  const bool wider = is_element(e->other) || widest2 >= width2_of(tree_of(d, 1 - e->which), e->other);
  if (!wider)
    exchange(d, e);
  else if (leaf)
    open_other(d, e);
  else
    open_lanes(d, e);
}

static bool is_stopped(const dual *d) {
  enum { POLL_INTERVAL = 64 };
  return d->goal.stop && d->visits % POLL_INTERVAL == 0 && d->goal.stop(d->goal.stop_user);
}

/* Until what is left is no nearer than the best, or as near as is asked for. */
static void descend(dual *d) {
  for (uint32_t left = tree_of(d, 0)->nodes[0].lanes; left && !d->out_of_memory; left &= left - 1)
    spread(d, 1, 0, tree_of(d, 1)->nodes[0].lanes, (dual_side){0, (uint32_t)__builtin_ctz(left)}, d->least);
  while (d->count > 0 && !d->best.overlap && !d->best.support_failed && !d->out_of_memory) {
    d->best.stopped = is_stopped(d);
    d->best.exhausted = d->best.exhausted || d->best.steps > d->goal.max_steps;
    const dual_entry top = pop(d);
    if (top.lower >= worth(d) || d->best.stopped || d->best.steps > d->goal.max_steps) {
      d->lower = lesser(d->lower, top.lower);
      if (top.lower >= worth(d)) d->best.exhausted = d->best.stopped = false;
      break;
    }
    d->visits++;
    visit(d, &top);
  }
}

/* ---- the hulls ---- */

static double hull_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  vec3 unused;
  return tree_farthest(shape->user, d, at ? at : &unused);
}

static const convex_ops hull_ops = {.kind = CPROX_BODY_POLYTOPE, .support = hull_support};

/* The hulls of both, by their support functions: where they are apart, how far, and where. */
static void part_hulls(dual *d, pair_answer *answer) {
  enum { MOST_STEPS = 24 };
  convex hull[2];
  for (int i = 0; i < 2; i++)
    hull[i] = (convex){.ops = &hull_ops, .user = tree_of(d, i), .scale = tree_of(d, i)->scale + 1e-100};
  const pair_goal goal = {.verdict = true,
                          .limit = d->goal.verdict ? d->goal.limit : 0.0,
                          .max_steps = MOST_STEPS < d->goal.max_steps ? MOST_STEPS : d->goal.max_steps};
  pair_separate(&hull[0], d->side[0]->margin, &hull[1], d->side[1]->margin, d->place, &goal, answer);
  d->best.steps += answer->steps;
  d->best.supports += answer->supports;
  d->normal = answer->lower > -d->margins ? answer->normal : vec(0, 0, 0);
}

/* An element of the first that is near a point, and one of the second that is near that. */
static void seed(dual *d, vec3 near) {
  const tree_hit hit = tree_nearest(tree_of(d, 0), near, INFINITY);
  vec3 v[3];
  tree_corners(tree_of(d, 0), hit.at, v);
  const tree_hit there = tree_nearest(tree_of(d, 1), across(d, 0, v[0]), INFINITY);
  measure(d, hit.at, there.at);
}

/* Less than minus any depth: to move one out of the other altogether. */
static double least_of(const dual *d) {
  return -(2.0 * (tree_of(d, 0)->scale + tree_of(d, 1)->scale) + d->margins);
}

static void overlap(const dual *d, vec3 common, pair_answer *answer) {
  answer->overlap = true;
  answer->upper = 0.0;
  answer->lower = least_of(d);
  answer->on_a = answer->on_b = answer->common = common;
  answer->normal = vec(0, 0, 0);
}

/* ---- insides ---- */

static bool is_solid(const pair_side *side) {
  return side->body->winding != NULL;
}

/* Whether a connected part of one is inside of the other, which is solid; the surfaces do not meet. */
static winding_side side_of(const dual *d, int solid, vec3 *point) {
  if (!is_solid(d->side[solid])) return WINDING_OUTSIDE;
  winding_guest guest = {.elements = tree_of(d, 1 - solid), .at = across(d, 1 - solid, vec(0, 0, 0))};
  guest.error = d->rounding;
  for (int i = 0; i < 9; i++) guest.r[i] = d->place->r[solid == 0 ? i : 3 * (i % 3) + i / 3];
  const winding_side side = winding_find_inside(d->side[solid]->body->winding, tree_of(d, solid), &guest, point);
  if (solid == 0) *point = across(d, 1, *point);
  return side;
}

/* What was not looked at is a surface, which has no inside to be deep in; else it may be as deep as anything. */
static double least_unseen(const dual *d) {
  const bool boxes = tree_of(d, 0)->kind == TREE_BOXES || tree_of(d, 1)->kind == TREE_BOXES;
  return boxes || is_solid(d->side[0]) || is_solid(d->side[1]) ? least_of(d) : -d->margins;
}

static void conclude(const dual *d, pair_answer *answer) {
  *answer = d->best;
  if (answer->support_failed) return;
  if (answer->overlap) {
    overlap(d, d->best.common, answer);
    return;
  }
  answer->rounding = greater(answer->rounding, d->rounding);
  CORE_CHECK(!(d->lower > answer->upper), "lower %.17g, upper %.17g", d->lower, answer->upper);
  answer->lower = lesser(d->lower, answer->upper);
  if (d->goal.verdict && answer->upper <= d->goal.limit) { /* whatever is inside of what */
    answer->lower = lesser(answer->lower, least_of(d));
    return;
  }
  const bool apart = answer->lower + d->margins > d->rounding;
  if ((answer->exhausted || answer->stopped) && !apart) answer->lower = lesser(least_unseen(d), answer->upper);

  /* surfaces that do not meet: one inside of the other, where that is solid, or each outside of the other */
  for (int solid = 1; apart && solid >= 0 && !answer->overlap; solid--) {
    vec3 inner = vec(0, 0, 0);
    const winding_side side = side_of(d, solid, &inner);
    if (side == WINDING_INSIDE) overlap(d, inner, answer);
    if (side == WINDING_NEAR) answer->lower = lesser(answer->lower, least_of(d));
  }
}

/* A vertex of one inside of the other, which is solid: they overlap, whatever their surfaces do. */
static void try_vertex(dual *d) {
  for (int solid = 0; solid < 2 && !d->best.overlap; solid++) {
    if (!is_solid(d->side[solid])) continue;
    const tree *host = tree_of(d, solid), *guest = tree_of(d, 1 - solid);
    vec3 v[3];
    tree_corners(guest, (tree_place){0, 0}, v);
    const vec3 x = across(d, 1 - solid, v[0]);
    if (winding_side_of(d->side[solid]->body->winding, host, x, d->rounding) != WINDING_INSIDE) continue;
    d->best.overlap = true;
    d->best.common = solid == 0 ? x : v[0];
  }
}

bool mesh_mesh_measure(const pair_side *a, const pair_side *b, const pair_goal *goal, cprox_workspace *workspace,
                       pair_answer *answer) {
  const pair_placement place = relative_pose_make(a, b);
  const tree *x = a->body->tree, *y = b->body->tree;
  dual d = {.side = {a, b}, .place = &place, .goal = *goal, .margins = a->margin + b->margin, .workspace = workspace};
  d.rounding = ROUND_UP * (place.error + (2.0 * ROUND_ROTATION + 2.0 * TREE_ROUND) * ROUND_U *
                                             (vec_norm(place.t) + x->scale + y->scale + d.margins));
  d.goal.epsilon = greater(goal->epsilon - 4.0 * d.rounding, 0.0);
  d.best = (pair_answer){.upper = INFINITY};
  d.lower = INFINITY;
  d.least = -d.margins - d.rounding;
  pair_answer hulls;
  part_hulls(&d, &hulls);
  if (d.goal.verdict && hulls.lower > d.goal.limit) { /* neither is inside of the other, then */
    *answer =
        (pair_answer){.lower = hulls.lower, .upper = INFINITY, .steps = d.best.steps, .supports = d.best.supports};
    return true;
  }
  if (!d.goal.verdict) seed(&d, vec_norm2(d.normal) > 0.0 ? hulls.on_b : place.t);
  if (!d.best.overlap && !d.best.support_failed) try_vertex(&d);
  if (!d.best.overlap && !d.best.support_failed) descend(&d);
  if (d.out_of_memory) return false;
  conclude(&d, answer);
  return true;
}
