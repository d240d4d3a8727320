/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies for tests: the reference files' notation, the paper's six objects. */
#ifndef CPROX_TEST_IMPLICITS_H
#define CPROX_TEST_IMPLICITS_H

#include "curve_proximity/cprox/implicit.h"
#include "support/csv.h"
#include "support/random.h"

/* A description and the arrays that it points to. */
typedef struct implicit_case {
  cprox_implicit_description description;
  cprox_hyperquadric hyperquadrics[8];
  double terms[8][16][5];
  double planes[32][4];
  double quadrics[8][10];
} implicit_case;

/* Reads constraints joined by `|`, fields by `:`: `H:(a1:a2:a3:d:p)*`, `P:b1:b2:b3:c`,
 * `Q:q11:q12:q13:q22:q23:q33:b1:b2:b3:c`. */
void implicit_case_read(const char *text, implicit_case *c);

/* The paper's objects I (1) to VI (6). */
void implicit_case_paper(int object, implicit_case *c);

/* The body; the test fails where it cannot be made. */
cprox_body *implicit_case_body(const implicit_case *c, const cprox_affine *map);

/* The largest constraint at a point of the description's frame, in long double. */
long double implicit_case_value(const implicit_case *c, const long double x[3]);

/* A uniform rotation, and a position at a distance between the two in a uniform direction. */
cprox_pose implicit_random_pose(rng *r, double near, double far);

/* A body made of another's constraints. */
static inline cprox_status implicit_deformed(const cprox_body *body, const cprox_affine *map, const double *exponents,
                                             size_t n, cprox_workspace *workspace, cprox_body **made) {
  const cprox_implicit_description d = {.deformed = body, .exponents = exponents, .n_exponents = n};
  return cprox_body_create_implicit(&d, map, workspace, made);
}

#endif
