/* SPDX-License-Identifier: BSD-3-Clause */
/* Where two standing convex shapes are, seen from the first. */
#ifndef CPROX_NARROWPHASE_RELATIVE_POSE_H
#define CPROX_NARROWPHASE_RELATIVE_POSE_H

#include "convex/pair.h"
#include "curve_proximity/cprox/query.h"
#include "problem/level_of_detail.h"
#include "shape/body.h"

/* A convex shape somewhere in the world. */
typedef struct pair_side {
  const convex *shape;
  frame f;
  double margin; /* the shape's own and the margin */
  double error;  /* of the pose, where it had to be composed */
  const cprox_body *body;
  cprox_lod lod;
} pair_side;

/* Part of an obstacle, by the finest model up to the level of detail; of its finest one. */
pair_side relative_pose_of_model(const cprox_obstacle *obstacle, size_t part, cprox_lod finest);
pair_side relative_pose_of_side(const cprox_obstacle *obstacle, size_t part);

/* b in a's frame. Positions are subtracted first: what they share does not enter the rounding. */
pair_placement relative_pose_make(const pair_side *a, const pair_side *b);

#endif
