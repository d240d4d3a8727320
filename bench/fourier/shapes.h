/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar shapes of convex pieces, with their exact distance: what the Fourier group measures against. */
#ifndef CPROX_BENCH_FOURIER_SHAPES_H
#define CPROX_BENCH_FOURIER_SHAPES_H

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"

enum { SHAPE_PIECES = 6, SHAPE_CORNERS = 8 };

typedef struct shape {
  const char *name;
  int n, corners[SHAPE_PIECES];
  double v[SHAPE_PIECES][SHAPE_CORNERS][2];
  cprox_solid *solid;
} shape;

/* L, T, E, a star, a hexagon, a rod: of circumradius about 1. */
enum { SHAPES = 6 };
void shapes_create(shape shapes[SHAPES]);
void shapes_free(shape shapes[SHAPES]);

/* A pose of the plane. */
cprox_pose shape_pose(double x, double y, double angle);

/* Distance between two shapes, or minus the overlap of their deepest pair of pieces along an edge normal. */
double shape_distance(const shape *a, const cprox_pose *pa, const shape *b, const cprox_pose *pb);

#endif
