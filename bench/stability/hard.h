/* SPDX-License-Identifier: BSD-3-Clause */
/* Hard inputs: families of curves and what they are held against, whose distance is known by construction. */
#ifndef CPROX_BENCH_HARD_H
#define CPROX_BENCH_HARD_H

#include "curve_proximity/cprox.h"
#include "paper/paper.h"
#include "peers/libraries.h"
#include "support/measure.h"
#include "support/random.h"

enum { MAX_POINTS = 46, MAX_VERTICES = 8 };

/* One query with its answer: a Bézier curve against a convex polygon, a point, or a second curve of the same degree. */
typedef struct hard {
  size_t degree, n;
  vec3 points[MAX_POINTS];
  vec3 vertex[MAX_VERTICES]; /* of the obstacle; n = 0: the second curve */
  vec3 other[MAX_POINTS];
  double truth;
  bool planar;
  cprox_curve *curve, *second;
  cprox_body *body;
  paper_bezier bezier[2];
  void *own[2][MOST_LIBRARIES]; /* the libraries' copies of both curves */
} hard;

typedef struct family {
  const char *name;
  void (*make)(rng *r, hard *h);
} family;

extern const family FAMILIES[];
extern const size_t N_FAMILIES;

/* What every method has at hand. */
typedef struct tools {
  cprox_workspace *workspace;
  paper_node *heap;
} tools;

/* One family, by all methods: what is right, wrong (column unsound) and given up (column failures). */
void stability_family(const bench_size *size, const family *f, uint64_t seed, tools *t);

/* Curves that are absolutely continuous and no smoother, known by points and lengths. */
void stability_rough(const bench_size *size, uint64_t seed, tools *t);

/* Collisions that are true by a witness: thin plates and grazes; a collision that a method does not see counts as
 * wrong. */
void stability_plates(const bench_size *size, uint64_t seed, tools *t);

/* Do solids overlap? Thin ones, a dot among bars, symmetry, unequal sizes, nearly equal rotations, high exponents: Fourier
 * gaps beside distances. */
void stability_gaps(const bench_size *size, uint64_t seed, tools *t);

#endif
