/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of a robot where there are meshes. A mesh tells whether it is apart, and how far; its hull tells how
 * deep it overlaps at most. doc/robot-depth.md, Depth */
#ifndef CPROX_ROBOT_QUERY_ROBOT_DEPTH_H
#define CPROX_ROBOT_QUERY_ROBOT_DEPTH_H

#include "problem/problem.h"

/* Whether a signed query about these obstacles has meshes that may answer. */
bool robot_depth_has_meshes(const query *q, size_t first, size_t last);

/* Then it begins with the query of what is apart, without depths. */
query robot_depth_apart(const query *q);

/* Where there are no meshes, or a contact was found, depths are those of this query: by convex bodies and hulls. */
query robot_depth_hulls(const query *q);

/* Whether the first says all. */
static inline bool robot_depth_is_settled(const query *q, const cprox_result *apart) {
  return query_wants_verdict(q) || apart->lower > 0.0 || apart->status == CPROX_STOPPED;
}

/* *hulls becomes the answer of both: lower is that of the hulls. upper is what is proven of the meshes; the hulls' own
 * counts where their deepest pair has no mesh. Returns its status: CPROX_OVERLAP where how deep is not known. */
cprox_status robot_depth_join(const query *q, double cutoff, const cprox_result *apart, cprox_result *hulls);

#endif
