/* SPDX-License-Identifier: BSD-3-Clause */
/* The loops of a batch that run in vector registers. All of them give the same results whatever the registers' width. */
#ifndef CPROX_QUERY_BATCH_LANES_H
#define CPROX_QUERY_BATCH_LANES_H

#include "curve/curve.h"

/* Sets of balls are padded to a multiple of LANES; a piece is sampled at SAMPLES parameters, s = (k + 1/2)/SAMPLES. */
enum { LANES = 8, SAMPLES = 16 };

/* Balls, one array a number, `padded` of each. */
typedef struct lanes_balls {
  size_t n, padded;
  double *x, *y, *z;
  double *reach; /* radius and padding */
  double *sizes; /* the sum of the lengths that entered, for rounding */
} lanes_balls;

/* lower[k]: the distance of the capsule, grown by `radius`, from ball k, rounding included; negative where they overlap. */
void lanes_ball_bounds(const lanes_balls *balls, const curve_capsule *capsule, double radius, double *lower);

/* basis[j * SAMPLES + k]: Bernstein polynomial j of the degree at sample k. */
void lanes_basis(size_t degree, double *basis);

/* The samples of a Bézier piece: x, y, z of SAMPLES numbers each, after one another. */
void lanes_sample(const double *basis, const vec3 *points, size_t degree, double *samples);

/* The least |sample - centre|², and the first sample that has it. */
double lanes_closest(const double *samples, vec3 centre, size_t *sample);

#endif
