/* SPDX-License-Identifier: BSD-3-Clause */
/* From the hulls of a pair down to the elements that they are made of, in the middle of the node. doc/robot-search.md,
 * Meshes */
#ifndef CPROX_ROBOT_QUERY_REFINE_H
#define CPROX_ROBOT_QUERY_REFINE_H

#include "branch_and_bound/search.h"
#include "robot_query/placed_robot_pair.h"

/* Two elements (-1: the side is convex) that are near each other. */
typedef struct robot_found {
  int32_t element[2];
  robot_gap gap;
} robot_found;

typedef struct robot_refinement {
  const placed_robot_pair *pair; /* of whole sides, of which one at least is made of elements */
  double reach;      /* pairs of elements that are farther are of no interest; finite. It falls to the nearest one's
                        distance, */
  double room;       /* and this more */
  double accuracy;   /* distances are measured so well */
  vec3 normal;       /* world, from the standing hull to the moving one; (0,0,0) where they are not apart */
  bool listing;      /* what is found is wanted, not the nearest alone */
  search_goal *goal; /* of the search that it is part of, which may have to end within it; NULL: of none, */
  uint64_t work;     /* what was done before, nodes included, */
  bool measured;     /* and whether that measured a distance */

  /* what was found */
  robot_found *found; /* in the workspace */
  size_t n_found;
  robot_found nearest; /* its gap's upper is infinite where there is none */
  double rest;   /* in the middle of the node every pair of elements that was not found is at least so far apart; not
                    listing, every pair */
  bool complete; /* false: it was given up, and knows nothing of the rest */
  bool support_failed, no_memory;
  double least; /* bound of those that were found */
  uint32_t gaps;
  vec3 last[2]; /* world: the normal found last of an element and a hull, and of two elements; (0,0,0): none */
} robot_refinement;

void robot_refinement_run(robot_refinement *refinement);

#endif
