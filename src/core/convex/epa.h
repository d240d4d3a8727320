/* SPDX-License-Identifier: BSD-3-Clause */
/* How deep 0 lies inside a convex set that is known by its support function: a polytope that expands from within, and
 * the planes that support the set from without (doc/convex-pairs.md). */
#ifndef CPROX_CONVEX_EPA_H
#define CPROX_CONVEX_EPA_H

#include "convex/simplex.h"

/* The set: its point farthest along the unit vector n; NaN in w ends the search. */
typedef struct epa_set {
  void *self;
  simplex_vertex (*farthest)(void *self, vec3 n);
} epa_set;

typedef struct epa_goal {
  double rounding; /* every w is within this of a point of the set, and every n·w of the set's maximum */
  double width;    /* how wide [least, most] may be, rounding not counted */
  bool rough;      /* or `most` may be four times `least` */
  uint32_t max_steps;
  int32_t room; /* for so many vertices, where that is more than a query needs: allocated, and none if memory is out */
  double shift; /* 0, or how large `shift` of the answer need be proven: the width is EPA_ALIKE / 20 of it at most */
} epa_goal;

/* least <= depth <= most, but for rounding. */
typedef struct epa_depth {
  double least, most;
  vec3 normal;   /* unit, outwards: the set reaches no farther than `most` along it */
  simplex touch; /* the facet that `least` was measured to, and the weights of its point nearest to 0 */
  bool exhausted;
  double shift; /* 0 may move by this much, and no way out farther than 2 EPA_ALIKE from the normal becomes the nearest;
                   0 where that was not asked for, or is not known */
  uint32_t steps;
} epa_depth;

/* Facets whose normals are no farther from that of the nearest are one with it. */
static const double EPA_ALIKE = 1e-3;

/* From a tetrahedron that encloses 0, or a triangle or an edge that 0 lies on. False where rounding hides that 0 is
 * enclosed: then nothing is set. */
bool epa_from(const epa_set *set, const simplex *start, const epa_goal *goal, epa_depth *depth);

/* The same from a simplex that encloses `shift` instead, whose w are relative to it: where 0 lies on faces that any
 * vertices span, a place beside it does not. False where the set does not reach farther than `shift` all round. */
bool epa_beside(const epa_set *set, const simplex *start, vec3 shift, const epa_goal *goal, epa_depth *depth);

/* For a set of two shapes of revolution about their own z, the second one's points at most `off` from where they would
 * be if its axis were the first one's: from scratch. */
bool epa_ring(const epa_set *set, double off, const epa_goal *goal, epa_depth *depth);

#endif
