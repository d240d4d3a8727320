/* SPDX-License-Identifier: BSD-3-Clause */
/* What one edge adds to the model: values in the middle, rates, bounds on accelerations, and what rounding may cost.
 * doc/robot-edges.md, doc/rounding.md */
#ifndef CPROX_EDGES_EDGE_BOUND_H
#define CPROX_EDGES_EDGE_BOUND_H

#include "edges/edge_model.h"

/* The intervals that a search begins with, and half of each by the edge's own parameter. */
enum { EDGE_LANES = 8 };
#define EDGE_ROOT_HALF (0.5f / (float)EDGE_LANES)

/* A frame over the whole edge. Derivatives are by the edge's parameter in [0, 1]; the first six are of float: of the
 * frame's orientation, origin, rotation rate and velocity as lanes compute them. */
typedef struct edge_frame_bound {
  double turn_error, place_error, spin_error, speed_error;
  double reach, spin, speed; /* bounds on the origin's distance from the base, on the rotation rate, on its velocity */
  double rate, shift;        /* of its own variable: bounds on the rate, and of a shift on its length */
  double spin_rate;          /* on the rotation rate's derivative */
  double acceleration, turn; /* of a point x of the frame: acceleration + turn |x| */
} edge_frame_bound;

/* Half of the same for lanes, which multiply it by the square of half an interval. */
typedef struct edge_half_bound {
  float acceleration, turn;
} edge_half_bound;

typedef struct edge_motion {
  float *middle, *rate;       /* of each frame's variable */
  edge_frame_bound *bounds;   /* of each frame */
  edge_half_bound *frames;    /* of each frame as the base sees it, */
  edge_half_bound *relations; /* and as others do */
  float *room;                /* of each part: what rounding may cost a distance from it [m] */
  bool stands;                /* from = to */
} edge_motion;

/* The bytes that an edge's arrays take, and the arrays in that memory. */
size_t edge_motion_size(const cprox_edge_checker *checker);
edge_motion edge_motion_in(const cprox_edge_checker *checker, char *memory);

/* All but the relations. False where the edge is beyond single precision. */
bool edge_motion_fill(const cprox_edge_checker *checker, const double *from, const double *to, edge_motion *motion);

/* The relations, for pairs of parts. */
void edge_motion_relate(const cprox_edge_checker *checker, const edge_motion *motion);

#endif
