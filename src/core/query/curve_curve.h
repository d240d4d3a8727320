/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball that rides one curve against a ball that rides another, each at its own parameter. A node is a pair of
 * intervals. doc/curve-bound.md derives it. */
#ifndef CPROX_QUERY_CURVE_CURVE_H
#define CPROX_QUERY_CURVE_CURVE_H

#include "query/curve_side.h"

/* A point of either curve, how far apart they are, and the direction from the second to the first. */
typedef struct curve_meeting {
  vec3 point[2];
  size_t piece[2];
  double s[2];
  double distance; /* between the points */
  vec3 normal;     /* unit within 4 u; (0,0,0) where there is none */
} curve_meeting;

typedef struct curve_curve {
  /* the problem */
  curve_side side[2];
  double offset;         /* the sum of the two radii */
  uint32_t polish_after; /* nodes before Newton is allowed to look for better points */
  double good_enough;    /* an upper bound at or below this needs no polish */

  /* what is known */
  curve_meeting best;
  search_best best_bound;
  uint32_t incumbent; /* counts the best meetings; 0: none */
  vec3 last_normal;   /* of the last pair of chords */
  uint32_t probes, nodes;

  /* memory */
  cprox_workspace *workspace;
  points_pool pool;
} curve_curve;

/* Makes the oracle ready; false where memory is out. Both curves are seen from the frame of the second, which `placed` puts into
 * the world of the first, about the second's first control point. */
bool curve_curve_begin(curve_curve *o, const cprox_curve *first, const cprox_curve *second, const cprox_pose *placed,
                       double offset, cprox_workspace *workspace);

/* The node that is this part of the first curve and the whole second one. */
search_node curve_curve_root(const curve_curve *o, search_interval part);

/* The functions of the contract in search/search.h, self being the curve_curve. */
search_oracle curve_curve_oracle(curve_curve *o);

#endif
