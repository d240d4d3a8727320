/* SPDX-License-Identifier: BSD-3-Clause */
/* The obstacles of a set, nearest box to the mover's curve first. */
#ifndef CPROX_BROADPHASE_OBSTACLE_SET_H
#define CPROX_BROADPHASE_OBSTACLE_SET_H

#include "bvh/bvh.h"
#include "curve_proximity/cprox/query.h"
#include "problem/candidates.h"

typedef struct obstacle_bvh {
  const cprox_obstacle *obstacles; /* not owned */
  size_t n;
  tree *boxes;         /* round the obstacles, margin included; NULL where none has bounds */
  vec3 *low, *high;    /* of the elements of the tree, about the centre */
  uint32_t *of_box;    /* whose box that is */
  uint32_t *unbounded; /* obstacles without a box */
  size_t n_boxes, n_unbounded;
  vec3 centre;
  bool has_clock, has_elements, has_fields, has_curves; /* what not every mover goes with */
  bool has_solids;                                      /* meshes with an inside */
} obstacle_bvh;

/* The BVH over the boxes of n obstacles, which were checked and must outlive it. */
cprox_status obstacle_bvh_create(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace,
                                 obstacle_bvh **set);
void obstacle_bvh_free(obstacle_bvh *set);

/* A node, a pack, or an obstacle. */
typedef struct set_entry {
  double lower;
  uint32_t at;
  enum { SET_NODE, SET_BOX, SET_TARGET } is;
} set_entry;

typedef struct set_traversal {
  const obstacle_bvh *set;
  const query *q;
  tree_segment segment;
  double offset, slack;
  size_t unbounded; /* how many of those were given out */
  size_t count;     /* of the heap in the workspace */
} set_traversal;

/* False where memory is out, here as there. q has been asked about its whole curve. */
bool traversal_begin(set_traversal *w, const obstacle_bvh *set, const query *q);

/* The next obstacle, if its lower bound is at most `most`; else *obstacle is UINT32_MAX and *lower a bound of all that
 * are left. */
bool traversal_next(set_traversal *w, double most, uint32_t *obstacle, double *lower);

#endif
