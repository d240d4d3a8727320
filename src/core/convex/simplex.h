/* SPDX-License-Identifier: BSD-3-Clause */
/* The point of a simplex that is nearest to 0: what every step of the Gilbert-Johnson-Keerthi search asks. */
#ifndef CPROX_CONVEX_SIMPLEX_H
#define CPROX_CONVEX_SIMPLEX_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec.h"

typedef struct simplex_vertex {
  vec3 w;        /* the vertex */
  vec3 a, b;     /* the points of the two shapes whose difference it is */
  int32_t id;    /* the number of a vertex of polytopes, */
  int32_t id_b;  /* and of pairs that of the second's; -1: none */
  double behind; /* what w fails to reach of the support value along the direction it was looked for; 0 but for implicit
                    shapes */
} simplex_vertex;

typedef struct simplex {
  int n;
  simplex_vertex vertex[4];
  double weight[4]; /* >= 0, sum 1: of the nearest point, or of 0 itself inside, after simplex_reduce() */
} simplex;

typedef struct simplex_nearest {
  bool inside;     /* 0 lies inside a tetrahedron, proven in spite of rounding */
  double depth;    /* then: a ball of this radius about 0 lies inside */
  vec3 v;          /* the nearest point, sum of weight * w */
  double distance; /* |v| */
  vec3 normal;     /* unit, along v, but from the feature that v lies on: exact where v itself is all rounding; (0,0,0)
                      where 0 lies on the feature */
} simplex_nearest;

/* Four directions all round, along no axis of symmetry: extreme points that enclose what lies well inside. */
extern const vec3 simplex_spread[4];

/* Whether w is one of the vertices already. */
bool simplex_has(const simplex *s, vec3 w);

/* Drops the vertices that the nearest point does not need (unless 0 is inside) and says where it is. */
void simplex_reduce(simplex *s, simplex_nearest *nearest);

#endif
