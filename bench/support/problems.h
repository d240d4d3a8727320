/* SPDX-License-Identifier: BSD-3-Clause */
/* Random problems, the same on every machine, with exact answers by long double. */
#ifndef CPROX_BENCH_PROBLEMS_H
#define CPROX_BENCH_PROBLEMS_H

#include "../paper/paper.h"
#include "curve_proximity/cprox.h"
#include "support/random.h"

typedef enum obstacle_kind {
  OBSTACLE_POINT,
  OBSTACLE_POLYGON,
  OBSTACLE_POLYTOPE,
  OBSTACLE_LARGE_POLYTOPE
} obstacle_kind;

enum { OBSTACLE_MAX_VERTICES = 512, PROBLEM_MAX_POINTS = 64 };

typedef struct obstacle {
  vec3 vertex[OBSTACLE_MAX_VERTICES];
  size_t n;
  int (*triangle)[3]; /* the faces of a polytope, as far as they were wanted */
  size_t triangles;
  cprox_body *body;
} obstacle;

/* One about the unit square or cube, for its kind. */
void obstacle_make(rng *r, obstacle_kind kind, obstacle *o);
void obstacle_free(obstacle *o);

/* The triangles of the hull of the vertices, which are in general position. */
void obstacle_find_faces(obstacle *o);

/* A Bézier curve and an obstacle that it does not touch, for us and for the paper's method. */
typedef struct curve_problem {
  size_t degree;
  vec3 points[PROBLEM_MAX_POINTS];
  cprox_curve *curve;
  obstacle obstacle;
  cprox_obstacle target;
  paper_bezier bezier;
  paper_curve paper;
  paper_obstacle paper_obstacle;
} curve_problem;

/* n of them; curves in the unit square or cube, obstacles of 1, 5 … 40, 8 … 64 or 500 vertices about it. */
curve_problem *curve_problems_make(obstacle_kind kind, size_t degree, size_t n);
void curve_problems_free(curve_problem *problems, size_t n);

/* The exact distances: long double, 600 parameters, the best of them refined by golden section. NAN for large
 * polytopes. */
double *curve_problems_truth(const curve_problem *problems, size_t n, obstacle_kind kind);

/* Two Bézier curves. */
typedef struct curve_pair {
  size_t degree;
  vec3 points[2][PROBLEM_MAX_POINTS];
  cprox_curve *curve[2];
  paper_bezier bezier[2];
  paper_curve paper[2];
} curve_pair;

curve_pair *curve_pairs_make(size_t degree, bool planar, size_t n);
void curve_pairs_free(curve_pair *pairs, size_t n);
double *curve_pairs_truth(const curve_pair *pairs, size_t n);

#endif
