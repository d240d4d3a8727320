/* SPDX-License-Identifier: BSD-3-Clause */
/* What a robot's search measures: distances of pairs in the middle of nodes, and a first one over the motion, and when
 * a pair needs no more work. */
#ifndef CPROX_ROBOT_QUERY_MEASURE_H
#define CPROX_ROBOT_QUERY_MEASURE_H

#include "robot_query/groups.h"
#include "robot_query/oracle.h"

/* A gap is measured to this fraction of the width asked for. */
#define ROBOT_GAP_FRACTION 0.02

/* The lower bound from which on a pair needs no more work, and whether one says that. */
static inline double robot_pruning_bound(const robot_search *o) {
  return search_pruning_bound(&o->goal, o->best_bound.upper);
}

static inline bool robot_is_pruned(const robot_search *o, double lower) {
  return search_is_pruned(&o->goal, o->best_bound.upper, lower);
}

/* Nothing more need be known: what is left on the lists does not matter. */
static inline bool robot_is_answered(const robot_search *o) {
  return search_is_answered(&o->goal, o->best_bound.upper);
}

/* Found where the scene is. */
void robot_place_normal(const robot_search *o, robot_pair *pair, vec3 normal);

void robot_keep_normal(const robot_search *o, const placed_robot_pair *placed, const robot_gap *gap);

/* The distance of the convex sides of a pair; it is that of the pair itself where that has no elements. */
cprox_status robot_measure(robot_search *o, const placed_robot_pair *placed, robot_accuracy accuracy, robot_gap *gap);

/* The same of two convex bodies as they are at u of a segment. The class of starts has one clock. */
cprox_status robot_measure_placed(robot_search *o, int32_t index, const robot_body *moving, const robot_body *standing,
                                  robot_accuracy accuracy, size_t segment, double u, robot_gap *gap);

/* Sets out from what is known of the hulls. No element is farther from the other side than the hulls' distance and
 * their sizes. */
robot_refinement robot_refinement_from(robot_search *o, const placed_robot_pair *placed, const robot_gap *hulls,
                                       double reach, double room);

cprox_status robot_refine_elements(robot_search *o, robot_refinement *c);

/* The distance of a pair, elements and all, as far as it can be less than the best. */
cprox_status robot_measure_whole(robot_search *o, int32_t index);

/* Measures a pair that is near enough to touch where the scene is. */
cprox_status robot_measure_if_near(robot_search *o, int32_t index);

/* Something done with a pair. CPROX_OK, or a negative status. */
typedef cprox_status robot_pair_visit(robot_search *o, int32_t index);

/* Visits pairs of two groups that may touch where the scene is, until contact is proven. */
cprox_status robot_visit_near_groups(robot_search *o, group_pair groups, robot_pair_visit *visit);

/* The same of the pairs of a list, where a node begins: the node's own, or those that stand still against each other
 * (-1: there are none). */
cprox_status robot_visit_near(robot_search *o, const search_node *node, int32_t list, robot_pair_visit *visit);

/* The distance of a pair is 0: the point, of the world, is in both where the scene is. */
void robot_keep_common(robot_search *o, int32_t index, vec3 point);

/* The knot inside the span, a multiple of `step` where there is one, that is nearest to a time. */
size_t robot_knot_near(const cprox_motion *m, size_t first, size_t last, size_t step, double t);

/* Blocks of the motion's tree are aligned: spans that begin and end at multiples of this are made of few of them. */
size_t robot_knot_step(size_t segments);

/* Measures the pair of a list whose balls and boxes come closest where the scene is. */
cprox_status robot_seed_here(robot_search *o, int32_t list);

/* A few places, so that the search begins with a distance. */
cprox_status robot_seed(robot_search *o, const search_node *node);

cprox_status robot_no_memory(const robot_search *o);

#endif
