/* SPDX-License-Identifier: BSD-3-Clause */
/* The oracle of a ball that rides a curve against one convex body that stands. doc/curve-bound.md derives it. */
#ifndef CPROX_CURVE_QUERY_CURVE_CONVEX_H
#define CPROX_CURVE_QUERY_CURVE_CONVEX_H

#include "branch_and_bound/search.h"
#include "convex/flat.h"
#include "curve/curve_side.h"
#include "shape/body.h"

/* The payload of a node, and how to get at it. */
typedef struct curve_convex_node {
  curve_interval at;
  uint32_t seen, seen_ball; /* the incumbents that its bound knows already: by their normals, and by the cover */
} curve_convex_node;

static inline const curve_convex_node *curve_convex_known(const search_node *node) {
  _Static_assert(sizeof(curve_convex_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const curve_convex_node *)node->payload.bytes;
}

static inline curve_convex_node *curve_convex_own(search_node *node) {
  return (curve_convex_node *)node->payload.bytes;
}

/* A surface point of the body, the direction away from it, and where on the curve it was seen. */
typedef struct curve_sample {
  convex_near near;
  vec3 y;         /* the curve's point, local */
  vec3 normal;    /* unit within 4 u */
  double support; /* h(normal) of body, margin and offset */
  size_t piece;
  double s;
} curve_sample;

typedef struct curve_convex {
  /* the problem */
  curve_side side; /* seen from the body's frame */
  const convex *shape;
  convex joined;      /* where a body is carried: the shape that stands for both */
  cprox_curve own[2]; /* the curve and the radius of `side` where they were made for this search */
  double offset;      /* margin of the body + radius of the ball */
  search_effort effort;

  /* what is known */
  curve_sample best, last; /* of the least upper bound; of the last probe */
  search_best best_bound;
  uint32_t incumbent; /* counts the best samples; 0: none */
  bool cover_known, cover_usable;
  bool refined; /* the best point was worth Newton's steps */
  convex_cover cover;
  convex_hint hint, support_hint;
  double settled; /* an upper bound at or below this needs no plane any more, though it touches */
  double goal;    /* what settles a node, as of the last one that was looked at */
  uint32_t distance_queries, nodes;

  /* memory */
  cprox_workspace *workspace;
  points_pool pool;
  size_t planar_piece; /* the piece that `planar` speaks of */
  bool planar;
  bool flat_known; /* where the shape lies, asked for when it is first touched */
  flat_shape flat;
} curve_convex;

/* The slot of the pool that nodes never get: the loaded piece. */
enum { CURVE_CONVEX_ROOT, CURVE_CONVEX_RESERVED };

/* Makes the oracle ready; false where memory is out. The shape stands in the frame; offset >= 0. */
bool curve_convex_begin(curve_convex *o, const cprox_curve *curve, const convex *shape, frame placed, double offset,
                        cprox_workspace *workspace);

/* The node that is all that is asked about: side.part. */
search_node curve_convex_root(const curve_convex *o);

/* Measures at s of a piece before the search begins, as a probe would, and bounds the root by what it learned. CPROX_OK
 * or a negative status. The search then starts with o->best_bound. */
cprox_status curve_convex_seed(curve_convex *o, size_t piece, double s, search_node *root);

/* The functions of the contract in branch_and_bound/search.h, self being the curve_convex. */
search_oracle curve_convex_oracle(curve_convex *o);

/* Raises node->lower by the normal of a sample. */
void curve_convex_bound(const curve_convex *o, search_node *node, const curve_sample *sample);

/* For curve_query/newton_convex.c: measures at a curve point y = psi(s) of the piece, which is within `error` of the
 * exact one; */
cprox_status curve_convex_measure(curve_convex *o, size_t piece, double s, vec3 y, double error, curve_sample *sample,
                                  search_best *bound);

/* whether the shape has no inside: o->flat says where it lies; */
bool curve_convex_is_flat(curve_convex *o);

/* makes a sample the best one. */
void curve_convex_adopt(curve_convex *o, const curve_sample *sample, search_best bound);

#endif
