/* SPDX-License-Identifier: BSD-3-Clause */
/** How a distance changes when the curve, the obstacle or the radii change: for optimisers. */
#ifndef CURVE_PROXIMITY_CPROX_GRADIENT_H
#define CURVE_PROXIMITY_CPROX_GRADIENT_H

#include <curve_proximity/cprox/obstacles.h>
#include <curve_proximity/cprox/query.h>
#include <curve_proximity/cprox/translation.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The derivatives of a distance, signed or not, at its minimiser. */
typedef struct cprox_gradient {
  /** false: the distance is not differentiable here, or cannot be told to be; the reason is in the workspace, the
   *  numbers are those of one of the minimisers or 0 */
  bool valid;
  /** the minimiser, as exactly as double arithmetic finds it */
  double t;
  /** the minimiser on an obstacle that is a curve; NaN for bodies */
  double t_obstacle;
  /** by the mover's point at t. By a coefficient of the mover's curve: its weight at t (cprox_curve_weights())
   *  times this */
  cprox_vec3 mover;
  /** the same of an obstacle that is a curve: by its point at t_obstacle, in the obstacle's frame; else 0 */
  cprox_vec3 obstacle_point;
  /** by the obstacle's position, world axes */
  cprox_vec3 position;
  /** [m/rad] by a small rotation vector w that turns the obstacle about its position, world axes:
   *  R becomes exp([w]) R */
  cprox_vec3 rotation;
  /** by the radius of the mover: -1 */
  double radius;
  /** by the margin of the obstacle: -1 */
  double margin;
  /** by the start of the range, the curve itself going on as it is: 0 unless the minimiser is there */
  double t0;
  /** by the end of the range, likewise */
  double t1;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[4];
} cprox_gradient;

/** The gradient of cprox_distance(mover, obstacle, options), given its result.
 *
 *  options   of that very call, less its certificate, which is refused here.
 *  result    of that very call; of a call with many obstacles, `obstacle` is the one that result->obstacle_index names.
 *
 *  By Danskin's theorem the derivatives are those of the distance at the minimiser alone, if there is only one. So the
 *  whole curve is searched once more. valid is false
 *    where the distance elsewhere comes within min(epsilon, 1e-9 curve lengths) of the least, or is as small on a
 *    interval of more than 1e-3 of the range about the minimiser (of 1e-6 where the distance grows like a square),
 *    where two parts or two points of an obstacle curve are equally near, or two elements of a mesh, of points or
 *    boxes, where the nearest points are not the only ones (face on face, edge along a face, a cone's base): a turn of
 *    1e-6 rad to either side moves them by as much as one of 1e-4 rad,
 *    where the way out of an overlap is not unique, found likewise by shifts of 1e-6 and 1e-4 sizes,
 *    and where the distance is 0 and not signed.
 *
 *  Returns CPROX_OK also where valid is false. CPROX_INVALID for unusable arguments, for a result without a witness,
 *  and for movers and obstacles of which no gradient is known (robots; sets known by their distance). *gradient is
 *  untouched then.
 *  Cost: about five distance queries, and for carried bodies four static pairs. Source: J. M. Danskin, The theory of
 *  max-min, 1967; doc/curve-bound.md. */
CPROX_API cprox_status cprox_distance_gradient(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                               const cprox_result *result, cprox_workspace *workspace,
                                               cprox_gradient *gradient);

/** The derivatives of the least distance of a robot's motion, at its minimiser. Set all members to 0, then those
 *  arrays that are wanted. A motion that was made of n_points waypoints or control points and gives n variables
 *  (cprox_motion_description) has n_points rows of n numbers. A joined motion has the rows of its first motion, then
 *  those of the second one, and so on. A state has none, and where floating joints turn by slerp or by screws they are
 *  not known: `variables` alone is for these. */
typedef struct cprox_motion_gradient {
  /** NULL, or receives one number a variable of the robot: by its value at t, or at rest [m/rad], [m/m] */
  double *variables;
  /** NULL, or receives n_points rows: by the positions of the waypoints, or by the control points [m/rad], [m/m] */
  double *positions;
  /** NULL, or receives n_points rows: by the velocities of the waypoints [m s/rad], [m s/m]; 0 where the interpolation
   *  does not use them, and for B-splines */
  double *velocities;
  /** NULL, or receives n_points rows: by the accelerations of the waypoints, likewise */
  double *accelerations;
  /** false: the distance is not differentiable here, or cannot be told to be; the reason is in the workspace, the
   *  numbers are those of one of the minimisers, or 0 where none was found */
  bool valid;
  /** [s] the minimiser, as exactly as double arithmetic finds it; NaN where none was found */
  double t;
  /** [m/s] by the duration, all times being stretched alike: positions, velocities and accelerations stay what they
   *  are. 0 without velocities, for B-splines and for joined motions, which have `durations` */
  double duration;
  /** by a shift of the whole robot, world axes; 0 for a pair of the robot with itself */
  cprox_vec3 base_position;
  /** [m/rad] by a small rotation vector w that turns the whole robot about the world's origin: x becomes exp([w]) x */
  cprox_vec3 base_rotation;
  /** by the position of the nearest obstacle, world axes; 0 for a pair of the robot with itself */
  cprox_vec3 position;
  /** [m/rad] by a small rotation vector w that turns that obstacle about its position: R becomes exp([w]) R */
  cprox_vec3 rotation;
  /** by the margin of that obstacle, or of one geometry of the pair: -1 */
  double margin;
  /** of joined motions: NULL, or receives one number for each of them [m/s]: by its start on the clock. NaN where the
   *  minimiser is at a waypoint or an end of two of them, and the distance has a kink there */
  double *starts;
  /** of joined motions: NULL, or receives one number for each of them [m/s]: by its duration, its start being kept.
   *  All its times are stretched alike; positions, velocities and accelerations stay what they are. NaN as `starts` */
  double *durations;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_motion_gradient;

/** The least distance of a robot along a motion, and its gradient, by one search.
 *
 *  obstacles  NULL: none, for a robot against itself.
 *  mover      cprox_robot_along(), cprox_robot_self() or cprox_robot_whole().
 *  options    NULL: the default. A certificate is refused.
 *  result     receives what cprox_obstacles_distance() answers: the same guarantees, not the same digits.
 *  gradient   see cprox_motion_gradient. Its arrays are the caller's.
 *
 *  By Danskin's theorem the derivatives are those of the distance at the minimiser, if there is only one: the search
 *  goes on until all other times and all other pairs are proven farther than the least distance by 1e-9 of the robot's
 *  size. valid is false
 *    where the distance is as small, within that, elsewhere along the motion or of another pair,
 *    where the distance does not fall towards the minimiser from within 3e-2 of the motion,
 *    where the nearest points are not the only ones (face on face, edge along a face): a turn of 1e-6 rad to either
 *    side moves them by as much as one of 1e-4 rad; of meshes, where another triangle is as near elsewhere,
 *    and where the distance is 0.
 *  A minimiser at a waypoint, at an end of the motion, or with a vertex as nearest point has a gradient. Nearer to the
 *  minimiser than the proof goes (1e-4 of the motion where that is enough, at most 3e-2) the slope of the distance is
 *  looked at to either side.
 *
 *  Returns as cprox_obstacles_distance(), also where valid is false. CPROX_INVALID also where the mover is no robot,
 * and where rows are wanted that are not known. Cost: 1.52 distances (instructions, the sum over 46 queries about real
 * robots). Source: J. M. Danskin, The theory of max-min, 1967; doc/robot-depth.md. */
CPROX_API cprox_status cprox_robot_distance_gradient(const cprox_obstacles *obstacles, cprox_mover mover,
                                                     const cprox_options *options, cprox_workspace *workspace,
                                                     cprox_result *result, cprox_motion_gradient *gradient);

/** What rows are wanted. */
typedef struct cprox_rows_query {
  /** [s] n_intervals + 1 times, ascending, within the motion; NULL: the waypoints or the knots of the motion */
  const double *breaks;
  /** the number of intervals; ignored where breaks is NULL */
  size_t n_intervals;
  /** [m] >= 0, finite: rows of what comes within it */
  double horizon;
  /** at most so many rows a pair, the nearest ones; >= 1 */
  size_t per_pair;
} cprox_rows_query;

/** A row: a pair of a robot on one interval of its motion. */
typedef struct cprox_motion_row {
  /** its distance there, as cprox_obstacles_distance() gives it; mover_part and obstacle_index say which pair */
  cprox_result result;
  /** its gradient, as cprox_robot_distance_gradient() gives it for this pair and interval; valid is about these alone.
   *  The caller sets the arrays that are wanted in every row before the call */
  cprox_motion_gradient gradient;
  /** between breaks[interval] and breaks[interval + 1] */
  size_t interval;
} cprox_motion_row;

/** The rows of a clearance constraint on a robot's motion: for each pair that comes near, its least distances along the
 *  motion with their gradients. That is what an SQP linearises.
 *
 *  obstacles  NULL: none, for a robot against itself.
 *  mover      cprox_robot_along() or cprox_robot_self().
 *  asked      see cprox_rows_query.
 *  options    NULL: the default. A certificate is refused.
 *  rows       room for `room` of them; receives those of one pair after those of another, nearest first. Rows may
 *             exchange the arrays that the caller set.
 *  count      receives their number.
 *
 *  Certified: the distance of a row's pair on its interval is in [lower, upper]. A pair that has no row for an interval
 *    is farther than the horizon there, or
 *    is nearest at the break to the neighbouring interval, and comes as near or nearer there: that one has a row, or
 *    the same is true of it, or
 *    has per_pair rows that come as near or nearer.
 *  Pairs whose sides the motion does not move against each other have rows, too: a step of its points may move them.
 *  So each row is a local minimum along the motion, as far as minimisers at breaks are known exactly. Minima within an
 *  interval besides its least one have no row: choose shorter intervals. Where `room` is too small CPROX_BUDGET is
 *  returned: then some rows are left out. So they may be where CPROX_STOPPED is returned.
 *
 *  Returns as cprox_obstacles_distance(). *count is untouched on a negative status. Cost: a search for each pair, which
 *  ends as soon as the pair is farther than the horizon; one more for each interval of those that are not; a gradient
 *  for each row. Source: doc/robot-depth.md. */
CPROX_API cprox_status cprox_robot_rows(const cprox_obstacles *obstacles, cprox_mover mover,
                                        const cprox_rows_query *asked, const cprox_options *options,
                                        cprox_workspace *workspace, cprox_motion_row *rows, size_t room, size_t *count);

/** The least growth distance of a robot's motion. */
typedef struct cprox_motion_growth {
  /** lower <= the least growth distance of all pairs along the motion <= upper; normal, from the obstacle or the other
   *  geometry to the robot's, is of the place at t; pairs: places that were measured */
  cprox_growth growth;
  /** [s] when upper was measured; NaN where there is no pair */
  double t;
  /** the geometry of the robot, as that of cprox_result; -1: there is no pair */
  int32_t mover_part;
  /** The obstacle or the other geometry, likewise. */
  int32_t obstacle_index;
  /** where both touch at t once they are scaled, world frame */
  cprox_vec3 touch;
  /** [1/m] no pair's growth distance changes faster with the place of one side */
  double steepest;
} cprox_motion_growth;

/** The least growth distance of a robot along its motion, and its derivatives by the motion.
 *
 *  obstacles  NULL: none, for a robot against itself.
 *  mover      cprox_robot_along(), cprox_robot_self() or cprox_robot_whole().
 *  options    NULL: the default. epsilon is the width as a part of the value, or 1e-3 of that where the value is below
 *             1e-3; max_nodes bounds nodes and places together.
 *  found      receives the answer: 1 is contact, below 1 the two overlap. Nothing to measure: both bounds are infinite.
 *  gradient   NULL, or set up as for cprox_robot_distance_gradient(), with derivatives of the growth distance in the
 *             place of those of the distance; margin is 0.
 *
 *  All sides are convex and bounded and have their centre inside, and have no margin. Level-of-detail bodies count by
 *  their hulls, each scaled about the hull's centre. valid is false where cprox_growth_gradient() has it false at the
 *  minimiser, and where another place or pair comes as near, within 1e-9 of the value.
 *
 *  Returns as cprox_obstacles_distance(). Cost: about three growth distances for each interval that is looked at; with
 *  derivatives twice that (doc/implicit.md, Along a robot's motion). */
CPROX_API cprox_status cprox_robot_growth(const cprox_obstacles *obstacles, cprox_mover mover,
                                          const cprox_options *options, cprox_workspace *workspace,
                                          cprox_motion_growth *found, cprox_motion_gradient *gradient);

#ifdef __cplusplus
}
#endif
#endif
