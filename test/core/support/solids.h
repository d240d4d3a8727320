/* SPDX-License-Identifier: BSD-3-Clause */
/* Random solids of every kind that Fourier gaps take, in the plane and in space, each with the same set as a union of
 * convex bodies: cprox_pair() knows the distance. In the plane the bodies are symmetric about z = 0, so that their
 * distance is the planar one. */
#ifndef CPROX_TEST_SOLIDS_H
#define CPROX_TEST_SOLIDS_H

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"
#include "support/random.h"

typedef enum test_solid_kind {
  SOLID_BALL,
  SOLID_BOX,
  SOLID_ELLIPSOID,
  SOLID_CAPSULE,
  SOLID_CYLINDER, /* in space only */
  SOLID_CONVEX,   /* a polygon or a mesh */
  SOLID_FOLDED,   /* one with a reflex corner or edge */
  SOLID_POLYLINE,
  SOLID_SWEEP,
  SOLID_GRID,
  SOLID_UNION,
  SOLID_CLIPPED,
  SOLID_KINDS
} test_solid_kind;

enum { SOLID_MOST_PARTS = 8 };

typedef struct test_solid {
  test_solid_kind kind;
  int dimension;
  cprox_solid *solid;
  size_t n;
  cprox_body *parts[SOLID_MOST_PARTS];
  cprox_body *body;      /* the union of the parts: the solid */
  cprox_body *unclipped; /* of SOLID_CLIPPED: the solid before, and the region; else NULL */
  cprox_body *region;
} test_solid;

/* Whether the kind exists in this dimension. */
bool solid_exists(test_solid_kind kind, int dimension);

const char *solid_name(test_solid_kind kind);

/* Sizes from scale/aspect to scale. The test fails where it cannot be made. */
test_solid solid_make(rng *r, test_solid_kind kind, int dimension, double scale, double aspect);

void solid_free(test_solid *s);

/* A rotation, and a position in the cube; in the plane about z and in the square. */
cprox_pose solid_pose(rng *r, int dimension, double half);

/* The signed distance. */
double solid_distance(const test_solid *a, const cprox_pose *pa, const test_solid *b, const cprox_pose *pb);

/* What a gap's over-reach is measured from: the distance, or that to an unclipped solid or to a region, where larger.
 */
double solid_reached(const test_solid *a, const cprox_pose *pa, const test_solid *b, const cprox_pose *pb);

#endif
