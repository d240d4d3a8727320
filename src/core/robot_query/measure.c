/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/measure.h"

#include <math.h>

#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/cluster.h"
#include "robot_query/deviation.h"

/* Of each part with groups of others about so many are tested. */
enum { MOST_SEEDS = 16, MOST_SEED_TESTS = 40000, GROUP_SEED_TESTS = 16 };

/* The first distances of a search need be no more exact than this. */
static const double SEED_FRACTION = 0.02;

/* Distances: the least one. Left to right: the earliest one within epsilon of contact, and until there is one, the
 * least. */
static bool is_better(const robot_search *o, double upper, double at) {
  if (o->goal.order != SEARCH_LEFT_TO_RIGHT) return upper < o->best_bound.upper;
  const double near = o->goal.limit + o->goal.epsilon;
  if (o->best_bound.upper <= near) return upper <= near && at < o->best_bound.at;
  return upper < o->best_bound.upper;
}

static cprox_status refuse_callback(const robot_search *o) {
  return workspace_fail(o->scene.q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
}

/* What was measured at u of a segment may be the least so far, or a contact; `other`: the other clock's time there. */
static void keep_sample_at(robot_search *o, int32_t index, const robot_gap *gap, size_t segment, double u,
                           double other) {
  const double upper = o->goal.is_signed ? gap->upper : fmax(gap->upper, 0.0),
               at = robot_scene_clock(&o->scene, motion_time_below(o->scene.motion, segment, u), other);
  const robot_sample sample = {.gap = *gap, .pair = index, .segment = segment, .u = u, .other = other};
  if (is_better(o, upper, at)) {
    o->best = sample;
    o->best_bound = (search_best){.upper = upper, .slack = gap->slack, .at = at};
  }
  if (o->goal.limit >= 0.0 && upper <= o->goal.limit && at < o->touch_at) {
    o->touch = sample;
    o->touch_at = at;
  }
}

static void keep_sample(robot_search *o, int32_t index, const robot_gap *gap) {
  if (!robot_scene_is_possible(&o->scene)) return;
  keep_sample_at(o, index, gap, o->scene.centre.segment, o->scene.centre.u, robot_scene_other_time(&o->scene));
}

void robot_keep_common(robot_search *o, int32_t index, vec3 point) {
  const robot_gap gap = {.on_moving = point, .on_standing = point};
  keep_sample(o, index, &gap);
}

static void place_normal_at(const robot_search *o, robot_pair *pair, vec3 normal, size_t segment, double u) {
  pair->normal = normal;
  pair->normal_rate = vec(0, 0, 0);
  pair->found = pair->from = pair->to = robot_scene_place(&o->scene, segment, u);
  pair->normal_known = true;
}

void robot_place_normal(const robot_search *o, robot_pair *pair, vec3 normal) {
  place_normal_at(o, pair, normal, o->scene.centre.segment, o->scene.centre.u);
}

void robot_keep_normal(const robot_search *o, const placed_robot_pair *p, const robot_gap *gap) {
  if (vec_norm2(gap->normal) > 0.0)
    robot_place_normal(o, p->pair, placement_turn_back(&p->standing->side.at, gap->normal));
}

static cprox_status measure_bodies(robot_search *o, const robot_body *moving, const robot_body *standing,
                                   robot_accuracy accuracy, robot_gap *gap) {
  robot_pair_measure(moving, standing, accuracy, gap);
  o->gaps++;
  return gap->support_failed ? refuse_callback(o) : CPROX_OK;
}

cprox_status robot_measure_placed(robot_search *o, int32_t index, const robot_body *moving, const robot_body *standing,
                                  robot_accuracy accuracy, size_t segment, double u, robot_gap *gap) {
  const cprox_status status = measure_bodies(o, moving, standing, accuracy, gap);
  if (status < 0) return status;
  if (vec_norm2(gap->normal) > 0.0)
    place_normal_at(o, &o->scene.pairs[index], placement_turn_back(&standing->side.at, gap->normal), segment, u);
  keep_sample_at(o, index, gap, segment, u, motion_time(o->scene.motion, segment, u));
  return CPROX_OK;
}

/* The distance without errors becomes what is left of it, along its normal and, for `lower`, along any. */
static cprox_status take_errors(robot_search *o, const placed_robot_pair *p, robot_gap *gap) {
  bound_side side = p->nominal->side;
  gap->loss = p->errors.middle;
  if (gap->upper > 0.0 && vec_norm2(gap->normal) > 0.0) {
    const double without = bound_lowest(&side, gap->normal);
    if (!deviation_losses(&o->scene, p, gap->normal, 0.0, false, &side)) return robot_no_memory(o);
    gap->loss = lesser(without - bound_lowest(&side, gap->normal), gap->loss);
  }
  gap->lower -= p->errors.middle, gap->upper -= gap->loss;
  return CPROX_OK;
}

static cprox_status measure_pair(robot_search *o, const placed_robot_pair *p, robot_accuracy accuracy, robot_gap *gap) {
  accuracy.floor += p->errors.middle;
  const cprox_status status = measure_bodies(o, p->nominal, p->standing, accuracy, gap);
  return status < 0 || !o->scene.q->errors ? status : take_errors(o, p, gap);
}

cprox_status robot_measure(robot_search *o, const placed_robot_pair *p, robot_accuracy accuracy, robot_gap *gap) {
  const cprox_status status = measure_pair(o, p, accuracy, gap);
  if (status < 0) return status;
  robot_keep_normal(o, p, gap);
  if (placed_robot_pair_is_convex(p)) keep_sample(o, p->index, gap);
  return CPROX_OK;
}

robot_refinement robot_refinement_from(robot_search *o, const placed_robot_pair *p, const robot_gap *hulls,
                                       double reach, double room) {
  const double most = fmax(hulls->upper, 0.0) + (p->moving->tree ? 4.0 * p->moving->radius : 0.0) +
                      (p->standing->tree ? 4.0 * p->standing->radius : 0.0);
  return (robot_refinement){.pair = p,
                            .reach = fmin(reach, most + room),
                            .room = room,
                            .goal = &o->goal,
                            .work = o->nodes + robot_work(o),
                            .measured = robot_has_measured(o),
                            .accuracy = ROBOT_GAP_FRACTION * o->goal.epsilon,
                            .normal = hulls->upper > 0.0 ? hulls->normal : vec(0, 0, 0)};
}

/* The nearest elements as they are without errors, and what these leave of their distance. */
static cprox_status keep_nearest_off(robot_search *o, const robot_refinement *c) {
  robot_pair near = *c->pair->pair;
  for (int k = 0; k < 2; k++) near.element[k] = c->nearest.element[k];
  placed_robot_pair p;
  placed_robot_pair_of(&o->scene, &near, &p);
  robot_gap gap;
  const cprox_status status = measure_pair(o, &p, (robot_accuracy){.epsilon = c->accuracy}, &gap);
  if (status >= 0) keep_sample(o, c->pair->index, &gap);
  return status;
}

cprox_status robot_refine_elements(robot_search *o, robot_refinement *c) {
  robot_refinement_run(c);
  o->gaps += c->gaps;
  o->refined = true;
  if (c->support_failed) return refuse_callback(o);
  if (c->no_memory) return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  if (!(c->nearest.gap.upper < INFINITY)) return CPROX_OK;
  if (o->scene.q->errors) return keep_nearest_off(o, c);
  keep_sample(o, c->pair->index, &c->nearest.gap);
  return CPROX_OK;
}

static cprox_status measure_whole(robot_search *o, const placed_robot_pair *p) {
  robot_gap gap;
  /* a verdict is not about what is farther than its limit */
  const bool verdict = o->goal.limit >= 0.0 && o->goal.order != SEARCH_LEFT_TO_RIGHT;
  const double most = verdict ? lesser(o->best_bound.upper, o->goal.limit + o->goal.epsilon) : o->best_bound.upper;
  const double floor = o->goal.is_signed ? robot_pruning_bound(o) : fmax(o->goal.limit, 0.0);
  const bool hulls = verdict && !placed_robot_pair_is_convex(p); /* their elements are what is measured */
  const cprox_status status = robot_measure(o, p,
                                            (robot_accuracy){.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon,
                                                             .floor = hulls ? most : floor,
                                                             .fraction = SEED_FRACTION,
                                                             .depth = o->goal.is_signed,
                                                             .verdict = hulls},
                                            &gap);
  if (status < 0 || placed_robot_pair_is_convex(p) || gap.lower >= most) return status;
  robot_refinement c = robot_refinement_from(o, p, &gap, most, 0.0);
  return robot_refine_elements(o, &c);
}

cprox_status robot_measure_whole(robot_search *o, int32_t index) {
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, index, &p);
  return measure_whole(o, &p);
}

/* ---- near pairs ---- */

/* Through all that entries of lists stand for, the nearest first. */
typedef struct pair_walk {
  robot_pair_visit *visit; /* NULL: the pair that comes closest by balls and boxes is wanted */
  double reach;            /* what is farther in the middle of the node is of no interest; how near that pair is, */
  int32_t nearest;         /* and its number; -1: none is nearer */
  double known;            /* it ends where contact is proven earlier than this */
} pair_walk;

static pair_walk walk_for(const robot_search *o, robot_pair_visit *visit, double reach) {
  return (pair_walk){.visit = visit, .reach = reach, .nearest = -1, .known = o->touch_at};
}

static cprox_status walk_pair(robot_search *o, pair_walk *w, int32_t index) {
  if (w->visit) return w->visit(o, index);
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, index, &p);
  o->balls++;
  if (robot_pair_balls(p.moving, p.standing) >= w->reach) return CPROX_OK;
  const double apart = robot_pair_ball_distance(p.moving, p.standing);
  if (apart < w->reach) w->reach = apart, w->nearest = index;
  return CPROX_OK;
}

cprox_status robot_no_memory(const robot_search *o) {
  return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
}

/* What is to be opened, the nearest on top: nodes of the set's tree, or pairs of groups. */
typedef struct walk_stack {
  size_t count;
  struct walk_place {
    double apart;
    uint32_t under;
    group_pair groups;
  } at[TREE_LANES * TREE_DEEPEST > GROUP_STACK ? TREE_LANES *TREE_DEEPEST : GROUP_STACK];
} walk_stack;

/* Among those from `first` on, where it is near enough. */
static void walk_push(walk_stack *stack, size_t first, const pair_walk *w, struct walk_place place) {
  if (!(place.apart < w->reach)) return;
  size_t i = stack->count++;
  for (; i > first && stack->at[i - 1].apart < place.apart; i--) stack->at[i] = stack->at[i - 1];
  stack->at[i] = place;
}

/* Whether there is one that is still near enough; it becomes *place. */
static bool walk_pop(const robot_search *o, walk_stack *stack, const pair_walk *w, struct walk_place *place) {
  while (stack->count > 0 && o->touch_at == w->known) {
    *place = stack->at[--stack->count];
    if (place->apart < w->reach) return true;
  }
  return false;
}

/* All that is under a node of the set's tree, for one part. */
static cprox_status walk_cluster(robot_search *o, pair_walk *w, const list_entry *entry) {
  const cluster_view view = cluster_see(&o->scene, entry->part, false);
  walk_stack stack;
  struct walk_place top = {.apart = -INFINITY, .under = entry->under};
  cprox_status status = CPROX_OK;
  stack.count = 0;
  walk_push(&stack, 0, w, top);
  while (status >= 0 && walk_pop(o, &stack, w, &top)) {
    cluster_lanes lanes;
    cluster_measure(&view, top.under, INFINITY, &lanes);
    const size_t first = stack.count;
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(lanes.live >> l & 1u) || !(lanes.apart[l] < w->reach)) continue;
      if (!(top.under & TREE_LEAF)) {
        walk_push(&stack, first, w, (struct walk_place){.apart = lanes.apart[l], .under = lanes.under[l]});
        continue;
      }
      size_t count;
      const int32_t pairs = cluster_pairs(&o->scene, entry->part, lanes.under[l], &count);
      if (pairs < 0) return robot_no_memory(o);
      for (size_t k = 0; k < count && status >= 0; k++) status = walk_pair(o, w, pairs + (int32_t)k);
    }
  }
  return status;
}

/* The pairs of two groups; groups with themselves are above all. */
static cprox_status walk_groups(robot_search *o, pair_walk *w, group_pair groups) {
  walk_stack stack;
  struct walk_place top = {.apart = -INFINITY, .groups = groups};
  cprox_status status = CPROX_OK;
  stack.count = 0;
  walk_push(&stack, 0, w, top);
  while (status >= 0 && walk_pop(o, &stack, w, &top)) {
    if (robot_groups_are_parts(&o->scene, top.groups)) {
      const int32_t pair = robot_groups_pair(&o->scene, top.groups);
      if (pair < 0) return robot_no_memory(o);
      status = walk_pair(o, w, pair);
      continue;
    }
    group_pair inside[GROUP_PAIRS_INSIDE];
    const size_t n = robot_groups_open(&o->scene, top.groups, inside), first = stack.count;
    for (size_t k = 0; k < n; k++) {
      const double apart = group_pair_is_one(inside[k]) ? -INFINITY : robot_groups_apart(&o->scene, inside[k]);
      walk_push(&stack, first, w, (struct walk_place){.apart = apart, .groups = inside[k]});
    }
  }
  return status;
}

static cprox_status walk_list(robot_search *o, pair_walk *w, int32_t list) {
  const size_t n = lists_count(&o->lists, list);
  cprox_status status = CPROX_OK;
  for (size_t k = 0; k < n && status >= 0 && o->touch_at == w->known; k++) {
    const list_entry entry = lists_at(&o->lists, list)[k];
    if (!w->visit && entry.lower >= w->reach) continue;
    if (entry.pair >= 0)
      status = walk_pair(o, w, entry.pair);
    else if (entry.pair == LIST_CLUSTER)
      status = walk_cluster(o, w, &entry);
    else
      status = walk_groups(o, w, (group_pair){{entry.part, (int32_t)entry.under}});
  }
  return status;
}

cprox_status robot_seed_here(robot_search *o, int32_t list) {
  double most = o->goal.limit >= 0.0 ? lesser(o->best_bound.upper, o->goal.limit) : o->best_bound.upper;
  if (o->best.pair >= 0) most = lesser(most, o->goal.cutoff); /* one distance is always measured */
  pair_walk walk = walk_for(o, NULL, most);
  const cprox_status status = walk_list(o, &walk, list);
  return status < 0 || walk.nearest < 0 ? status : robot_measure_whole(o, walk.nearest);
}

size_t robot_knot_near(const cprox_motion *m, size_t first, size_t last, size_t step, double t) {
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

size_t robot_knot_step(size_t segments) {
  size_t step = 1;
  while (32 * step <= segments) step *= 2;
  return step;
}

/* How the motion of what is on a list looks over the node at hand. */
static void look_at_list(robot_search *o, int32_t list) {
  const size_t n = lists_count(&o->lists, list);
  for (size_t k = 0; k < n; k++) {
    const list_entry *entry = lists_at(&o->lists, list) + k;
    if (entry->pair >= 0)
      robot_scene_fill_pair(&o->scene, &o->scene.pairs[entry->pair]);
    else
      robot_scene_fill(&o->scene);
  }
}

/* Whether halves of a span are to be looked at: bent ones, and all of several tracks, whose looks cost more than
 * places. Otherwise the scene is in the middle of the span. */
static bool wants_halves(robot_search *o, int32_t list, const motion_interval *over, size_t places) {
  robot_scene *s = &o->scene;
  if (s->motion->n_tracks == 1 || robot_scene_has_two_times(s)) {
    robot_scene_enter_span(s, over);
    look_at_list(o, list);
    return s->centre.bent && places > 1;
  }
  if (places > 1 && motion_is_span(over)) return true;
  const span_centre middle = motion_middle(s->motion, over);
  robot_scene_enter_place(s, middle.segment, middle.u);
  return false;
}

/* In the middle of a span, or of its halves, `places` at most. */
static cprox_status seed_span(robot_search *o, int32_t list, const motion_interval *over, size_t places) {
  if (!wants_halves(o, list, over, places)) return robot_seed_here(o, list);
  const cprox_motion *m = o->scene.motion;
  const double t0 = motion_time(m, over->first, over->a), t1 = motion_time(m, over->last - 1, over->b);
  const size_t knot =
      robot_knot_near(m, over->first, over->last, robot_knot_step(over->last - over->first), 0.5 * (t0 + t1));
  motion_interval half = *over;
  half.last = knot, half.b = 1.0;
  const cprox_status status = seed_span(o, list, &half, places / 2);
  if (status < 0 || robot_is_answered(o) || robot_must_end(o)) return status;
  half = *over;
  half.first = knot, half.a = 0.0;
  return seed_span(o, list, &half, places - places / 2);
}

cprox_status robot_measure_if_near(robot_search *o, int32_t index) {
  if (!robot_pair_is_whole(&o->scene.pairs[index])) return CPROX_OK;
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, index, &p);
  if (robot_pair_balls(p.moving, p.standing) > o->goal.epsilon) return CPROX_OK;
  return robot_pair_ball_distance(p.moving, p.standing) > o->goal.epsilon ? CPROX_OK : measure_whole(o, &p);
}

cprox_status robot_visit_near_groups(robot_search *o, group_pair groups, robot_pair_visit *visit) {
  pair_walk walk = walk_for(o, visit, nextafter(o->goal.epsilon, INFINITY));
  return walk_groups(o, &walk, groups);
}

cprox_status robot_visit_near(robot_search *o, const search_node *node, int32_t list, robot_pair_visit *visit) {
  if (list < 0) return CPROX_OK;
  const robot_node *payload = robot_known(node);
  const bool stands = o->scene.groups && list == o->standing;
  pair_walk walk = walk_for(o, visit, nextafter(o->goal.epsilon, INFINITY));
  robot_scene_enter(&o->scene, payload->first, payload->a, payload->a);
  if (stands) robot_groups_choose(&o->scene, PAIRS_STANDING);
  const cprox_status status = walk_list(o, &walk, list);
  if (stands) robot_groups_choose(&o->scene, PAIRS_MOVING);
  return status;
}

cprox_status robot_seed(robot_search *o, const search_node *node) {
  const motion_interval over = robot_interval(node);
  const int32_t list = robot_known(node)->list;
  if (lists_count(&o->lists, list) == 0) return CPROX_OK;
  if (o->scene.motion->is_state) return seed_span(o, list, &over, 1); /* it is the same everywhere */
  const size_t n =
      lists_count(&o->lists, list) + (o->scene.groups ? GROUP_SEED_TESTS * o->scene.motion->robot->n_parts : 0);
  size_t places = MOST_SEEDS;
  while (places > 1 && places * n > MOST_SEED_TESTS) places /= 2;
  cprox_status status = seed_span(o, list, &over, places);
  for (int end = 0; end < 2 && status >= 0 && !robot_is_answered(o) && !robot_must_end(o); end++) {
    const double u = end == 0 ? over.a : over.b;
    const size_t segment = end == 0 ? over.first : over.last - 1;
    if (robot_scene_has_two_times(&o->scene))
      robot_scene_enter(&o->scene, segment, u, u);
    else
      robot_scene_enter_place(&o->scene, segment, u);
    status = robot_seed_here(o, list);
  }
  return status;
}
