/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of a body that a level of detail of its level-of-detail body means. doc/non-convex.md */
#ifndef CPROX_PROBLEM_LEVEL_OF_DETAIL_H
#define CPROX_PROBLEM_LEVEL_OF_DETAIL_H

#include "curve_proximity/cprox/query.h"
#include "shape/body.h"

/* The body itself lies within `excess` of `body`, which stands at `shift` in its frame. */
typedef struct model {
  const cprox_body *body;
  double excess;
  vec3 shift; /* (0, 0, 0) but for balls */
  cprox_lod lod;
} model;

/* The finest model up to the level of detail; CPROX_LOD_NONE: the finest of all. Bodies that are no level-of-detail
 * bodies are their own models from the hull on; so are points and boxes always, and what has no bounding sphere. `body`
 * is no compound. */
model lod_model_of(const cprox_body *body, cprox_lod finest);

/* Whether the body, or a part of it where it is a compound, is made of many elements up to the level of detail. */
bool lod_has_tree(const cprox_body *body, cprox_lod finest);

/* Most bodies are their own only model. */
static inline bool lod_is_body(const cprox_body *body, cprox_lod finest) {
  return body->kind != CPROX_BODY_COMPOUND && body->kind != CPROX_BODY_LOD && finest != CPROX_LOD_SPHERE;
}

/* Of a part of a compound, or of the body where it is none; *inner becomes the pose of the model in the frame of the
 * body. False in *moved: that is the identity. */
model lod_model_of_part(const cprox_body *body, size_t part, cprox_lod finest, cprox_pose *inner, bool *moved);

#endif
