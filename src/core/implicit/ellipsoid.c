/* SPDX-License-Identifier: BSD-3-Clause */
/* A body of one quadric x'Qx + b·x + c <= 0 is an ellipsoid: with its middle m = -Q^-1 b/2 and r² = m'Qm - c, its
 * extreme point along n is m + r Q^-1 n/sqrt(n'Q^-1 n), and the multiplier there sqrt(n'Q^-1 n)/(2r). */
#include <math.h>

#include "implicit/implicit.h"

/* Q x = v by Cholesky's factor; false where rounding has made Q indefinite. */
static bool solve_quadric(const double q[6], vec3 v, vec3 *x) {
  const double l00 = sqrt(q[0]), l10 = q[1] / l00, l20 = q[2] / l00;
  const double l11 = sqrt(q[3] - l10 * l10), l21 = (q[4] - l20 * l10) / l11;
  const double l22 = sqrt(q[5] - l20 * l20 - l21 * l21);
  if (!(l00 > 0.0 && l11 > 0.0 && l22 > 0.0)) return false;
  const double y0 = v.x / l00, y1 = (v.y - l10 * y0) / l11, y2 = (v.z - l20 * y0 - l21 * y1) / l22;
  x->z = y2 / l22;
  x->y = (y1 - l21 * x->z) / l11;
  x->x = (y0 - l10 * x->y - l20 * x->z) / l00;
  return true;
}

bool implicit_ellipsoid_support(const implicit *body, vec3 n, vec3 *at, double *upper) {
  enum { SHRINKS = 8 };
  if (body->n_planes + body->n_powers > 0 || body->n_quadrics != 1) return false;
  const implicit_quadric *quadric = &body->quadric[0];
  vec3 along, middle;
  if (!solve_quadric(quadric->q, n, &along) || !solve_quadric(quadric->q, quadric->b, &middle)) return false;
  middle = vec_scale(-0.5, middle);
  const double root = sqrt(vec_dot(n, along));
  const double radius = sqrt(-0.5 * vec_dot(quadric->b, middle) - quadric->c);
  if (!(root > 0.0 && radius > 0.0)) return false;
  const vec3 x = vec_axpy(middle, radius / root, along);
  *upper = implicit_quadric_height(body, n, x, 0.5 * root / radius);

  /* drawn to the middle until it is inside, as computed */
  double drawn = 0.0;
  *at = x;
  for (int i = 0; i < SHRINKS && implicit_value(body, *at) > 0.0; i++) {
    drawn = i == 0 ? ROUND_U : 8.0 * drawn;
    *at = vec_axpy(x, -drawn * body->radius / body->inner, vec_sub(x, middle));
  }
  return implicit_value(body, *at) <= 0.0;
}
