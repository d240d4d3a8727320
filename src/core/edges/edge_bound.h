/* SPDX-License-Identifier: BSD-3-Clause */
/* What one edge adds to the model: values in the middle, rates, bounds on accelerations, and what rounding may cost;
 * and what errors of an execution may cost. doc/robot-edges.md, doc/rounding.md, doc/robust.md */
#ifndef CPROX_EDGES_EDGE_BOUND_H
#define CPROX_EDGES_EDGE_BOUND_H

#include "edges/edge_model.h"
#include "kinematics/motion.h"
#include "problem/problem.h"

/* The intervals that a search begins with, and half of each by the edge's own parameter. */
enum { EDGE_LANES = 8 };
#define EDGE_ROOT_HALF (0.5f / (float)EDGE_LANES)

/* Polynomials have so many powers beyond the first. */
enum { EDGE_POWERS = MOTION_MAX_DEGREE - 1 };

/* A frame over the whole edge. Derivatives are by the edge's parameter in [0, 1]; the first six are of float: of the
 * frame's orientation, origin, rotation rate and velocity as lanes compute them. */
typedef struct edge_frame_bound {
  double turn_error, place_error, spin_error, speed_error;
  double reach, spin, speed; /* bounds on the origin's distance from the base, on the rotation rate, on its velocity */
  double rate, shift;        /* of its own variable: bounds on the rate, and of a shift on its length, */
  double second;             /* on the second derivative; */
  double value_error, rate_error; /* of float: what its value and its rate as lanes have them are off by */
  double bend;                    /* on the second derivatives of all turns up to here, together */
  double acceleration, turn;      /* of a point x of the frame: acceleration + turn |x| */
} edge_frame_bound;

/* Half of the same for lanes, which multiply it by the square of half an interval. */
typedef struct edge_half_bound {
  float acceleration, turn;
} edge_half_bound;

/* Of a query that has errors, over one edge. */
typedef struct edge_losses {
  float *still, *by_rate, *most; /* of each frame: it is off by still + by_rate times its rate by the edge's parameter,
                                    and by no more than `most` */
  float *slack;                  /* of each part: lever arms of its points are off by this, however lanes round [m] */
  float *standing, *pairs;       /* what a part may lose against what stands, and each pair, anywhere on the edge [m] */
  int32_t *axis_of;              /* of each frame; -1: the base */
  float base_origin[3];          /* seen from the base, as all coordinates */
  float base_rotation, object_rotation, places, flex; /* places: base, object and sensor together [m] */
  float object_reach, object_far; /* obstacles that end reach so far from their poses' positions; the others have these
                                     so far from the base */
} edge_losses;

typedef struct edge_motion {
  float *middle, *rate;       /* of each frame's variable */
  float *more, *more_rate;    /* powers from the second on, and their derivatives: EDGE_POWERS of each frame */
  size_t degree;              /* at most 1: those are all 0 */
  edge_frame_bound *bounds;   /* of each frame */
  edge_half_bound *frames;    /* of each frame as the base sees it, */
  edge_half_bound *relations; /* and as others do */
  float *room;                /* of each part: what rounding may cost a distance from it [m] */
  bool stands;                /* from = to */
  const edge_losses *losses;  /* by errors of an execution; NULL: there are none */
} edge_motion;

/* The bytes that an edge's arrays take, and the arrays in that memory. */
size_t edge_motion_size(const cprox_edge_checker *checker);
edge_motion edge_motion_in(const cprox_edge_checker *checker, char *memory);

/* All but the relations. False where the edge is beyond single precision. */
bool edge_motion_fill(const cprox_edge_checker *checker, const double *from, const double *to, edge_motion *motion);

/* The same of a part of one segment of a motion of one track, or of a state. The edge's parameter is 0 at over->a and 1
 * at over->b. */
bool edge_motion_fill_along(const cprox_edge_checker *checker, const cprox_motion *along, const motion_interval *over,
                            edge_motion *motion);

/* Segment k of an interval of many. */
static inline motion_interval edge_segment(const motion_interval *over, size_t k) {
  return (motion_interval){
      .a = k == over->first ? over->a : 0.0, .b = k + 1 == over->last ? over->b : 1.0, .first = k, .last = k + 1};
}

/* How far a part is from the base at most on the way. */
double edge_motion_reach(const cprox_edge_checker *checker, const edge_motion *motion, size_t part);

/* The relations, for pairs of parts. */
void edge_motion_relate(const cprox_edge_checker *checker, const edge_motion *motion);

/* The bytes that the arrays of losses take; what is the same of all edges, with the arrays in that memory. */
size_t edge_losses_size(const cprox_edge_checker *checker);
edge_losses edge_losses_in(const cprox_edge_checker *checker, const query *q, size_t first, size_t last, char *memory);

/* Those of a part of one segment of the motion; `edge` is filled from it. */
void edge_losses_over(const query *q, const cprox_edge_checker *checker, const motion_interval *over,
                      const edge_motion *edge, edge_losses *losses);

#endif
