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

/* How far to go: the interval, rounding included, may be epsilon wide, or the fraction relative_epsilon of its upper end. */
typedef struct pair_goal {
  double epsilon, relative_epsilon;
  uint32_t max_steps;
} pair_goal;

typedef struct pair_answer {
  bool fault;          /* a support callback misbehaved: nothing else is set */
  bool exhausted;      /* max_steps were not enough */
  bool overlap;        /* the cores overlap, proven: upper is 0, lower a bound on minus the depth */
  double lower, upper; /* of the signed distance, margins and rounding included */
  double rounding;     /* how much of each end is rounding */
  vec3 on_a, on_b;     /* a's frame, margins included: the points that attain upper */
  vec3 normal;         /* a's frame, unit, from b to a; (0,0,0) where there is none */
  uint32_t steps, supports;
} pair_answer;

/* The shapes are a and b grown by margin_a and margin_b, which take the place of their own. Neither is a halfspace. */
void pair_separate(const convex *a, double margin_a, const convex *b, double margin_b, const pair_placement *placement,
                   const pair_goal *goal, pair_answer *answer);

#endif
