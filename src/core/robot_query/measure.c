/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/measure.h"

#include <math.h>

#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/cull.h"

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

void robot_keep_normal(const robot_search *o, robot_pair *pair, const robot_body *standing, const robot_gap *gap) {
  if (vec_norm2(gap->normal) > 0.0) robot_place_normal(o, pair, placement_turn_back(&standing->side.at, gap->normal));
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

cprox_status robot_measure(robot_search *o, int32_t index, robot_accuracy accuracy, robot_gap *gap) {
  robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  const cprox_status status = measure_bodies(o, moving, standing, accuracy, gap);
  if (status < 0) return status;
  robot_keep_normal(o, pair, standing, gap);
  if (robot_is_convex(moving, standing)) keep_sample(o, index, gap);
  return CPROX_OK;
}

robot_refinement robot_refinement_from(robot_search *o, int32_t index, const robot_gap *hulls, double reach,
                                       double room) {
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  const double most = fmax(hulls->upper, 0.0) + (moving->tree ? 4.0 * moving->radius : 0.0) +
                      (standing->tree ? 4.0 * standing->radius : 0.0);
  return (robot_refinement){.scene = &o->scene,
                            .pair = index,
                            .reach = fmin(reach, most + room),
                            .room = room,
                            .goal = &o->goal,
                            .work = o->nodes + robot_work(o),
                            .measured = robot_has_measured(o),
                            .accuracy = ROBOT_GAP_FRACTION * o->goal.epsilon,
                            .normal = hulls->upper > 0.0 ? hulls->normal : vec(0, 0, 0)};
}

cprox_status robot_refine_elements(robot_search *o, robot_refinement *c) {
  robot_refinement_run(c);
  o->gaps += c->gaps;
  o->refined = true;
  if (c->support_failed) return refuse_callback(o);
  if (c->no_memory) return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  if (c->nearest.gap.upper < INFINITY) keep_sample(o, c->pair, &c->nearest.gap);
  return CPROX_OK;
}

cprox_status robot_measure_whole(robot_search *o, int32_t index) {
  robot_gap gap;
  const double floor = o->goal.is_signed ? robot_pruning_bound(o) : fmax(o->goal.limit, 0.0);
  const cprox_status status = robot_measure(o, index,
                                            (robot_accuracy){.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon,
                                                             .floor = floor,
                                                             .fraction = SEED_FRACTION,
                                                             .depth = o->goal.is_signed},
                                            &gap);
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  /* a verdict is not about what is farther than its limit */
  const bool verdict = o->goal.limit >= 0.0 && o->goal.order != SEARCH_LEFT_TO_RIGHT;
  const double most = verdict ? lesser(o->best_bound.upper, o->goal.limit + o->goal.epsilon) : o->best_bound.upper;
  if (status < 0 || robot_is_convex(moving, standing) || gap.lower >= most) return status;
  robot_refinement c = robot_refinement_from(o, index, &gap, most, 0.0);
  return robot_refine_elements(o, &c);
}

/* The pair that comes closest by balls and boxes. */
typedef struct nearest_pair {
  double apart;
  int32_t pair; /* -1: none is nearer */
} nearest_pair;

static void try_pair(robot_search *o, int32_t index, nearest_pair *nearest) {
  const robot_pair *pair = &o->scene.pairs[index];
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  o->balls++;
  if (robot_pair_balls(moving, standing) >= nearest->apart) return;
  const double apart = robot_pair_ball_distance(moving, standing);
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

cprox_status robot_no_memory(const robot_search *o) {
  return workspace_fail(o->scene.q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
}

/* The same of all that is under a node of the set's tree. */
static cprox_status try_cluster(robot_search *o, const list_entry *entry, nearest_pair *nearest) {
  const cluster_view view = cluster_see(&o->scene, entry->part, false);
  cluster_stack stack = {.at = {entry->under}, .apart = {-INFINITY}, .count = 1};
  while (stack.count > 0) {
    const uint32_t at = stack.at[--stack.count];
    if (stack.apart[stack.count] >= nearest->apart) continue;
    cluster_lanes lanes;
    cluster_measure(&view, at, INFINITY, &lanes);
    if (!(at & TREE_LEAF)) push_nearest_last(&stack, &lanes, nearest->apart);
    for (uint32_t l = 0; (at & TREE_LEAF) && l < TREE_LANES; l++) {
      if (!(lanes.live >> l & 1u) || !(lanes.apart[l] < nearest->apart)) continue;
      size_t count;
      const int32_t pairs = cluster_pairs(&o->scene, entry->part, lanes.under[l], &count);
      if (pairs < 0) return robot_no_memory(o);
      for (size_t k = 0; k < count; k++) try_pair(o, pairs + (int32_t)k, nearest);
    }
  }
  return CPROX_OK;
}

/* What two groups consist of, of what is nearer than `most`; the nearest on top, groups with themselves above all. */
typedef struct group_stack {
  group_pair at[GROUP_STACK];
  double apart[GROUP_STACK];
  size_t count;
} group_stack;

static void begin_groups(group_stack *stack, group_pair groups) {
  stack->at[0] = groups, stack->apart[0] = -INFINITY;
  stack->count = 1;
}

static void push_groups_inside(robot_search *o, group_stack *stack, group_pair groups, double most) {
  group_pair inside[GROUP_PAIRS_INSIDE];
  const size_t n = robot_groups_open(&o->scene, groups, inside), first = stack->count;
  for (size_t k = 0; k < n; k++) {
    const double apart = group_pair_is_one(inside[k]) ? -INFINITY : robot_groups_apart(&o->scene, inside[k]);
    if (!(apart < most)) continue;
    size_t i = stack->count++;
    for (; i > first && stack->apart[i - 1] < apart; i--)
      stack->apart[i] = stack->apart[i - 1], stack->at[i] = stack->at[i - 1];
    stack->apart[i] = apart, stack->at[i] = inside[k];
  }
}

/* The pair that comes closest of those of two groups. */
static cprox_status try_groups(robot_search *o, const list_entry *entry, nearest_pair *nearest) {
  group_stack stack;
  begin_groups(&stack, (group_pair){{entry->part, (int32_t)entry->under}});
  while (stack.count > 0) {
    const group_pair groups = stack.at[--stack.count];
    if (stack.apart[stack.count] >= nearest->apart) continue;
    if (robot_groups_are_parts(&o->scene, groups)) {
      const int32_t pair = robot_groups_pair(&o->scene, groups);
      if (pair < 0) return robot_no_memory(o);
      try_pair(o, pair, nearest);
    } else {
      push_groups_inside(o, &stack, groups, nearest->apart);
    }
  }
  return CPROX_OK;
}

cprox_status robot_seed_here(robot_search *o, int32_t list) {
  double most = o->goal.limit >= 0.0 ? lesser(o->best_bound.upper, o->goal.limit) : o->best_bound.upper;
  if (o->best.pair >= 0) most = lesser(most, o->goal.cutoff); /* one distance is always measured */
  const size_t n = lists_count(&o->lists, list);
  nearest_pair nearest = {.apart = most, .pair = -1};
  for (size_t k = 0; k < n; k++) {
    const list_entry entry = lists_at(&o->lists, list)[k];
    cprox_status status = CPROX_OK;
    if (entry.lower >= nearest.apart) continue;
    if (entry.pair >= 0)
      try_pair(o, entry.pair, &nearest);
    else
      status = entry.pair == LIST_CLUSTER ? try_cluster(o, &entry, &nearest) : try_groups(o, &entry, &nearest);
    if (status < 0) return status;
  }
  return nearest.pair < 0 ? CPROX_OK : robot_measure_whole(o, nearest.pair);
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
  const robot_pair *pair = &o->scene.pairs[index];
  if (pair->element[0] != ROBOT_WHOLE || pair->element[1] != ROBOT_WHOLE) return CPROX_OK;
  const robot_body *moving = robot_scene_moving(&o->scene, pair), *standing = robot_scene_standing(&o->scene, pair);
  if (robot_pair_balls(moving, standing) > o->goal.epsilon) return CPROX_OK;
  return robot_pair_ball_distance(moving, standing) > o->goal.epsilon ? CPROX_OK : robot_measure_whole(o, index);
}

/* Pairs under a node of the set's tree that may touch, until contact is proven. */
static cprox_status visit_near_cluster(robot_search *o, const list_entry *entry, robot_pair_visit *visit) {
  const cluster_view view = cluster_see(&o->scene, entry->part, false);
  const double known = o->touch_at;
  cluster_stack stack = {.at = {entry->under}, .apart = {-INFINITY}, .count = 1};
  cprox_status status = CPROX_OK;
  while (stack.count > 0 && status >= 0 && o->touch_at == known) {
    const uint32_t at = stack.at[--stack.count];
    const double near = nextafter(o->goal.epsilon, INFINITY);
    cluster_lanes lanes;
    cluster_measure(&view, at, INFINITY, &lanes);
    if (!(at & TREE_LEAF)) push_nearest_last(&stack, &lanes, near);
    for (uint32_t l = 0; (at & TREE_LEAF) && l < TREE_LANES; l++) {
      if (!(lanes.live >> l & 1u) || !(lanes.apart[l] < near)) continue;
      size_t count;
      const int32_t pairs = cluster_pairs(&o->scene, entry->part, lanes.under[l], &count);
      if (pairs < 0) return robot_no_memory(o);
      for (size_t k = 0; k < count && status >= 0; k++) status = visit(o, pairs + (int32_t)k);
    }
  }
  return status;
}

cprox_status robot_visit_near_groups(robot_search *o, group_pair groups, robot_pair_visit *visit) {
  const double known = o->touch_at, near = nextafter(o->goal.epsilon, INFINITY);
  group_stack stack;
  begin_groups(&stack, groups);
  cprox_status status = CPROX_OK;
  while (stack.count > 0 && status >= 0 && o->touch_at == known) {
    const group_pair top = stack.at[--stack.count];
    if (!robot_groups_are_parts(&o->scene, top)) {
      push_groups_inside(o, &stack, top, near);
      continue;
    }
    const int32_t pair = robot_groups_pair(&o->scene, top);
    if (pair < 0) return robot_no_memory(o);
    status = visit(o, pair);
  }
  return status;
}

static cprox_status visit_near_list(robot_search *o, int32_t list, robot_pair_visit *visit) {
  const double known = o->touch_at;
  const size_t n = lists_count(&o->lists, list);
  cprox_status status = CPROX_OK;
  for (size_t k = 0; k < n && status >= 0 && o->touch_at == known; k++) {
    const list_entry entry = lists_at(&o->lists, list)[k];
    if (entry.pair >= 0)
      status = visit(o, entry.pair);
    else if (entry.pair == LIST_CLUSTER)
      status = visit_near_cluster(o, &entry, visit);
    else
      status = robot_visit_near_groups(o, (group_pair){{entry.part, (int32_t)entry.under}}, visit);
  }
  return status;
}

cprox_status robot_visit_near(robot_search *o, const search_node *node, robot_pair_visit *visit) {
  const robot_node *payload = robot_known(node);
  robot_scene_enter(&o->scene, payload->first, payload->a, payload->a);
  return visit_near_list(o, payload->list, visit);
}

cprox_status robot_visit_near_standing(robot_search *o, const search_node *root, robot_pair_visit *visit) {
  if (o->standing < 0) return CPROX_OK;
  const robot_node *payload = robot_known(root);
  robot_scene_enter(&o->scene, payload->first, payload->a, payload->a);
  if (o->scene.groups) robot_groups_choose(&o->scene, PAIRS_STANDING);
  const cprox_status status = visit_near_list(o, o->standing, visit);
  if (o->scene.groups) robot_groups_choose(&o->scene, PAIRS_MOVING);
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
