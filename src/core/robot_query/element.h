/* SPDX-License-Identifier: BSD-3-Clause */
/* What a part is made of: a triangle, a point or a box, or the hull of a cluster of triangles, as a convex body of its
 * own about its own middle. */
#ifndef CPROX_ROBOT_QUERY_ELEMENT_H
#define CPROX_ROBOT_QUERY_ELEMENT_H

#include "kinematics/bound.h"
#include "kinematics/link_model.h"

/* Something convex somewhere, with what the cheap tests need; and what it is made of. */
typedef struct robot_body {
  bound_side side;
  double radius;                 /* of a ball about the shape's origin that contains the part, margin included */
  double core;                   /* robot_core_radius() */
  uint32_t steps;                /* transforms that its place went through */
  int32_t index, part;           /* obstacle and part of it; or geometry and its number among the robot's parts */
  const tree *tree;              /* the elements under the shape, NULL for none; the tree's axes are the shape's, */
  const cluster_hulls *clusters; /* those of the tree, NULL for none */
  vec3 tree_at;                  /* its origin stands here in the shape's frame, */
  double tree_margin;            /* and elements are thickened by this */
  const struct winding *winding; /* what tells the inside of a solid mesh, NULL for a surface and for parts of it */
} robot_body;

/* Of a ball round the core: a margin does not turn. Elements may have a smaller margin than what contains them. */
double robot_core_radius(const robot_body *body);

/* A place in a tree as a number; -1 stands for none. */
static inline int32_t robot_element_code(tree_place at) {
  return (int32_t)(at.pack * TREE_LANES + at.lane);
}

static inline tree_place robot_element_place(int32_t code) {
  return (tree_place){(uint32_t)code / TREE_LANES, (uint32_t)code % TREE_LANES};
}

/* A body by its number among those under a part: ROBOT_WHOLE: the part itself; 0 and above: an element; below
 * ROBOT_WHOLE: a cluster. */
enum { ROBOT_WHOLE = -1 };

static inline int32_t robot_cluster_code(uint32_t cluster) {
  return ROBOT_WHOLE - (int32_t)cluster;
}

/* What a part or a cluster of it consists of, one level down. */
static inline const cluster_hull *robot_cluster_of(const robot_body *owner, int32_t code) {
  return &owner->clusters->hull[ROBOT_WHOLE - code];
}

static inline int32_t robot_inner_code(const cluster_hull *hull, uint32_t i) {
  const uint32_t inner = hull->inside[i];
  return inner & TREE_LEAF ? (int32_t)(inner & ~TREE_LEAF) : robot_cluster_code(inner);
}

/* Whether a pair can be opened: each side is convex or has clusters, one at least has. side: moving, standing. */
static inline bool robot_can_open(const robot_body *const side[2]) {
  return (side[0]->clusters || !side[0]->tree) && (side[1]->clusters || !side[1]->tree) &&
         (side[0]->clusters || side[1]->clusters);
}

/* The larger one. */
static inline int robot_side_to_open(const robot_body *const side[2]) {
  if (!side[0]->clusters || !side[1]->clusters) return side[0]->clusters ? 0 : 1;
  return side[0]->radius >= side[1]->radius ? 0 : 1;
}

typedef struct robot_element {
  uint32_t node; /* it is still that of a pair's side on this node; 0: of none, */
  int32_t part, code;
  bool self;
  convex shape;
  double x[8], y[8], z[8];
  robot_body body;
} robot_element;

/* An element or a cluster; the answer points into `element`. */
const robot_body *robot_element_make(const robot_body *owner, int32_t code, robot_element *element);

#endif
