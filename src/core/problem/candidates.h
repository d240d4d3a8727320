/* SPDX-License-Identifier: BSD-3-Clause */
/* What a mover is asked about, taken apart into the sets that one search each can deal with. */
#ifndef CPROX_PROBLEM_CANDIDATES_H
#define CPROX_PROBLEM_CANDIDATES_H

#include "problem/problem.h"

/* One convex part of one obstacle, or a curve, against one convex part of what is carried, with what their bounding
 * spheres say. placed_pair_resolve() looks the indices up. */
typedef struct candidate {
  double lower;
  int32_t obstacle, part, mover_part;
  uint32_t seed_piece; /* where a search against a convex body begins to measure: */
  double seed_s;       /* s of that piece, inside (0, 1); 0: wherever it likes */
  cprox_lod lod;       /* the model that is searched; CPROX_LOD_NONE: the finest that the query allows */
} candidate;

/* The candidates of obstacles first … last - 1, nearest ball first, in the workspace. NULL where memory is out.
 * `ranked` false: of a single candidate nothing is asked, its bound is minus infinity. */
candidate *candidates_list(const query *q, size_t first, size_t last, bool ranked, size_t *count);

/* What the balls of mover and candidate say: never above the true distance; minus infinity where there is no ball. */
double candidate_ball_bound(const query *q, const candidate *c);

/* Round a candidate, in the world, without margin and but for rounding; *sizes becomes the sum of the lengths that
 * entered. */
typedef struct candidate_ball {
  vec3 centre;
  double radius;
} candidate_ball;
candidate_ball candidate_bounding_ball(const query *q, const candidate *c, double *sizes);

/* Ascending by lower. */
void candidates_sort(candidate *list, size_t n);

#endif
