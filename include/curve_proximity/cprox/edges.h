/* SPDX-License-Identifier: BSD-3-Clause */
/** Straight edges of a planner: may the robot go from one state to another?
 *
 *  Each verdict is proven for the whole edge, not for samples of it, and costs less than samples. What depends on the
 *  robot, the obstacles and the pairs alone is made once, in a handle. Source: doc/robot-edges.md. */
#ifndef CURVE_PROXIMITY_CPROX_EDGES_H
#define CURVE_PROXIMITY_CPROX_EDGES_H

#include <curve_proximity/cprox/obstacles.h>
#include <curve_proximity/cprox/robot.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What edges are asked. Set all members to 0, then those that are needed. */
typedef struct cprox_edge_query {
  /** what stands; NULL: nothing. Kept by reference */
  const cprox_obstacles *obstacles;
  /** pairs of geometries and obstacles; NULL: all geometries with all obstacles */
  const cprox_robot_pair *pairs;
  /** their number */
  size_t n_pairs;
  /** pairs of geometries; NULL: all on links with at least two joints between them that can move */
  const cprox_robot_pair *self_pairs;
  /** their number */
  size_t n_self_pairs;
  /** the robot is not held against itself */
  bool without_self;
  /** [m] >= 0: verdicts are about this distance; 0: collision */
  double delta;
  /** [m] >= 0: what the caller's numbers may be off by, in any distance. Clear is then proven beyond delta + rounding,
   *  and violated within delta - rounding, or 0 where that is negative: contact of the numbers as they are. What is
   *  nearer to delta is undecided. Costs nothing where lanes decide, and a second search where the search finds what is
   *  within delta + rounding only */
  double rounding;
  /** of an edge that is not clear, cprox_edge_result.t_free is wanted as late as can be proven. Such an edge costs a
   *  search for its time of contact. */
  bool first;
  /** for what the search must decide: epsilon, max_nodes, max_lod and stop functions count; NULL: the default */
  const cprox_options *options;
} cprox_edge_query;

/** A robot among obstacles, made ready for edges. Immutable: any number of threads may use it, each with its own
 *  workspace. */
typedef struct cprox_edge_checker cprox_edge_checker;

/** Makes a robot ready for edges.
 *
 *  robot    kept by reference, and so are its bodies; it must outlive the handle.
 *  asked    copied, but for the obstacles; NULL: all members 0.
 *  checker  receives the handle, owned by the caller: cprox_edge_checker_free(). Untouched on failure.
 *
 *  CPROX_INVALID where a pair names what is not there, or delta or rounding is negative or not finite; CPROX_MEMORY.
 *  Cost: a few microseconds an obstacle and geometry; convex bodies on links take up to some hundred nearest-point
 *  queries each. */
CPROX_API cprox_status cprox_edge_checker_create(const cprox_robot *robot, const cprox_edge_query *asked,
                                                 cprox_workspace *workspace, cprox_edge_checker **checker);

/** Frees a handle; NULL is allowed. No call may be using it. */
CPROX_API void cprox_edge_checker_free(cprox_edge_checker *checker);

/** What decided an edge. */
typedef enum cprox_edge_level {
  /** nothing did: the edge was refused, or there is nothing to ask about */
  CPROX_EDGE_NONE = 0,
  /** bounding spheres of whole geometries, in single precision */
  CPROX_EDGE_BALL = 1,
  /** the balls that cover each geometry, in single precision */
  CPROX_EDGE_COVER = 2,
  /** hulls of each geometry and of its pieces, along normals, in single precision */
  CPROX_EDGE_NORMAL = 3,
  /** one measurement in double precision of a pair that lanes left open, at one time: it proved contact */
  CPROX_EDGE_MEASUREMENT = 4,
  /** the search in double precision, for the pairs and the part of the edge that were left open */
  CPROX_EDGE_SEARCH = 5
} cprox_edge_level;

/** The answer about one edge. */
typedef struct cprox_edge_result {
  /** of the whole edge */
  cprox_verdict verdict;
  /** CPROX_OK, or as cprox_obstacles_tolerance() returns; CPROX_INVALID: a value is not finite, nothing is known of the
   *  edge, and the verdict is undecided */
  cprox_status status;
  /** the finest level that the answer needed */
  cprox_edge_level level;
  /** time intervals that were looked at in single precision */
  uint32_t intervals;
  /** nodes of the search */
  uint32_t nodes;
  /** violated: proven here, 0 at the start and 1 at the end of the edge; else NaN */
  double t;
  /** before this the edge is clear: 1 where all of it is, 0 where that is not known */
  double t_free;
  /** violated: by this geometry; else -1 */
  int32_t geometry;
  /** and this obstacle, or the number of obstacles plus the other geometry; else -1 */
  int32_t other;
  /** 0: room for later members */
  uint64_t reserved[2];
} cprox_edge_result;

/** Asks about n edges: from + t (to - from), t in [0, 1], of all variables of the robot.
 *
 *  from, to   n rows of n_variables values each. An edge with from = to is a state.
 *  workspace  not NULL. One a thread.
 *  verdicts   receives n values of cprox_verdict.
 *  results    receives n results, or NULL.
 *
 *  A row with a value that is not finite is refused alone: its verdict is undecided, its status CPROX_INVALID; all
 *  others are answered. Returns CPROX_OK, or the first status below it or the largest above it that an edge had.
 *
 *  Cost: some microseconds an edge. Memory: that of one edge whatever n is; edges that are left to the search allocate
 *  the motion of one edge at a time. Robots with floating joints or rotation vectors, and edges beyond single precision
 *  (a joint that turns by more than 64 rad or stands beyond 1e6 rad, coordinates beyond 1e6 m), go to the search as a
 *  whole: the level says so. */
CPROX_API cprox_status cprox_robot_edges(const cprox_edge_checker *checker, const double *from, const double *to,
                                         size_t n, cprox_workspace *workspace, uint8_t *verdicts,
                                         cprox_edge_result *results);

#ifdef __cplusplus
}
#endif
#endif
