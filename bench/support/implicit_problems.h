/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of implicit bodies: the objects of Chakraborty et al. 2008 at random poses, bodies of many constraints, and
 * hard families. */
#ifndef CPROX_BENCH_IMPLICIT_PROBLEMS_H
#define CPROX_BENCH_IMPLICIT_PROBLEMS_H

#include "curve_proximity/cprox.h"
#include "implicit/implicit.h"
#include "support/random.h"

/* Two bodies apart: a stands still at the origin, b at its pose. */
typedef struct implicit_problem {
  const cprox_body *a, *b;
  cprox_pose pose;
  implicit_query query; /* the same, as the solvers take it */
} implicit_problem;

/* The paper's objects I (1) to VI (6). */
cprox_body *implicit_object(int object);

/* n problems of two bodies whose centres are `near` to `far` apart and that do not overlap. free() frees. */
implicit_problem *implicit_problems_make(const cprox_body *a, const cprox_body *b, double near, double far,
                                         uint64_t seed, size_t n);

/* b at another pose. */
void implicit_problem_place(implicit_problem *problem, cprox_pose pose);

/* The distances, to 1e-11 of distance and sizes. free() frees. */
double *implicit_problems_truth(const implicit_problem *problems, size_t n);

/* The rows of a reference file with one tag, apart from each other: problems and distances, both for free(); the bodies
 * are never freed. Returns how many; `tag` NULL: all. */
size_t implicit_problems_read(const char *path, const char *tag, implicit_problem **problems, double **truth);

/* A ball of radius 1.3 cut by n planes, by n quadrics, by n superquadrics that each touch the unit ball. */
typedef enum implicit_many { MANY_PLANES, MANY_QUADRICS, MANY_SUPERQUADRICS } implicit_many;
cprox_body *implicit_body_of_many(implicit_many kind, size_t n, uint64_t seed);

#endif
