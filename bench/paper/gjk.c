/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "convex/simplex.h"
#include "paper.h"

static size_t extreme(const vec3 *p, size_t n, vec3 d) {
  size_t best = 0;
  double most = vec_dot(d, p[0]);
  for (size_t i = 1; i < n; i++) {
    const double h = vec_dot(d, p[i]);
    if (h > most) most = h, best = i;
  }
  return best;
}

/* The mean of the numbers of the second set's vertices, in [0, 1]. */
static double place_of(const simplex *s, size_t nb) {
  double sum = 0.0;
  for (int i = 0; i < s->n; i++) sum += s->weight[i] * (double)s->vertex[i].id_b;
  return nb > 1 ? sum / (double)(nb - 1) : 0.0;
}

double paper_gjk(const vec3 *a, size_t na, const vec3 *b, size_t nb, double *lower, double *at, uint32_t *evaluations) {
  enum { MOST_STEPS = 100 };
  const double tolerance = 1e-12; /* relative gap between the two bounds */
  simplex s = {.n = 1};
  s.vertex[0].w = vec_sub(a[0], b[0]);
  simplex_nearest nearest;
  simplex_reduce(&s, &nearest);
  *lower = 0.0;
  for (int i = 0; i < MOST_STEPS && !nearest.inside && nearest.distance > 0.0; i++) {
    const vec3 v = nearest.v;
    const size_t in_b = extreme(b, nb, v);
    const vec3 w = vec_sub(a[extreme(a, na, vec_neg(v))], b[in_b]);
    (*evaluations)++;
    *lower = fmax(*lower, vec_dot(v, w) / nearest.distance);
    if (nearest.distance - *lower <= tolerance * nearest.distance || simplex_has(&s, w) || s.n == 4) break;
    simplex grown = s;
    grown.vertex[grown.n] = (simplex_vertex){.w = w, .id_b = (int32_t)in_b};
    grown.n++;
    simplex_nearest closer;
    simplex_reduce(&grown, &closer);
    if (!closer.inside && closer.distance >= nearest.distance) break;
    s = grown, nearest = closer;
  }
  if (at) *at = place_of(&s, nb);
  return nearest.inside ? 0.0 : nearest.distance;
}
