/* SPDX-License-Identifier: BSD-3-Clause */
/* Seeded random numbers for tests: the same on every machine (xorshift64*, Vigna 2016). */
#ifndef CPROX_TEST_RANDOM_H
#define CPROX_TEST_RANDOM_H

#include <stddef.h>
#include <stdint.h>

#include "base/vec.h"

typedef struct rng {
  uint64_t state;
} rng;

rng rng_seed(uint64_t seed);
uint64_t rng_next(rng *r);

/* 0 … n-1, n > 0. */
size_t rng_index(rng *r, size_t n);

/* Uniform in [low, high). */
double rng_uniform(rng *r, double low, double high);

/* Uniform in the logarithm, 0 < low < high. */
double rng_log_uniform(rng *r, double low, double high);

/* A number of [-scale, scale] whose mantissa is awkward: all ones, few ones, a power of two, 0, or random. */
double rng_awkward(rng *r, double scale);

/* Uniform on the unit sphere, and in the cube |x|, |y|, |z| <= half. */
vec3 rng_unit(rng *r);
vec3 rng_in_cube(rng *r, double half);

/* A uniform rotation, and that with a position in the cube. */
cprox_quat rng_quat(rng *r);
cprox_pose rng_pose(rng *r, double half);

/* `cases` times the environment's CPROX_TEST_SCALE (default 1), at least 1. */
size_t test_cases(size_t cases);

#endif
