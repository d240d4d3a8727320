/* SPDX-License-Identifier: BSD-3-Clause */
/* One number for each place: points with equal coordinates share theirs. */
#ifndef CPROX_SHAPE_PLACES_H
#define CPROX_SHAPE_PLACES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/vec.h"

typedef struct places {
  vec3 *at;        /* of each number */
  uint32_t n;      /* numbers so far */
  uint32_t *slots; /* a hash table of numbers; NO_PLACE: empty */
  size_t mask;     /* it has so many slots, less one; a power of two */
} places;

/* Room for so many points, fewer than 2^32 - 1. False where memory is out; what there is then is places_free()'s. */
bool places_begin(places *p, size_t most);
uint32_t places_number(places *p, vec3 at);
void places_free(places *p);

#endif
