/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball that rides a curve against a set that is known by its distance function alone.
 * doc/distance-functions.md derives it. */
#ifndef CPROX_CURVE_QUERY_CURVE_DISTANCE_H
#define CPROX_CURVE_QUERY_CURVE_DISTANCE_H

#include "branch_and_bound/search.h"
#include "curve/curve_side.h"
#include "shape/body.h"
#include "shape/distance_field.h"

/* A value, and where on the curve it was seen. */
typedef struct distance_sample {
  distance_value seen; /* in the body's frame */
  vec3 y;              /* the same place about the body's centre */
  size_t piece;
  double s;
} distance_sample;

typedef struct curve_distance {
  curve_side side; /* seen from the body's frame */
  const cprox_body *body;
  cprox_curve own[2]; /* where the body is on the mover's clock: the mover's curve, seen from there */
  double offset;      /* margin of the body + radius of the ball */
  double epsilon;
  bool left_to_right; /* the best sample is the leftmost within epsilon; while there is none, the nearest */
  distance_sample best, proven;
  search_best best_bound, proven_bound;
  bool found;
  uint32_t distance_queries;
  cprox_workspace *workspace;
  points_pool pool;
} curve_distance;

/* Makes the oracle ready; false where memory is out. The body stands in the frame; offset >= 0. */
bool curve_distance_begin(curve_distance *o, const cprox_curve *curve, const cprox_body *body, frame placed,
                          double offset, double epsilon, cprox_workspace *workspace);

/* Before a search for the time of contact. */
void curve_distance_begin_contact(curve_distance *o);

/* The node that is all that is asked about: side.part. */
search_node curve_distance_root(const curve_distance *o);
search_oracle curve_distance_oracle(curve_distance *o);

#endif
