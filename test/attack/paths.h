/* SPDX-License-Identifier: BSD-3-Clause */
/* Random curves of every family, evaluated in long double by their definitions: none by Bézier pieces but those that
 * are given so. */
#ifndef CPROX_TEST_ATTACK_PATHS_H
#define CPROX_TEST_ATTACK_PATHS_H

#include "attack.h"
#include "support/reference.h"

enum { PATH_POINTS = 16, PATH_PARTS = 3, PATH_FAMILIES = 13 };

typedef enum path_family {
  PATH_BEZIER,
  PATH_BSPLINE,
  PATH_POLYNOMIAL,
  PATH_LEGENDRE,
  PATH_LAGRANGE,
  PATH_TRIGONOMETRIC,
  PATH_CLOTHOID,
  PATH_DUBINS,
  PATH_INVOLUTE,
  PATH_PYTHAGOREAN,
  PATH_SMOOTH,
  PATH_RECTIFIABLE,
  PATH_PIECEWISE
} path_family;

typedef struct random_path {
  cprox_curve *curve;
  path_family family;
  double t0, t1;
  size_t n, degree;
  vec3 points[PATH_POINTS];        /* or coefficients */
  double numbers[2 * PATH_POINTS]; /* knots, nodes; heading, curvature, rate, radius, angle */
  cprox_quat preimage[PATH_POINTS];
  cprox_dubins_path word;
  double extent; /* no point that is met on the way of the evaluation is farther from the origin */
  double break_at[PATH_PARTS + 1];
  struct random_path *parts[PATH_PARTS]; /* of a piecewise curve */
} random_path;

const char *path_name(path_family family);

/* A curve about `origin`, of size about scale; in the plane z = 0 of the origin where planar. p must stay where it is.
 * The core's reason fails the case where it refuses the curve. */
void path_make(attack *a, rng *r, path_family family, double scale, vec3 origin, bool planar, random_path *p);

/* The same family and size on a given range, for a mover on another's clock: false where the family has no free range.
 */
bool path_has_range(path_family family);
void path_make_on(attack *a, rng *r, path_family family, double scale, vec3 origin, bool planar, double t0, double t1,
                  random_path *p);
void path_free(random_path *p);

/* The point at t, within 2^-58 of extent or so. */
vec3l path_at(const random_path *p, long double t);

#endif
