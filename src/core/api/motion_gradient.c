/* SPDX-License-Identifier: BSD-3-Clause */
/* The gradient of a robot's clearance; its least growth distance with its gradient. */
#include "solve/motion_gradient.h"

#include "api/obstacle_bvh.h"
#include "base/workspace.h"
#include "kinematics/motion.h"
#include "problem/obstacles.h"
#include "solve/growth_motion.h"

cprox_status cprox_robot_distance_gradient(const cprox_obstacles *obstacles, cprox_mover mover,
                                           const cprox_options *options, cprox_workspace *workspace,
                                           cprox_result *result, cprox_motion_gradient *gradient) {
  WORKSPACE_USE(workspace);
  static const arguments_query ASKED = {"the gradient of a robot's distance",
                                        ARGUMENTS_SEARCH | ARGUMENTS_WHOLE | ARGUMENTS_SIGNED | ARGUMENTS_INTERVAL};
  const obstacle_bvh *set = obstacles ? obstacles->bvh : NULL;
  query q = query_create(mover, obstacles_list(obstacles), obstacles_count(obstacles), -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  const cprox_status begun = set ? bvh_begin(set, &q, ASKED) : query_begin(&q, ASKED);
  if (begun != CPROX_OK) return begun;
  if (!mover.motion)
    return workspace_fail(workspace, CPROX_INVALID,
                          "the mover is no robot: ask cprox_distance_gradient() for the gradient along a curve");
  if (!result || !gradient)
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", result ? "gradient" : "result");
  const cprox_status known = motion_gradient_check(&q, gradient);
  return known ? known : motion_gradient_of(&q, 0, q.n, result, gradient);
}

cprox_status cprox_robot_growth(const cprox_obstacles *obstacles, cprox_mover mover, const cprox_options *options,
                                cprox_workspace *workspace, cprox_motion_growth *found,
                                cprox_motion_gradient *gradient) {
  WORKSPACE_USE(workspace);
  static const arguments_query ASKED = {"the growth distance of a robot",
                                        ARGUMENTS_SEARCH | ARGUMENTS_WHOLE | ARGUMENTS_SIGNED | ARGUMENTS_INTERVAL};
  query q = query_create(mover, obstacles_list(obstacles), obstacles_count(obstacles), -1.0, options, workspace);
  q.is_signed = q.options.signed_distance = true; /* it measures overlaps as well */
  const cprox_status begun = query_begin(&q, ASKED);
  if (begun != CPROX_OK) return begun;
  if (!mover.motion)
    return workspace_fail(workspace, CPROX_INVALID,
                          "the mover is no robot: ask cprox_growth_along() about a body along a curve");
  if (!found) return workspace_fail(workspace, CPROX_INVALID, "found is NULL: nowhere to put the answer");
  const cprox_status known = gradient ? motion_gradient_check(&q, gradient) : CPROX_OK;
  return known ? known : growth_motion_answer(&q, found, gradient);
}
