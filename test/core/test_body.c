/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies: what constructors refuse and in which words, bounding spheres, supports, nearest points, compounds. */
#include <string.h>

#include "base/rounding.h"
#include "curve_proximity/cprox/query.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/random.h"
#include "support/reference.h"

/* The call fails with exactly these words, leaves the handle alone and keeps no memory. */
#define REFUSED(call, words)                                              \
  do {                                                                    \
    cprox_body *body = (cprox_body *)&ws;                                 \
    const size_t live = allocations_live();                               \
    assert_int_equal(call, CPROX_INVALID);                                \
    assert_string_equal(cprox_workspace_error(ws), words);                \
    assert_true(body == (cprox_body *)&ws && allocations_live() == live); \
  } while (0)

CASE(bad_sizes_are_refused_by_name_and_value) {
  REFUSED(cprox_body_create_sphere(-1.0, ws, &body), "radius is -1, must be > 0");
  REFUSED(cprox_body_create_sphere(0.0, ws, &body), "radius is 0, must be > 0");
  REFUSED(cprox_body_create_sphere(NAN, ws, &body), "radius is nan, must be > 0");
  REFUSED(cprox_body_create_sphere(INFINITY, ws, &body), "radius is inf, must be finite");
  REFUSED(cprox_body_create_sphere(1e-200, ws, &body), "radius is 1e-200, must be between 1e-100 and 1e+100");
  REFUSED(cprox_body_create_box(vec(1, 0, 1), ws, &body), "size.y is 0, must be > 0");
  REFUSED(cprox_body_create_capsule(-2.0, 1.0, ws, &body), "height is -2, must be > 0");
  REFUSED(cprox_body_create_cylinder(1.0, -0.5, ws, &body), "radius is -0.5, must be > 0");
  REFUSED(cprox_body_create_cone(NAN, 1.0, ws, &body), "height is nan, must be > 0");
  REFUSED(cprox_body_create_ellipsoid(vec(1, 2, -3), ws, &body), "semi_axes.z is -3, must be > 0");
  REFUSED(cprox_body_create_ellipsoid(vec(1, 3e6, 1), ws, &body), "semi-axis 3e+06 is more than 1e6 times semi-axis 1");
  REFUSED(cprox_body_create_halfspace(vec(0, 0, 0), 1.0, ws, &body), "normal is (0, 0, 0)");
  REFUSED(cprox_body_create_halfspace(vec(0, 0, 1), NAN, ws, &body), "offset is nan, must be finite");
  REFUSED(cprox_body_create_point(vec(0, NAN, 1), ws, &body), "the point is not finite: (0, nan, 1)");
  REFUSED(cprox_body_create_point(vec(0, 2e100, 1), ws, &body),
          "the point is (0, 2e+100, 1), farther than 1e+100 from the origin");
}

CASE(bad_vertices_are_refused_by_number) {
  const vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, INFINITY, 1}};
  REFUSED(cprox_body_create_polytope(v, 4, ws, &body), "vertex 3 is not finite: (0, inf, 1)");
  REFUSED(cprox_body_create_polytope(v, 0, ws, &body), "a polytope needs at least 1 vertex, got none");
  REFUSED(cprox_body_create_polytope(NULL, 3, ws, &body), "vertices is NULL");
  assert_int_equal(cprox_body_create_polytope(v, 3, ws, NULL), CPROX_INVALID);
}

CASE(polygons_that_are_not_convex_are_refused) {
  const double dent[5][2] = {{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}};
  const double line[3][2] = {{0, 0}, {1, 1}, {3, 3}};
  const double back[5][2] = {{0, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}};
  double star[5][2], nan[3][2] = {{0, 0}, {1, 0}, {0, NAN}};
  for (int i = 0; i < 5; i++) {
    star[i][0] = cos(4 * 3.14159265358979 * i / 5);
    star[i][1] = sin(4 * 3.14159265358979 * i / 5);
  }
  REFUSED(cprox_body_create_polygon(dent, 5, ws, &body),
          "the polygon is not convex: it turns to the other side at (1, 0.5)");
  REFUSED(cprox_body_create_polygon(back, 5, ws, &body), "the polygon is not convex: it turns back at (3, 0)");
  REFUSED(cprox_body_create_polygon((const double(*)[2])star, 5, ws, &body),
          "the polygon is not convex: it winds round 2 times");
  REFUSED(cprox_body_create_polygon(line, 3, ws, &body), "the polygon's area is 0, must be > 0");
  REFUSED(cprox_body_create_polygon(line, 2, ws, &body), "a polygon needs at least 3 vertices, got 2");
  REFUSED(cprox_body_create_polygon((const double(*)[2])nan, 3, ws, &body), "vertex 2 is not finite: (0, nan, 0)");
}

static void any_support(const void *shape, const double d[3], double p[3]) {
  (void)shape, (void)d;
  p[0] = p[1] = p[2] = 0.0;
}

CASE(bad_callbacks_are_refused) {
  const vec3 o = {0, 0, 0};
  REFUSED(cprox_body_create_support(NULL, NULL, o, 1.0, 0.0, 0.0, ws, &body), "support is NULL");
  REFUSED(cprox_body_create_support(any_support, NULL, o, 0.0, 0.0, 0.0, ws, &body), "radius is 0, must be > 0");
  REFUSED(cprox_body_create_support(any_support, NULL, o, 1.0, -1.0, 0.0, ws, &body), "slack is -1, must be >= 0");
  REFUSED(cprox_body_create_support(any_support, NULL, o, 1.0, 0.0, NAN, ws, &body), "margin is nan, must be >= 0");
}

CASE(bad_parts_are_refused_by_number) {
  cprox_body *ball = NULL, *two = NULL;
  assert_int_equal(cprox_body_create_sphere(1.0, ws, &ball), CPROX_OK);
  cprox_pose poses[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
  const cprox_body *parts[2] = {ball, NULL};
  REFUSED(cprox_body_create_compound(parts, poses, 0, ws, &body), "a compound needs at least 1 part, got none");
  REFUSED(cprox_body_create_compound(parts, poses, 2, ws, &body), "part 1 is NULL");
  REFUSED(cprox_body_create_compound(NULL, poses, 2, ws, &body), "parts is NULL");
  parts[1] = ball;
  poses[1].orientation = (cprox_quat){0, 0, 0, 0};
  REFUSED(cprox_body_create_compound(parts, poses, 2, ws, &body), "the pose of part 1: the quaternion's norm is 0");
  poses[1] = poses[0];
  assert_int_equal(cprox_body_create_compound(parts, poses, 2, ws, &two), CPROX_OK);
  parts[1] = two;
  REFUSED(cprox_body_create_compound(parts, poses, 2, ws, &body),
          "part 1 is a compound itself: give its parts instead");
  cprox_body_free(two);
  cprox_body_free(ball);
}

CASE(a_workspace_is_not_needed) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_sphere(-1.0, NULL, &body), CPROX_INVALID);
  assert_null(body);
  assert_int_equal(cprox_body_create_sphere(1.0, NULL, &body), CPROX_OK);
  cprox_body_free(body);
  cprox_body_free(NULL);
}

CASE(a_failed_allocation_is_said_and_leaves_nothing_behind) {
  const vec3 v[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const double flat[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  cprox_body *ball = NULL, *body = NULL;
  cprox_body_create_sphere(1.0, ws, &ball);
  const cprox_body *parts[1] = {ball};
  const cprox_pose pose = CPROX_POSE_IDENTITY;
  for (size_t k = 0; k < 3; k++) {
    const size_t live = allocations_live();
    allocations_fail_after(k);
    const cprox_status polytope = k < 2 ? cprox_body_create_polytope(v, 3, ws, &body) : CPROX_MEMORY;
    allocations_fail_after(k);
    const cprox_status polygon = cprox_body_create_polygon(flat, 3, ws, &body);
    allocations_fail_after(k);
    const cprox_status compound = k < 2 ? cprox_body_create_compound(parts, &pose, 1, ws, &body) : CPROX_MEMORY;
    allocations_allow();
    assert_int_equal(polytope, CPROX_MEMORY);
    assert_int_equal(polygon, CPROX_MEMORY);
    assert_int_equal(compound, CPROX_MEMORY);
    assert_string_equal(cprox_workspace_error(ws), "no memory for a body");
    assert_true(body == NULL && allocations_live() == live);
  }
  cprox_body_free(ball);
}

CASE(every_kind_has_its_name) {
  const char *names[] = {"point",     "sphere",    "box",      "capsule", "cylinder", "cone",
                         "ellipsoid", "halfspace", "polytope", "polygon", "compound", "support"};
  for (int k = CPROX_BODY_POINT; k <= CPROX_BODY_SUPPORT; k++)
    assert_string_equal(cprox_body_kind_name((cprox_body_kind)k), names[k]);
  cprox_body *body = NULL;
  cprox_body_create_cone(1.0, 1.0, ws, &body);
  assert_int_equal(cprox_body_get_info(body).kind, CPROX_BODY_CONE);
  cprox_body_free(body);
}

CASE(a_polygon_may_turn_either_way_and_repeat_or_line_up_vertices) {
  const double left[6][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {2, 2}, {0, 2}};
  double right[6][2];
  for (int i = 0; i < 6; i++) memcpy(right[i], left[5 - i], sizeof right[i]);
  const double(*both[2])[2] = {left, (const double(*)[2])right};
  for (int k = 0; k < 2; k++) {
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_polygon(both[k], 6, ws, &body), CPROX_OK);
    vec3 p;
    assert_true(cprox_body_nearest(body, vec(1, 1, 3), &p) == 3.0 && vec_equal(p, vec(1, 1, 0)));
    assert_true(fabs(cprox_body_nearest(body, vec(5, 6, 0), &p) - 5.0) < 1e-15 && vec_equal(p, vec(2, 2, 0)));
    convex_near near;
    convex_polygon_nearest_in_plane(&body->shape, vec_sub(vec(1.5, 1, 0), body->centre), &near);
    assert_true(near.distance == -0.5 && vec_equal(near.normal, vec(1, 0, 0)));
    cprox_body_free(body);
  }
}

/* Seed 501, 1e5 points about polygons of 3 to 20 vertices, aspects up to 1e6 and sharp corners: in space and in the
 * plane. */
CASE(the_distance_of_a_polygon_is_within_its_rounding) {
  rng r = rng_seed(501);
  long double worst = 0;
  for (size_t i = 0; i < test_cases(12500); i++) {
    double v[20][2];
    vec3 local[20];
    const size_t n = 3 + rng_index(&r, rng_index(&r, 2) ? 1 : 18);
    const double a = rng_log_uniform(&r, 1e-6, 1e6), b = a * rng_log_uniform(&r, 1e-6, 1.0),
                 turn = rng_uniform(&r, 0, 7);
    for (size_t k = 0; k < n; k++) {
      const double angle = turn + 6.283185307 * ((double)k + 0.6 * rng_uniform(&r, 0.0, 1.0)) / (double)n;
      v[k][0] = a * cos(angle);
      v[k][1] = b * sin(angle);
    }
    cprox_body *body = NULL;
    if (cprox_body_create_polygon((const double(*)[2])v, n, ws, &body) != CPROX_OK)
      continue; /* no area left at that aspect */
    const convex *shape = &body->shape;
    for (size_t k = 0; k < n; k++) local[k] = vec(shape->x[k], shape->y[k], 0);
    for (int j = 0; j < 8; j++) {
      const size_t p = rng_index(&r, n), q = rng_index(&r, n);
      vec3 y =
          vec_lerp(local[p], local[q], rng_index(&r, 2) ? rng_uniform(&r, -0.2, 1.2) : rng_log_uniform(&r, 1e-12, 1.0));
      y.z = 0;
      const double off = shape->scale * rng_log_uniform(&r, 1e-15, 1e3);
      if (rng_index(&r, 2)) y = vec_axpy(y, off, rng_unit(&r));
      convex_near near;
      shape->ops->nearest(shape, y, NULL, &near);
      const double reach = vec_norm(y) + shape->scale;
      const long double exact = ref_point_polygon(ref_vec(y), local, (size_t)shape->n);
      const long double error = fabsl(near.distance - exact);
      if (!(error <= shape->ops->near_rounding * ROUND_U * reach))
        fail_msg("distance %.17g, exact %.20Lg, off by %Lg u of %g", near.distance, exact, error / (ROUND_U * reach),
                 reach);
      worst = fmaxl(worst, error / (ROUND_U * reach));
      assert_true(fabs(vec_norm(near.normal) - 1.0) < 1e-15);
      const double h = shape->ops->support(shape, near.normal, NULL, NULL), bound = vec_dot(near.normal, y) - h;
      assert_true(bound <= near.distance + 32 * ROUND_U * reach);

      /* in the plane: the same outside, the nearest edge inside */
      y.z = 0;
      convex_polygon_nearest_in_plane(shape, y, &near);
      const long double flat = ref_point_polygon(ref_vec(y), local, (size_t)shape->n);
      long double edge = HUGE_VALL;
      for (size_t k = 0; k < (size_t)shape->n; k++)
        edge =
            fminl(edge, ref_point_segment(ref_vec(y), ref_vec(local[k]), ref_vec(local[(k + 1) % (size_t)shape->n])));
      const long double signed_distance = flat > 0 ? flat : -edge;
      assert_true(fabsl(near.distance - signed_distance) <= shape->ops->near_rounding * ROUND_U * reach);
    }
    cprox_body_free(body);
  }
  print_message("worst error %.2Lf u (|y| + scale)\n", worst);
}

/* ---- what bodies answer ---- */

static cprox_body *some_body(rng *r, int k) {
  cprox_body *body = NULL;
  const vec3 s = vec(rng_log_uniform(r, 0.1, 10), rng_log_uniform(r, 0.1, 10), rng_log_uniform(r, 0.1, 10));
  vec3 v[12];
  for (int i = 0; i < 12; i++) v[i] = vec_add(rng_in_cube(r, 3.0), s);
  switch (k) {
    case 0: cprox_body_create_point(s, ws, &body); break;
    case 1: cprox_body_create_sphere(s.x, ws, &body); break;
    case 2: cprox_body_create_box(s, ws, &body); break;
    case 3: cprox_body_create_capsule(s.x, s.y, ws, &body); break;
    case 4: cprox_body_create_cylinder(s.x, s.y, ws, &body); break;
    case 5: cprox_body_create_cone(s.x, s.y, ws, &body); break;
    case 6: cprox_body_create_ellipsoid(s, ws, &body); break;
    default: cprox_body_create_polytope(v, 12, ws, &body);
  }
  assert_non_null(body);
  return body;
}

/* Seed 502, 2e4 bodies and unions of three of them, 20 directions each. */
CASE(the_bounding_sphere_holds_the_body) {
  rng r = rng_seed(502);
  for (size_t i = 0; i < test_cases(20000); i++) {
    cprox_body *parts[3], *all = NULL;
    cprox_pose poses[3];
    for (int k = 0; k < 3; k++) {
      parts[k] = some_body(&r, (int)rng_index(&r, 8));
      poses[k] = rng_pose(&r, 20.0);
    }
    assert_int_equal(cprox_body_create_compound((const cprox_body *const *)parts, poses, 3, ws, &all), CPROX_OK);
    for (int k = 0; k < 4; k++) {
      const cprox_body *body = k < 3 ? parts[k] : all;
      const cprox_body_info info = cprox_body_get_info(body);
      const vec3 centre = info.centre;
      const double radius = info.radius;
      vec3 p;
      for (int j = 0; j < 20; j++) {
        const vec3 d = rng_unit(&r);
        const double h = cprox_body_support(body, d, &p);
        assert_true(ref_norm(ref_sub(ref_vec(p), ref_vec(centre))) <= radius * (1.0L + 8 * ROUND_U));
        assert_true(fabs(vec_dot(d, p) - h) <= 1e-14 * (fabs(h) + radius + vec_norm(p)));
      }
    }
    cprox_body_free(all);
    for (int k = 0; k < 3; k++) cprox_body_free(parts[k]);
  }
}

/* Seed 503, 2e4 points. */
CASE(the_nearest_point_of_a_compound_is_that_of_its_nearest_part) {
  rng r = rng_seed(503);
  for (size_t i = 0; i < test_cases(20000); i++) {
    cprox_body *parts[3], *all = NULL;
    cprox_pose poses[3];
    for (int k = 0; k < 3; k++) {
      parts[k] = some_body(&r, (int)rng_index(&r, 8));
      poses[k] = rng_pose(&r, 5.0);
    }
    cprox_body_create_compound((const cprox_body *const *)parts, poses, 3, ws, &all);
    const vec3 y = rng_in_cube(&r, 20.0);
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
      const vec3l local = ref_to_local(&poses[k], ref_vec(y));
      const vec3 p = vec((double)local.x, (double)local.y, (double)local.z);
      least = fmin(least, cprox_body_nearest(parts[k], p, NULL));
    }
    vec3 nearest;
    const double d = cprox_body_nearest(all, y, &nearest);
    assert_true(fabs(d - least) < 1e-12);
    if (d > 0) assert_true(fabs(vec_norm(vec_sub(y, nearest)) - d) < 1e-12);
    cprox_body_free(all);
    for (int k = 0; k < 3; k++) cprox_body_free(parts[k]);
  }
}

CASE(a_halfspace_has_no_end) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(0, 3, 4), -10.0, ws, &body), CPROX_OK);
  vec3 p;
  assert_true(isinf(cprox_body_get_info(body).radius));
  assert_true(isinf(cprox_body_support(body, vec(1, 0, 0), &p)));
  assert_true(fabs(cprox_body_support(body, vec(0, 6, 8), &p) - 20.0) < 1e-14);
  assert_true(fabs(cprox_body_nearest(body, vec(7, 6, 8), &p) - 8.0) < 1e-14);
  assert_true(vec_norm(vec_sub(p, vec(7, 1.2, 1.6))) < 1e-14);
  assert_true(fabs(cprox_body_nearest(body, vec(0, 0, 0), &p) + 2.0) < 1e-15);
  convex_near near;
  body->shape.ops->nearest(&body->shape, vec(1, 1, 1), NULL, &near);
  assert_true(isfinite(body->shape.ops->support(&body->shape, near.normal, NULL, NULL)));
  near.normal.x += 1e-16;
  assert_true(isinf(body->shape.ops->support(&body->shape, near.normal, NULL, NULL)));
  cprox_body_free(body);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
