/* SPDX-License-Identifier: BSD-3-Clause */
/* Random convex shapes, their support functions in long double, and pairs whose distance is known by construction. */
#ifndef CPROX_TEST_SHAPES_H
#define CPROX_TEST_SHAPES_H

#include "shape/body.h"
#include "support/random.h"
#include "support/reference.h"

#define TEST_MAX_VERTICES 40

typedef struct test_shape {
  cprox_body_kind kind;
  double size[3]; /* as the core keeps them: half extents; radius and half height; semi-axes */
  vec3 v[TEST_MAX_VERTICES];
  size_t n;
  cprox_body *body;
} test_shape;

/* Every convex kind but the halfspace. */
extern const cprox_body_kind TEST_BOUNDED[10];
enum { TEST_N_BOUNDED = 10 };

/* Fills s, which must stay where it is: a callback points into it. Sizes from scale/aspect to scale. The caller frees
 * s->body. */
void shape_make(rng *r, cprox_body_kind kind, double scale, double aspect, test_shape *s);

const char *shape_name(const test_shape *s);

/* The point of the posed shape that is farthest along d. */
vec3l shape_extreme(const test_shape *s, const cprox_pose *pose, vec3l d);

/* A point of the posed shape: an extreme one, moved towards the middle by the fraction. */
vec3l shape_point_within(rng *r, const test_shape *s, const cprox_pose *pose, double fraction);

/* A direction that matters to the shape: the normal of its nearest point to somewhere, in the world. */
vec3 shape_telling_direction(rng *r, const test_shape *s, const cprox_pose *pose);

/* Moves b so that a's least and b's greatest point along n are `gap` apart along n: their distance if gap >= 0, a bound
 * below the signed distance if not. Returns by how much the rounding of b's position may have changed it. */
double shape_place(const test_shape *a, const cprox_pose *pa, const test_shape *b, cprox_pose *pb, vec3 n, double gap);

/* A vector turned by the pose, and back. */
vec3l pose_turn(const cprox_pose *pose, vec3l v);
vec3l pose_turn_back(const cprox_pose *pose, vec3l v);

#endif
