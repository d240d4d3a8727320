/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/oracle.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/cull.h"

enum { MOST_SEEDS = 16, MOST_SEED_TESTS = 40000 };

/* A gap is measured to this fraction of the width asked for. */
static const double GAP_FRACTION = 0.02;

/* Of a pair that is too far to matter in the middle only so much of the excess need be known. */
static const double EXCESS_FRACTION = 0.05;

/* The first distances of a search need be no more exact than this. */
static const double SEED_FRACTION = 0.02;

/* Intervals that are shorter are measured even where a part moves farther than its own size. */
#define SHORT_INTERVAL 0x1p-8

/* Parts that move farther than their own size, and than this fraction of their distance, are split before they are
 * measured. */
static const double MOST_DISPLACEMENT = 0.5;

/* Normals that turn faster than this over a node are taken to stand still. */
static const double FASTEST_NORMAL_RATE = 0.5;

/* Where a plane in the middle asks for more pieces than this, no distance is measured. */
static const double ENOUGH_PIECES = 3.0;

#define SHORTEST_INTERVAL 0x1p-46

/* ---- nodes ---- */

static motion_interval interval_of(const search_node *node) {
  const robot_node *payload = robot_known(node);
  return (motion_interval){.a = payload->a, .b = payload->b, .first = payload->first, .last = payload->last};
}

/* Whether a node is so short that everything is measured. */
static bool is_short(const search_node *node) {
  const motion_interval over = interval_of(node);
  return !motion_is_span(&over) && !(over.b - over.a > SHORT_INTERVAL);
}

static search_node node_of(const robot_search *o, const search_node *parent, size_t first, double a, size_t last,
                           double b) {
  search_node node = *parent;
  robot_node *to = robot_own(&node);
  to->a = a, to->first = (uint32_t)first;
  to->b = b, to->last = (uint32_t)last;
  node.start = motion_time_below(o->scene.motion, first, a);
  return node;
}

bool robot_search_root(robot_search *o, size_t first, double u0, size_t last, double u1, search_node *root) {
  *root = (search_node){.lower = -INFINITY};
  const obstacle_bvh *set = o->scene.q->set;
  const size_t n_pairs = o->scene.n_pairs, n_parts = set && set->boxes ? o->scene.motion->robot->n_parts : 0;
  const int32_t slot = lists_take(&o->lists, n_pairs + n_parts);
  if (slot < 0) return false;
  robot_own(root)->list = slot;
  list_entry *entry = lists_at(&o->lists, slot);
  for (size_t i = 0; i < n_pairs; i++) entry[i] = (list_entry){.lower = -INFINITY, .pair = (int32_t)i};
  size_t n = n_pairs;
  for (size_t i = 0; i < n_parts; i++)
    if (robot_scene_asks(&o->scene, i)) entry[n++] = (list_entry){.lower = -INFINITY, .pair = -1, .part = (int32_t)i};
  lists_set_count(&o->lists, slot, n);
  *root = node_of(o, root, first, u0, last, u1);
  return true;
}

/* ---- measuring ---- */

/* The lower bound from which on a pair needs no more work, and whether one says that. */
static double pruning_bound(const robot_search *o) {
  return search_pruning_bound(&o->goal, o->best_bound.upper);
}

static bool is_pruned(const robot_search *o, double lower) {
  return search_is_pruned(&o->goal, o->best_bound.upper, lower);
}

/* Nothing more need be known: what is left on the lists does not matter. */
static bool is_answered(const robot_search *o) {
  return search_is_answered(&o->goal, o->best_bound.upper);
}

/* Distances: the least one. Left to right: the earliest one within epsilon of contact, and until there is one, the
 * least. */
static bool is_better(const robot_search *o, double upper, double at) {
  if (o->goal.order != SEARCH_LEFT_TO_RIGHT) return upper < o->best_bound.upper;
  const double near = o->goal.limit + o->goal.epsilon;
  if (o->best_bound.upper <= near) return upper <= near && at < o->best_bound.at;
  return upper < o->best_bound.upper;
}

static bool is_convex(const robot_body *moving, const robot_body *standing) {
  return !moving->tree && !standing->tree;
}

static cprox_status refuse_callback(const robot_search *o) {
  return workspace_fail(o->scene.q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
}

/* What was measured may be the least so far, or a contact. */
static void keep_sample(robot_search *o, int32_t index, const robot_gap *gap) {
  const size_t segment = o->scene.segment;
  const double u = o->scene.u, upper = fmax(gap->upper, 0.0), at = motion_time_below(o->scene.motion, segment, u);
  const robot_sample sample = {.gap = *gap, .pair = index, .segment = segment, .u = u};
  if (is_better(o, upper, at)) {
    o->best = sample;
    o->best_bound = (search_best){.upper = upper, .slack = gap->slack, .at = at};
  }
  if (upper <= o->goal.limit && at < o->touch_at) {
    o->touch = sample;
    o->touch_at = at;
  }
}

/* Found where the scene is. */
static void place_normal(const robot_search *o, robot_pair *pair, vec3 normal) {
  pair->normal = normal;
  pair->normal_rate = vec(0, 0, 0);
  pair->found = pair->from = pair->to = robot_scene_place(&o->scene, o->scene.segment, o->scene.u);
  pair->normal_known = true;
}

static void keep_normal(const robot_search *o, robot_pair *pair, const robot_body *standing, const robot_gap *gap) {
  if (vec_norm2(gap->normal) > 0.0) place_normal(o, pair, placement_turn_back(&standing->side.at, gap->normal));
}

/* The distance of the convex sides of a pair; it is that of the pair itself where that has no elements. */
static cprox_status measure(robot_search *o, int32_t index, robot_accuracy accuracy, robot_gap *gap) {
  robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  robot_scene_measure(moving, standing, accuracy, gap);
  o->gaps++;
  if (gap->support_failed) return refuse_callback(o);
  keep_normal(o, pair, standing, gap);
  if (is_convex(moving, standing)) keep_sample(o, index, gap);
  return CPROX_OK;
}

/* Sets out from what is known of the hulls. No element is farther from the other side than the hulls' distance and
 * their sizes. */
static robot_refinement refinement_from(robot_search *o, int32_t index, const robot_gap *hulls, double reach,
                                        double room) {
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  const double most = fmax(hulls->upper, 0.0) + (moving->tree ? 4.0 * moving->radius : 0.0) +
                      (standing->tree ? 4.0 * standing->radius : 0.0);
  return (robot_refinement){.scene = &o->scene,
                            .pair = index,
                            .reach = fmin(reach, most + room),
                            .room = room,
                            .accuracy = GAP_FRACTION * o->goal.epsilon,
                            .normal = hulls->upper > 0.0 ? hulls->normal : vec(0, 0, 0)};
}

static cprox_status refine_elements(robot_search *o, robot_refinement *c) {
  robot_refinement_run(c);
  o->gaps += c->gaps;
  o->refined = true;
  if (c->support_failed) return refuse_callback(o);
  if (c->no_memory) return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  if (c->nearest.gap.upper < INFINITY) keep_sample(o, c->pair, &c->nearest.gap);
  return CPROX_OK;
}

/* The distance of a pair, elements and all, as far as it can be less than the best. */
static cprox_status measure_whole(robot_search *o, int32_t index) {
  robot_gap gap;
  const double floor = fmax(o->goal.limit, 0.0);
  const cprox_status status = measure(
      o, index, (robot_accuracy){.epsilon = GAP_FRACTION * o->goal.epsilon, .floor = floor, .fraction = SEED_FRACTION},
      &gap);
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  if (status < 0 || is_convex(moving, standing) || gap.lower >= o->best_bound.upper) return status;
  robot_refinement c = refinement_from(o, index, &gap, o->best_bound.upper, 0.0);
  return refine_elements(o, &c);
}

/* The pair that comes closest by balls and boxes. */
typedef struct nearest_pair {
  double apart;
  int32_t pair; /* -1: none is nearer */
} nearest_pair;

static void try_pair(robot_search *o, int32_t index, nearest_pair *nearest) {
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  if (robot_scene_balls(moving, standing) >= nearest->apart) return;
  const double apart = robot_scene_ball_distance(moving, standing);
  if (apart < nearest->apart) *nearest = (nearest_pair){.apart = apart, .pair = index};
}

/* What is to be opened, the nearest on top. */
typedef struct cluster_stack {
  uint32_t at[TREE_LANES * TREE_DEEPEST];
  double apart[TREE_LANES * TREE_DEEPEST];
  size_t count;
} cluster_stack;

static void push_nearest_last(cluster_stack *stack, const cluster_lanes *lanes, double most) {
  const size_t first = stack->count;
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    if (!(lanes->live >> l & 1u) || !(lanes->apart[l] < most)) continue;
    size_t i = stack->count++;
    for (; i > first && stack->apart[i - 1] < lanes->apart[l]; i--)
      stack->apart[i] = stack->apart[i - 1], stack->at[i] = stack->at[i - 1];
    stack->apart[i] = lanes->apart[l], stack->at[i] = lanes->under[l];
  }
}

static cprox_status no_memory_for_pairs(const robot_search *o) {
  return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
}

/* The same of all that is under a node of the set's tree. */
static cprox_status try_cluster(robot_search *o, const list_entry *entry, nearest_pair *nearest) {
  cluster_stack stack = {.at = {entry->under}, .apart = {-INFINITY}, .count = 1};
  while (stack.count > 0) {
    const uint32_t at = stack.at[--stack.count];
    if (stack.apart[stack.count] >= nearest->apart) continue;
    cluster_lanes lanes;
    cluster_measure(&o->scene, entry->part, at, 0.0, &lanes);
    if (!(at & TREE_LEAF)) push_nearest_last(&stack, &lanes, nearest->apart);
    for (uint32_t l = 0; (at & TREE_LEAF) && l < TREE_LANES; l++) {
      if (!(lanes.live >> l & 1u) || !(lanes.apart[l] < nearest->apart)) continue;
      size_t count;
      const int32_t pairs = cluster_pairs(&o->scene, entry->part, lanes.under[l], &count);
      if (pairs < 0) return no_memory_for_pairs(o);
      for (size_t k = 0; k < count; k++) try_pair(o, pairs + (int32_t)k, nearest);
    }
  }
  return CPROX_OK;
}

/* Measures the pair whose balls and boxes come closest where the scene is. */
static cprox_status seed_here(robot_search *o, int32_t list) {
  const double most = o->goal.limit >= 0.0 ? lesser(o->best_bound.upper, o->goal.limit) : o->best_bound.upper;
  const size_t n = lists_count(&o->lists, list);
  nearest_pair nearest = {.apart = most, .pair = -1};
  for (size_t k = 0; k < n; k++) {
    const list_entry entry = lists_at(&o->lists, list)[k];
    const cprox_status status = entry.pair < 0 ? try_cluster(o, &entry, &nearest) : CPROX_OK;
    if (status < 0) return status;
    if (entry.pair >= 0) try_pair(o, entry.pair, &nearest);
  }
  return nearest.pair < 0 ? CPROX_OK : measure_whole(o, nearest.pair);
}

/* The knot inside the span, a multiple of `step` where there is one, that is nearest to a time. */
static size_t knot_near(const cprox_motion *m, size_t first, size_t last, size_t step, double t) {
  size_t low = (first + step) / step, high = (last - 1) / step;
  if (low > high) step = 1, low = first + 1, high = last - 1;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (m->times[middle * step] < t)
      low = middle + 1;
    else
      high = middle;
  }
  const size_t knot = low * step;
  return knot > first + step && t - m->times[knot - step] < m->times[knot] - t ? knot - step : knot;
}

/* Blocks of the motion's tree are aligned: spans that begin and end at multiples of this are made of few of them. */
static size_t step_for(size_t segments) {
  size_t step = 1;
  while (32 * step <= segments) step *= 2;
  return step;
}

/* In the middle of a span, or where it is bent of its halves, `places` at most. */
static cprox_status seed_span(robot_search *o, int32_t list, const motion_interval *over, size_t places) {
  robot_scene_enter_span(&o->scene, over);
  if (!o->scene.bent || places < 2) return seed_here(o, list);
  const cprox_motion *m = o->scene.motion;
  const double t0 = motion_time(m, over->first, over->a), t1 = motion_time(m, over->last - 1, over->b);
  const size_t knot = knot_near(m, over->first, over->last, step_for(over->last - over->first), 0.5 * (t0 + t1));
  motion_interval half = *over;
  half.last = knot, half.b = 1.0;
  const cprox_status status = seed_span(o, list, &half, places / 2);
  if (status < 0 || is_answered(o)) return status;
  half = *over;
  half.first = knot, half.a = 0.0;
  return seed_span(o, list, &half, places - places / 2);
}

/* Measures a pair that is near enough to touch where the scene is. */
static cprox_status measure_if_near(robot_search *o, int32_t index) {
  const robot_pair *pair = &o->scene.pairs[index];
  if (pair->element[0] >= 0 || pair->element[1] >= 0) return CPROX_OK;
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  if (robot_scene_balls(moving, standing) > o->goal.epsilon) return CPROX_OK;
  return robot_scene_ball_distance(moving, standing) > o->goal.epsilon ? CPROX_OK : measure_whole(o, index);
}

/* The same of all that is under a node of the set's tree, until contact is proven. */
static cprox_status measure_near_cluster(robot_search *o, const list_entry *entry) {
  const double known = o->touch_at;
  cluster_stack stack = {.at = {entry->under}, .apart = {-INFINITY}, .count = 1};
  cprox_status status = CPROX_OK;
  while (stack.count > 0 && status >= 0 && o->touch_at == known) {
    const uint32_t at = stack.at[--stack.count];
    const double near = nextafter(o->goal.epsilon, INFINITY);
    cluster_lanes lanes;
    cluster_measure(&o->scene, entry->part, at, 0.0, &lanes);
    if (!(at & TREE_LEAF)) push_nearest_last(&stack, &lanes, near);
    for (uint32_t l = 0; (at & TREE_LEAF) && l < TREE_LANES; l++) {
      if (!(lanes.live >> l & 1u) || !(lanes.apart[l] < near)) continue;
      size_t count;
      const int32_t pairs = cluster_pairs(&o->scene, entry->part, lanes.under[l], &count);
      if (pairs < 0) return no_memory_for_pairs(o);
      for (size_t k = 0; k < count && status >= 0; k++) status = measure_if_near(o, pairs + (int32_t)k);
    }
  }
  return status;
}

/* Contact at the beginning answers a search from left to right at once; halves of halves would only close in on it. */
static cprox_status measure_start(robot_search *o, const search_node *node) {
  const robot_node *payload = robot_known(node);
  const double known = o->touch_at;
  const size_t n = lists_count(&o->lists, payload->list);
  robot_scene_enter(&o->scene, payload->first, payload->a, payload->a);
  cprox_status status = CPROX_OK;
  for (size_t k = 0; k < n && status >= 0 && o->touch_at == known; k++) {
    const list_entry entry = lists_at(&o->lists, payload->list)[k];
    status = entry.pair < 0 ? measure_near_cluster(o, &entry) : measure_if_near(o, entry.pair);
  }
  return status;
}

/* A few places, so that the search begins with a distance. */
static cprox_status seed(robot_search *o, const search_node *node) {
  const motion_interval over = interval_of(node);
  const int32_t list = robot_known(node)->list;
  const size_t n = lists_count(&o->lists, list);
  size_t places = MOST_SEEDS;
  while (places > 1 && places * n > MOST_SEED_TESTS) places /= 2;
  cprox_status status = seed_span(o, list, &over, places);
  for (int end = 0; end < 2 && status >= 0 && !is_answered(o); end++) {
    const double u = end == 0 ? over.a : over.b;
    robot_scene_enter(&o->scene, end == 0 ? over.first : over.last - 1, u, u);
    status = seed_here(o, list);
  }
  return status;
}

/* ---- bounds ---- */

/* The pair's last normal, carried on to where the scene is as it turned; in the standing frame. (0,0,0) where there is
 * none. */
static vec3 known_normal(const robot_search *o, const robot_pair *pair) {
  if (!pair->normal_known) return vec(0, 0, 0);
  const double here = robot_scene_place(&o->scene, o->scene.segment, o->scene.u);
  const double away = here >= pair->from && here <= pair->to ? here - pair->found : 0.0;
  const vec3 n = vec_axpy(pair->normal, away, pair->normal_rate);
  return vec_scale(1.0 / vec_norm(n), n);
}

/* The beginning and the end of the node that the scene is at, along the motion; in that of one segment, of the segment.
 */
static void ends_of_node(const robot_search *o, bool whole, double *from, double *to) {
  const motion_interval *over = &o->scene.over;
  const bool segment = whole && !motion_is_span(over);
  *from = robot_scene_place(&o->scene, over->first, segment ? 0.0 : over->a);
  *to = robot_scene_place(&o->scene, over->last - 1, segment ? 1.0 : over->b);
}

static double width_of_node(const robot_search *o) {
  double from, to;
  ends_of_node(o, false, &from, &to);
  return to - from;
}

static vec3 normal_in_middle(const robot_search *o, const robot_pair *pair, const robot_body *standing) {
  const vec3 n = placement_turn(&standing->side.at, known_normal(o, pair));
  return vec_scale(1.0 / vec_norm(n), n);
}

/* In the place of a normal that is not known yet. */
static void keep_guess(const robot_search *o, robot_pair *pair, const robot_body *moving, const robot_body *standing) {
  const vec3 guess = robot_scene_guess(moving, standing);
  if (vec_norm2(guess) > 0.0) place_normal(o, pair, guess);
}

/* How far the two are apart along it: only to choose by, its rounding is not counted. */
static double plane_middle(const robot_search *o, const robot_pair *pair, const robot_body *moving,
                           const robot_body *standing) {
  const vec3 n = normal_in_middle(o, pair, standing);
  const double along = vec_dot(n, vec_sub(moving->side.at.p, standing->side.at.p));
  return along - bound_height(&moving->side, vec_neg(n)) - robot_scene_height(standing, n);
}

/* What that normal says of the node. */
static double bound_by_normal(robot_search *o, const robot_pair *pair, const robot_body *moving,
                              const robot_body *standing, const chain_motion *motion, double goal, double *slack) {
  const double here = robot_scene_place(&o->scene, o->scene.segment, o->scene.u);
  const bool turning = here >= pair->from && here <= pair->to;
  const vec3 n = normal_in_middle(o, pair, standing);
  vec3 normal_rate = placement_turn(&standing->side.at, vec_scale(turning ? width_of_node(o) : 0.0, pair->normal_rate));
  normal_rate = vec_axpy(normal_rate, -vec_dot(normal_rate, n), n);
  if (!(vec_norm2(normal_rate) < FASTEST_NORMAL_RATE * FASTEST_NORMAL_RATE)) normal_rate = vec(0, 0, 0);
  double heights[2];
  heights[0] = robot_scene_height(standing, vec_axpy(n, -0.5, normal_rate));
  heights[1] = vec_norm2(normal_rate) > 0.0 ? robot_scene_height(standing, vec_axpy(n, 0.5, normal_rate)) : heights[0];
  o->planes++;
  return motion_plane_bound(motion, &moving->side, &standing->side, n, normal_rate, heights,
                            moving->steps + standing->steps, goal, slack);
}

/* What a cut into so many pieces would do for one pair counts for the node. */
static void want_pieces(robot_search *o, double pieces) {
  o->pieces = greater(pieces, o->pieces);
}

/* A pair that is `middle` apart in the middle, of which the whole node says `bound`: what is lost shrinks as the square
 * of the length on the piece that is nearest; on others it may shrink slower, but there is more to lose. */
static double pieces_for(const robot_search *o, double middle, double bound) {
  const double goal = pruning_bound(o);
  return middle > goal ? sqrt(1.05 * (middle - bound) / (middle - goal)) : 2.0;
}

/* The plane of the distance just measured, turning as its feature does. */
static double bound_by_gap(robot_search *o, robot_pair *pair, const robot_body *moving, const robot_body *standing,
                           const chain_motion *motion, const robot_gap *gap, double *slack) {
  const vec3 normal_rate = vec_scale(1.0 / width_of_node(o), robot_scene_normal_rate(gap, moving, standing, motion));
  pair->normal_rate = placement_turn_back(&standing->side.at, normal_rate);
  ends_of_node(o, true, &pair->from, &pair->to);
  return bound_by_normal(o, pair, moving, standing, motion, pruning_bound(o), slack);
}

static bool keep_entry(robot_search *o, const list_entry *entry) {
  list_entry *next = workspace_reserve(o->scene.q->workspace, WORKSPACE_ROBOT_NEXT, (o->n_next + 1) * sizeof *next);
  if (!next) return false;
  o->next = next;
  next[o->n_next++] = *entry;
  return true;
}

/* One of the pairs of elements that take the place of a pair: kept where its own plane does not settle it. */
static cprox_status enlist(robot_search *o, search_node *node, const robot_pair *whole, const robot_found *found) {
  robot_pair pair = {.moving = whole->moving,
                     .standing = whole->standing,
                     .element = {found->element[0], found->element[1]},
                     .self = whole->self};
  const robot_body *moving = robot_scene_moving(&o->scene, &pair), *standing = robot_scene_standing(&o->scene, &pair);
  chain_motion own;
  const chain_motion *motion = robot_scene_motion(&o->scene, &pair, moving, &own);
  keep_normal(o, &pair, standing, &found->gap);
  list_entry entry = {.lower = found->gap.lower - motion->displacement};
  double slack = moving->side.error + standing->side.error;
  if (!is_pruned(o, entry.lower) && pair.normal_known && found->gap.upper > 0.0)
    entry.lower = fmax(entry.lower, bound_by_gap(o, &pair, moving, standing, motion, &found->gap, &slack));
  if (is_pruned(o, entry.lower)) {
    o->dropped = fmin(o->dropped, entry.lower);
    return CPROX_OK;
  }
  entry.pair = robot_scene_add_pair(&o->scene, &pair);
  if (entry.pair < 0 || !keep_entry(o, &entry))
    return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  if (entry.lower < node->lower) node->lower = entry.lower, node->slack = slack;
  return CPROX_OK;
}

/* The hulls do not settle it: what of their elements comes near enough takes the place of the pair. */
static cprox_status refine_pair_elements(robot_search *o, search_node *node, list_entry *entry, const robot_gap *hulls,
                                         double displacement) {
  const double spare = 4.0 * hulls->slack;
  robot_refinement c =
      refinement_from(o, entry->pair, hulls, pruning_bound(o) + displacement + spare, displacement + spare);
  c.listing = true;
  const cprox_status status = refine_elements(o, &c);
  if (status < 0 || c.too_many) return status;
  entry->lower = fmax(entry->lower, c.rest - displacement - hulls->slack);
  const robot_pair whole = o->scene.pairs[entry->pair];
  for (size_t i = 0; i < c.n_found; i++) {
    const cprox_status listed = enlist(o, node, &whole, &c.found[i]);
    if (listed < 0) return listed;
  }
  return CPROX_OK;
}

/* Raises the bound of one pair over the node that the scene is at by balls and boxes. A part that moves too far to be
 * measured wants the node cut. */
static void bound_pair_roughly(robot_search *o, const search_node *node, list_entry *entry) {
  const robot_pair *pair = &o->scene.pairs[entry->pair];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  entry->needs_split = false;
  double coarse = INFINITY;
  if (pair->element[0] < 0 && pair->element[1] < 0) {
    coarse = robot_scene_coarse_displacement(&o->scene, pair);
    entry->lower = greater(robot_scene_balls(moving, standing) - coarse, entry->lower);
    if (is_pruned(o, entry->lower)) return;
  }
  const double apart = robot_scene_ball_distance(moving, standing);
  entry->lower = greater(apart - coarse, entry->lower);
  if (is_pruned(o, entry->lower)) return;
  const double displacement = robot_scene_displacement(&o->scene, pair, moving);
  entry->lower = greater(apart - displacement, entry->lower);
  const double size = greater(MOST_DISPLACEMENT * apart, moving->radius);
  if (is_pruned(o, entry->lower) || !(displacement > size) || is_short(node)) return;
  entry->needs_split = true;
  want_pieces(o, displacement / size);
}

/* The same by planes and distances, the cheapest way that settles it. */
static cprox_status bound_pair(robot_search *o, search_node *node, list_entry *entry, double *slack) {
  robot_pair *pair = &o->scene.pairs[entry->pair];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  *slack = moving->side.error + standing->side.error;
  chain_motion own;
  const chain_motion *motion = robot_scene_motion(&o->scene, pair, moving, &own);
  const double displacement = motion->displacement;

  if (!pair->normal_known) keep_guess(o, pair, moving, standing);
  if (pair->normal_known) {
    const double bound = bound_by_normal(o, pair, moving, standing, motion, pruning_bound(o), slack);
    entry->lower = fmax(entry->lower, bound);
    if (is_pruned(o, entry->lower)) return CPROX_OK;

    /* verdicts: a plane that parts the two in the middle says how short the pieces must be; no distance could say much
     * more */
    const double pieces = o->goal.limit >= 0.0 ? pieces_for(o, plane_middle(o, pair, moving, standing), bound) : 2.0;
    if (pieces > ENOUGH_PIECES && !is_short(node)) {
      want_pieces(o, pieces);
      return CPROX_OK;
    }
  }

  /* another pair wants the node cut: pieces will tell more */
  if (o->cut) return CPROX_OK;
  robot_gap gap;
  const robot_accuracy accuracy = {GAP_FRACTION * o->goal.epsilon, pruning_bound(o), EXCESS_FRACTION,
                                   known_normal(o, pair)};
  const cprox_status status = measure(o, entry->pair, accuracy, &gap);
  if (status < 0) return status;
  entry->lower = fmax(entry->lower, gap.lower - displacement);
  if (pair->normal_known && gap.upper > 0.0)
    entry->lower = fmax(entry->lower, bound_by_gap(o, pair, moving, standing, motion, &gap, slack));
  if (!is_pruned(o, entry->lower)) want_pieces(o, pieces_for(o, gap.lower, entry->lower));
  if (is_convex(moving, standing) || is_pruned(o, entry->lower)) return CPROX_OK;

  /* where the hulls are far enough apart in the middle, halves will settle them: their elements cannot do better */
  if (o->goal.limit < 0.0 && gap.lower < o->best_bound.upper) {
    robot_refinement nearest = refinement_from(o, entry->pair, &gap, o->best_bound.upper, 0.0);
    const cprox_status refined = refine_elements(o, &nearest);
    if (refined < 0) return refined;
  }
  if (is_pruned(o, gap.lower) && !is_short(node)) return CPROX_OK;
  return refine_pair_elements(o, node, entry, &gap, displacement);
}

static cprox_status keep_open(robot_search *o, const list_entry *entry) {
  if (!is_pruned(o, entry->lower)) return keep_entry(o, entry) ? CPROX_OK : no_memory_for_pairs(o);
  o->dropped = lesser(entry->lower, o->dropped);
  return CPROX_OK;
}

/* The pairs of a part and the target in a box of the set's tree. */
static cprox_status open_box(robot_search *o, const search_node *node, const list_entry *entry) {
  size_t count;
  const int32_t pairs = cluster_pairs(&o->scene, entry->part, entry->under, &count);
  if (pairs < 0) return no_memory_for_pairs(o);
  cprox_status status = CPROX_OK;
  for (size_t k = 0; k < count && status == CPROX_OK; k++) {
    list_entry one = {.lower = entry->lower, .pair = pairs + (int32_t)k};
    bound_pair_roughly(o, node, &one);
    status = keep_open(o, &one);
  }
  return status;
}

/* What is under a node of the set's tree and within reach of a part: pairs, or, where the part moves too far for these
 * to be measured, nodes that hold them. */
static cprox_status open_cluster(robot_search *o, const search_node *node, const list_entry *entry) {
  const robot_pair any = {.moving = entry->part, .element = {-1, -1}};
  const double radius = robot_scene_moving(&o->scene, &any)->radius,
               displacement = robot_scene_coarse_displacement(&o->scene, &any);
  uint32_t stack[TREE_LANES * TREE_DEEPEST] = {entry->under};
  size_t n = 1;
  cprox_status status = CPROX_OK;
  while (n > 0 && status == CPROX_OK) {
    const uint32_t at = stack[--n];
    cluster_lanes lanes;
    cluster_measure(&o->scene, entry->part, at, displacement, &lanes);
    for (uint32_t l = 0; l < TREE_LANES && status == CPROX_OK; l++) {
      if (!(lanes.live >> l & 1u)) continue;
      list_entry lane = *entry;
      lane.lower = greater(lanes.lower[l], entry->lower), lane.under = lanes.under[l];
      const double size = greater(MOST_DISPLACEMENT * lanes.apart[l], radius);
      lane.needs_split = displacement > size && !is_short(node);
      if (is_pruned(o, lane.lower)) {
        o->dropped = lesser(lane.lower, o->dropped);
      } else if (at & TREE_LEAF) {
        status = open_box(o, node, &lane);
      } else if (lane.needs_split) {
        want_pieces(o, displacement / size);
        status = keep_open(o, &lane);
      } else {
        stack[n++] = lane.under;
      }
    }
  }
  return status;
}

/* Balls and boxes of all pairs of a node; those that still matter are kept. */
static cprox_status bound_roughly(robot_search *o, const search_node *node) {
  const int32_t list = robot_known(node)->list;
  const size_t n = lists_count(&o->lists, list);
  cprox_status status = CPROX_OK;
  for (size_t i = 0; i < n && status == CPROX_OK; i++) {
    list_entry entry = lists_at(&o->lists, list)[i];
    if (!is_pruned(o, entry.lower) && entry.pair < 0) {
      status = open_cluster(o, node, &entry);
    } else {
      if (!is_pruned(o, entry.lower)) bound_pair_roughly(o, node, &entry);
      status = keep_open(o, &entry);
    }
  }
  return status;
}

/* Bounds all pairs of a node; those that still matter become its own list. */
static cprox_status bound_node(robot_search *o, search_node *node) {
  robot_node *payload = robot_own(node);
  const int32_t old = payload->list;
  const double inherited = node->lower;
  const motion_interval over = interval_of(node);
  robot_scene_enter_span(&o->scene, &over);
  o->n_next = 0;
  o->pieces = 2.0;
  const cprox_status rough = bound_roughly(o, node);
  if (rough < 0) return rough;

  /* those that stay move to the front, elements that take the place of a pair come behind the last one */
  const size_t n = o->n_next;
  o->cut = o->pieces > 2.0;
  size_t kept = 0;
  node->lower = INFINITY;
  for (size_t i = 0; i < n; i++) {
    list_entry entry = o->next[i];
    double slack = 0.0;
    if (!is_pruned(o, entry.lower) && !entry.needs_split && !o->scene.bent) {
      const cprox_status status = bound_pair(o, node, &entry, &slack);
      if (status < 0) return status;
      if (is_answered(o)) {
        node->lower = inherited;
        return CPROX_OK;
      }
    }
    if (is_pruned(o, entry.lower)) {
      o->dropped = lesser(entry.lower, o->dropped);
      continue;
    }
    o->next[kept++] = entry;
    if (entry.lower < node->lower) node->lower = entry.lower, node->slack = slack;
  }
  for (size_t i = n; i < o->n_next; i++) o->next[kept++] = o->next[i];
  o->n_next = kept;

  const int32_t list = lists_take(&o->lists, o->n_next);
  if (list < 0) return CPROX_MEMORY;
  list_entry *to = lists_at(&o->lists, list);
  for (size_t i = 0; i < o->n_next; i++) to[i] = o->next[i];
  lists_set_count(&o->lists, list, o->n_next);
  lists_release(&o->lists, old);
  payload->list = list;
  node->lower = fmax(node->lower, inherited);
  return CPROX_OK;
}

/* ---- the oracle ---- */

static double filter(void *self, search_node *node, double goal) {
  (void)self, (void)goal;
  return node->lower;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  robot_search *o = self;
  cprox_status status = CPROX_OK;
  if (!o->seeded) {
    o->seeded = true;
    if (o->goal.order == SEARCH_LEFT_TO_RIGHT) status = measure_start(o, node);
    if (status >= 0 && !isfinite(o->touch_at)) status = seed(o, node);
  }
  const bool begins_in_contact = o->touch_at <= node->start;
  if (status == CPROX_OK && !is_answered(o) && !begins_in_contact) status = bound_node(o, node);
  *best = o->best_bound;
  return status;
}

/* At knots, into pieces that take about the same time: as many as are wanted, or where the span is bent as many as can
 * be. */
static int split_span(const robot_search *o, const search_node *node, search_node *child) {
  const cprox_motion *m = o->scene.motion;
  const motion_interval over = interval_of(node);
  const size_t segments = over.last - over.first;
  const size_t wanted =
      o->scene.bent || o->pieces > SEARCH_MAX_CHILDREN ? SEARCH_MAX_CHILDREN : (size_t)ceil(o->pieces);
  const double t0 = motion_time(m, over.first, over.a), t1 = motion_time(m, over.last - 1, over.b);
  const size_t step = step_for(2 * segments / wanted);
  size_t from = over.first;
  int n = 0;
  for (size_t k = 1; k <= wanted && from < over.last; k++) {
    size_t to = over.last;
    if (segments <= wanted)
      to = from + 1;
    else if (k < wanted)
      to = knot_near(m, over.first, over.last, step, t0 + (t1 - t0) * (double)k / (double)wanted);
    if (to <= from) continue;
    child[n++] = node_of(o, node, from, from == over.first ? over.a : 0.0, to, to == over.last ? over.b : 1.0);
    from = to;
  }
  return n;
}

static int split(void *self, search_node *node, search_node *child) {
  const robot_node *payload = robot_known(node);
  robot_search *o = self;
  const size_t first = payload->first, last = payload->last;
  const double a = payload->a, b = payload->b;
  int n;
  if (first + 1 < last) {
    n = split_span(o, node, child);
  } else {
    if (!(b - a > SHORTEST_INTERVAL)) return 0;
    n = o->pieces < 2.0 ? 2 : o->pieces > SEARCH_MAX_CHILDREN ? SEARCH_MAX_CHILDREN : (int)ceil(o->pieces);
    for (int k = 0; k < n; k++) {
      const double from = k == 0 ? a : robot_known(&child[k - 1])->b, to = k + 1 == n ? b : a + (b - a) * (k + 1) / n;
      child[k] = node_of(o, node, first, from, last, to);
    }
  }
  for (int k = 1; k < n; k++) lists_share(&o->lists, payload->list);
  return n;
}

static void release(void *self, const search_node *node) {
  robot_search *o = self;
  lists_release(&o->lists, robot_known(node)->list);
}

void robot_search_begin(robot_search *o, const search_goal *goal) {
  o->goal = *goal;
  o->best = o->touch = (robot_sample){.pair = -1};
  o->best_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  o->dropped = o->touch_at = INFINITY;
  o->seeded = o->refined = false;
  o->gaps = o->planes = 0;
  lists_begin(&o->lists, o->scene.q->workspace);
}

/* ---- proof of contact ---- */

/* The distance of a pair at a time, as exactly as arithmetic has it, or of every pair that may touch (-1); what it
 * proves stands in o->touch. */
static cprox_status measure_pair_at(robot_search *o, int32_t pair, double t, double *upper) {
  const cprox_motion *m = o->scene.motion;
  const size_t segment = motion_segment_at(m, t);
  const double from = m->times[segment], to = m->times[segment + 1];
  const double u = fmin(fmax((t - from) / (to - from), 0.0), 1.0), known = o->touch_at;
  robot_scene_enter(&o->scene, segment, u, u);

  /* what was found stays the best, whatever is seen here */
  const robot_sample best = o->best;
  const search_best bound = o->best_bound;
  const double epsilon = o->goal.epsilon;
  o->best_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  o->goal.epsilon = 0.0;
  cprox_status status = CPROX_OK;
  if (pair >= 0) status = measure_whole(o, pair);
  const size_t n = pair < 0 ? o->scene.n_pairs : 0;
  for (size_t i = 0; i < n && status >= 0 && o->touch_at == known; i++) status = measure_if_near(o, (int32_t)i);
  *upper = o->best_bound.upper;
  o->best = best, o->best_bound = bound, o->goal.epsilon = epsilon;
  return status;
}

/* By the speed at which the two approach each other. */
static cprox_status prove_by_speed(robot_search *o, int32_t pair, double t, double first, double end) {
  enum { MOST_STEPS = 8 };
  double before, now, step = first;
  cprox_status status = measure_pair_at(o, pair, t, &before);
  for (int i = 0; i < MOST_STEPS && status >= 0 && t + step < o->touch_at; i++) {
    const double next = fmin(t + step, end);
    if (!(next > t)) break;
    status = measure_pair_at(o, pair, next, &now);
    if (status < 0 || !(now > 0.0)) break;
    const double speed = (before - now) / (next - t);
    if (!(speed > 0.0)) break;
    /* a little deeper than the surface, or rounding hides it */
    step = now / speed * (1.0 + 1e-6) + 1e-9 * first;
    t = next, before = now;
  }
  return status;
}

/* Elements that only slide along each other prove nothing, where others of the same two parts do. */
static int32_t whole_pair(const robot_search *o, int32_t index) {
  const robot_pair *of = &o->scene.pairs[index];
  for (size_t i = 0; i < o->scene.n_pairs; i++) {
    const robot_pair *pair = &o->scene.pairs[i];
    if (pair->moving == of->moving && pair->standing == of->standing && pair->self == of->self &&
        pair->element[0] < 0 && pair->element[1] < 0)
      return (int32_t)i;
  }
  return index;
}

cprox_status robot_search_prove(robot_search *o, double end) {
  enum { MOST_STEPS = 24, MOST_CUTS = 40, EVERY_PAIR = -1 };
  const double begin = o->best_bound.at, range = end - begin;
  if (o->best.pair < 0 || !(o->best_bound.upper <= o->goal.epsilon) || !(o->best_bound.upper > 0.0) || !(range > 0.0))
    return CPROX_OK;
  const double known = o->touch_at;
  double unused;
  cprox_status status = prove_by_speed(o, whole_pair(o, o->best.pair), begin, 1e-6 * range, end);
  if (status < 0 || o->touch_at < known) return status;

  /* farther along in growing steps, and then back to where it is not proven */
  double step = 1e-7 * range, before = begin;
  for (int i = 0; i < MOST_STEPS && step < range && begin + step < known; i++, step *= 2.0) {
    status = measure_pair_at(o, EVERY_PAIR, begin + step, &unused);
    if (status < 0 || o->touch_at < known) break;
    before = begin + step;
  }
  if (status < 0 || !(o->touch_at < known)) return status;
  const int32_t pair = o->touch.pair;
  for (int i = 0; i < MOST_CUTS && o->touch_at - before > 1e-9 * range; i++) {
    const double middle = 0.5 * (before + o->touch_at);
    status = measure_pair_at(o, pair, middle, &unused);
    if (status < 0) return status;
    if (o->touch_at > middle) before = middle;
  }
  return CPROX_OK;
}

search_oracle robot_search_oracle(robot_search *o) {
  return (search_oracle){.self = o, .filter = filter, .probe = probe, .split = split, .release = release};
}
