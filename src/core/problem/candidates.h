/* SPDX-License-Identifier: BSD-3-Clause */
/* What a mover is asked about, taken apart into the sets that one search each can deal with. */
#ifndef CPROX_PROBLEM_CANDIDATES_H
#define CPROX_PROBLEM_CANDIDATES_H

#include "base/frame.h"
#include "problem/problem.h"

/* One convex part of one target, or a curve, against one convex part of what is carried, with what their bounding balls say. */
typedef struct candidate {
  double lower;
  int32_t target, part, mover_part;
  uint32_t seed_piece; /* where a search against a convex body begins to measure: */
  double seed_s;       /* s of that piece, inside (0, 1); 0: wherever it likes */
  cprox_rung rung;     /* the model that is searched; CPROX_RUNG_NONE: the finest that the question allows */
} candidate;

/* The candidates of targets first … last - 1, nearest ball first, in the workspace. NULL where memory is out. `ranked` false: of a
 * single candidate nothing is asked, its bound is minus infinity. */
candidate *candidates_list(const question *q, size_t first, size_t last, bool ranked, size_t *count);

/* What the balls of mover and candidate say: never above the true distance; minus infinity where there is no ball. */
double candidate_ball_bound(const question *q, const candidate *c);

/* Round a candidate, in the world, without padding and but for rounding; *sizes becomes the sum of the lengths that entered. */
typedef struct candidate_ball {
  vec3 centre;
  double radius;
} candidate_ball;
candidate_ball candidate_bounding_ball(const question *q, const candidate *c, double *sizes);

/* Ascending by lower. */
void candidates_sort(candidate *list, size_t n);

/* The model of a candidate that is searched (its body is NULL for a curve at its own parameter), its pose in the world, what is
 * round it, and that and the ball that rides the curve. What is on the mover's clock has a body, if only a point, and stands where
 * it would if its curve were at the origin. */
const cprox_body *candidate_body(const question *q, const candidate *c);
cprox_pose candidate_pose(const question *q, const candidate *c);
double candidate_padding(const question *q, const candidate *c);

/* How far the pose may be off, and what turns with it, because it had to be composed. */
double candidate_misplaced(const question *q, const candidate *c);

/* The rung of that model. */
cprox_rung candidate_rung(const question *q, const candidate *c);

/* The body's frame, with what composing its poses may have moved it. */
frame candidate_frame(const question *q, const candidate *c);
double candidate_offset(const question *q, const candidate *c);

/* The convex part that the mover carries (NULL for none), and its pose while the curve is at the origin. */
const cprox_body *candidate_carried(const question *q, const candidate *c, cprox_pose *pose);

#endif
