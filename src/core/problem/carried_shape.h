/* SPDX-License-Identifier: BSD-3-Clause */
/* A carried body and what it must keep away from, as one shape that the curve alone must keep away from. */
#ifndef CPROX_PROBLEM_CARRIED_SHAPE_H
#define CPROX_PROBLEM_CARRIED_SHAPE_H

#include "shape/body.h"

/* The shape that stands in for both. A point y of the curve, in the frame `placed`, is shape-distance - offset away. */
typedef struct carried_shape {
  convex shape;
  frame placed;
  double offset; /* of a ball that is carried: the shape is then the standing one */
} carried_shape;

/* `standing` is convex and stands at the pose; `carried` is convex and bounded, its pose that at the curve's origin.
 * False where its support callback misbehaved. */
bool carried_shape_join(const cprox_body *standing, const cprox_pose *pose, const cprox_body *carried,
                        const cprox_pose *carried_pose, carried_shape *joined);

/* One point, at the origin of its frame: what stands where a carried body meets a curve. */
extern const cprox_body carried_point;

#endif
