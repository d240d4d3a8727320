/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves, queries and rows that all workloads share. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "support/make_curve.h"
#include "worlds/worlds.h"

void worlds_check(cprox_status status, const cprox_workspace *ws) {
  if (status >= 0) return;
  fprintf(stderr, "worlds: %s\n", cprox_workspace_error(ws));
  exit(1);
}

void *worlds_get(size_t bytes) {
  void *memory = malloc(bytes);
  if (!memory) exit(1);
  return memory;
}

void worlds_curve_make(rng *r, worlds_problem *p, vec3 centre, vec3 half, double scale) {
  p->points[0] = vec_add(
      centre, vec(rng_uniform(r, -half.x, half.x), rng_uniform(r, -half.y, half.y), rng_uniform(r, -half.z, half.z)));
  const vec3 step = vec_scale(scale / 5.0, rng_unit(r));
  for (int k = 1; k < WORLDS_POINTS; k++)
    p->points[k] = vec_add(vec_add(p->points[k - 1], step), rng_in_cube(r, 0.15 * scale));
  if (curve_from(describe_bezier(p->points, WORLDS_POINTS, 0.0, 1.0), NULL, &p->curve) != CPROX_OK) exit(1);
}

cprox_mover worlds_mover(const worlds_problem *p) {
  return cprox_tube_along(p->curve, p->radius);
}

void worlds_take(const cprox_result *r, bench_answer *a) {
  *a = (bench_answer){.lower = r->lower, .upper = r->upper, .nodes = r->nodes, .distance_queries = r->distance_queries};
  a->failed = r->status < 0 || r->status == CPROX_BUDGET;
}

cprox_options worlds_options(double epsilon) {
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.epsilon = epsilon;
  return o;
}

double worlds_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void worlds_say_build(const char *what, size_t n, double seconds, const cprox_body *body) {
  printf("worlds,build %s,curve_proximity,elements %zu,%.4g,%.4g,%.4g,,,0,0\n", what, n, 1e6 * seconds, 1e6 * seconds,
         (double)cprox_body_get_info(body).bytes / (double)n);
  fflush(stdout);
}
