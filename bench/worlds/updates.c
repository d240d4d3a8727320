/* SPDX-License-Identifier: BSD-3-Clause */
/* Points of which some move. */
#include <stdio.h>
#include <stdlib.h>

#include "worlds/worlds.h"

static int by_number(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A million points in a cube, of which those in three of its 64 cells move, with the memory of the body before the
 * last. */
void worlds_ask_updates(const bench_size *size, worlds_asked *q) {
  enum { MANY = 1000000, UPDATES = 9 };
  if (!bench_wanted(size, "update points")) return;
  rng r = rng_seed(311);
  vec3 *points = worlds_get(MANY * sizeof *points), *places = worlds_get(MANY * sizeof *places);
  uint32_t *changed = worlds_get(MANY * sizeof *changed);
  for (size_t i = 0; i < MANY; i++) points[i] = rng_in_cube(&r, 5.0);
  cprox_body *body = NULL, *before = NULL;
  const double start = worlds_now();
  worlds_check(cprox_body_create_points(points, MANY, 0.01, SIZE_MAX, q->ws, &body), q->ws);
  worlds_say_build("points", MANY, worlds_now() - start, body);
  double best[UPDATES];
  for (int k = 0; k < UPDATES; k++) {
    const double low = -5.0 + 2.5 * (k % 4);
    size_t n = 0;
    for (uint32_t i = 0; i < MANY; i++) {
      if (points[i].x < low || points[i].x > low + 2.5 || points[i].y > -2.5 || points[i].z > 2.5) continue;
      points[i] = vec_add(points[i], rng_in_cube(&r, 0.01));
      changed[n] = i, places[n++] = points[i];
    }
    cprox_body *next = NULL;
    const double begun = worlds_now();
    worlds_check(cprox_body_update_points(body, changed, places, n, before, q->ws, &next), q->ws);
    best[k] = worlds_now() - begun;
    before = body, body = next;
  }
  qsort(best + 1, UPDATES - 1, sizeof *best, by_number); /* the first had no memory to take over */
  printf("worlds,update points,curve_proximity,points %d cells 3 of 64,%.4g,%.4g,,,,0,0\n", MANY,
         1e6 * best[UPDATES / 2], 1e6 * best[UPDATES - 1]);
  cprox_body_free(before);
  cprox_body_free(body);
  free(points), free(places), free(changed);
}
