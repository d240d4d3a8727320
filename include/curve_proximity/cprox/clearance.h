/* SPDX-License-Identifier: BSD-3-Clause */
/** Which targets are close, and how close the mover is on each interval of its way. */
#ifndef CURVE_PROXIMITY_CPROX_CLEARANCE_H
#define CURVE_PROXIMITY_CPROX_CLEARANCE_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The k targets that come closest.
 *
 *  nearest   receives min(k, n) results, ascending by upper; obstacle_index says which. Each is as cprox_distance()
 *  gives
 *            it, signed where options say so.
 *            Every target that is not among them is at least nearest[last].upper - w away, w = max(epsilon,
 *            relative_epsilon * nearest[last].upper).
 *  count     receives their number.
 *
 *  Returns as cprox_distance(); the first status above CPROX_OK that a target gave is returned, and then the sentence
 *  about the rest holds with that target's own lower bound in place of it. On a negative status nothing is written.
 *  k >= 1. Cost: a bounding-ball test a target, and a search for those that the k-th best so far does not rule out. */
CPROX_API cprox_status cprox_nearest(cprox_mover mover, const cprox_obstacle *targets, size_t n, size_t k,
                                     const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                     size_t *count);

/** All targets that come within delta >= 0 [m].
 *
 *  near      room for n results; receives those with lower <= delta, in the order of the targets. verdict violated:
 *  upper <=
 *            delta, and then upper - lower <= epsilon. undecided: neither was proven.
 *            Every target that is not among them is farther than delta everywhere.
 *  count     receives their number.
 *
 *  Returns as cprox_nearest(). */
CPROX_API cprox_status cprox_within(cprox_mover mover, const cprox_obstacle *targets, size_t n, double delta,
                                    const cprox_options *options, cprox_workspace *workspace, cprox_result *near,
                                    size_t *count);

/** The pairs of a robot that come closest: of a geometry and a target (cprox_robot_along()), or of two geometries
 *  (cprox_robot_self(), n = 0). Which pairs are asked about says the mover.
 *
 *  k         at most so many, >= 1; the number of all pairs: a result for every pair.
 *  delta     [m] >= 0: only pairs that come within it; infinity: any.
 *  nearest   receives up to k results, ascending by upper; mover_part and obstacle_index say which pair. Each is as
 *            cprox_distance() gives it for that pair alone.
 *            Every pair that is not among them is farther than delta everywhere, or at least nearest[last].upper - w
 *            away, w = max(epsilon, relative_epsilon * nearest[last].upper).
 *  count     receives their number.
 *
 *  Returns as cprox_nearest(). Cost: a search a pair, which ends where the pair is out of query. */
CPROX_API cprox_status cprox_nearest_pairs(cprox_mover mover, const cprox_obstacle *targets, size_t n, size_t k,
                                           double delta, const cprox_options *options, cprox_workspace *workspace,
                                           cprox_result *nearest, size_t *count);

/** The clearance of the mover on one interval of its way. */
typedef struct cprox_profile_interval {
  double t0, t1; /**< the interval of the parameter */
  /** [m] lower <= min over [t0, t1] of the distance to the nearest target <= upper; infinity: no target */
  double lower, upper;
  double t;               /**< where in [t0, t1] upper was attained */
  int32_t obstacle_index; /**< which target that was; -1 for none */
  int32_t mover_part;     /**< of a robot: which geometry; else as in cprox_result */
} cprox_profile_interval;

/** The clearance profile: lower and upper clearance on each interval of a partition, for colouring a path and for
 *  planners.
 *
 *  breaks      n_intervals + 1 parameters, ascending, inside the mover's range.
 *  intervals   receives n_intervals of them, each to the accuracy that options ask for.
 *
 *  Returns as cprox_distance(); a status above CPROX_OK means that some interval is less accurate than asked, and all
 *  are true.
 *  CPROX_INVALID also where breaks do not ascend or leave the range. On a negative status nothing or some is
 *  written. */
CPROX_API cprox_status cprox_profile(cprox_mover mover, const cprox_obstacle *targets, size_t n, const double *breaks,
                                     size_t n_intervals, const cprox_options *options, cprox_workspace *workspace,
                                     cprox_profile_interval *intervals);

#ifdef __cplusplus
}
#endif
#endif
