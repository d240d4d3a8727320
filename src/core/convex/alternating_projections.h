/* SPDX-License-Identifier: BSD-3-Clause */
/* Two cores that know their projections: alternating projections, sped up by Newton's method on the pieces of the
 * surfaces that they land on (doc/convex-pairs.md). */
#ifndef CPROX_CONVEX_ALTERNATING_PROJECTIONS_H
#define CPROX_CONVEX_ALTERNATING_PROJECTIONS_H

#include "convex/pair.h"
#include "convex/simplex.h"

typedef struct alternating_task {
  const convex *a, *b;
  const double *r; /* b stands at r x_b + t in a's frame */
  vec3 t;
  const pair_goal *goal;
  double margins, rounding;
  double contact_tolerance; /* cores nearer than this are left to others */
  pair_feature *feature;    /* set where the projections get as close as the goal asks; NULL: not wanted */
} alternating_task;

typedef struct alternating_answer {
  bool reached;        /* the bounds are as close as the goal asks */
  bool met;            /* the projections found a point of both cores within the contact tolerance */
  simplex_vertex pair; /* w = a - b the shortest so far, of a point of each core */
  double distance;     /* |w| */
  vec3 u;              /* the best direction, and its phi; (0,0,0) and -infinity where none was tried */
  double lower;
  uint32_t looks; /* directions that were tried */
  bool described; /* the feature is set */
} alternating_answer;

/* By projections: both cores have ops->project. */
void alternating_search(const alternating_task *task, alternating_answer *answer);

/* By Newton's method on phi alone, from u on: both cores are smooth. */
void alternating_smooth(const alternating_task *task, vec3 u, alternating_answer *answer);

#endif
