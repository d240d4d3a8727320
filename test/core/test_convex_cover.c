/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers hold the whole shape and touch it; supports and nearest points speak of the same set. */
#include "base/rounding.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { MOST = 24 };

static cprox_body *random_body(rng *r, cprox_body_kind kind, double aspect) {
  const double scale = rng_log_uniform(r, 1e-3, 1e3);
  const double a = scale * rng_log_uniform(r, 1.0 / aspect, 1.0), b = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  const double c = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  cprox_body *body = NULL;
  cprox_status status = CPROX_INVALID;
  switch (kind) {
    case CPROX_BODY_POINT: status = cprox_body_create_point(vec(a, b, c), NULL, &body); break;
    case CPROX_BODY_SPHERE: status = cprox_body_create_sphere(a, NULL, &body); break;
    case CPROX_BODY_BOX: status = cprox_body_create_box(vec(a, b, c), NULL, &body); break;
    case CPROX_BODY_CAPSULE: status = cprox_body_create_capsule(a, b, NULL, &body); break;
    case CPROX_BODY_CYLINDER: status = cprox_body_create_cylinder(a, b, NULL, &body); break;
    case CPROX_BODY_CONE: status = cprox_body_create_cone(a, b, NULL, &body); break;
    case CPROX_BODY_ELLIPSOID: status = cprox_body_create_ellipsoid(vec(a, b, c), NULL, &body); break;
    case CPROX_BODY_POLYGON: {
      double v[MOST][2];
      const size_t n = 3 + rng_index(r, MOST - 3);
      for (size_t i = 0; i < n; i++) {
        const double angle = 6.283185307 * ((double)i + 0.4 * rng_uniform(r, 0.0, 1.0)) / (double)n;
        v[i][0] = a * cos(angle);
        v[i][1] = b * sin(angle);
      }
      status = cprox_body_create_polygon((const double(*)[2])v, n, NULL, &body);
      break;
    }
    default: {
      vec3 v[MOST];
      const size_t n = 1 + rng_index(r, MOST);
      for (size_t i = 0; i < n; i++) {
        const vec3 u = rng_unit(r);
        v[i] = vec(a * u.x, b * u.y, c * u.z);
      }
      status = cprox_body_create_polytope(v, n, NULL, &body);
    }
  }
  assert_int_equal(status, CPROX_OK);
  return body;
}

static vec3 extreme(const convex *shape, vec3 d) {
  vec3 at;
  shape->ops->support(shape, d, NULL, &at);
  return vec_axpy(at, shape->margin / vec_norm(d), d);
}

static const cprox_body_kind KINDS[] = {CPROX_BODY_POINT,     CPROX_BODY_SPHERE,   CPROX_BODY_BOX,
                                        CPROX_BODY_CAPSULE,   CPROX_BODY_CYLINDER, CPROX_BODY_CONE,
                                        CPROX_BODY_ELLIPSOID, CPROX_BODY_POLYTOPE, CPROX_BODY_POLYGON};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

/* Distance of p from the cover's centre or axis, in long double. */
static long double reach(const convex_cover *cover, vec3 p) {
  vec3l w = ref_sub(ref_vec(p), ref_vec(cover->centre));
  if (cover->cylinder) {
    const vec3l axis = ref_vec(cover->axis);
    w = ref_sub(w, ref_scale(ref_dot(w, axis) / ref_dot(axis, axis), axis));
  }
  return ref_norm(w);
}

/* Seed 401, 1e5 covers of shapes of aspect up to 1e3: every extreme point tried lies inside to the last bit, and the
 * cover passes within 1e-12 (R + size) of the nearest point. Extreme points carry their own rounding, 8 u size. */
CASE(a_cover_holds_the_whole_shape_and_touches_it) {
  rng r = rng_seed(401);
  size_t covers[N_KINDS] = {0}, cylinders[N_KINDS] = {0};
  for (size_t i = 0; i < test_cases(100000); i++) {
    const size_t k = i % N_KINDS;
    cprox_body *body = random_body(&r, KINDS[k], rng_index(&r, 2) ? 1e3 : 3.0);
    const convex *shape = &body->shape;
    const vec3 y = vec_scale(shape->scale * rng_log_uniform(&r, 0.5, 10.0), rng_unit(&r));
    convex_near near;
    convex_cover cover = {0};
    shape->ops->nearest(shape, y, NULL, &near);
    if (near.distance > 1e-9 * shape->scale && shape->ops->cover && shape->ops->cover(shape, &near, &cover)) {
      covers[k]++;
      cylinders[k] += cover.cylinder;
      const long double slack = KINDS[k] == CPROX_BODY_POLYTOPE || KINDS[k] == CPROX_BODY_POLYGON ||
                                        KINDS[k] == CPROX_BODY_BOX || KINDS[k] == CPROX_BODY_POINT
                                    ? 0.0L
                                    : 8.0L * ROUND_U * shape->scale;
      for (int j = 0; j < 30; j++) {
        const vec3 d = j % 3 ? rng_unit(&r) : vec_axpy(near.normal, rng_log_uniform(&r, 1e-6, 1.0), rng_unit(&r));
        const long double out = reach(&cover, extreme(shape, d));
        if (!(out <= cover.radius + slack))
          fail_msg("%s: a point is %.20Lg from the centre, radius %.17g", cprox_body_kind_name(KINDS[k]), out,
                   cover.radius);
      }
      const long double touch = cover.radius - reach(&cover, near.point);
      if (!(fabsl(touch) <= 1e-12 * (cover.radius + shape->scale)))
        fail_msg("%s: the cover passes %.3Lg beside the nearest point, radius %g", cprox_body_kind_name(KINDS[k]),
                 touch, cover.radius);
    }
    cprox_body_free(body);
  }
  for (size_t k = 0; k < N_KINDS; k++) {
    if (KINDS[k] == CPROX_BODY_CONE)
      assert_int_equal(covers[k], 0);
    else
      assert_true(covers[k] > 0 || test_cases(100) < 100);
  }
  assert_true(cylinders[2] > 0 && cylinders[3] > 0 && cylinders[4] > 0 && cylinders[7] > 0);
}

CASE(a_face_has_no_cover) {
  cprox_body *box = NULL;
  cprox_body_create_box(vec(2, 2, 2), NULL, &box);
  convex_near near;
  convex_cover cover;
  box->shape.ops->nearest(&box->shape, vec(0.1, 0.2, 3), NULL, &near);
  assert_false(box->shape.ops->cover(&box->shape, &near, &cover));
  box->shape.ops->nearest(&box->shape, vec(3, 3, 0.5), NULL, &near);
  assert_true(box->shape.ops->cover(&box->shape, &near, &cover));
  assert_true(cover.cylinder && fabs(cover.radius - sqrt(2.0)) < 1e-12);
  box->shape.ops->nearest(&box->shape, vec(3, 3, 3), NULL, &near);
  assert_true(box->shape.ops->cover(&box->shape, &near, &cover));
  assert_true(!cover.cylinder && fabs(cover.radius - sqrt(3.0)) < 1e-12);
  cprox_body_free(box);
}

/* Seed 402, 1e5 directions of any length: h(d) is d·x of the point it names, that point is in the shape and within its
 * scale, and no point of the shape lies beyond it. ROUND_SUPPORT u |d| scale as convex.h states it. */
CASE(the_support_is_attained_and_never_passed) {
  rng r = rng_seed(402);
  for (size_t i = 0; i < test_cases(100000); i++) {
    const size_t k = i % N_KINDS;
    cprox_body *body = random_body(&r, KINDS[k], rng_index(&r, 2) ? 1e6 : 3.0);
    const convex *shape = &body->shape;
    const double length = rng_index(&r, 2) ? 1.0 : rng_log_uniform(&r, 1e-30, 1e30);
    const vec3 axes[3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    const vec3 d = vec_scale(length, rng_index(&r, 8) ? rng_unit(&r) : axes[rng_index(&r, 3)]);
    const double norm = vec_norm(d), slack = ROUND_SUPPORT * ROUND_U * norm * shape->scale;
    vec3 at, other;
    const double h = shape->ops->support(shape, d, NULL, &at);
    assert_true(fabsl(ref_dot(ref_vec(d), ref_vec(at)) - h) <= slack);
    assert_true(vec_norm(at) <= shape->scale * (1.0 + 1e-15));
    for (int j = 0; j < 5; j++) {
      const vec3 e = vec_axpy(vec_scale(1.0 / norm, d), rng_log_uniform(&r, 1e-8, 1.0), rng_unit(&r));
      shape->ops->support(shape, e, NULL, &other);
      assert_true(ref_dot(ref_vec(d), ref_vec(other)) <= h + slack);
    }
    /* of the shape: the distance of the whole from the point and margin beyond it is 0 */
    convex_near near;
    const vec3 surface = extreme(shape, d);
    shape->ops->nearest(shape, surface, NULL, &near);
    assert_true(near.distance <= (shape->ops->near_rounding + 8.0) * ROUND_U * 2.0 * shape->scale);
    /* a point a little farther along d is away from it by as much or nearly so */
    if (shape->ops->follow) {
      const vec3 same = shape->ops->follow(shape, d, at);
      assert_true(vec_norm(vec_sub(same, at)) <= 1e-15 * shape->scale);
    }
    cprox_body_free(body);
  }
}

/* Seed 403, 3e4 directions at least 0.2 off the axis: central differences over a turn of 1e-5 agree with the derivative
 * within 1e-6 sizes (their second order is 1e-10, their rounding 1e-11, times what a ratio of axes of 4 and 1/0.2 raise
 * it by). */
CASE(the_maximiser_moves_as_its_curvature_says) {
  rng r = rng_seed(403);
  const cprox_body_kind curved[] = {CPROX_BODY_CYLINDER, CPROX_BODY_CONE, CPROX_BODY_ELLIPSOID};
  for (size_t i = 0; i < test_cases(30000); i++) {
    cprox_body *body = random_body(&r, curved[i % 3], 2.0);
    const convex *shape = &body->shape;
    const vec3 d = rng_unit(&r), turn = rng_unit(&r);
    if (hypot(d.x, d.y) > 0.2) {
      vec3 x;
      double h[6];
      shape->ops->support(shape, d, NULL, &x);
      shape->ops->curvature(shape, d, x, h);
      const double step = 1e-5;
      const vec3 up = shape->ops->follow(shape, vec_axpy(d, step, turn), x);
      const vec3 down = shape->ops->follow(shape, vec_axpy(d, -step, turn), x);
      const vec3 moved = vec_scale(0.5 / step, vec_sub(up, down));
      const vec3 stated =
          vec(h[0] * turn.x + h[1] * turn.y + h[2] * turn.z, h[1] * turn.x + h[3] * turn.y + h[4] * turn.z,
              h[2] * turn.x + h[4] * turn.y + h[5] * turn.z);
      /* the derivative of a function of the direction alone has no part along it */
      const vec3 across = vec_axpy(stated, -vec_dot(stated, d), d);
      if (!(vec_norm(vec_sub(moved, stated)) <= 1e-6 * shape->scale) ||
          !(vec_norm(vec_sub(across, stated)) <= 1e-12 * shape->scale))
        fail_msg("%s: off by %g", cprox_body_kind_name(curved[i % 3]), vec_norm(vec_sub(moved, stated)) / shape->scale);
    }
    cprox_body_free(body);
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
