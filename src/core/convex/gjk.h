/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest point of a convex core that is known by its support function alone: a vertex set or a callback. */
#ifndef CPROX_CONVEX_GJK_H
#define CPROX_CONVEX_GJK_H

#include "convex/convex.h"
#include "convex/simplex.h"

typedef struct gjk_answer {
  simplex feature; /* the vertices (relative to y) that the nearest point is made of */
  double
      distance;  /* to the core, attained by `point`; minus a proven depth inside; NaN where the callback misbehaved */
  vec3 point;    /* of the core; y itself inside */
  vec3 normal;   /* unit, from the core to y, the one with the best lower bound; (0,0,0) at distance 0 and inside */
  double height; /* the core's support function along it */
} gjk_answer;

/* The hint's vertices, if the shape has any, are where the search starts; the last ones are left in it. hint may be
 * NULL. */
void gjk_nearest(const convex *shape, vec3 y, convex_hint *hint, gjk_answer *answer);

#endif
