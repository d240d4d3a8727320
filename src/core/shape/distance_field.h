/* SPDX-License-Identifier: BSD-3-Clause */
/* A set that is known by its distance function alone: the caller's, or a grid of distances. doc/distance-functions.md
 */
#ifndef CPROX_SHAPE_DISTANCE_FIELD_H
#define CPROX_SHAPE_DISTANCE_FIELD_H

#include <stddef.h>

#include "base/vec.h"
#include "curve_proximity/cprox/body.h"

typedef struct distance_field distance_field;

struct distance_field {
  /* A value at a point of the body's frame, and how far it may be from the distance, rounding excluded. NaN: none. */
  double (*value)(const distance_field *field, vec3 x, double *error);
  double error;     /* of values in general: bounds get no nearer to each other than twice this */
  double lipschitz; /* of the values; infinity: not known */
  vec3 centre;      /* the set lies within `radius` of it */
  double radius;
  double step;        /* the distance at which differences of values tell a direction */
  const char *source; /* "the distance callback", for messages */

  cprox_distance_fn callback; /* the caller's function */
  const void *user;

  size_t n[3]; /* a grid: values along x, y, z, x running fastest, the first one at `origin` */
  vec3 origin;
  double cell, values_error, most;
  double *values;
};

/* A value at a point. */
typedef struct distance_value {
  vec3 at;
  double value;
  double error, rounding; /* how far it may be off, rounding included; and the rounding alone */
} distance_value;

/* Evaluates. CPROX_INVALID, and a message with the place, where the value is not a number or contradicts `other` (NULL:
 * none) or the ball that the set lies in. */
cprox_status distance_field_measure(const distance_field *field, vec3 x, const distance_value *other,
                                    cprox_workspace *workspace, distance_value *measured);

/* A lower bound of the distance to the set over the segment between two points that were measured. */
double distance_field_over_segment(const distance_field *field, const distance_value *a, const distance_value *b);

/* The point of the set nearest to a point that was measured, as far as a few values near it tell; *normal gets the
 * direction from it, (0, 0, 0) where none is seen. */
vec3 distance_field_nearest(const distance_field *field, const distance_value *from, vec3 *normal);

void distance_field_free(distance_field *field);

#endif
