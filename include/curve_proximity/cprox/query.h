/* SPDX-License-Identifier: BSD-3-Clause */
/** The queries: distance, tolerance, collision of what moves against what stands; static pairs.
 *
 *  Every answer is an interval [lower, upper] that contains the true value, rounding included, or a verdict that
 *  follows from one. Numbers must be finite. Lengths, positions and accuracies are limited to 1e60 m, so that their
 *  powers stay finite. Other values return CPROX_INVALID with an error message. Any number of threads may ask at once,
 *  each with its own workspace. */
#ifndef CURVE_PROXIMITY_CPROX_QUERY_H
#define CURVE_PROXIMITY_CPROX_QUERY_H

#include <stdbool.h>

#include <curve_proximity/cprox/base.h>
#include <curve_proximity/cprox/body.h>
#include <curve_proximity/cprox/curve.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A body or a curve somewhere: a value. What it names is kept by reference. */
typedef struct cprox_obstacle {
  /** or NULL, for a curve */
  const cprox_body *body;
  /** The pose in the world. */
  cprox_pose pose;
  /** [m] >= 0: the set of all points within this of the body or curve */
  double margin;
  /** or NULL, for a body */
  const cprox_curve *curve;
  /** the curve is at the mover's own parameter, and carries the body if there is one */
  bool synchronized;
  /** of a curve at the mover's own parameter: as of cprox_mover, what it adds to the margin there; NULL: nothing */
  const cprox_curve *radius_curve;
} cprox_obstacle;

/** A body at a pose, without margin. */
CPROX_API cprox_obstacle cprox_obstacle_at(const cprox_body *body, cprox_pose pose);
/** The same obstacle with a margin >= 0 [m]. */
CPROX_API cprox_obstacle cprox_with_margin(cprox_obstacle obstacle, double margin);

/** A curve that stands where it was made, as thick as a ball of the radius that rides it: [m] >= 0, 0 for a line. The
 *  mover and the obstacle are each at any parameter of their own. Its pose may be changed like that of a body. Curves
 *  have no inside, so that two without radius that cross or touch are answered [0, upper] and undecided. */
CPROX_API cprox_obstacle cprox_obstacle_curve(const cprox_curve *curve, double radius);

struct cprox_motion;
struct cprox_robot_pair;

/** The kinds of moving objects. Each comment names the members of cprox_mover that the kind reads; all others are 0. */
typedef enum cprox_mover_kind {
  /** A ball that rides a curve, or a point where the radius is 0: curve, radius, radius_curve. cprox_point_along(),
   *  cprox_tube_along(). */
  CPROX_MOVER_BALL,
  /** A body that is carried along a curve without turning: curve, body, radius, radius_curve.
   *  cprox_body_along(). */
  CPROX_MOVER_BODY,
  /** A robot along a joint motion, against obstacles: motion, pairs, n_pairs. cprox_robot_along(), robot.h. */
  CPROX_MOVER_ROBOT,
  /** A robot along a joint motion, against itself: motion, pairs, n_pairs. cprox_robot_self(), robot.h. */
  CPROX_MOVER_ROBOT_SELF,
  /** A robot along a joint motion, against obstacles and itself at once: motion, pairs, n_pairs, self_pairs,
   *  n_self_pairs. cprox_robot_whole(), robot.h. */
  CPROX_MOVER_ROBOT_WHOLE
} cprox_mover_kind;

/** What moves: a value, made by one of the functions that cprox_mover_kind names. What it refers to is kept by
 *  reference. A query refuses members that do not belong to the kind. */
typedef struct cprox_mover {
  /** which members are read */
  cprox_mover_kind kind;
  /** the curve that a ball or a body follows */
  const cprox_curve *curve;
  /** [m] >= 0: of the ball; of a body its margin */
  double radius;
  /** the frame's origin is on the curve and its axes are those of the world; convex or a compound, no halfspace */
  const cprox_body *body;
  /** of a robot */
  const struct cprox_motion *motion;
  /** of a robot: the pairs to test, or NULL for all */
  const struct cprox_robot_pair *pairs;
  /** the number of pairs */
  size_t n_pairs;
  /** of CPROX_MOVER_ROBOT_WHOLE: its pairs with itself, or NULL for all */
  const struct cprox_robot_pair *self_pairs;
  /** the number of pairs with itself */
  size_t n_self_pairs;
  /** a radius that changes: at each parameter the x of this curve is added to radius [m]. It has the domain of `curve`,
   *  and the sum is 0 or more. NULL: nothing is added. Distances (signed or not), verdicts, profiles, the nearest
   *  obstacles, gradients, the time of contact and certificates take it, against all obstacles but curves that are
   *  known by their arc length alone. Violations and the nearest pairs refuse it. doc/curve-bound.md */
  const cprox_curve *radius_curve;
} cprox_mover;

/** A point along a curve. */
CPROX_API cprox_mover cprox_point_along(const cprox_curve *curve);
/** A ball of the radius >= 0 [m] along a curve. */
CPROX_API cprox_mover cprox_tube_along(const cprox_curve *curve, double radius);

/** A body that is carried along the curve without turning. Every query answers for it: the curve of its origin is held
 *  against the Minkowski difference of the obstacle and the body, doc/curve-bound.md. */
CPROX_API cprox_mover cprox_body_along(const cprox_body *body, const cprox_curve *curve);

/** Another mover on the clock of the mover asked about: both are at the same parameter, so that they may cross each
 *  other's way at different times. Both curves must have the same domain, else CPROX_INVALID. Either may carry a ball
 *  or a body. The pose that the obstacle is given, identity at first, moves the other's curve and turns its body with
 *  it. */
CPROX_API cprox_obstacle cprox_synchronized(cprox_mover other);

/** What a query can leave behind as proof: see certificate.h. */
typedef struct cprox_certificate cprox_certificate;

/** What is proven about a clearance limit: Δ of a tolerance, 0 of a collision. One polarity for every query. */
typedef enum cprox_verdict {
  /** farther than the limit everywhere */
  CPROX_VERDICT_CLEAR = 0,
  /** a point at most as far as the limit; for a collision a common point */
  CPROX_VERDICT_VIOLATED = 1,
  /** neither is proven: count it as unsafe */
  CPROX_VERDICT_UNDECIDED = 2
} cprox_verdict;

/** "clear", "violated", "undecided". Never NULL. */
CPROX_API const char *cprox_verdict_name(cprox_verdict verdict);

/** The models of a body, from coarse to fine; in a result, the finest one that the answer needed. */
typedef enum cprox_lod { CPROX_LOD_NONE = 0, CPROX_LOD_SPHERE = 1, CPROX_LOD_HULL = 2, CPROX_LOD_MESH = 3 } cprox_lod;

/** "none", "sphere", "hull", "mesh". Convex bodies are their own hull. */
CPROX_API const char *cprox_lod_name(cprox_lod lod);

/** Where a search of a pair of bodies ended, for the next search of the same two bodies, a little moved. Zeros: nothing
 *  is known. It changes what the answer costs, and within its interval the answer, but not what holds of it. */
typedef struct cprox_pair_start {
  /** the members below are those of a former answer */
  bool usable;
  /** [m] in the frame of a, without its margin */
  cprox_vec3 point_a;
  /** [m] in the frame of b, without its margin */
  cprox_vec3 point_b;
  /** unit, in the frame of a, from b to a */
  cprox_vec3 normal;
  /** [m] between the two points; 0 where they overlapped */
  double distance;
  /** [m] either body may move by this much, and no way out whose normal is farther than 2e-3 rad from this one becomes
   *  the nearest; 0: not known, or more than one. Of convex bodies that are apart without margins
   *  (a sphere's and a capsule's radius is one) it is how far, and the normal turns without a jump. Not read. */
  double shift;
  /** 0 … 3: of boxes and polytopes, the vertices between which the nearest points lie */
  int32_t n_vertices;
  /** numbers of vertices of a */
  int32_t vertices_a[3];
  /** numbers of vertices of b */
  int32_t vertices_b[3];
} cprox_pair_start;

/** How a query is to be answered. Start from CPROX_OPTIONS_DEFAULT, which sets the size.
 *
 *  Every query has epsilon and max_nodes. An option that is set and does not apply to the query is refused:
 *  CPROX_INVALID, and the reason names the option. What applies:
 *
 *    query                                     relative_epsilon  stop  max_lod  certificate  signed_distance
 *    distance                                  yes               yes   yes       yes          yes
 *    tolerance, collision                      yes               yes   yes       yes          no
 *    time of contact                             no                yes   yes       no           no
 *    nearest, within, profile, gradient, rows  yes               yes   yes       no           yes
 *    nearest pairs of a robot                  yes               yes   yes       no           no
 *    CPROX_INDEX_BVH, and batches              as above, but no certificate
 *    pair                                      yes               yes   yes       no           yes: always signed
 *    translating distance                      yes               no    no        no           no
 *    translating contact, growth distance      no                yes   no        no           no
 *    certificate for an answer                 yes               no    yes       no           no
 *
 *  Of pairs alone: start. Of robots alone: interval goes with distance, tolerance, collision and time of contact; share
 * with distance. */
typedef struct cprox_options {
  /** sizeof(cprox_options), as CPROX_OPTIONS_DEFAULT sets it; any other size is refused */
  size_t size;
  /** [m] width of the interval asked for, 0 … 1e60; 0 asks for the narrowest one that double arithmetic allows, and
   *  the status says precision. Default 1e-6 */
  double epsilon;
  /** the interval may also be this fraction of upper wide; 0 … 1e60, default 0 */
  double relative_epsilon;
  /** budget of work for each result; >= 1, default 500000, which is about a second. One unit is what a distance query
   *  (a narrowphase call) costs, 1 to 2 microseconds. Each of these counts as one: a parameter interval examined, a
   *  distance query, of robots a plane or 16 balls tested over an interval, of cprox_pair() an iteration or a node of a
   *  BVH. So nodes and distance_queries of the result add up to at most max_nodes, but for what the last interval
   *  needed. The first interval is always examined. A result is the union over all obstacles, or where a query answers
   *  for each obstacle, pair or interval the answer for one of them; violations are one result */
  uint32_t max_nodes;
  /** polled at least once in 64 units of max_nodes (0.1 ms); true ends the query with CPROX_STOPPED. NULL: never */
  bool (*stop)(void *user);
  /** handed to stop */
  void *stop_user;
  /** receives the proof of the answer, against all obstacles at once; NULL: none. For a distance the claim is that of
   *  lower, or where lower is 0 that of upper. It changes nothing in the answer; it is empty where there is no proof,
   *  and the reason in the workspace says why */
  cprox_certificate *certificate;
  /** distance: where they overlap, the answer is minus the depth of the deepest overlap along the curve: the shortest
   *  way by which the mover, there, could leave the obstacle (a part of it, for compounds). Curves have no inside
   *  beyond their radius. Meshes, points and octrees have no depth: the status is CPROX_OVERLAP and lower is a bound. A
   *  hull raises lower to its own depth; where both agree to epsilon the status is CPROX_OK. Robots: meshes that are
   *  apart are measured; of those that overlap lower, witness points and gradient are those of the hulls, and lod says
   *  so; points, octrees and meshes without a hull are refused. Default false: distances are 0 at least */
  bool signed_distance;
  /** the finest model of obstacles that may answer, CPROX_LOD_MESH (or NONE): any. HULL: convex hulls
   *  replace level-of-detail bodies. SPHERE: bounding spheres replace all bodies except points, octrees and halfspaces.
   *  A coarser model contains the body: lower and clear hold for the body itself as well, but upper, the witness
   *  points and violated are the model's */
  cprox_lod max_lod;
  /** robots: NULL for the whole motion, or two times [s], begin < end, within its domain: distance, tolerance,
   *  collision, contact, nearest pairs and violations are then asked of this interval alone, without certificate */
  const double *interval;
  /** robots, distance: shares the upper bound between queries that split one problem by intervals or pairs. Called at
   *  each node with this query's upper bound (infinity while it has none); returns the minimum over all queries. A
   *  query looks no closer than that: its lower is near its own upper, or at most a width below the least one. NULL: a
   *  query of its own. Calls come from the thread that asks; parallel.hpp uses it
   */
  double (*share)(void *user, double upper);
  /** handed to share */
  void *share_user;
  /** a pair of convex bodies: read before the search and written after it, so that the nearest points are tracked over
   *  a motion from call to call. NULL: each search begins from scratch */
  cprox_pair_start *start;
} cprox_options;

/** The default of all options. */
#define CPROX_OPTIONS_DEFAULT                                                                                          \
  (CPROX_VALUE(cprox_options){sizeof(cprox_options), 1e-6, 0.0, 500000, NULL, NULL, NULL, false, CPROX_LOD_MESH, NULL, \
                              NULL, NULL, NULL})

/** The result of a query. */
typedef struct cprox_result {
  /** the same that the call returned */
  cprox_status status;
  /** clear: farther than delta everywhere, of a collision farther than 0; violated: a point at most delta away, of a
   *  collision a common point, is proven; undecided: neither, which counts as unsafe. Of a distance: undecided */
  cprox_verdict verdict;
  /** [m] certified: lower <= true value <= upper. upper = infinity where bounding spheres (in batches also boxes) alone
   *  decided a verdict: then there is no witness, and obstacle_index is -1 */
  double lower;
  /** [m] certified: not below the true value. */
  double upper;
  /** where on the mover's curve, or when [s] in a robot's motion, upper was attained; no meaning where upper is
   *  infinite. It is a double: the distance at t itself may be above upper by what moves within a rounding of t (at
   *  times of 1.7e9 s 2.4e-7 s), so measure times from the beginning of a fast motion. Where a curve goes through a
   *  surface (upper 0) it may be above by the error of cprox_curve_get_info(), too: it meets it near t */
  double t;
  /** where on an obstacle that is a curve; NaN for bodies */
  double t_obstacle;
  /** [m] world frame, the two points that attain upper (surfaces, radius and margin included); equal where they
   *  overlap, and either end of the way out for signed distances */
  cprox_vec3 witness_mover;
  /** [m] the witness point on the obstacle, world frame. */
  cprox_vec3 witness_obstacle;
  /** unit, world frame, from obstacle to mover; (0,0,0) where there is none */
  cprox_vec3 normal;
  /** which obstacle (of a list also one that was not measured, upper is infinite then); which other geometry, where a
   * robot is asked about itself; of CPROX_MOVER_ROBOT_WHOLE the number of obstacles and that of the other geometry
   * added up; -1 for none */
  int32_t obstacle_index;
  /** which part of a compound; 0 otherwise */
  int32_t obstacle_part;
  /** which part of a carried compound; which geometry of a robot, -1 for none; 0 otherwise */
  int32_t mover_part;
  /** The finest level of detail that the result needed. */
  cprox_lod lod;
  /** what it cost: parameter intervals examined */
  uint32_t nodes;
  /** what it cost: nearest-point queries */
  uint32_t distance_queries;
  /** time of contact: no contact at any smaller parameter; other queries: 0 */
  double t_contact_lower;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[4];
} cprox_result;

/** Distance between what moves and what stands, over the mover's whole parameter range.
 *
 *  result->lower <= min over t of dist(mover(t), obstacle) <= result->upper, in metres; 0 where they touch or overlap.
 *  Rounding is inside the interval.
 *
 *  Returns CPROX_OK        upper - lower <= max(epsilon, relative_epsilon * upper)
 *          CPROX_BUDGET    max_nodes were not enough: the interval is true, only wider
 *          CPROX_PRECISION epsilon is below what double arithmetic can promise at this scale: likewise
 *          CPROX_INEXACT epsilon is below the stated error of a distance function, or that of a grid's interpolation:
 *          likewise
 *          CPROX_STOPPED   options->stop said so: likewise
 *          CPROX_INVALID   an argument is unusable; cprox_workspace_error() says which and why; *result is untouched
 *          CPROX_MEMORY    likewise
 *
 *  options NULL: the default. Cost: a few nearest-point queries and control-point sweeps; no allocation once the
 *  workspace has grown.
 *  Source: Lakshmanan et al. 2019, Algorithms 1 and 2, with the bounds of doc/curve-bound.md.
 */
CPROX_API cprox_status cprox_distance(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                      cprox_workspace *workspace, cprox_result *result);

/** Is the mover farther than delta from the obstacle everywhere? delta >= 0 [m].
 *
 *  verdict clear: lower > delta. violated: upper <= delta. undecided: the distance is within epsilon of delta, or the
 *  budget was too small. The interval is true, but only as narrow as the verdict needed. Returns as cprox_distance().
 *  Source: Lakshmanan et al. 2019, Algorithm 3. */
CPROX_API cprox_status cprox_tolerance(cprox_mover mover, cprox_obstacle obstacle, double delta,
                                       const cprox_options *options, cprox_workspace *workspace, cprox_result *result);

/** Do mover and obstacle touch or overlap anywhere?
 *
 *  verdict clear: lower > 0. violated: a common point is proven. undecided: closer than epsilon, neither is proven.
 *  Returns as cprox_distance().
 *  Source: Lakshmanan et al. 2019, Algorithm 4. */
CPROX_API cprox_status cprox_collision(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                       cprox_workspace *workspace, cprox_result *result);

/** Where, along its parameter, does the mover first touch the obstacle? Never late.
 *
 *  t_contact_lower  no contact at any t < t_contact_lower, certified and rounded down. The distance there is at most
 *                   epsilon, or it is the end of the range.
 *  verdict          violated: a common point is proven, the time of contact lies in [t_contact_lower, t]. Where a point
 *                   goes through a flat body or a triangle, the witness points are where they meet, and t is when they
 *                   certainly have met: later by what rounding hides.
 *                   clear: they do not touch at all, lower > 0.
 *                   undecided: closer than epsilon at t, the earliest such place that was measured; contact is not
 *                   proven anywhere.
 *  lower, upper     of the distance over the whole range, as in cprox_collision(). upper is the distance of the two
 *                   witness points at t: 0 for violated, at most epsilon for undecided.
 *
 *  A ball round the obstacle that is not to be entered is its margin. Returns as cprox_distance(); after CPROX_BUDGET,
 *  CPROX_STOPPED, CPROX_PRECISION and CPROX_INEXACT t_contact_lower is true, but may lie before the place where the
 *  distance is epsilon. relative_epsilon is refused. Source: doc/time-of-contact.md. */
CPROX_API cprox_status cprox_time_of_contact(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_result *result);

/** Signed distance of two standing bodies.
 *
 *  Apart: lower <= distance <= upper, both witness points, the normal from b to a, CPROX_OK.
 *  Overlapping: the same, both bounds negative, minus the penetration depth: the shortest way by which a can leave b,
 *  along the normal; witness_mover and witness_obstacle are the ends of that way, on either surface. How deep two
 *  implicit bodies without a support function of closed form overlap may stay open: then lower <= minus the depth,
 *  upper = 0, CPROX_OVERLAP. Meshes, points and boxes are held against convex bodies and each other; how deep they
 *  overlap is not measured: CPROX_OVERLAP. Of two of these the order does not matter, a looser epsilon never costs
 *  more, and after CPROX_BUDGET or CPROX_STOPPED lower is at least minus the margins, but for solids and boxes that are
 *  not proven apart. A compound answers with the least over its parts. witness_mover is the point on a,
 *  witness_obstacle that on b; nodes counts iterations (of meshes, points and boxes nodes of their trees, too),
 *  distance queries support evaluations. stop is asked between parts and in searches through two meshes.
 *  CPROX_INVALID for two halfspaces (they have no distance), for a curve, and for arguments that are unusable.
 *  Cost: a few support evaluations; no allocation.
 *  Source: doc/convex-pairs.md.
 */
CPROX_API cprox_status cprox_pair(cprox_obstacle a, cprox_obstacle b, const cprox_options *options,
                                  cprox_workspace *workspace, cprox_result *result);

/** Are two standing bodies farther apart than delta? delta >= 0 [m]; 0: do they touch or overlap?
 *
 *  verdict clear: lower > delta; the search ends at the first direction that proves it. violated: upper <= delta; it
 *  ends at the first two points that prove it, or where the bodies have a point in common (upper is 0 then, and both
 *  witness points are that one). undecided: the distance is within epsilon of delta, or the budget was too small. How
 *  deep bodies overlap is not measured: lower <= 0 bounds the signed distance of cprox_pair(). upper = infinity where
 *  bounding spheres or boxes alone proved the bodies clear: then there is no witness, and the points are NaN.
 *  Bodies as for cprox_pair(); options too, but for start and signed_distance, which are refused.
 *  Returns as cprox_distance(). Cost: at most about that of cprox_pair(); bodies far apart: one look at their balls. */
CPROX_API cprox_status cprox_pair_tolerance(cprox_obstacle a, cprox_obstacle b, double delta,
                                            const cprox_options *options, cprox_workspace *workspace,
                                            cprox_result *result);

#ifdef __cplusplus
}
#endif
#endif
