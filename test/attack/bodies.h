/* SPDX-License-Identifier: BSD-3-Clause */
/* Random bodies of every kind, with distances and supports of their own in long double. Each is a union of parts, and
 * each part one of nine forms of which the nearest point is found by the plainest method: all facets, all triangles,
 * bisection. */
#ifndef CPROX_TEST_ATTACK_BODIES_H
#define CPROX_TEST_ATTACK_BODIES_H

#include "attack.h"
#include "support/reference.h"

enum { BODY_POINTS = 12, BODY_TRIANGLES = 220, BODY_PARTS = 3 };

typedef enum form {
  FORM_HULL,    /* of points */
  FORM_BALLS,   /* of radius size.x about points */
  FORM_BOXES,   /* from points[i] to high[i] */
  FORM_CAPSULE, /* radius size.x, half height size.z; so the next two */
  FORM_CYLINDER,
  FORM_CONE,
  FORM_POWER,     /* sum |x_i/size_i|^exponents_i <= 1 */
  FORM_HALFSPACE, /* size·x + offset <= 0 */
  FORM_MESH       /* triangles, and what is inside where it is solid */
} form;

typedef struct part {
  form form;
  cprox_pose pose; /* in the body's frame */
  vec3 size, exponents;
  double offset, margin; /* margin: a ball added */
  vec3 points[BODY_POINTS], high[BODY_POINTS];
  size_t n, m;
  uint32_t triangles[BODY_TRIANGLES][3]; /* of a mesh; of a hull the facets, seen from outside counter-clockwise, or all
                                            where it is flat */
  bool full;                             /* hull: it has an inside; mesh: the inside counts */
} part;

typedef struct random_body {
  cprox_body *body;
  cprox_body *owned[BODY_PARTS + 1]; /* made before it and freed after it */
  part parts[BODY_PARTS];
  size_t n_parts;
  char name[40];
  bool convex, carried; /* may a curve carry it? */
  bool depth;           /* is the depth of points in it known here and there? */
  double extent;        /* every point is within it of the frame's origin; of a halfspace the scale */
  double slack;         /* the body that the core was given may differ from the parts by this */
  double callback[4];   /* of a support callback */
} random_body;

enum { BODY_KINDS = 24 };

/* Fills b, which must stay where it is: callbacks point into it. The kind is a number below BODY_KINDS; sizes from
 * about scale/1000 to scale. The core's reason fails the case where it refuses the body. */
void body_make(attack *a, rng *r, size_t kind, double scale, random_body *b);

/* One kind that a curve can carry. */
size_t body_carried_kind(rng *r);
void body_free(random_body *b);

/* The distance to the posed body, 0 inside, and the nearest point (the point itself inside). An upper bound always; the
 * distance itself within 2^-60 of the sizes for forms but FORM_POWER, there within 2^-50. */
long double body_nearest(const random_body *b, const cprox_pose *pose, vec3l p, vec3l *nearest);

/* How deep the point is in the posed body, least way out of its deepest part; 0 outside. Only where b->depth. */
long double body_depth(const random_body *b, const cprox_pose *pose, vec3l p);

/* The greatest d·x over the posed body, d a unit vector; of superquadrics that of the box about them; INFINITY where it
 * has none. */
long double body_support(const random_body *b, const cprox_pose *pose, vec3l d);

#endif
