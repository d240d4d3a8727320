/* SPDX-License-Identifier: BSD-3-Clause */
#include "span.h"

/* In plain doubles; every way takes fewer than 12 roundings, none of more than |n| times the radius. */
static double along(const set *s, const double n[3]) {
  const double *a = s->size, across = sqrt(n[0] * n[0] + n[1] * n[1]);
  switch (s->kind) {
    case SPHERE: return a[0] * length_of(n);
    case BOX: return fabs(a[0] * n[0]) + fabs(a[1] * n[1]) + fabs(a[2] * n[2]);
    case ELLIPSOID: return length_of((const double[3]){a[0] * n[0], a[1] * n[1], a[2] * n[2]});
    case CAPSULE: return a[0] * fabs(n[2]) + a[1] * length_of(n);
    case CYLINDER: return a[0] * fabs(n[2]) + a[1] * across;
    case CONE: return fmax(a[0] * n[2], a[1] * across - a[0] * n[2]);
    case HALFSPACE: return -a[3];
    case POINT: return 0.0;
    case IMPLICIT:
    case CURVE: return INFINITY;
    default: { /* of vertices */
      double most = -INFINITY;
      for (size_t i = 0; i < s->n; i++) {
        const double *v = s->vertices[i], far = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
        if (far > most) most = far;
      }
      return most + a[0] * length_of(n);
    }
  }
}

num span_along(const set *s, double radius, const vec *n) {
  return (num){along(s, n->m), GROW(radius * (n->e + 16.0 * BALL_U * length_of(n->m)))};
}

double span_radius(const set *s) {
  const double *a = s->size;
  double most = 0.0;
  switch (s->kind) {
    case SPHERE: most = a[0]; break;
    case BOX: most = length_of(a); break;
    case ELLIPSOID: most = fmax(a[0], fmax(a[1], a[2])); break;
    case CAPSULE: most = a[0] + a[1]; break;
    case CYLINDER:
    case CONE: most = length_of((const double[3]){a[0], a[1], 0.0}); break;
    case HALFSPACE: most = fabs(a[3]); break;
    case POINT: break;
    case IMPLICIT:
    case CURVE: most = INFINITY; break;
    default:
      for (size_t i = 0; i < s->n; i++) {
        const double *v = s->vertices[i], square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        if (square > most) most = square;
      }
      most = sqrt(most) + 0x1p-500 + a[0];
      break;
  }
  return GROW(most);
}

void span_box(const set *s, double middle[3], double half[3]) {
  const double ball = s->kind == SPHERE    ? s->size[0]
                      : s->kind == CAPSULE ? s->size[1]
                      : s->kind == HULL    ? s->size[0]
                                           : 0.0;
  for (int k = 0; k < 3; k++) {
    double n[3] = {0.0, 0.0, 0.0};
    n[k] = 1.0;
    const double high = along(s, n);
    n[k] = -1.0;
    const double low = -along(s, n);
    middle[k] = 0.5 * (low + high);
    half[k] = 0.5 * (high - low) - ball;
  }
}
