/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distance of two convex shapes, as far as separation tells it (doc/convex-pairs.md). */
#ifndef CPROX_CONVEX_PAIR_H
#define CPROX_CONVEX_PAIR_H

#include "convex/convex.h"

/* Where shape b stands in a's frame: x_a = r x_b + t. */
typedef struct pair_placement {
  double r[9]; /* row-major */
  vec3 t;
  double error; /* every point of b is within this of where it stands exactly */
} pair_placement;

/* Vertices of boxes and polytopes between which the nearest points lie, by their numbers. */
typedef struct pair_vertices {
  int32_t n, a[3], b[3]; /* n 0 … 3 */
} pair_vertices;

/* How far to go: the interval, rounding included, may be epsilon wide, or the fraction relative_epsilon of its upper
 * end. */
typedef struct pair_goal {
  double epsilon, relative_epsilon;
  double floor, fraction; /* or this fraction of what its lower end is above the floor; 0: none */
  bool verdict; /* or the side of `limit` that the distance is on: no more than that is known then, nor a depth */
  double limit;
  uint32_t max_steps;
  bool (*stop)(void *user); /* searches through many elements ask it now and then; NULL: never */
  void *stop_user;
  vec3 start;  /* a's frame, unit: near the normal of the answer; (0,0,0): nothing is known */
  bool placed; /* `place`, a's frame, is near the point of b that is nearest to a */
  vec3 place;
  const pair_vertices *known; /* those of a former answer are tried first; NULL: none */
  bool wants_vertices, wants_feature;
  bool wants_depth; /* how deep the cores overlap, not only that they do */
  bool plain;       /* the bounds need not hold: what is likely to be rounding and not what may be at worst */
  int32_t room;     /* wants_depth: memory may be allocated for so many vertices of M; 0: none */
  bool wants_shift; /* wants_depth: and whether that is the only way out */
} pair_goal;

/* What the point of M = A - B that is nearest to 0 lies on: how the distance changes when 0 moves. */
typedef struct pair_feature {
  bool flat;         /* polyhedra: a vertex, an edge or a face of M */
  int n;             /* then: its vertices */
  vec3 w[3];         /* a - b */
  vec3 b[3];         /* the points of b in that, in b's own frame */
  double hessian[6]; /* else: the second derivative of the distance (xx, xy, xz, yy, yz, zz), as well as it is known */
} pair_feature;

typedef struct pair_answer {
  bool support_failed;    /* a support callback misbehaved: nothing else is set */
  bool exhausted;         /* max_steps were not enough */
  bool stopped;           /* the caller's stop function ended a search through elements or parts */
  bool overlap;           /* the cores overlap, proven */
  bool measured;          /* then: lower and upper are those of minus the depth; else upper is 0 */
  double lower, upper;    /* of the signed distance, margins and rounding included */
  double rounding;        /* how much the ends may be off by rounding */
  double above;           /* how much of upper is rounding, where the cores are apart */
  vec3 on_a, on_b;        /* a's frame, margins included: the points that attain upper */
  vec3 common;            /* a's frame: where they overlap or touch, a point of both but for rounding */
  vec3 normal;            /* a's frame, unit, from b to a; (0,0,0) where there is none */
  double depth;           /* overlap: the cores' own depth is proven to be at least this */
  double shift;           /* either core may move by this much without another way out; 0: not known */
  pair_feature feature;   /* only where the goal asks for it, and the cores are apart or their depth is measured */
  pair_vertices vertices; /* only where the goal asks for them, and the cores are apart */
  uint32_t steps, supports;
} pair_answer;

/* The shapes are a and b grown by margin_a and margin_b, which take the place of their own. Neither is a halfspace. */
void pair_separate(const convex *a, double margin_a, const convex *b, double margin_b, const pair_placement *place,
                   const pair_goal *goal, pair_answer *answer);

/* Whether bounds on the cores' distance, without margins and rounding (each end's), are as close as the goal asks. */
bool pair_is_reached(const pair_goal *goal, double margins, double rounding, double lower, double upper);

#endif
