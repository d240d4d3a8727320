/* SPDX-License-Identifier: BSD-3-Clause */
/** How a distance changes when the curve, the target or the radii change: for optimisers. */
#ifndef CURVE_PROXIMITY_CPROX_GRADIENT_H
#define CURVE_PROXIMITY_CPROX_GRADIENT_H

#include <curve_proximity/cprox/query.h>

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
  /** the minimiser on a target that is a curve; NaN for bodies */
  double t_obstacle;
  /** by the mover's point at t. By a coefficient of the mover's curve: its weight at t (cprox_curve_weights())
   *  times this */
  cprox_vec3 mover;
  /** the same of a target that is a curve: by its point at t_obstacle, in the target's frame; else 0 */
  cprox_vec3 obstacle_point;
  /** by the target's position, world axes */
  cprox_vec3 position;
  /** [m/rad] by a small rotation vector w that turns the target about its position, world axes: R becomes exp([w]) R */
  cprox_vec3 rotation;
  /** by the radius of the mover: -1 */
  double radius;
  /** by the margin of the target: -1 */
  double margin;
  /** by the start of the range, the curve itself going on as it is: 0 unless the minimiser is there */
  double t0;
  /** by the end of the range, likewise */
  double t1;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[4];
} cprox_gradient;

/** The gradient of cprox_distance(mover, target, options), given its result.
 *
 *  options   of that very call, less its certificate, which is refused here.
 *  result    of that very call; of a call with many targets, `target` is the one that result->obstacle_index names.
 *
 *  By Danskin's theorem the derivatives are those of the distance at the minimiser alone, if there is only one. So the
 *  whole curve is searched once more. valid is false
 *    where the distance elsewhere comes within min(epsilon, 1e-9 curve lengths) of the least, or is as small on a
 *    interval of more than 1e-3 of the range about the minimiser (of 1e-6 where the distance grows like a square),
 *    where two parts or two points of a target curve are equally near,
 *    where the nearest points are not the only ones (face on face, edge along a face, a cone's base): a turn of 1e-6
 *    rad to either side moves them by as much as one of 1e-4 rad,
 *    where the way out of an overlap is not unique, found likewise by shifts of 1e-6 and 1e-4 sizes,
 *    and where the distance is 0 and not signed.
 *
 *  Returns CPROX_OK also where valid is false. CPROX_INVALID for unusable arguments, for a result without a witness,
 *  and for movers and targets of which no gradient is known (meshes, points, robots). *gradient is untouched then.
 *  Cost: about five distance queries, and for carried bodies four static pairs. Source: J. M. Danskin, The theory of
 *  max-min, 1967; doc/curve-bound.md. */
CPROX_API cprox_status cprox_distance_gradient(cprox_mover mover, cprox_obstacle target, const cprox_options *options,
                                               const cprox_result *result, cprox_workspace *workspace,
                                               cprox_gradient *gradient);

#ifdef __cplusplus
}
#endif
#endif
