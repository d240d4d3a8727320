/* SPDX-License-Identifier: BSD-3-Clause */
/* Distances to superquadrics in long double, as an interval that needs no trust in how it was found: a point of the
 * body from above, a tangent plane from below. */
#ifndef CPROX_TEST_SUPERQUADRICS_H
#define CPROX_TEST_SUPERQUADRICS_H

#include "curve_proximity/cprox/implicit.h"
#include "support/random.h"
#include "support/reference.h"

typedef struct superquadric {
  vec3 a, p; /* semi-axes and exponents */
} superquadric;

/* Semi-axes from 1/aspect to 1, exponents 1 … 50, many of them near 1 and near 2. */
superquadric superquadric_random(rng *r, double aspect);

/* The body; the running test fails where it cannot be made. */
cprox_body *superquadric_body(const superquadric *s, cprox_workspace *workspace);

/* A pose up to `far` from the origin, its quaternion of any norm that is allowed. */
cprox_pose superquadric_random_pose(rng *r, double far);

typedef struct ref_interval {
  long double lower, upper;
} ref_interval;

/* sum |x_i/a_i|^p_i */
long double superquadric_level(const superquadric *s, vec3l x);

/* The distance of a point of the body's frame, 0 inside, and the point of the body that `upper` is measured to (NULL if
 * not needed). */
ref_interval superquadric_distance(const superquadric *s, vec3l y, vec3l *nearest);

/* The support function along d, from above. */
long double superquadric_reach(const superquadric *s, vec3l d);

#endif
