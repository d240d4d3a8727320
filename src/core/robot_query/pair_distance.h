/* SPDX-License-Identifier: BSD-3-Clause */
/* Two parts that stand still: bounds on their distance, the distance, and what its normal does when one of them moves.
 */
#ifndef CPROX_ROBOT_QUERY_PAIR_DISTANCE_H
#define CPROX_ROBOT_QUERY_PAIR_DISTANCE_H

#include "kinematics/bound.h"
#include "robot_query/element.h"

static inline bool robot_body_is_halfspace(const robot_body *body) {
  return body->side.shape->ops->kind == CPROX_BODY_HALFSPACE;
}

/* A lower bound on the distance of two parts by their balls and boxes, and a quicker one by their balls; halfspaces
 * have none. */
double robot_pair_ball_distance(const robot_body *moving, const robot_body *standing);
double robot_pair_balls(const robot_body *moving, const robot_body *standing);

/* The distance in the middle of the node. */
typedef struct robot_gap {
  double lower, upper, slack;
  vec3 on_moving, on_standing; /* world */
  vec3 normal;                 /* world, unit, from standing to moving; (0,0,0) where there is none */
  /* Polyhedra, world: points of the moving side, and the ways to them from points of the standing one, n of them: the
   * feature that the normal stands on. Curved shapes, n = 0: the derivative of the normal by a shift of the moving
   * side, in the standing frame. */
  vec3 on_edge[3], across[3];
  int n;
  double hessian[6];
  bool support_failed;
  double loss; /* of upper, by errors of the pair */
} robot_gap;

/* How exactly: within epsilon, or within `fraction` of what the lower end is above `floor`. And where to begin. */
typedef struct robot_accuracy {
  double epsilon, floor, fraction;
  vec3 start;   /* standing frame, unit: near the normal; (0,0,0): nothing is known */
  bool depth;   /* how deep the two overlap, not only that they do; the points are then the ends of the way out */
  bool verdict; /* or on which side of `floor` it is: no more is known then */
} robot_accuracy;

void robot_pair_measure(const robot_body *moving, const robot_body *standing, robot_accuracy accuracy, robot_gap *gap);

/* From the box round what stands to the centre of what moves: a direction that parts most pairs, for nothing. Standing
 * frame, unit; (0,0,0) where the centre is in the box. */
vec3 robot_pair_guess(const robot_body *moving, const robot_body *standing);

/* How fast the normal turns where what moves does so as `motion` says, by u of the node; orthogonal to it. */
vec3 robot_pair_normal_rate(const robot_gap *gap, const robot_body *moving, const robot_body *standing,
                            const chain_motion *motion);

/* Along a normal of the world: the height of what stands, as bound_height(), exact for halfspaces. */
double robot_pair_height(const robot_body *standing, vec3 normal);

#endif
