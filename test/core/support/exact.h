/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of 320 bits by MPFR, as expressions: each result is a new number of a row that is used again from its
 * beginning after exact_reset(). What 53 bits leave in error is 2^-267 of it here. */
#ifndef CPROX_TEST_EXACT_H
#define CPROX_TEST_EXACT_H

#include <mpfr.h>
#include <stddef.h>

#include "base/vec.h"

typedef mpfr_ptr num;

typedef struct num3 {
  num k[3];
} num3;

/* All numbers so far are given up. */
void exact_reset(void);
void exact_free(void);

num exact(double a);
num exact_add(num a, num b);
num exact_sub(num a, num b);
num exact_mul(num a, num b);
num exact_div(num a, num b);
num exact_root(num a);
num exact_max(num a, num b);
num exact_min(num a, num b);
num exact_cos(num a);
num exact_sin(num a);
double exact_double(num a);

num3 exact3(vec3 a);
num3 exact3_sub(num3 a, num3 b);
num3 exact3_blend(num3 a, num3 b, num s); /* (1 - s) a + s b */
num exact3_dot(num3 a, num3 b);
num exact3_norm(num3 a);

/* |a - b| */
double exact3_error(num3 a, vec3 b);

#endif
