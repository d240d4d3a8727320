/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies as bodies: what their constructors refuse, support and nearest points, curves and pairs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "base/rounding.h"
#include "curve_proximity/cprox.h"
#include "implicit/implicit.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/implicits.h"
#include "support/make_curve.h"
#include "support/random.h"

static int make_workspace(void **state) {
  *state = cprox_workspace_create();
  return *state ? 0 : -1;
}

static int free_workspace(void **state) {
  cprox_workspace_free(*state);
  return 0;
}

/* ---- what is refused ---- */

static void assert_refused(cprox_status status, cprox_workspace *workspace, const char *reason) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(workspace), reason))
    fail_msg("\"%s\" is not in \"%s\"", reason, cprox_workspace_error(workspace));
}

CASE(a_superquadric_of_bad_numbers_is_refused_by_name) {
  cprox_workspace *w = *state;
  cprox_body *body = NULL;
  const vec3 a = vec(1, 1, 1), n = vec(2, 2, 2);
  assert_refused(cprox_body_create_superquadric(vec(1, 0, 1), n, w, &body), w, "semi_axes.y is 0");
  assert_refused(cprox_body_create_superquadric(vec(-1, 1, 1), n, w, &body), w, "semi_axes.x is -1");
  assert_refused(cprox_body_create_superquadric(vec(1, 1, NAN), n, w, &body), w, "semi_axes.z is nan");
  assert_refused(cprox_body_create_superquadric(a, vec(0.5, 2, 2), w, &body), w, "exponents.x is 0.5");
  assert_refused(cprox_body_create_superquadric(a, vec(2, 1e9, 2), w, &body), w, "exponents.y is 1e+09");
  assert_refused(cprox_body_create_superquadric(a, vec(2, 2, INFINITY), w, &body), w, "exponents.z is inf");
  assert_refused(cprox_body_create_superquadric(vec(1e-6, 1, 1e4), n, w, &body), w, "more than 1e9 times");
  assert_refused(cprox_body_create_superquadric(a, n, w, NULL), w, "body is NULL");
  assert_null(body);
}

static void refuse_text(const char *text, const char *reason, cprox_workspace *workspace) {
  implicit_case c;
  cprox_body *body = NULL;
  implicit_case_read(text, &c);
  assert_refused(cprox_body_create_implicit(&c.description, NULL, workspace, &body), workspace, reason);
  assert_null(body);
}

/* The first ball that is known about such a set is 1e10 times its size where the origin lies in it. */
CASE(ellipsoids_by_one_quadric_are_accepted_wherever_they_stand) {
  cprox_workspace *w = *state;
  rng r = rng_seed(17);
  for (int i = 0; i < 3000; i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3);
    const vec3 a = vec(scale * rng_log_uniform(&r, 0.1, 1.0), scale * rng_log_uniform(&r, 0.1, 1.0), scale);
    const double quadric[1][10] = {{1.0 / (a.x * a.x), 0, 0, 1.0 / (a.y * a.y), 0, 1.0 / (a.z * a.z), 0, 0, 0, -1}};
    const cprox_implicit_description d = {.quadrics = quadric, .n_quadrics = 1};
    const cprox_pose pose = rng_pose(&r, i % 2 ? 0.5 * scale : 10.0 * scale);
    cprox_affine map = {.translation = pose.position};
    const frame f = frame_create(&pose, vec(0, 0, 0));
    for (int k = 0; k < 3; k++) {
      const vec3 column = frame_turn_to_world(&f, vec(k == 0, k == 1, k == 2));
      map.linear[k] = column.x, map.linear[3 + k] = column.y, map.linear[6 + k] = column.z;
    }
    cprox_body *body = NULL;
    if (cprox_body_create_implicit(&d, &map, w, &body) != CPROX_OK)
      fail_msg("case %d: %s", i, cprox_workspace_error(w));
    const cprox_body_info info = cprox_body_get_info(body);
    if (!(info.radius >= (1.0 - 1e-9) * scale && info.radius <= 4.0 * scale))
      fail_msg("case %d: the radius is %g of the longest semi-axis", i, info.radius / scale);
    cprox_body_free(body);
  }
}

CASE(an_implicit_body_is_refused_by_the_constraint_at_fault) {
  cprox_workspace *w = *state;
  refuse_text("P:0:0:0:-1", "the normal of plane 0 is 0", w);
  refuse_text("P:1:0:0:-1|P:nan:0:0:-1", "plane 1 is not finite", w);
  refuse_text("P:1:0:0:-1|P:1:0:0:-1e300", "plane 1 is out of range", w);
  refuse_text("P:1e300:0:0:-1", "plane 0 is out of range", w);
  refuse_text("Q:1:0:0:1:0:-1:0:0:0:-1", "quadric 0 is not convex", w);
  refuse_text("Q:1:0:0:1:2:1:0:0:0:-1", "quadric 0 is not convex", w);
  refuse_text("Q:0:0:0:0:0:0:0:0:0:-1", "quadric 0 has no matrix", w);
  refuse_text("Q:1:0:0:1:0:inf:0:0:0:-1", "not finite", w);
  refuse_text("Q:1e300:0:0:1:0:1:0:0:0:-1", "out of range", w);
  refuse_text("H:1:0:0:0:2:0:1:0:0:0.999:0:0:1:0:2", "term 1 of hyperquadric 0: the exponent is 0.999", w);
  refuse_text("H:1:0:0:0:2:0:1:0:0:nan:0:0:1:0:2", "term 1 of hyperquadric 0: the exponent is nan", w);
  refuse_text("H:1:0:0:0:2:0:1:0:inf:2:0:0:1:0:2", "term 1 of hyperquadric 0 is not finite", w);
  refuse_text("H:1:0:0:0:2:0:0:0:0:2:0:0:1:0:2", "term 1 of hyperquadric 0 is out of range", w);
  refuse_text("H:1:0:0:0:2|H:1e300:0:0:0:2", "term 0 of hyperquadric 1 is out of range", w);
}

CASE(a_set_without_an_interior_is_refused) {
  cprox_workspace *w = *state;
  refuse_text("Q:1:0:0:1:0:1:0:0:0:-1|P:1:0:0:2", "no interior", w);            /* the plane excludes the ball */
  refuse_text("Q:1:0:0:1:0:1:0:0:0:-1|P:1:0:0:0|P:-1:0:0:0", "no interior", w); /* a disc */
  refuse_text("Q:1:0:0:1:0:1:0:0:0:1", "no interior", w);                       /* empty by itself */
  refuse_text("Q:1:0:0:1:0:1:0:0:0:0", "no interior", w);                       /* a point */
  refuse_text("H:1:0:0:0:2:1:0:0:4:2:0:1:0:0:2:0:0:1:0:2", "no interior", w);
}

CASE(an_unbounded_set_is_refused_with_the_axis) {
  cprox_workspace *w = *state;
  refuse_text("P:1:0:0:-1", "unbounded", w);
  refuse_text("Q:1:0:0:1:0:0:0:0:0:-1", "unbounded, or larger than 1e+10, along (0, 0, 1)", w); /* a cylinder */
  refuse_text("Q:1:0:0:1:0:0:0:0:-1:0", "unbounded, or larger than 1e+10, along (0, 0, 1)", w); /* a paraboloid */
  refuse_text("H:1:0:0:0:4:0:1:0:0:4", "unbounded", w);
  refuse_text("P:1:0:1:-1|P:-1:0:1:-1|P:0:1:1:-1|P:0:-1:1:-1", "along (1, 0, 0)", w); /* a pyramid without a base */
}

CASE(maps_that_are_singular_and_lists_that_are_too_long_are_refused) {
  cprox_workspace *w = *state;
  cprox_body *body = NULL;
  implicit_case c;
  implicit_case_paper(2, &c);
  cprox_affine map = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  map.linear[8] = 0.0;
  assert_refused(cprox_body_create_implicit(&c.description, &map, w, &body), w, "its determinant is 0");
  map.linear[8] = NAN;
  assert_refused(cprox_body_create_implicit(&c.description, &map, w, &body), w, "map is not finite");
  map = (cprox_affine){.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  map.linear[4] = 1e-13;
  assert_refused(cprox_body_create_implicit(&c.description, &map, w, &body), w, "singular");

  double(*planes)[4] = calloc(10000, sizeof *planes);
  cprox_implicit_description many = {.planes = (const double(*)[4])planes, .n_planes = 10000};
  assert_refused(cprox_body_create_implicit(&many, NULL, w, &body), w, "10000 planes");
  free(planes);
  const cprox_implicit_description nothing = {0}, absent = {.n_planes = 1};
  assert_refused(cprox_body_create_implicit(&nothing, NULL, w, &body), w, "at least 1 constraint");
  assert_refused(cprox_body_create_implicit(&absent, NULL, w, &body), w, "is NULL and its count is not 0");
  assert_refused(cprox_body_create_implicit(NULL, NULL, w, &body), w, "description is NULL");
  assert_null(body);
}

/* ---- centre, radius ---- */

/* Seed 1, 200 points a body: every point of the set is in the bounding sphere, and the inner ball is in the set (Object
 * IV's origin is not). */
CASE(the_bounding_ball_holds_the_body_and_the_inner_ball_is_in_it) {
  rng r = rng_seed(1);
  for (int object = 1; object <= 6; object++) {
    implicit_case c;
    implicit_case_paper(object, &c);
    cprox_body *body = implicit_case_body(&c, NULL);
    const cprox_body_info info = cprox_body_get_info(body);
    const vec3 centre = info.centre;
    const double radius = info.radius;
    const implicit *shape = body->shape.implicit;
    assert_true(shape->inner > 0.1 && radius < 3.5);
    for (int i = 0; i < 200; i++) {
      const vec3 d = rng_unit(&r);
      long double inside = 0, outside = 4;
      while (outside - inside > 1e-15L * outside) { /* the surface along d */
        const long double s = 0.5L * (inside + outside);
        const long double x[3] = {centre.x + s * d.x, centre.y + s * d.y, centre.z + s * d.z};
        if (implicit_case_value(&c, x) <= 0)
          inside = s;
        else
          outside = s;
        if (s == inside && s == outside) break;
      }
      assert_true(outside <= radius * (1 + 1e-12L));
      assert_true(inside >= shape->inner);
    }
    cprox_body_free(body);
  }
}

/* ---- support ---- */

/* Seed 2, exponents 1 … 1000, aspects to 1e3, cold and from the mu of the last direction: on the surface to 1e-12, and
 * no point of 300 random ones on it reaches farther. */
CASE(support_points_lie_on_the_surface_and_reach_farthest) {
  cprox_workspace *w = *state;
  rng r = rng_seed(2);
  static const double exponent[] = {1, 1.0001, 1.05, 4.0 / 3, 1.9, 2, 2.0001, 7, 30, 100, 1000};
  for (size_t test = 0; test < test_cases(400); test++) {
    const vec3 a = vec(rng_log_uniform(&r, 0.03, 30), rng_log_uniform(&r, 0.03, 30), rng_log_uniform(&r, 0.03, 30));
    const vec3 p = vec(exponent[rng_index(&r, 11)], exponent[rng_index(&r, 11)], exponent[rng_index(&r, 11)]);
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_superquadric(a, p, w, &body), CPROX_OK);
    const implicit *shape = body->shape.implicit;
    double warm = 0.0;
    for (int i = 0; i < 20; i++) {
      const vec3 d = i < 3 ? vec(i == 0, i == 1, i == 2) : rng_unit(&r);
      double cold = 0.0;
      vec3 x[2];
      double h[2];
      h[0] = implicit_closed_support(shape, d, &cold, &x[0], NULL);
      h[1] = implicit_closed_support(shape, d, &warm, &x[1], NULL);
      for (int k = 0; k < 2; k++) {
        const long double f = powl(fabsl((long double)x[k].x / a.x), p.x) +
                              powl(fabsl((long double)x[k].y / a.y), p.y) +
                              powl(fabsl((long double)x[k].z / a.z), p.z) - 1;
        if (!(fabsl(f) <= 1e-12L)) fail_msg("f = %Lg at exponents %g %g %g", f, p.x, p.y, p.z);
        assert_true(fabs(vec_dot(d, x[k]) - h[k]) <= body->shape.slack);
        assert_true(h[k] >= vec_dot(d, x[k]) - 8 * ROUND_U * body->shape.scale);
      }
      assert_true(fabs(h[0] - h[1]) <= 32 * ROUND_U * body->shape.scale);
      for (int j = 0; j < 15; j++) { /* points of the surface by scaling */
        const vec3 u = rng_unit(&r);
        double least = 0.0, most = 2.0 * shape->radius;
        for (int k = 0; k < 60; k++) {
          const double s = 0.5 * (least + most);
          if (implicit_value(shape, vec_scale(s, u)) <= 0)
            least = s;
          else
            most = s;
        }
        assert_true(least * vec_dot(u, d) <= h[0] + body->shape.slack);
      }
    }
    cprox_body_free(body);
  }
}

/* Seed 3: the derivative of the support point against central differences; where the surface is flat its size is
 * bounded by what the differences see. */
CASE(the_support_points_derivative_is_that_of_differences) {
  cprox_workspace *w = *state;
  rng r = rng_seed(3);
  for (int test = 0; test < 300; test++) {
    const vec3 a = vec(rng_uniform(&r, 0.5, 2), rng_uniform(&r, 0.5, 2), rng_uniform(&r, 0.5, 2));
    const vec3 p = vec(rng_uniform(&r, 1.3, 6), rng_uniform(&r, 1.3, 6), rng_uniform(&r, 1.3, 6));
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_superquadric(a, p, w, &body), CPROX_OK);
    const implicit *shape = body->shape.implicit;
    const vec3 d = rng_unit(&r);
    if (fmin(fabs(d.x), fmin(fabs(d.y), fabs(d.z))) > 0.1) {
      const double step = 1e-5;
      double mu = 0.0, h[6];
      vec3 x;
      implicit_closed_support(shape, d, &mu, &x, h);
      for (int k = 0; k < 3; k++) {
        const vec3 e = vec(k == 0, k == 1, k == 2);
        const vec3 column = k == 0 ? vec(h[0], h[1], h[2]) : k == 1 ? vec(h[1], h[3], h[4]) : vec(h[2], h[4], h[5]);
        vec3 before, after;
        implicit_closed_support(shape, vec_axpy(d, -step, e), &mu, &before, NULL);
        implicit_closed_support(shape, vec_axpy(d, step, e), &mu, &after, NULL);
        const vec3 slope = vec_scale(0.5 / step, vec_sub(after, before));
        assert_true(vec_norm(vec_sub(slope, column)) <= 1e-5 * (1.0 + vec_norm(column)));
      }
    }
    cprox_body_free(body);
  }
}

/* ---- points ---- */

/* Seed 4, 300 points a body at 1e-9 … 1e2 from the centre's ball: the point is in the body, the distance is its own,
 * and the plane through it separates. Inside, the depth is one that the body has. */
CASE(nearest_points_are_optimal) {
  rng r = rng_seed(4);
  for (int object = 1; object <= 6; object++) {
    implicit_case c;
    implicit_case_paper(object, &c);
    cprox_body *body = implicit_case_body(&c, NULL);
    const convex *shape = &body->shape;
    for (size_t i = 0; i < test_cases(300); i++) {
      const vec3 y = vec_scale(rng_log_uniform(&r, 0.05, 100), rng_unit(&r));
      convex_near near;
      shape->ops->nearest(shape, y, NULL, &near);
      if (near.distance <= 0.0) {
        for (int k = 0; k < 30; k++) {
          const vec3 z = vec_axpy(y, -near.distance * (1 - 1e-12), rng_unit(&r));
          assert_true(implicit_value(shape->implicit, z) <= 1e-12);
        }
        continue;
      }
      assert_true(implicit_value(shape->implicit, near.point) <= 0.0);
      assert_true(fabs(vec_norm(vec_sub(y, near.point)) - near.distance) <= 4 * ROUND_U * (near.distance + 4));
      const double h = shape->ops->support(shape, near.normal, NULL, NULL);
      const double lower = vec_dot(near.normal, y) - h, accuracy = 2e-12 * (near.distance + 4) + shape->slack;
      if (!(near.distance - lower <= accuracy)) fail_msg("object %d: %g wide", object, near.distance - lower);
      assert_true(near.distance >= lower - accuracy);
      assert_true(near.height_known && near.height >= h - shape->slack);
    }
    cprox_body_free(body);
  }
}

/* Seed 5: the second derivative of the distance against differences of the normal, for bodies without flats. */
CASE(the_distances_second_derivative_is_that_of_differences) {
  rng r = rng_seed(5);
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_superquadric(vec(1, 0.7, 1.5), vec(2, 3, 1.6), NULL, &body), CPROX_OK);
  const convex *shape = &body->shape;
  size_t compared = 0;
  for (int i = 0; i < 100; i++) {
    const vec3 y = vec_scale(rng_uniform(&r, 2, 4), rng_unit(&r));
    convex_near near, before, after;
    shape->ops->nearest(shape, y, NULL, &near);
    for (int k = 0; k < 3; k++) {
      const vec3 e = vec(k == 0, k == 1, k == 2);
      const double *h = near.hessian, step = 1e-4;
      const vec3 column = k == 0 ? vec(h[0], h[1], h[2]) : k == 1 ? vec(h[1], h[3], h[4]) : vec(h[2], h[4], h[5]);
      shape->ops->nearest(shape, vec_axpy(y, -step, e), NULL, &before);
      shape->ops->nearest(shape, vec_axpy(y, step, e), NULL, &after);
      const vec3 slope = vec_scale(0.5 / step, vec_sub(after.normal, before.normal));
      compared += vec_norm(vec_sub(slope, column)) <= 1e-2 * (vec_norm(column) + 0.1);
    }
  }
  assert_true(compared >= 290); /* of 300: near a coordinate plane an exponent below 2 makes the curvature jump */
  cprox_body_free(body);
}

/* ---- special cases that other kinds answer ---- */

/* Seed 6: a superquadric of exponents 2 is an ellipsoid, six planes are a box, a quadric is a sphere: curves see the
 * same. */
CASE(a_curve_sees_the_same_distance_as_from_the_kind_it_equals) {
  cprox_workspace *w = *state;
  rng r = rng_seed(6);
  for (size_t test = 0; test < test_cases(60); test++) {
    const vec3 a = vec(rng_uniform(&r, 0.2, 2), rng_uniform(&r, 0.2, 2), rng_uniform(&r, 0.2, 2));
    cprox_body *known = NULL, *body = NULL;
    const int kind = (int)(test % 3);
    if (kind == 0) {
      assert_int_equal(cprox_body_create_ellipsoid(a, w, &known), CPROX_OK);
      assert_int_equal(cprox_body_create_superquadric(a, vec(2, 2, 2), w, &body), CPROX_OK);
    } else if (kind == 1) {
      assert_int_equal(cprox_body_create_box(vec_scale(2, a), w, &known), CPROX_OK);
      const double planes[6][4] = {{1, 0, 0, -a.x},  {-1, 0, 0, -a.x}, {0, 2, 0, -2 * a.y},
                                   {0, -1, 0, -a.y}, {0, 0, 1, -a.z},  {0, 0, -3, -3 * a.z}};
      const cprox_implicit_description d = {.planes = planes, .n_planes = 6};
      assert_int_equal(cprox_body_create_implicit(&d, NULL, w, &body), CPROX_OK);
    } else {
      assert_int_equal(cprox_body_create_sphere(a.x, w, &known), CPROX_OK);
      const double quadrics[1][10] = {{1, 0, 0, 1, 0, 1, 0, 0, 0, -a.x * a.x}};
      const cprox_implicit_description d = {.quadrics = quadrics, .n_quadrics = 1};
      assert_int_equal(cprox_body_create_implicit(&d, NULL, w, &body), CPROX_OK);
    }
    cprox_vec3 points[6];
    for (int i = 0; i < 6; i++) points[i] = rng_in_cube(&r, 4);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(points, 6, 0, 1), w, &curve), CPROX_OK);
    const cprox_pose pose = rng_pose(&r, 2);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result expected, found;
    assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(known, pose), &options, w, &expected),
                     CPROX_OK);
    assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, pose), &options, w, &found),
                     CPROX_OK);
    assert_true(found.lower <= expected.upper && expected.lower <= found.upper);
    cprox_result verdict;
    cprox_collision(cprox_point_along(curve), cprox_obstacle_at(body, pose), NULL, w, &verdict);
    if (expected.upper == 0.0) assert_int_equal(verdict.verdict, CPROX_VERDICT_VIOLATED);
    if (expected.lower > 1e-5) assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
    cprox_curve_free(curve);
    cprox_body_free(known);
    cprox_body_free(body);
  }
}

/* Seed 7: a map moves, scales and shears the set: points are inside when their preimages are, as computed in long
 * double. */
CASE(a_mapped_body_holds_the_images_of_the_points) {
  rng r = rng_seed(7);
  for (int test = 0; test < 60; test++) {
    implicit_case c;
    implicit_case_paper(1 + test % 6, &c);
    cprox_affine map;
    for (int i = 0; i < 9; i++) map.linear[i] = rng_uniform(&r, -1, 1) + (i % 4 == 0 ? 2 : 0);
    map.translation = rng_in_cube(&r, 10);
    cprox_body *body = implicit_case_body(&c, &map);
    int inside = 0;
    for (int i = 0; i < 200; i++) {
      const vec3 x = rng_in_cube(&r, 1.5);
      const vec3 image = vec(vec_dot(vec(map.linear[0], map.linear[1], map.linear[2]), x) + map.translation.x,
                             vec_dot(vec(map.linear[3], map.linear[4], map.linear[5]), x) + map.translation.y,
                             vec_dot(vec(map.linear[6], map.linear[7], map.linear[8]), x) + map.translation.z);
      const long double value = implicit_case_value(&c, (long double[3]){x.x, x.y, x.z});
      if (fabsl(value) < 1e-9L) continue;
      inside += value < 0;
      assert_true((cprox_body_nearest(body, image, NULL) <= 0.0) == (value < 0));
    }
    assert_true(inside > 0);
    cprox_body_free(body);
  }
}

int main(void) {
  return cases_run(make_workspace, free_workspace);
}
