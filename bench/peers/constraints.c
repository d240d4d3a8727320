/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/constraints.h"

#include <math.h>

vec3 constraint_turn(const double *m, vec3 v) {
  return vec(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
             m[6] * v.x + m[7] * v.y + m[8] * v.z);
}

vec3 constraint_turn_back(const double *m, vec3 v) {
  return vec(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
             m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

double constraint_at(const implicit *body, int32_t k, vec3 x, vec3 *g, double h[6]) {
  for (int i = 0; i < 6; i++) h[i] = 0.0;
  if (k < body->n_planes) {
    *g = body->plane[k].b;
    return vec_dot(*g, x) + body->plane[k].c;
  }
  k -= body->n_planes;
  if (k < body->n_quadrics) {
    for (int i = 0; i < 6; i++) h[i] = 2.0 * body->quadric[k].q[i];
    return implicit_quadric_at(&body->quadric[k], x, g);
  }
  const implicit_power *power = &body->power[k - body->n_quadrics];
  double value = -1.0;
  *g = vec(0, 0, 0);
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    const implicit_term *term = &body->term[i];
    const double row = implicit_row(term, x), u = fabs(row), raised = implicit_raise(term, u);
    const double slope = u > 0.0 ? term->p * raised / row : 0.0;
    /* p < 2 has no second derivative at 0: a large number stands for it */
    const double bend = u > 1e-12 ? term->p * (term->p - 1.0) * raised / (u * u) : term->p < 2.0 ? 1e8 : 0.0;
    value += raised;
    *g = vec_axpy(*g, slope, term->a);
    const vec3 a = term->a;
    h[0] += bend * a.x * a.x, h[1] += bend * a.x * a.y, h[2] += bend * a.x * a.z;
    h[3] += bend * a.y * a.y, h[4] += bend * a.y * a.z, h[5] += bend * a.z * a.z;
  }
  return value;
}
