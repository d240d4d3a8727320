/* SPDX-License-Identifier: BSD-3-Clause */
/* A pair of a robot's scene, resolved once on a node: both sides where they are in its middle, and how far they move
 * against each other over it. */
#ifndef CPROX_ROBOT_QUERY_PLACED_ROBOT_PAIR_H
#define CPROX_ROBOT_QUERY_PLACED_ROBOT_PAIR_H

#include "robot_query/robot_scene.h"

typedef struct placed_robot_pair {
  robot_scene *scene;
  robot_pair *pair; /* until one is added to the scene */
  int32_t index;    /* its number there; -1: it is none of the scene's */
  /* Of pairs of elements, only those of one pair at a time. */
  const robot_body *moving, *standing;
  const chain_motion *motion; /* of the moving side as the standing one sees it; NULL: not found yet */
  chain_motion own;
  /* Where the query has errors: how far both sides may be off, by all and by all but joints. The moving side is then
   * `off`, with a margin for the middle of the node; what is added elsewhere in the node counts as if the sides
   * moved. */
  deviation errors, places;
  robot_body off;
  const robot_body *nominal; /* the moving side without errors */
} placed_robot_pair;

/* Places a pair of the scene, or one that is none of its pairs. */
void placed_robot_pair_at(robot_scene *scene, int32_t index, placed_robot_pair *placed);
void placed_robot_pair_of(robot_scene *scene, robot_pair *pair, placed_robot_pair *placed);

/* The motion. */
const chain_motion *placed_robot_pair_move(placed_robot_pair *placed);

/* How far the moving side moves as the standing one sees it; coarse: how far both move together, as the axis above both
 * sees it: quicker; round: the same where a side may turn about its own axis of symmetry, infinity elsewhere. */
double placed_robot_pair_displacement(const placed_robot_pair *placed);
double placed_robot_pair_coarse_displacement(const placed_robot_pair *placed);
double placed_robot_pair_round_displacement(placed_robot_pair *placed);

static inline bool placed_robot_pair_is_convex(const placed_robot_pair *placed) {
  return !placed->moving->tree && !placed->standing->tree;
}

/* The pairs that a pair is opened into: of one side's clusters or elements instead of that side. The first one's number
 * and how many, or -1 where memory is out. It may move all pairs in memory. */
int32_t placed_robot_pair_open(const placed_robot_pair *placed, uint32_t *count);

/* A bound on how far the sides of a pair move towards or away from each other between any two times that are asked
 * about, with the same starts as where it was measured, at these times. */
double placed_robot_pair_travel(robot_scene *scene, int32_t index, double lead, double other);

#endif
