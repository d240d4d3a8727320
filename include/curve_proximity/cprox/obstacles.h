/* SPDX-License-Identifier: BSD-3-Clause */
/** Many obstacles behind one handle, and the queries against them.
 *
 *  The handle is a list, with an index where one is asked for. Its queries answer against the union of the obstacles,
 *  for curves and robots alike. A handle is immutable; any number of threads may use it at once, each with its own
 *  workspace. `obstacles` may be NULL in every query: then there are none, as for a robot against itself
 *  (cprox_robot_self()). */
#ifndef CURVE_PROXIMITY_CPROX_OBSTACLES_H
#define CURVE_PROXIMITY_CPROX_OBSTACLES_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Obstacles, with their index. */
typedef struct cprox_obstacles cprox_obstacles;

/** How the obstacles are found. The index changes the cost, never the guarantees; the digits may differ. */
typedef enum cprox_obstacle_index {
  /** A list: each obstacle is tested by its bounding sphere, nearest first. Cost: a copy of the list. */
  CPROX_INDEX_NONE,
  /** A BVH over the boxes of the obstacles: only nearby obstacles are tested exactly. For distance, tolerance,
   *  collision, time of contact and nearest; other queries go by the list. Obstacles without bounds (halfspaces) and
   *  those on the clock of the mover are tested every time. Cost: n log n, and 6 support values an obstacle. */
  CPROX_INDEX_BVH,
  /** Spheres and boxes in SIMD packets, for cprox_obstacles_distance_batch() and its like. Queries of one mover go by
   *  the list. Cost: about fifty nearest-point queries for each convex part. */
  CPROX_INDEX_BATCH
} cprox_obstacle_index;

/** A handle for n >= 0 obstacles.
 *
 *  list       copied; the bodies and curves that it names are kept by reference and must outlive the handle.
 *  obstacles  receives the handle, owned by the caller: cprox_obstacles_free(). Untouched on failure.
 *
 *  CPROX_INVALID where an obstacle is unusable, with its number in the error message; CPROX_MEMORY. */
CPROX_API cprox_status cprox_obstacles_create(const cprox_obstacle *list, size_t n, cprox_obstacle_index index,
                                              cprox_workspace *workspace, cprox_obstacles **obstacles);

/** Frees a handle; NULL is allowed. No query may be using it. */
CPROX_API void cprox_obstacles_free(cprox_obstacles *obstacles);

/** What is known of obstacles. */
typedef struct cprox_obstacles_info {
  /** their number */
  size_t n;
  /** the index that the handle was created with */
  cprox_obstacle_index index;
} cprox_obstacles_info;

/** What is known of obstacles; of NULL: none, by a list. */
CPROX_API cprox_obstacles_info cprox_obstacles_get_info(const cprox_obstacles *obstacles);

/** Distance, tolerance and collision against the union of the obstacles, as cprox_distance(), cprox_tolerance() and
 *  cprox_collision() answer for one.
 *
 *  result    obstacle_index counts as the list was given. Without obstacles: CPROX_OK, lower = upper = infinity,
 *            obstacle_index -1.
 *  each      NULL if not needed; else one result an obstacle, each to the accuracy asked. It makes the query go by the
 *            list and test every obstacle. Without `each` obstacles that cannot be the nearest are skipped.
 *
 *  CPROX_INVALID where options ask for a certificate and the index is CPROX_INDEX_BVH. */
CPROX_API cprox_status cprox_obstacles_distance(const cprox_obstacles *obstacles, cprox_mover mover,
                                                const cprox_options *options, cprox_workspace *workspace,
                                                cprox_result *result, cprox_result *each);
/** As cprox_obstacles_distance(): are all obstacles farther than delta everywhere? delta >= 0 [m]. */
CPROX_API cprox_status cprox_obstacles_tolerance(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                                 const cprox_options *options, cprox_workspace *workspace,
                                                 cprox_result *result, cprox_result *each);
/** As cprox_obstacles_distance(): does the mover touch or overlap an obstacle anywhere? */
CPROX_API cprox_status cprox_obstacles_collision(const cprox_obstacles *obstacles, cprox_mover mover,
                                                 const cprox_options *options, cprox_workspace *workspace,
                                                 cprox_result *result, cprox_result *each);

/** The time of contact with any of the obstacles, as cprox_time_of_contact() answers for one. */
CPROX_API cprox_status cprox_obstacles_time_of_contact(const cprox_obstacles *obstacles, cprox_mover mover,
                                                       const cprox_options *options, cprox_workspace *workspace,
                                                       cprox_result *result);

/** What a query that lists results tells of its list. */
typedef struct cprox_listed {
  /** so many results were written */
  size_t count;
  /** [m] everything that is not among them is at least so far away; infinity: nothing was left out. Where a search was
   *  stopped or ran out of its budget this is less than the limit of the list, and the list may not be complete */
  double others;
} cprox_listed;

/** The k obstacles that come closest.
 *
 *  k         >= 1.
 *  nearest   receives min(k, n) results, ascending by upper; obstacle_index says which. Each is as cprox_distance()
 *  gives
 *            it, signed where options say so.
 *            Every obstacle that is not among them is at least nearest[last].upper - w away, w = max(epsilon,
 *            relative_epsilon * nearest[last].upper).
 *            Of one that was not measured, since the search was stopped, upper is infinity.
 *  listed    receives their number, and a bound of all others.
 *
 *  Returns as cprox_distance(). The first status above CPROX_OK that an obstacle gave is returned; then of the rest
 * only listed->others is proven. On a negative status nothing is written. Cost: a bounding-sphere test an obstacle, and
 * a search for those that the k-th best so far does not rule out. */
CPROX_API cprox_status cprox_obstacles_nearest(const cprox_obstacles *obstacles, cprox_mover mover, size_t k,
                                               const cprox_options *options, cprox_workspace *workspace,
                                               cprox_result *nearest, cprox_listed *listed);

/** All obstacles that come within delta >= 0 [m].
 *
 *  near      room for n results; receives those with lower <= delta, in the order of the list. Verdict violated:
 *            upper <= delta, and then upper - lower <= epsilon. undecided: neither was proven.
 *            Every obstacle that is not among them is farther than delta everywhere, unless CPROX_STOPPED is returned.
 *  listed    receives their number, and a bound of all others.
 *
 *  Returns as cprox_obstacles_nearest(). */
CPROX_API cprox_status cprox_obstacles_within(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                              const cprox_options *options, cprox_workspace *workspace,
                                              cprox_result *near, cprox_listed *listed);

/** The pairs of a robot that come closest: of a geometry and an obstacle (cprox_robot_along()), or of two geometries
 *  (cprox_robot_self(), obstacles NULL). The mover selects the pairs.
 *
 *  k         at most so many, >= 1; the number of all pairs: a result for every pair.
 *  delta     [m] >= 0: only pairs that come within it; infinity: any.
 *  nearest   receives up to k results, ascending by upper; mover_part and obstacle_index say which pair. Each is as
 *            cprox_distance() gives it for that pair alone.
 *            Every pair that is not among them is farther than delta everywhere, or at least nearest[last].upper - w
 *            away, w = max(epsilon, relative_epsilon * nearest[last].upper).
 *  listed    receives their number, and a bound of all others.
 *
 *  Returns as cprox_obstacles_nearest(). Cost: a look at the boxes of all pairs; a search for each of those that are
 *  likely to be among them, which ends as soon as the pair cannot be; one search for all others together. */
CPROX_API cprox_status cprox_obstacles_nearest_pairs(const cprox_obstacles *obstacles, cprox_mover mover, size_t k,
                                                     double delta, const cprox_options *options,
                                                     cprox_workspace *workspace, cprox_result *nearest,
                                                     cprox_listed *listed);

/** The clearance of the mover on one interval of its parameter. */
typedef struct cprox_profile_interval {
  /** the start of the interval */
  double t0;
  /** the end of the interval */
  double t1;
  /** [m] lower <= min over [t0, t1] of the distance to the nearest obstacle <= upper; infinity: no obstacle */
  double lower;
  /** [m] and at most this. */
  double upper;
  /** where in [t0, t1] upper was attained, rounded as t of cprox_result is */
  double t;
  /** which obstacle that was; -1 for none */
  int32_t obstacle_index;
  /** of a robot: which geometry; else as in cprox_result */
  int32_t mover_part;
  /** [m] world frame, the two points that attain upper, as in cprox_result; (0,0,0) where there is none */
  cprox_vec3 witness_mover;
  /** [m] the witness point on the obstacle */
  cprox_vec3 witness_obstacle;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_profile_interval;

/** The clearance profile: lower and upper clearance on each interval of a partition, for colouring a path and for
 *  planners.
 *
 *  breaks      n_intervals + 1 parameters, ascending, inside the range of the mover.
 *  horizon     [m] >= 0: clearance beyond it is only bounded, not measured; infinity: all is measured.
 *  intervals   receives n_intervals of them, each to the accuracy that options ask for, or with lower > horizon; there
 *              upper is what was measured on the way, infinity where nothing was.
 *
 *  Returns as cprox_distance(); a status above CPROX_OK means that some interval is less accurate than asked, and all
 *  are true. CPROX_INVALID also where breaks do not ascend or leave the range. On a negative status nothing or some is
 *  written. */
CPROX_API cprox_status cprox_obstacles_profile(const cprox_obstacles *obstacles, cprox_mover mover,
                                               const double *breaks, size_t n_intervals, double horizon,
                                               const cprox_options *options, cprox_workspace *workspace,
                                               cprox_profile_interval *intervals);

/** An interval of the mover's parameter in which it is within delta of an obstacle. */
typedef struct cprox_violation {
  /** farther than delta before: from leave_upper of the violation before, or from the beginning */
  double enter_lower;
  /** violated: at most delta away from here … */
  double enter_upper;
  /** … to here, everywhere; where only one place is proven, both are that place */
  double leave_lower;
  /** farther than delta after: up to enter_lower of the next violation, or to the end */
  double leave_upper;
  /** VIOLATED: proven on [enter_upper, leave_lower]. UNDECIDED: nothing is proven; then enter_upper and leave_lower are
   *  the ends of the other side */
  cprox_verdict verdict;
  /** [m] the least distance that was measured in it, */
  double upper;
  /** there, rounded as t of cprox_result is, */
  double t;
  /** from this obstacle, as in cprox_result; */
  int32_t obstacle_index;
  /** of a robot: by this geometry; else as in cprox_result */
  int32_t mover_part;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_violation;

/** Room for violations, and how many there are. */
typedef struct cprox_violations {
  /** `room` of them, of the caller */
  cprox_violation *list;
  /** at least 1 */
  size_t room;
  /** receives how many of them are written, in the order of the parameter */
  size_t count;
} cprox_violations;

/** All intervals of the parameter in which the mover is at most delta [m] from an obstacle: when does it enter, when
 *  does it leave? Outside of them it is proven to be farther; from enter_upper to leave_lower it is proven not to be.
 *
 *  resolution  in units of the parameter, > 0: each end of a violation is at most so wide. Wider ends stay where the
 *              distance hardly changes: it runs along delta, or epsilon does not tell it from delta. So does what lies
 *              between two violations that may be one: then leave_upper is the next one's enter_upper.
 *
 *  Robots and movers with overlaps: delta > 0, as a distance of 0 does not say how deep; with delta = 0 single places
 *  are proven. Convex bodies along curves: with options.signed_distance. Beside a synchronized obstacle likewise only
 *  single places are.
 *
 *  Returns CPROX_OK; CPROX_BUDGET: there was no room for all, or options.max_nodes was not enough for all searches
 *  together, and CPROX_STOPPED: the last violation goes on to the end of what was asked, all else is true; a negative
 *  status as cprox_distance(). Of robots options.interval applies. Cost: two searches for each halving towards an end.
 *  Source: doc/time-of-contact.md, Enter and leave. */
CPROX_API cprox_status cprox_obstacles_violations(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                                  double resolution, const cprox_options *options,
                                                  cprox_workspace *workspace, cprox_violations *violations);

/** Distance of movers first … last - 1 from the union of the obstacles. Threads may answer ranges of the same movers,
 *  each with its own workspace. Each answer depends on its mover alone: results are the same for every split into
 *  ranges, every number of threads and every instruction set.
 *
 *  obstacles made with CPROX_INDEX_BATCH, else CPROX_INVALID.
 *  movers    at least `last` of them; first <= last.
 *  options   NULL: the default. A certificate is refused: ask the query of one mover for it.
 *  results   results[i] receives what cprox_obstacles_distance() answers for movers[i]: the same guarantees, not the
 *            same digits. Signed distances are searched one mover at a time.
 *            The others are untouched. nodes and distance queries are 0 where spheres and boxes round the parts settled
 *            it.
 *
 *  A mover that is unusable fails alone: its result has the negative status and the interval [0, infinity], all others
 *  are answered. Returns the first negative status, else the largest; the error message names the first mover that it
 *  belongs to. Where obstacles, movers, results, options or the range are unusable: CPROX_INVALID, and nothing is
 *  written. Source: doc/batches.md. */
CPROX_API cprox_status cprox_obstacles_distance_batch(const cprox_obstacles *obstacles, const cprox_mover *movers,
                                                      size_t first, size_t last, const cprox_options *options,
                                                      cprox_workspace *workspace, cprox_result *results);

/** The same for cprox_obstacles_tolerance(), and at delta = 0 for cprox_obstacles_collision(). delta >= 0 [m]. */
CPROX_API cprox_status cprox_obstacles_tolerance_batch(const cprox_obstacles *obstacles, const cprox_mover *movers,
                                                       size_t first, size_t last, double delta,
                                                       const cprox_options *options, cprox_workspace *workspace,
                                                       cprox_result *results);

#ifdef __cplusplus
}
#endif
#endif
