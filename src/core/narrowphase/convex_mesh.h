/* SPDX-License-Identifier: BSD-3-Clause */
/* A standing mesh, points or boxes against a standing convex shape. doc/non-convex.md derives it. */
#ifndef CPROX_NARROWPHASE_CONVEX_MESH_H
#define CPROX_NARROWPHASE_CONVEX_MESH_H

#include "bvh/bvh.h"
#include "narrowphase/relative_pose.h"

/* The answer is in the frame of the elements, which are its a. The convex shape is bounded. */
void convex_mesh_measure(const pair_side *elements, const pair_side *convex_side, const pair_goal *goal,
                         pair_answer *answer);

/* An element as a convex shape about a centre of its own, which is returned. */
vec3 convex_mesh_element_shape(const tree *t, tree_place at, double vertices[3][TREE_LANES], convex *shape);

#endif
