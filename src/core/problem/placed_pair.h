/* SPDX-License-Identifier: BSD-3-Clause */
/* A candidate resolved once: both shapes at the level of detail that is searched, where they are, and the margins round
 * them. */
#ifndef CPROX_PROBLEM_PLACED_PAIR_H
#define CPROX_PROBLEM_PLACED_PAIR_H

#include "base/frame.h"
#include "problem/candidates.h"

typedef struct placed_pair {
  candidate which; /* the indices, the bound by bounding spheres, and where the search begins */
  const cprox_obstacle *obstacle;
  cprox_lod lod; /* of the models below */

  /* The obstacle's model; NULL for a curve at a parameter of its own. An obstacle on the mover's clock has a shape, if
   * only a point, which stands where it would if its curve were at the origin. */
  const cprox_body *shape;
  cprox_pose pose;       /* in the world */
  frame frame;           /* the same, about the shape's centre; not set without a shape */
  double position_error; /* the composition of the pose may have moved the shape, and what turns with it, this far */
  double margin;         /* round the shape */

  /* The model of the convex part that the mover carries, NULL for none, and its pose while the curve is at the origin.
   */
  const cprox_body *carried;
  cprox_pose carried_pose;
  double offset;       /* all margins: the obstacle's, and that of what rides the curve; */
  bool radius_changes; /* on top of it, the radius of one of the two changes */
} placed_pair;

placed_pair placed_pair_resolve(const query *q, const candidate *c);

/* One part of a body at a level of detail. */
typedef struct placed_model {
  const cprox_body *body; /* NULL: none */
  double excess;          /* the part is within this of the model */
  cprox_lod lod;
  cprox_pose pose;  /* of an obstacle: in the world; of what is carried: while the curve is at the origin */
  bool moved;       /* false: the model stands in the frame of the body, */
  cprox_pose inner; /* and this, its pose there, is not set */
} placed_model;

/* The models of both sides of a candidate. */
typedef struct placed_models {
  placed_model obstacle, carried;
} placed_models;

placed_models placed_models_resolve(const query *q, const candidate *c);

/* That of the obstacle alone. */
placed_model placed_model_of_obstacle(const query *q, const candidate *c);

/* Round one model of an obstacle, or where its curve carries that; *sizes as of candidate_bounding_ball(). */
candidate_ball placed_model_ball(const cprox_obstacle *obstacle, int32_t part, const placed_model *m, double *sizes);

/* No less than the length, and had without a root: for sums of sizes that rounding is measured by. */
static inline double placed_size(vec3 v) {
  return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

#endif
