/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/oracle.h"

#include <math.h>

#include "broadphase/obstacle_set.h"
#include "robot_query/bound_node.h"
#include "robot_query/measure.h"

#define SHORTEST_INTERVAL 0x1p-46

/* ---- nodes ---- */

static search_node node_of(const robot_search *o, const search_node *parent, size_t first, double a, size_t last,
                           double b) {
  search_node node = *parent;
  robot_node *to = robot_own(&node);
  to->a = a, to->first = (uint32_t)first;
  to->b = b, to->last = (uint32_t)last;
  node.start = motion_time_below(o->scene.motion, first, a);
  return node;
}

bool robot_search_root(robot_search *o, const motion_interval *over, search_node *root) {
  *root = (search_node){.lower = -INFINITY};
  const obstacle_bvh *set = o->scene.q->set;
  const size_t n_pairs = o->scene.n_pairs, n_parts = set && set->boxes ? o->scene.motion->robot->n_parts : 0;
  const int32_t slot = lists_take(&o->lists, n_pairs + n_parts + 1);
  if (slot < 0) return false;
  robot_own(root)->list = slot;
  list_entry *entry = lists_at(&o->lists, slot);
  for (size_t i = 0; i < n_pairs; i++)
    entry[i] = (list_entry){.lower = robot_scene_apart(&o->scene, &o->scene.pairs[i]), .pair = (int32_t)i};
  size_t n = n_pairs;
  for (size_t i = 0; i < n_parts; i++)
    if (robot_scene_asks(&o->scene, i))
      entry[n++] = (list_entry){.lower = -INFINITY, .pair = LIST_CLUSTER, .part = (int32_t)i};
  if (o->scene.groups) entry[n++] = (list_entry){.lower = -INFINITY, .pair = LIST_GROUPS}; /* all parts with all */
  lists_set_count(&o->lists, slot, n);
  *root = node_of(o, root, over->first, over->a, over->last, over->b);
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

static cprox_status probe(void *self, search_node *node, search_best *best) {
  robot_search *o = self;
  cprox_status status = CPROX_OK;
  if (!o->seeded) {
    o->seeded = true;
    if (o->goal.order == SEARCH_LEFT_TO_RIGHT) status = robot_measure_start(o, node);
    if (status >= 0 && !isfinite(o->touch_at) && !others_seeded(o)) status = robot_seed(o, node);
  }
  const bool begins_in_contact = o->touch_at <= node->start;
  if (status == CPROX_OK && !robot_is_answered(o) && !begins_in_contact) status = robot_bound_node(o, node);
  *best = o->best_bound;
  return status;
}

/* At knots, into pieces that take about the same time: as many as are wanted, or where the span is bent as many as can
 * be. */
static int split_span(const robot_search *o, const search_node *node, search_node *child) {
  const cprox_motion *m = o->scene.motion;
  const motion_interval over = robot_interval(node);
  const size_t segments = over.last - over.first;
  const size_t wanted =
      o->scene.centre.bent || o->pieces > SEARCH_MAX_CHILDREN ? SEARCH_MAX_CHILDREN : (size_t)ceil(o->pieces);
  const double t0 = motion_time(m, over.first, over.a), t1 = motion_time(m, over.last - 1, over.b);
  const size_t step = robot_knot_step(2 * segments / wanted);
  size_t from = over.first;
  int n = 0;
  for (size_t k = 1; k <= wanted && from < over.last; k++) {
    size_t to = over.last;
    if (segments <= wanted)
      to = from + 1;
    else if (k < wanted)
      to = robot_knot_near(m, over.first, over.last, step, t0 + (t1 - t0) * (double)k / (double)wanted);
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
  o->dropped = o->scene.beyond, o->touch_at = INFINITY;
  o->seeded = o->refined = false;
  o->gaps = o->planes = 0;
  lists_begin(&o->lists, o->scene.q->workspace);
}
search_oracle robot_search_oracle(robot_search *o) {
  return (search_oracle){.self = o, .filter = filter, .probe = probe, .split = split, .release = release};
}
