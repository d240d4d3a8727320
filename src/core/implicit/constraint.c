/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/rounding.h"
#include "implicit/implicit.h"

double implicit_raise(const implicit_term *term, double u) {
  if (term->whole == 2) return u * u;
  if (term->whole == 0) return pow(u, term->p);
  double power = 1.0, square = u;
  for (int n = term->whole; n > 0; n >>= 1) {
    if (n & 1) power *= square;
    square *= square;
  }
  return power;
}

double implicit_quadric_at(const implicit_quadric *k, vec3 x, vec3 *gradient) {
  const double *q = k->q;
  const vec3 qx = vec(q[0] * x.x + q[1] * x.y + q[2] * x.z, q[1] * x.x + q[3] * x.y + q[4] * x.z,
                      q[2] * x.x + q[4] * x.y + q[5] * x.z);
  if (gradient) *gradient = vec_axpy(k->b, 2.0, qx);
  return vec_dot(qx, x) + vec_dot(k->b, x) + k->c;
}

double implicit_value(const implicit *body, vec3 x) {
  double most = -INFINITY;
  for (int32_t k = 0; k < body->n_planes; k++) most = fmax(most, vec_dot(body->plane[k].b, x) + body->plane[k].c);
  for (int32_t k = 0; k < body->n_quadrics; k++) most = fmax(most, implicit_quadric_at(&body->quadric[k], x, NULL));
  for (int32_t k = 0; k < body->n_powers; k++) {
    const implicit_term *term = body->term + body->power[k].first;
    double sum = -1.0;
    for (int32_t i = 0; i < body->power[k].n; i++) sum += implicit_raise(&term[i], fabs(implicit_row(&term[i], x)));
    most = fmax(most, sum);
  }
  return most;
}

double implicit_gauge(const implicit *body, vec3 x, double tolerance) {
  /* the longest s with s x inside, from inside: s = 1 or more to begin with, radius/|x| or less at the end */
  const double norm = vec_norm(x);
  if (!(norm > tolerance * body->inner)) return tolerance;
  double inside = 1.0, outside = fmax(2.0, 1.01 * body->radius / norm);
  for (int i = 0; i < 60 && outside - inside > tolerance * inside; i++) {
    const double middle = sqrt(inside * outside);
    if (implicit_value(body, vec_scale(middle, x)) <= 0.0)
      inside = middle;
    else
      outside = middle;
  }
  return 1.0 / inside;
}
