/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a robot along a motion: nodes are segments of the motion, each with the list of pairs that could still
 * matter. doc/robot-motion-bounds.md derives its bounds. */
#ifndef CPROX_ROBOT_QUERY_ORACLE_H
#define CPROX_ROBOT_QUERY_ORACLE_H

#include "branch_and_bound/search.h"
#include "robot_query/pair_lists.h"
#include "robot_query/refine.h"
#include "robot_query/robot_scene.h"

/* The payload of a node: from u = a of segment `first` to u = b of segment last - 1, the same of another clock that the
 * class of starts may have, and the list of its pairs. */
typedef struct robot_node {
  double a, b;
  double other_a, other_b;
  uint32_t first, last;
  uint32_t other_first, other_last;
  int32_t list;
} robot_node;

static inline const robot_node *robot_known(const search_node *node) {
  _Static_assert(sizeof(robot_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const robot_node *)node->payload.bytes;
}

static inline robot_node *robot_own(search_node *node) {
  return (robot_node *)node->payload.bytes;
}

static inline motion_interval robot_interval(const search_node *node) {
  const robot_node *payload = robot_known(node);
  return (motion_interval){.a = payload->a, .b = payload->b, .first = payload->first, .last = payload->last};
}

static inline motion_interval robot_other_interval(const search_node *node) {
  const robot_node *payload = robot_known(node);
  return (motion_interval){
      .a = payload->other_a, .b = payload->other_b, .first = payload->other_first, .last = payload->other_last};
}

/* Where the least distance was measured. */
typedef struct robot_sample {
  robot_gap gap;
  int32_t pair; /* -1: nothing was measured */
  size_t segment;
  double u;
  double other; /* [s] the time of the other clock, if there is one */
} robot_sample;

typedef struct robot_search {
  robot_scene scene;
  robot_lists lists;
  search_goal goal;

  /* what is known */
  robot_sample best;
  search_best best_bound;
  double dropped;     /* the least lower bound of pairs that were dropped from a list */
  robot_sample touch; /* left to right: the earliest place where contact is proven */
  double touch_at;
  int32_t standing;  /* the list of pairs whose sides stand still against each other; -1: none, or they are settled */
  size_t n_standing; /* so many of the scene's pairs were on it */
  bool seeded;
  bool looked_inside;    /* of solid meshes, where the motion begins; */
  bool unsure;           /* something touches one there, and may be inside */
  uint32_t gaps, planes; /* distances measured, plane bounds asked for, */
  uint32_t balls;        /* and pairs held against each other by their balls and boxes */
  uint32_t nodes;        /* looked at, */
  uint32_t flights;      /* and more intervals inside them, for one pair */
  uint32_t work;         /* all this as the engine counts it, the nodes apart */
  bool refined;          /* elements of meshes were looked at */
  double pieces;         /* into so many the node at hand is best cut, */
  bool cut_other;        /* of two times: the other clock's interval */
  list_entry *next;      /* what the node at hand keeps, in the workspace */
  size_t n_next;
  bool cut; /* it will be cut whatever is measured */
} robot_search;

/* Intervals that are shorter are measured even where a part moves farther than its own size. */
#define ROBOT_SHORT_INTERVAL 0x1p-8

/* Whether a node is so short that everything is measured. Of a posture parts are no shorter. */
static inline bool robot_is_short(const robot_search *o, const search_node *node) {
  if (o->scene.motion->is_state) return true;
  const motion_interval over = robot_interval(node), other = robot_other_interval(node);
  return !motion_is_span(&over) && !(over.b - over.a > ROBOT_SHORT_INTERVAL) && !motion_is_span(&other) &&
         !(other.b - other.a > ROBOT_SHORT_INTERVAL);
}

/* The unit of work is a distance query. A test of a plane over an interval costs about as much, and so do several of
 * balls and boxes. */
static inline uint64_t robot_work(const robot_search *o) {
  enum { BALLS_A_UNIT = 16 };
  return (uint64_t)o->gaps + o->planes + o->flights + o->balls / BALLS_A_UNIT;
}

/* Whether one distance was measured, as always is before a search ends. Of meshes that are farther apart than the limit
 * of a verdict there is none to be had: then that of their hulls is enough. */
static inline bool robot_has_measured(const robot_search *o) {
  return o->best.pair >= 0 || (o->goal.limit >= 0.0 && o->gaps > 0);
}

/* Whether the search must end within the node at hand. */
static inline bool robot_must_end(robot_search *o) {
  return robot_has_measured(o) && search_must_end(&o->goal, o->nodes + robot_work(o));
}

/* The scene must have begun. */
void robot_search_begin(robot_search *o, const search_goal *goal);

/* The node of all that is asked about. False where memory is out. */
bool robot_search_root(robot_search *o, const motion_interval *over, const motion_interval *other, search_node *root);

search_oracle robot_search_oracle(robot_search *o);

/* After a search from left to right: contact that is nearer than epsilon, but proven only later if at all, becomes
 * proven a little farther along, up to the time `end`, if a few measurements of its pair succeed. CPROX_OK, or a
 * negative status. */
cprox_status robot_search_prove(robot_search *o, double end);

#endif
