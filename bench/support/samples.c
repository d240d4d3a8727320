/* SPDX-License-Identifier: BSD-3-Clause */
#include "samples.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peers/sampling.h"

enum { MOST_SAMPLES = 10000 };

typedef struct effort {
  size_t samples;
  vec3 *points; /* room for 2 (samples + 1) */
} effort;

static void take_points(const cprox_curve *curve, size_t n, vec3 *points) {
  double t0, t1;
  t0 = cprox_curve_get_info(curve).t0, t1 = cprox_curve_get_info(curve).t1;
  for (size_t i = 0; i <= n; i++) {
    const double t = i == n ? t1 : t0 + (t1 - t0) * (double)i / (double)n;
    cprox_curve_evaluate(curve, t, NULL, &points[i], NULL, NULL);
  }
}

static void ask(const void *queries, size_t i, void *state, bench_answer *a) {
  const sampled_query *p = (const sampled_query *)queries + i;
  const effort *e = state;
  const size_t n = p->second ? (size_t)sqrt((double)e->samples) : e->samples;
  double least = INFINITY;
  take_points(p->curve, n, e->points);
  if (p->second) {
    vec3 *other = e->points + n + 1;
    take_points(p->second, n, other);
    for (size_t j = 0; j <= n; j++)
      for (size_t k = 0; k <= n; k++) least = fmin(least, vec_norm(vec_sub(e->points[j], other[k])));
  } else if (p->peer) {
    least = sampling_polytope_distance(p->peer, e->points, n + 1);
  } else {
    for (size_t j = 0; j <= n; j++) least = fmin(least, vec_norm(vec_sub(e->points[j], p->obstacle->vertex[0])));
  }
  *a = (bench_answer){.lower = least, .upper = least, .nodes = (uint32_t)e->samples};
}

void samples_measure(const bench_size *size, const char *group, const char *workload, const char *prefix,
                     sampled_query *queries, size_t n, const double *truth) {
  const bool polytope = queries[0].obstacle && queries[0].obstacle->n > 1;
  if (polytope && !sampling_polytope_name()) return;
  for (size_t i = 0; i < n && polytope; i++) {
    const obstacle *o = queries[i].obstacle;
    queries[i].peer = sampling_polytope(o->vertex, o->n, (const int(*)[3])o->triangle, o->triangles);
  }
  effort e = {.points = calloc(2 * (MOST_SAMPLES + 1), sizeof *e.points)};
  if (!e.points) exit(1);
  for (e.samples = 100; e.samples <= MOST_SAMPLES; e.samples *= 10) {
    char parameter[64];
    snprintf(parameter, sizeof parameter, "%ssamples %zu", prefix, e.samples);
    const bench_workload w = {group, workload, parameter, queries, n, truth, 1e-9};
    const bench_method method = {polytope ? sampling_polytope_name() : "points of the curve", ask, &e};
    bench_measure(&w, size, &method, 1);
  }
  for (size_t i = 0; i < n && polytope; i++) sampling_polytope_free(queries[i].peer);
  free(e.points);
}
