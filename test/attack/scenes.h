/* SPDX-License-Identifier: BSD-3-Clause */
/* A random moving object among random obstacles, and distances between them at one parameter, in long double. */
#ifndef CPROX_TEST_ATTACK_SCENES_H
#define CPROX_TEST_ATTACK_SCENES_H

#include "bodies.h"
#include "paths.h"

enum { SCENE_OBSTACLES = 4 };

typedef struct obstacle {
  bool curved, synchronized, bodied; /* a curve, at the same parameter, with a body on it; or a body alone */
  random_path path;
  random_body body;
  cprox_pose pose;
  double margin;
  cprox_obstacle target;
} obstacle;

typedef struct scene {
  double scale;
  bool planar, bodied; /* a body on the curve */
  random_path path;
  double radius;
  random_body body;
  cprox_mover mover;
  size_t n;
  obstacle obstacles[SCENE_OBSTACLES];
  cprox_obstacle targets[SCENE_OBSTACLES];
} scene;

/* Fills s, which must stay where it is. True where the core took everything; scene_free() in either case. */
bool scene_make(attack *a, rng *r, scene *s);
void scene_free(scene *s);

/* What is checked at one parameter t. `at` is the obstacle's own parameter where it is a curve at rest, NAN: the best
 * of many. */

/* No less than the distance of the moving object from obstacle i, radius and margin taken off and not cut at 0:
 * negative where they overlap by so much at least. Where neither carries a body and the obstacle is no curve at rest it
 * is the distance. */
long double scene_distance(const scene *s, size_t i, long double t, double at);

/* Is that so, or is there but a bound? */
bool scene_is_exact(const scene *s, size_t i);

/* How far a point is from the moving object at t, and from obstacle i: radius and margin taken off, 0 at least. */
long double scene_off_mover(const scene *s, long double t, vec3l p);
long double scene_off_obstacle(const scene *s, size_t i, long double t, double at, vec3l p);

/* The reference's own error where obstacle i is asked about, and the error of a point in double. */
long double scene_room(const scene *s, size_t i);
long double scene_witness_room(const scene *s, size_t i);

/* The steps to both sides of t within which a parameter of the core may have been rounded. */
double scene_step(const random_path *p);

/* The smallest scene_distance() that is found over [t0, t1], beginning with samples, t and what is near it. *where: its
 * parameter. */
long double scene_least(const scene *s, size_t i, rng *r, double t, double t0, double t1, double *where);

#endif
