/* SPDX-License-Identifier: BSD-3-Clause */
#include "support.h"

/* out = v × n for doubles v */
static void cross(iv out[3], const double v[3], const iv n[3]) {
  iv *w = iv_new(2);
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    iv_mul_d(&w[0], &n[j], v[i]);
    iv_mul_d(&w[1], &n[i], v[j]);
    iv_sub(&out[k], &w[0], &w[1]);
  }
  iv_free(w, 2);
}

/* n becomes R n, or with back its inverse: n + 2/q·q (w v × n + v × (v × n)), q = (w, v) */
static void turn(iv n[3], const double q[4], bool back) {
  iv *first = iv_new(3), *second = iv_new(3), *s = iv_new(2);
  for (int k = 0; k < 4; k++) {
    iv_set_d(&s[1], q[k]);
    iv_mul(&s[1], &s[1], &s[1]);
    iv_add(&s[0], &s[0], &s[1]);
  }
  iv_set_d(&s[1], 2.0);
  iv_div(&s[0], &s[1], &s[0]);
  cross(first, q + 1, n);
  cross(second, q + 1, first);
  for (int k = 0; k < 3; k++) {
    iv_mul_d(&first[k], &first[k], back ? -q[0] : q[0]);
    iv_add(&first[k], &first[k], &second[k]);
    iv_mul(&first[k], &first[k], &s[0]);
    iv_add(&n[k], &n[k], &first[k]);
  }
  iv_free(first, 3);
  iv_free(second, 3);
  iv_free(s, 2);
}

static bool turns(const pose *p) {
  return p->q[1] != 0.0 || p->q[2] != 0.0 || p->q[3] != 0.0;
}

void support_of_frame(iv *far, iv own[3], const set *s, const iv n[3]) {
  iv *w = iv_new(4);
  iv_set_d(far, 0.0);
  for (int k = 0; k < 3; k++) iv_set(&own[k], &n[k]);
  for (size_t i = 0; i < s->n_poses; i++) {
    for (int k = 0; k < 3; k++) iv_set_d(&w[k], s->poses[i].x[k]);
    iv_dot(&w[3], own, w);
    iv_add(far, far, &w[3]);
    if (turns(&s->poses[i])) turn(own, s->poses[i].q, true);
  }
  iv_free(w, 4);
}

set support_outermost(const set *s) {
  set outer = *s;
  outer.n_poses = s->n_poses > 0;
  return outer;
}

void support_point_to_frame(iv own[3], const set *s, const iv p[3], const iv *ride) {
  iv *w = iv_new(1);
  for (int k = 0; k < 3; k++) iv_set(&own[k], &p[k]);
  for (size_t i = 0; i < s->n_poses; i++) {
    for (int k = 0; k < 3; k++) {
      iv_set_d(w, s->poses[i].x[k]);
      iv_sub(&own[k], &own[k], w);
    }
    if (turns(&s->poses[i])) turn(own, s->poses[i].q, true);
    for (int k = 0; k < 3 && ride && i == 0; k++) iv_sub(&own[k], &own[k], &ride[k]);
  }
  for (int k = 0; k < 3 && ride && s->n_poses == 0; k++) iv_sub(&own[k], &own[k], &ride[k]);
  iv_free(w, 1);
}

void support_to_world(iv n[3], const set *s) {
  for (size_t i = s->n_poses; i-- > 0;)
    if (turns(&s->poses[i])) turn(n, s->poses[i].q, false);
}

void support_point_to_world(iv p[3], const set *s, const iv own[3]) {
  iv *w = iv_new(1);
  for (int k = 0; k < 3; k++) iv_set(&p[k], &own[k]);
  for (size_t i = s->n_poses; i-- > 0;) {
    if (turns(&s->poses[i])) turn(p, s->poses[i].q, false);
    for (int k = 0; k < 3; k++) {
      iv_set_d(w, s->poses[i].x[k]);
      iv_add(&p[k], &p[k], w);
    }
  }
  iv_free(w, 1);
}

/* max n·v over the vertices, the centre added. */
static void vertices(iv *out, const set *s, const iv n[3]) {
  iv *w = iv_new(4);
  for (size_t i = 0; i < s->n; i++) {
    for (int k = 0; k < 3; k++) iv_set_d(&w[k], s->vertices[i][k]);
    iv_dot(&w[3], n, w);
    if (i == 0) iv_set(out, &w[3]);
    iv_max(out, out, &w[3]);
  }
  for (int k = 0; k < 3; k++) iv_set_d(&w[k], s->centre[k]);
  iv_dot(&w[3], n, w);
  iv_add(out, out, &w[3]);
  iv_free(w, 4);
}

/* sum a_k |n_k|, or with squares the root of sum (a_k n_k)² */
static void boxed(iv *out, const double a[3], const iv n[3], bool squares) {
  iv *w = iv_new(3), *sum = iv_new(1);
  for (int k = 0; k < 3; k++) {
    iv_mul_d(&w[k], &n[k], a[k]);
    iv_abs(&w[k], &w[k]);
    iv_add(sum, sum, &w[k]);
  }
  if (squares) iv_norm(sum, w);
  iv_set(out, sum);
  iv_free(w, 3);
  iv_free(sum, 1);
}

void support_of_body(iv *out, const set *s, const iv n[3]) {
  /* SIZE of capsules, cylinders and cones: half the height along z, the radius */
  const double *size = s->size, along[3] = {0.0, 0.0, size[0]}, across[3] = {size[1], size[1], 0.0};
  iv *w = iv_new(2);
  iv_set_d(out, 0.0);
  switch (s->kind) {
    case POINT:
    case POLYTOPE: {
      const set one = {
          .n = 1, .vertices = (double[1][3]){{0.0, 0.0, 0.0}}, .centre = {s->centre[0], s->centre[1], s->centre[2]}};
      vertices(out, s->kind == POINT ? &one : s, n);
      break;
    }
    case SPHERE:
      iv_norm(out, n);
      iv_mul_d(out, out, size[0]);
      break;
    case BOX: boxed(out, size, n, false); break;
    case ELLIPSOID: boxed(out, size, n, true); break;
    case HULL: /* of a mesh that may stick out of it */
      vertices(out, s, n);
      iv_norm(&w[0], n);
      iv_mul_d(&w[0], &w[0], size[0]);
      iv_add(out, out, &w[0]);
      break;
    case CAPSULE:
      boxed(out, along, n, false);
      iv_norm(&w[0], n);
      iv_mul_d(&w[0], &w[0], size[1]);
      iv_add(out, out, &w[0]);
      break;
    case CYLINDER:
      boxed(out, along, n, false);
      boxed(&w[0], across, n, true);
      iv_add(out, out, &w[0]);
      break;
    case CONE: /* the apex, or the rim */
      iv_mul_d(out, &n[2], size[0]);
      boxed(&w[0], across, n, true);
      iv_sub(&w[0], &w[0], out);
      iv_max(out, out, &w[0]);
      break;
    case HALFSPACE: /* along its own normal only: n·x + d <= 0 */ iv_set_d(out, -size[3]); break;
    default: break; /* asked part by part */
  }
  iv_free(w, 2);
}
