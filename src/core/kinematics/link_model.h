/* SPDX-License-Identifier: BSD-3-Clause */
/* A body as the search about robots has it: a convex set that contains it, and under that the elements that it is made
 * of. */
#ifndef CPROX_KINEMATICS_LINK_MODEL_H
#define CPROX_KINEMATICS_LINK_MODEL_H

#include "bvh/bvh.h"
#include "shape/body.h"
#include "shape/cluster_hulls.h"

typedef struct part_model {
  const convex *shape; /* of a level-of-detail body its hull, of a mesh, points or boxes a point */
  vec3 centre;         /* of the shape, in the body's frame */
  double margin;       /* what thickens the shape, so that the body lies within */
  double radius;       /* of a ball about the centre that contains the body */
  vec3 middle, half;   /* of a box, axes those of the shape, that contains its core: part_model_find_box() */
  bool by_ball;        /* the shape stands for nothing but that ball */
  const tree *tree;    /* the elements; NULL: the body is the shape with its margin */
  vec3 tree_at;        /* where the tree's origin is, from the centre */
  double tree_margin;
  const cluster_hulls *clusters; /* between the shape and the elements; NULL: there are none */
  const struct winding *winding; /* of a solid mesh: what tells its inside; else NULL */
} part_model;

/* body: no compound. */
part_model part_model_of(const cprox_body *body);

/* Draws the box, by the shape's support function. Not of a halfspace. */
void part_model_find_box(part_model *model);

/* The ball alone. */
part_model part_model_ball(const part_model *model);

/* Whether the body, or a part of it, is a mesh with an inside. */
bool part_model_is_solid(const cprox_body *body);

#endif
