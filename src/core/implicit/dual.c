/* SPDX-License-Identifier: BSD-3-Clause */
/* Multipliers of bounds on the support function, for proofs that others check. */
#include "implicit/implicit.h"

/* Of one hyperquadric of three terms: n = sum w_i a_i. */
static void dual_of_closed(const implicit *body, vec3 n, implicit_dual *dual) {
  enum { STEPS = 60 };
  const double *inv = body->inverse;
  const double along[3] = {inv[0] * n.x + inv[3] * n.y + inv[6] * n.z, inv[1] * n.x + inv[4] * n.y + inv[7] * n.z,
                           inv[2] * n.x + inv[5] * n.y + inv[8] * n.z};
  double w[3], u[3], mu = 0.0;
  for (int i = 0; i < 3; i++) {
    dual->row[1 + i] = along[i];
    w[i] = fabs(along[i]);
  }
  implicit_power_reach(body->term, 3, w, &mu, STEPS, u);
  dual->row[0] = mu;
}

bool implicit_dual_along(const implicit *body, vec3 n, void *memory, implicit_dual *dual) {
  dual->x = vec(0, 0, 0);
  if (body->closed) {
    dual_of_closed(body, n, dual);
    return true;
  }
  double upper;
  if (implicit_ellipsoid_support(body, n, &dual->x, &upper)) { /* along its own gradient there */
    vec3 gradient;
    implicit_quadric_at(&body->quadric[0], dual->x, &gradient);
    dual->row[0] = 1.0 / vec_norm(gradient);
    return true;
  }
  const implicit_query query = {.a = body, .far = true, .t = n, .dual = dual};
  const implicit_goal goal = {.epsilon = 1e-12 * body->radius, .max_steps = 2000};
  implicit_answer answer;
  implicit_solve(&query, &goal, NULL, memory, &answer);
  return isfinite(answer.upper);
}
