/* SPDX-License-Identifier: BSD-3-Clause */
/* The published method: Lakshmanan, Patterson, Cichella, Hovakimyan (RSS 2019). It is the baseline of all ratios.
 *
 * The search is best-first bisection. The lower bound of an interval is the GJK distance to a polytope round the
 * ellipsoid of Theorem 1. The closed-form arc-length bound of Eq. 6 gives the size of the ellipsoid. The upper bound is
 * the GJK distance of the curve's point in the middle.
 *
 * Kept as published: plain double arithmetic without regard to rounding. Its u² - L² cancels, so that lower bounds may
 * be too high; the benches count that. Two mends in its favour: the axes of the 3-D hull are orthogonal here (as
 * published they are not, and the hull misses part of the ellipsoid), and lower bounds are GJK's own lower bounds. */
#ifndef CPROX_BENCH_PAPER_H
#define CPROX_BENCH_PAPER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/vec.h"

enum { PAPER_MAX_DEGREE = 64, PAPER_MAX_HULL = 16, PAPER_MAX_NODES = 100000 };

/* A curve on [t0, t1] that knows its points and the integral of |psi'|². */
typedef struct paper_curve {
  double t0, t1;
  bool planar;
  const void *self;
  vec3 (*point)(const void *self, double t);
  double (*energy)(const void *self, double t); /* from t0 to t, of |psi'|² */
} paper_curve;

/* A Bézier curve on [0, 1]; the energy is a polynomial in Bernstein form, found once. */
typedef struct paper_bezier {
  size_t degree;
  vec3 points[PAPER_MAX_DEGREE];
  double energy[2 * PAPER_MAX_DEGREE];
} paper_bezier;

void paper_bezier_make(const vec3 *points, size_t degree, paper_bezier *bezier);
paper_curve paper_bezier_curve(const paper_bezier *bezier, bool planar);

/* A convex obstacle: its vertices. */
typedef struct paper_obstacle {
  const vec3 *vertex;
  size_t n;
} paper_obstacle;

/* Distance of two vertex sets by GJK; *lower is its lower bound. *at, where not NULL: where the nearest point of the
 * second hull lies, as the mean of its vertices' numbers, from 0 to 1. Counts support evaluations in *evaluations. */
double paper_gjk(const vec3 *a, size_t na, const vec3 *b, size_t nb, double *lower, double *at, uint32_t *evaluations);

typedef enum paper_query_type { PAPER_DISTANCE, PAPER_TOLERANCE, PAPER_COLLISION } paper_query_type;

typedef struct paper_query {
  paper_query_type query_type;
  double delta, epsilon;
  uint32_t max_nodes;
} paper_query;

typedef struct paper_answer {
  double lower, upper;
  bool ended;   /* within max_nodes */
  bool verdict; /* tolerance: farther than delta; collision: touches */
  uint32_t nodes, evaluations;
} paper_answer;

/* Algorithms 1, 3, 4 and 2. `heap` is memory for PAPER_MAX_NODES nodes, kept by the caller. */
typedef struct paper_node {
  double lower, a[2], b[2];
} paper_node;
void paper_search(const paper_curve *curve, const paper_obstacle *obstacle, const paper_query *q, paper_node *heap,
                  paper_answer *answer);
void paper_search_curves(const paper_curve *first, const paper_curve *second, const paper_query *q, paper_node *heap,
                         paper_answer *answer);

/* The distance of a Bézier curve by subdivision: Chang, Chen, Paul and others, Computation of the minimum distance
 * between two Bézier curves/surfaces, Computers & Graphics 35, 2011, of which the paper's Fig. 10 shows the time. The
 * Bernstein toolkit BeBOT (Kielas-Jensen and others, 2022) searches in the same way. Written here from what both say:
 * the lower bound of a part is the GJK distance of its control points' hull, the upper bound that of points of the
 * curve. A part is cut where the hull's nearest point suggests, and the half whose end is nearer comes first. Depth
 * first, in plain double arithmetic. `paper_answer` has the interval; ended: within PAPER_MAX_NODES parts. */
void paper_subdivide(const paper_bezier *bezier, const paper_obstacle *obstacle, double epsilon, paper_answer *answer);

#endif
