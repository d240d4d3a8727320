/* SPDX-License-Identifier: BSD-3-Clause */
/* A triangle, a point or a box of what a part is made of, as a convex body of its own about its own middle. */
#ifndef CPROX_ROBOT_QUERY_ELEMENT_H
#define CPROX_ROBOT_QUERY_ELEMENT_H

#include "kinematics/bound.h"
#include "kinematics/link_model.h"

/* Something convex somewhere, with what the cheap tests need; and what it is made of. */
typedef struct robot_body {
  bound_side side;
  vec3 middle, half;   /* of a box, axes those of the shape, that contains the core; half is infinite for halfspaces */
  double radius;       /* of a ball about the shape's origin that contains the part, margin included */
  uint32_t steps;      /* transforms that its place went through */
  int32_t index, part; /* target and part of it; or geometry and its number among the robot's parts */
  const tree *tree;    /* the elements under the shape, NULL for none; the tree's axes are the shape's, */
  vec3 tree_at;        /* its origin stands here in the shape's frame, */
  double tree_margin;  /* and elements are thickened by this */
} robot_body;

/* A place in a tree as a number; -1 stands for none. */
static inline int32_t robot_element_code(tree_place at) {
  return (int32_t)(at.pack * TREE_LANES + at.lane);
}

static inline tree_place robot_element_place(int32_t code) {
  return (tree_place){(uint32_t)code / TREE_LANES, (uint32_t)code % TREE_LANES};
}

typedef struct robot_element {
  convex shape;
  double x[8], y[8], z[8];
  robot_body body;
} robot_element;

/* The element of the owner's tree; the answer points into `element`. */
const robot_body *robot_element_make(const robot_body *owner, int32_t code, robot_element *element);

#endif
