/* SPDX-License-Identifier: BSD-3-Clause */
/** Continuous collision detection (CCD) of two primitives: a vertex and a triangle, or two edges, all of whose points
 *  move linearly. No body is made: a call takes four points at the start of a step and the same four at its end. */
#ifndef CURVE_PROXIMITY_CPROX_CCD_H
#define CURVE_PROXIMITY_CPROX_CCD_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The result of continuous collision detection of two primitives. */
typedef struct cprox_ccd {
  /** the same that the call returned */
  cprox_status status;
  /** clear: no contact at any t. violated: contact is proven. undecided: neither, which counts as unsafe */
  cprox_verdict verdict;
  /** certified: no contact at any t < t_contact_lower. 1 where the verdict is clear */
  double t_contact_lower;
  /** violated: contact is proven within [t_contact_lower, t]. Else: when the least distance that was measured occurs */
  double t;
  /** [m] certified: not above the least distance over the step, less the margin; 0 where contact is possible */
  double lower;
  /** [m] certified: not below the same; 0 where the verdict is violated */
  double upper;
  /** the nearest points at t, where the verdict is violated at t_contact_lower: weights >= 0 of the four points, to
   *  double accuracy. Vertex and face: 1 and the three weights of the face. Two edges: two weights of the first, two of
   *  the second. Each two or three sum to 1 */
  double weights[4];
  /** unit, from the face to the vertex, or from the second edge to the first, where the weights are; or 0 */
  cprox_vec3 normal;
  /** what it cost: times at which the distance was measured */
  uint32_t nodes;
} cprox_ccd;

/** When does a moving vertex first touch a moving triangle? Never late.
 *
 *  start    [m] the vertex, then the three corners of the triangle, at t = 0; each coordinate at most 1e60 in size
 *  end      [m] the same four points at t = 1. Each point moves along its segment: p(t) = (1 - t) start + t end
 *  margin   [m] >= 0: the minimum separation. Contact is a distance of at most margin; 0: a common point
 *  options  epsilon: contact is looked for from a distance of margin + epsilon on, and t_contact_lower is exact to it;
 *           max_nodes; the others are refused. NULL: the default
 *
 *  Rounding is inside all that is certified: the answer is that of the real motion of the points that were given.
 *  A triangle may be a segment or a point. Contact that ends with a touch, or within a plane that contains the path of
 *  the vertex, cannot be told from a near miss in double numbers where margin is 0: it is undecided.
 *
 *  Returns CPROX_OK        clear, violated, or undecided with a distance of at most margin + epsilon at t
 *          CPROX_BUDGET    max_nodes were not enough: what is certified holds
 *          CPROX_PRECISION double arithmetic cannot tell, and epsilon is narrower: likewise
 *          CPROX_INVALID   an argument is unusable; cprox_workspace_error() says which and why; *ccd is untouched
 *
 *  workspace: for the error message; NULL is allowed. Cost: a step that misses takes about 0.25 us (1 plane in the
 *  median), one that hits about 1 us (10 planes). No allocation.
 *  Source: conservative advancement (Mirtich 1996) by separating planes; the query is that of Wang et al. 2021, "A
 *  Large-scale Benchmark and an Inclusion-based Algorithm for Continuous Collision Detection". doc/convex-pairs.md. */
CPROX_API cprox_status cprox_ccd_vertex_face(const cprox_vec3 start[4], const cprox_vec3 end[4], double margin,
                                             const cprox_options *options, cprox_workspace *workspace, cprox_ccd *ccd);

/** When do two moving edges first touch? Never late.
 *
 *  start, end  [m] both ends of the first edge, then both ends of the second, at t = 0 and at t = 1
 *
 *  All else is as in cprox_ccd_vertex_face(). An edge may be a point. Parallel edges have a contact that is proven with
 *  a margin above 0 only. */
CPROX_API cprox_status cprox_ccd_edge_edge(const cprox_vec3 start[4], const cprox_vec3 end[4], double margin,
                                           const cprox_options *options, cprox_workspace *workspace, cprox_ccd *ccd);

#ifdef __cplusplus
}
#endif
#endif
