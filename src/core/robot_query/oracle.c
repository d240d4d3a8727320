/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/oracle.h"

#include <math.h>

#include "broadphase/obstacle_set.h"
#include "robot_query/bound_node.h"
#include "robot_query/groups.h"
#include "robot_query/inside.h"
#include "robot_query/measure.h"
#include "robot_query/settle_flight.h"

#define SHORTEST_INTERVAL 0x1p-46

/* ---- nodes ---- */

/* A part of the parent: of the lead's interval, or of that of the other clock. */
static search_node node_of(const robot_search *o, const search_node *parent, const motion_interval *over,
                           const motion_interval *other) {
  search_node node = *parent;
  robot_node *to = robot_own(&node);
  to->a = over->a, to->first = (uint32_t)over->first;
  to->b = over->b, to->last = (uint32_t)over->last;
  to->other_a = other->a, to->other_first = (uint32_t)other->first;
  to->other_b = other->b, to->other_last = (uint32_t)other->last;
  const double from = motion_time_below(o->scene.motion, over->first, over->a);
  node.start = robot_scene_clock(&o->scene, from, motion_time(o->scene.motion, other->first, other->a));
  return node;
}

bool robot_search_root(robot_search *o, const motion_interval *over, const motion_interval *other, search_node *root) {
  *root = (search_node){.lower = -INFINITY};
  *root = node_of(o, root, over, other);
  robot_scene *s = &o->scene;
  const obstacle_bvh *set = s->q->set;
  const size_t n_pairs = s->n_pairs, n_parts = set && set->boxes ? s->motion->robot->n_parts : 0;
  const size_t room = n_pairs + n_parts + 1;

  /* what stands is settled once; but where others as near as the nearest are looked for, or errors take off, with
   * nodes */
  const bool together = s->motion->is_state || o->goal.beyond > 0.0 || s->q->errors;
  lists_begin(&o->lists, s->q->workspace);
  int32_t list[2]; /* of what moves; of what stands */
  for (int k = 0; k < (together ? 1 : 2); k++) list[k] = lists_take(&o->lists, room);
  if (together) list[1] = list[0];
  const int32_t moving = list[0], standing = list[1];
  if (moving < 0 || standing < 0) return false;
  const pair_choice choice = together ? PAIRS_ALL : s->q->choice;
  size_t n[2] = {0, 0};
  o->n_standing = 0;
  for (size_t i = 0; i < n_pairs; i++) {
    const bool stands = !together && robot_scene_stands(s, &s->pairs[i]);
    o->n_standing += stands;
    lists_add(&o->lists, list, n, stands, (list_entry){.lower = s->plan.pairs[i].apart, .pair = (int32_t)i});
  }
  for (size_t i = 0; i < n_parts; i++)
    if (start_class_has(s->motion, s->starts, (int32_t)i, -1))
      lists_add(&o->lists, list, n, s->parts[i].carrier < 0 && !together,
                (list_entry){.lower = -INFINITY, .pair = LIST_CLUSTER, .part = (int32_t)i});
  for (int still = !together; s->groups && still >= 0; still--) { /* all parts with all; those that move stay chosen */
    robot_groups_choose(s, together ? PAIRS_ALL : still ? PAIRS_STANDING : PAIRS_MOVING);
    if (robot_groups_ask(s, (group_pair){{0, 0}}))
      lists_add(&o->lists, list, n, still, (list_entry){.lower = -INFINITY, .pair = LIST_GROUPS});
  }
  lists_set_count(&o->lists, moving, choice == PAIRS_STANDING ? 0 : n[0]);
  robot_own(root)->list = moving;
  if (!together && (n[1] == 0 || choice == PAIRS_MOVING)) {
    lists_release(&o->lists, standing);
  } else if (!together) {
    lists_set_count(&o->lists, standing, n[1]);
    o->standing = standing;
  }
  return true;
}

/* ---- the oracle ---- */

static double filter(void *self, search_node *node, double goal) {
  (void)self, (void)goal;
  return node->lower;
}

/* Another search of those that share a bound has one already. */
static bool others_seeded(const robot_search *o) {
  return o->goal.share && isfinite(o->goal.cutoff);
}

/* Of a node that nobody looks into it is not known how it is best cut: in two. */
static void begin_node(robot_search *o) {
  o->pieces = 2.0;
  o->cut_other = o->cut = false;
}

/* What stands, unless more need not be known. */
static cprox_status settle(robot_search *o, const search_node *node) {
  const bool known = robot_is_answered(o) || o->touch_at <= node->start;
  return known ? CPROX_OK : robot_settle_standing(o, node);
}

static cprox_status look_at(robot_search *o, search_node *node) {
  bool served = false;
  o->nodes++;
  begin_node(o);
  cprox_status status = robot_look_inside(o, node);
  /* from left to right and before a flight at once, else as soon as something is known of what moves */
  const bool at_once = o->goal.order == SEARCH_LEFT_TO_RIGHT || o->scene.n_pairs - o->n_standing == 1;
  if (status >= 0 && at_once) status = settle(o, node);
  const bool known = robot_is_answered(o) || o->touch_at <= node->start;
  if (status >= 0 && !known) status = robot_bound_flight(o, node, &served);
  if (status < 0 || known || served) return status;
  if (!o->seeded) {
    o->seeded = true;
    /* contact at the beginning answers at once; halves of halves would only close in on it */
    if (o->goal.order == SEARCH_LEFT_TO_RIGHT)
      status = robot_visit_near(o, node, robot_known(node)->list, robot_measure_if_near);
    if (status >= 0 && !isfinite(o->touch_at) && !others_seeded(o)) status = robot_seed(o, node);
    if (status >= 0) status = settle(o, node);
  }
  const bool begins_in_contact = o->touch_at <= node->start;
  return status == CPROX_OK && !robot_is_answered(o) && !begins_in_contact ? robot_bound_node(o, node) : status;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  robot_search *o = self;
  const cprox_status status = look_at(o, node);
  *best = o->best_bound;
  o->work = (uint32_t)robot_work(o);
  return status;
}

/* At knots, into pieces that take about the same time: as many as are wanted, or where the span is bent as many as can
 * be. */
static int split_span(const robot_search *o, const motion_interval *over, bool bent, motion_interval *piece) {
  const cprox_motion *m = o->scene.motion;
  const size_t segments = over->last - over->first;
  const size_t wanted = bent || o->pieces > SEARCH_MAX_CHILDREN ? SEARCH_MAX_CHILDREN : (size_t)ceil(o->pieces);
  const double t0 = motion_time(m, over->first, over->a), t1 = motion_time(m, over->last - 1, over->b);
  const size_t step = robot_knot_step(2 * segments / wanted);
  size_t from = over->first;
  int n = 0;
  for (size_t k = 1; k <= wanted && from < over->last; k++) {
    size_t to = over->last;
    if (segments <= wanted)
      to = from + 1;
    else if (k < wanted)
      to = robot_knot_near(m, over->first, over->last, step, t0 + (t1 - t0) * (double)k / (double)wanted);
    if (to <= from) continue;
    piece[n++] = (motion_interval){
        .a = from == over->first ? over->a : 0.0, .b = to == over->last ? over->b : 1.0, .first = from, .last = to};
    from = to;
  }
  return n;
}

static int split_segment(const robot_search *o, const motion_interval *over, motion_interval *piece) {
  const double a = over->a, b = over->b;
  if (!(b - a > SHORTEST_INTERVAL)) return 0;
  const int n = o->pieces < 2.0 ? 2 : o->pieces > SEARCH_MAX_CHILDREN ? SEARCH_MAX_CHILDREN : (int)ceil(o->pieces);
  for (int k = 0; k < n; k++) {
    piece[k] = *over;
    piece[k].a = k == 0 ? a : piece[k - 1].b;
    piece[k].b = k + 1 == n ? b : a + (b - a) * (k + 1) / n;
  }
  return n;
}

static int split_interval(const robot_search *o, const motion_interval *over, bool bent, motion_interval *piece) {
  return motion_is_span(over) ? split_span(o, over, bent, piece) : split_segment(o, over, piece);
}

static int split(void *self, search_node *node, search_node *child) {
  robot_search *o = self;
  const robot_scene *s = &o->scene;
  const bool two = robot_scene_has_two_times(s);
  const motion_interval over = robot_interval(node), other = robot_other_interval(node);
  motion_interval piece[SEARCH_MAX_CHILDREN];
  bool cut_other = two && o->cut_other;
  int pieces = 0;
  if (s->motion->is_state) return 0; /* it is the same everywhere */
  for (int tries = 0; tries < (two ? 2 : 1) && pieces == 0; tries++) {
    if (tries > 0) cut_other = !cut_other;
    pieces = cut_other ? split_interval(o, &other, s->other_centre.bent, piece)
                       : split_interval(o, &over, s->centre.bent, piece);
  }
  int n = 0;
  for (int k = 0; k < pieces; k++) {
    motion_interval lead = cut_other ? over : piece[k], late = cut_other ? piece[k] : other;
    if (two && !robot_scene_fit(s, &lead, &late)) continue;
    child[n++] = node_of(o, node, &lead, two ? &late : &lead);
  }
  for (int k = 1; k < n; k++) lists_share(&o->lists, robot_known(node)->list);
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
  o->dropped = o->scene.plan.beyond, o->touch_at = INFINITY;
  o->standing = -1;
  o->n_standing = 0;
  o->seeded = o->refined = o->looked_inside = o->unsure = false;
  o->gaps = o->planes = o->balls = o->nodes = o->flights = o->work = 0;
  o->next = NULL, o->n_next = 0;
  begin_node(o);
}
search_oracle robot_search_oracle(robot_search *o) {
  return (search_oracle){
      .self = o, .work = &o->work, .filter = filter, .probe = probe, .split = split, .release = release};
}
