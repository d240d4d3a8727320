/* SPDX-License-Identifier: BSD-3-Clause */
/* A pose made ready for use: the rotation matrix, and moves between the world and a body's own frame.
 *
 * Bodies are stored about a centre of their own, so that sizes and not positions enter the rounding:
 *   local = R^T (world - position) - centre,    world = R (local + centre) + position. */
#ifndef CPROX_BASE_FRAME_H
#define CPROX_BASE_FRAME_H

#include <stdbool.h>

#include "base/vec.h"

typedef struct frame {
  double r[9]; /* row-major, body to world */
  vec3 position;
  vec3 centre;
  bool rotated;     /* false: R is exactly the identity and is skipped */
  bool about_z;     /* R turns about z only, exactly */
  double misplaced; /* where it ought to stand may be as far off as this [m], */
  double misturned; /* and for each metre that a point is away from `position` as this times u: of a composed pose */
} frame;

/* pose must have been checked by frame_pose_error(). */
frame frame_create(const cprox_pose *pose, vec3 centre);

/* The frame of `inner` within `outer`. Their positions are not added, so that sizes and not positions enter the
 * rounding. */
frame frame_create_within(const cprox_pose *outer, const cprox_pose *inner, vec3 centre);

/* Why a pose is not usable, as part of an error message ("the quaternion's norm is 0"), or NULL if it is. */
const char *frame_pose_error(const cprox_pose *pose);

/* Local coordinates of a world point; *error grows to at least the distance between the computed and the exact ones. */
vec3 frame_to_local(const frame *f, vec3 world, double *error);

vec3 frame_to_world(const frame *f, vec3 local);

/* Directions turn without moving. */
vec3 frame_turn_to_local(const frame *f, vec3 world);
vec3 frame_turn_to_world(const frame *f, vec3 local);

/* The pose that applies `inner` first and `outer` then. */
cprox_pose frame_compose(const cprox_pose *outer, const cprox_pose *inner);

#endif
