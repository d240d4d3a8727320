/* SPDX-License-Identifier: BSD-3-Clause */
/* Complex numbers by hand: the products of C's own complex type test for NaN, which costs more than the product. */
#ifndef CPROX_FOURIER_WAVE_H
#define CPROX_FOURIER_WAVE_H

#include "base/vec.h"

typedef struct wave {
  double re, im;
} wave;

/* A spectrum's value, and its gradient by q. */
typedef struct wave_jet {
  wave value;
  vec3 re, im; /* gradient */
} wave_jet;

static inline wave wave_times(wave a, wave b) {
  return (wave){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* exp(-i phase) */
static inline wave wave_back(double phase) {
  return (wave){cos(phase), -sin(phase)};
}

#endif
