/* SPDX-License-Identifier: BSD-3-Clause */
/** Answers that hold for the robot as it is: for every execution of a motion within bounds of its errors.
 *
 *  A controller does not follow a trajectory exactly, and objects are not exactly where a scene has them. The caller
 *  bounds these errors; a query answers for all executions within the bounds at once. Source: doc/robust.md. */
#ifndef CURVE_PROXIMITY_CPROX_ROBUST_H
#define CURVE_PROXIMITY_CPROX_ROBUST_H

#include <curve_proximity/cprox/obstacles.h>
#include <curve_proximity/cprox/robot.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Bounds of all errors of an execution. Set all members to 0, then those that are known. None is negative.
 *
 *  An execution is at time t where the trajectory is at t + δ, |δ| <= timing. There variable i is off by at most
 *  tracking[i] + speed[i] |q_i′| + acceleration[i] |q_i″|, with the rates of the trajectory. The accelerations are
 *  those of its polynomial pieces: a jump of the velocity at a waypoint counts nothing. */
typedef struct cprox_error_bounds {
  /** [rad, or m of prismatic joints] of each variable of the robot, whether or not the motion moves it; NULL: all 0. Of
   *  floating joints and rotation vectors 0 */
  const double *tracking;
  /** [s] of each variable: the part that is proportional to the speed, as a delay of this joint alone; NULL: all 0 */
  const double *speed;
  /** [s²] of each variable: the part that is proportional to the acceleration; NULL: all 0 */
  const double *acceleration;
  /** the number of variables of the robot; 0 where the three arrays are NULL */
  size_t n_variables;
  /** [s] the whole motion is early or late by at most this. It costs nothing: everything else stands, so that only an
   *  interval that is asked about is longer by it, at both ends */
  double timing;
  /** [m] the robot's base is within this of where it is given, against obstacles */
  double base_position;
  /** [rad] and turned by at most this about any axis through base_origin */
  double base_rotation;
  /** [m] world frame: the point that base_rotation is about */
  cprox_vec3 base_origin;
  /** [m] each obstacle is within this of where it is given */
  double object_position;
  /** [rad] and turned by at most this about any axis through its pose's position */
  double object_rotation;
  /** [m] every point of an obstacle is within this of where it was measured: voxel size, noise of points */
  double sensor;
  /** [m] every point of a link below the first joint is within this of where rigid links would have it */
  double flex;
} cprox_error_bounds;

/** The clearance that is certified for every execution within the bounds.
 *
 *  obstacles  may be NULL: none.
 *  mover      a robot: cprox_robot_along(), cprox_robot_self() or cprox_robot_whole(), along one motion (not a joined
 *             one).
 *  bounds     not NULL; read during the call.
 *  options    relative_epsilon, stop, max_lod and interval apply.
 *  result     lower: every execution keeps this distance at all times. upper: this method certifies no more; it is no
 *             distance of an execution. t, witness points and indices say where the certified clearance is least; the
 *             witness point on the robot is one of the link enlarged by how far it may be off there.
 *
 *  The work is that of cprox_obstacles_distance() of links that are enlarged, each by its own bound at each time. */
CPROX_API cprox_status cprox_robust_distance(const cprox_obstacles *obstacles, cprox_mover mover,
                                             const cprox_error_bounds *bounds, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_result *result);

/** Is every execution within the bounds farther than delta >= 0 [m] from everything, at all times?
 *
 *  verdict    clear: yes. violated: the motion itself, without any error, is not; result is that of the motion itself.
 *             undecided: neither is proven, and result is that of cprox_robust_distance() as far as it was searched.
 *  status     CPROX_OK also where the verdict is undecided because the bounds leave no room.
 *
 *  The work is that of one search, and where the verdict is not clear that of a plain verdict, too. */
CPROX_API cprox_status cprox_robust_tolerance(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                              const cprox_error_bounds *bounds, const cprox_options *options,
                                              cprox_workspace *workspace, cprox_result *result);

/** By how much all bounds may grow. */
typedef struct cprox_robust_scale {
  /** with all bounds times this, the motion is certified; infinity where the bounds do not matter, 0 where not even the
   *  motion without errors is certified */
  double certified;
  /** with all bounds times this, it was not certified; infinity where no such scale was found */
  double refused;
  /** clear: certified > 0; violated: the motion itself violates delta; undecided: neither is proven */
  cprox_verdict verdict;
  /** how many verdicts were asked for, 8 at most, but for that of the motion itself */
  int32_t n_verdicts;
  /** intervals examined, in all */
  uint64_t nodes;
  /** distance queries, in all */
  uint64_t distance_queries;
  /** of the refused scale nearest to the certified one, or of the last verdict: what stands in the way, and when */
  cprox_result limit;
} cprox_robust_scale;

/** The largest multiple of all bounds with which every execution is farther than delta from everything, at all times.
 *  The search ends when `refused` is at most 1 % above `certified`, or after 8 verdicts. Timing errors are not scaled.
 *  Arguments are those of cprox_robust_tolerance(); max_nodes is the budget of each verdict. */
CPROX_API cprox_status cprox_robust_find_scale(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                               const cprox_error_bounds *bounds, const cprox_options *options,
                                               cprox_workspace *workspace, cprox_robust_scale *scale);

#ifdef __cplusplus
}
#endif
#endif
