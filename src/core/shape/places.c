/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/places.h"

#include <stdlib.h>
#include <string.h>

#define NO_PLACE UINT32_MAX

bool places_begin(places *p, size_t most) {
  size_t slots = 64;
  while (slots < 2 * most) slots *= 2;
  *p = (places){.mask = slots - 1};
  p->at = malloc((most + 1) * sizeof *p->at);
  p->slots = malloc(slots * sizeof *p->slots);
  if (!p->at || !p->slots) return false;
  memset(p->slots, 0xff, slots * sizeof *p->slots);
  return true;
}

/* Equal places have equal hashes: adding 0 turns -0 into 0. The seed, an address, keeps files from being made for
 * collisions; no number depends on it. */
static size_t hash_of(vec3 at, const void *seed) {
  const double numbers[3] = {at.x + 0.0, at.y + 0.0, at.z + 0.0};
  uint64_t bits[3], h = (uint64_t)(uintptr_t)seed;
  memcpy(bits, numbers, sizeof bits);
  for (int k = 0; k < 3; k++) {
    h = (h ^ bits[k]) * UINT64_C(0x9e3779b97f4a7c15);
    h ^= h >> 32;
  }
  return (size_t)h;
}

uint32_t places_number(places *p, vec3 at) {
  size_t slot = hash_of(at, p->slots) & p->mask;
  while (p->slots[slot] != NO_PLACE && !vec_equal(p->at[p->slots[slot]], at)) slot = (slot + 1) & p->mask;
  if (p->slots[slot] == NO_PLACE) {
    p->slots[slot] = p->n;
    p->at[p->n++] = at;
  }
  return p->slots[slot];
}

void places_free(places *p) {
  free(p->at);
  free(p->slots);
  *p = (places){0};
}
