/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball that rides a curve against a mesh, points or boxes: many elements in a tree, of which each
 * interval keeps those that still matter to it. For searches that are depth first or left to right. doc/non-convex.md
 * derives it. */
#ifndef CPROX_CURVE_QUERY_CURVE_BVH_H
#define CPROX_CURVE_QUERY_CURVE_BVH_H

#include "branch_and_bound/search.h"
#include "bvh/bvh.h"
#include "curve/curve_side.h"
#include "shape/body.h"

/* The payload of a node, and how to get at it. */
typedef struct curve_tree_node {
  curve_interval at;
  uint32_t list, list_end; /* the lanes that still matter to it, */
  double rest;             /* and the least bound of those that do not */
} curve_tree_node;

static inline const curve_tree_node *curve_tree_known(const search_node *node) {
  _Static_assert(sizeof(curve_tree_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const curve_tree_node *)node->payload.bytes;
}

static inline curve_tree_node *curve_tree_own(search_node *node) {
  return (curve_tree_node *)node->payload.bytes;
}

/* The nearest point of one element, and where on the curve it was seen. */
typedef struct tree_sample {
  tree_place place;
  tree_near near;
  vec3 y; /* the curve's point, local */
  size_t piece;
  double s;
  bool inside; /* the curve's point lies inside a solid */
} tree_sample;

typedef struct curve_tree {
  /* the problem */
  curve_side side; /* seen from the body's frame */
  const cprox_body *body;
  const tree *tree;
  cprox_curve own[2]; /* the curve and the radius of `side` where they were made for this search */
  double offset;      /* margin, the ball's radius, and that of points */
  search_goal asked;
  search_effort effort; /* depths are not measured: epsilon is that of `asked` */

  /* what is known */
  tree_sample best;
  search_best best_bound;
  bool found, seeded;
  uint32_t distance_queries, nodes;

  /* memory */
  cprox_workspace *workspace;
  points_pool pool;
} curve_tree;

/* Makes the oracle ready; false where memory is out. `asked` and `effort` are the caller's to set. */
bool curve_tree_begin(curve_tree *o, const cprox_curve *curve, const cprox_body *body, frame placed, double offset,
                      cprox_workspace *workspace);

/* The node that is all that is asked about. False where memory is out. */
bool curve_tree_root(curve_tree *o, search_node *root);

/* Measures where the curve's parameter is t, into o->best and o->best_bound. */
void curve_tree_measure_at(curve_tree *o, double t);

/* The functions of the contract in branch_and_bound/search.h, self being the curve_tree. */
search_oracle curve_tree_oracle(curve_tree *o);

/* ---- for curve_query/contact_bvh.c ---- */

/* Goes through a node's list, measured as the segment says: keeps the lanes that may come below the goal, raises
 * node->lower. The nearest element that was met stands in *nearest, squared distance *least2, infinity for none.
 * `share`, where not NULL, becomes the least fraction of the segment that every lane leaves free. */
cprox_status curve_tree_filter(curve_tree *o, search_node *node, tree_segment *segment, double slack,
                               tree_place *nearest, double *least2, double *share);

/* The segment that a node is, seen from x; its rounding in *slack. */
void curve_tree_segment(const curve_tree *o, const search_node *node, vec3 x, tree_segment *segment, double *slack);

/* Measures an element at a curve point y = psi(s) of the piece, which is within `error` of the exact one. */
search_best curve_tree_measure(curve_tree *o, tree_place place, size_t piece, double s, vec3 y, double error,
                               tree_sample *sample);

/* Whether a point is inside of the body, which is a solid mesh. */
bool curve_tree_holds(const curve_tree *o, vec3 y);

/* Whether the curve certainly meets the body near a sample, which moves there: it goes through a triangle before
 * *until of a piece, or is inside of a solid there. */
bool curve_tree_meets(curve_tree *o, tree_sample *sample, size_t *until_piece, double *until);

/* Whether it begins inside of a solid, or jumps into it, for a search that has not begun; the sample is filled then. */
bool curve_tree_begins_inside(curve_tree *o, tree_sample *sample);

#endif
