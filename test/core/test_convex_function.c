/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex bodies known by a function and its derivatives: support values by formula, distances against the interior
 * point solver and by formula, in space and in the plane; values that are off by what was stated; what is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

static cprox_body *made(const cprox_convex_function *function, double margin) {
  cprox_body *body = NULL;
  if (cprox_body_create_convex_function(function, margin, ws, &body) < 0) fail_msg("%s", cprox_workspace_error(ws));
  return body;
}

/* ---- sum |x_i/a_i|^p - 1, with values that are off by `off` ---- */

typedef struct power_ball {
  double axis[3], power, off;
  int dimensions;
} power_ball;

static double power_value(const void *user, const double x[3], double gradient[3], double hessian[6]) {
  static const int diagonal[3] = {0, 3, 5};
  const power_ball *ball = user;
  double value = ball->off - 1.0;
  for (int i = 0; i < 6; i++) hessian[i] = 0.0;
  for (int i = 0; i < ball->dimensions; i++) {
    const double a = ball->axis[i], p = ball->power, t = fabs(x[i] / a);
    value += pow(t, p);
    gradient[i] = copysign(p * pow(t, p - 1.0) / a, x[i]);
    hessian[diagonal[i]] = p * (p - 1.0) * pow(t, p - 2.0) / (a * a);
  }
  return value;
}

/* The dual norm. */
static double power_support(const power_ball *ball, vec3 u) {
  const double q = ball->power / (ball->power - 1.0), d[3] = {u.x, u.y, u.z};
  double sum = 0.0;
  for (int i = 0; i < ball->dimensions; i++) sum += pow(fabs(d[i] * ball->axis[i]), q);
  return pow(sum, 1.0 / q);
}

static power_ball power_random(rng *r, int dimensions) {
  static const double powers[5] = {2.0, 2.0, 3.0, 4.0, 10.0};
  power_ball ball = {.power = powers[rng_index(r, 5)], .dimensions = dimensions};
  for (int i = 0; i < dimensions; i++) ball.axis[i] = rng_log_uniform(r, 0.02, 1.0);
  return ball;
}

static cprox_convex_function power_function(const power_ball *ball) {
  return (cprox_convex_function){
      .evaluate = power_value, .user = ball, .radius = 2.0, .error = ball->off, .planar = ball->dimensions == 2};
}

/* 2e-12 of the radius is eight times the widest certified gap that these bodies have. */
CASE(support_values_are_the_dual_norm) {
  rng r = rng_seed(41);
  for (int i = 0; i < (int)test_cases(40); i++) {
    const power_ball ball = power_random(&r, i % 4 == 0 ? 2 : 3);
    const cprox_convex_function function = power_function(&ball);
    cprox_body *body = made(&function, 0.0);
    for (int k = 0; k < 50; k++) {
      const vec3 u = rng_unit(&r);
      vec3 at;
      const double h = cprox_body_support(body, u, &at), exact = power_support(&ball, u);
      if (!(fabs(h - exact) <= 4e-12)) fail_msg("case %d: %.15g instead of %.15g", i, h, exact);
      const double point[3] = {at.x, at.y, at.z};
      double gradient[3], hessian[6];
      assert_true(power_value(&ball, point, gradient, hessian) <= 1e-12); /* attained */
    }
    cprox_body_free(body);
  }
}

/* The same set as a superquadric has another solver: both intervals hold the one distance. */
CASE(distances_are_those_of_the_same_set_by_its_constraints) {
  rng r = rng_seed(42);
  for (int i = 0; i < (int)test_cases(60); i++) {
    const power_ball ball = power_random(&r, 3);
    const cprox_convex_function function = power_function(&ball);
    cprox_body *body = made(&function, 0.0), *same = NULL, *box = NULL;
    const double p = ball.power;
    assert_int_equal(
        cprox_body_create_superquadric(vec(ball.axis[0], ball.axis[1], ball.axis[2]), vec(p, p, p), ws, &same),
        CPROX_OK);
    assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &box), CPROX_OK);
    const cprox_pose here = {rng_in_cube(&r, 0.2), rng_quat(&r)}, there = {rng_in_cube(&r, 2.0), rng_quat(&r)};
    const cprox_options options = accurate(1e-8);
    cprox_result one, other;
    assert_true(cprox_pair(cprox_obstacle_at(body, here), cprox_obstacle_at(box, there), &options, ws, &one) >= 0);
    assert_true(cprox_pair(cprox_obstacle_at(same, here), cprox_obstacle_at(box, there), &options, ws, &other) >= 0);
    if (!(one.lower <= other.upper && other.lower <= one.upper))
      fail_msg("case %d: [%.12g, %.12g] and [%.12g, %.12g]", i, one.lower, one.upper, other.lower, other.upper);
    if (other.lower > 0.0) assert_true(one.upper - one.lower <= 1e-5);
    cprox_body_free(body);
    cprox_body_free(same);
    cprox_body_free(box);
  }
}

/* Along a line past a ball and past a disc the distance has a formula; a margin comes off. */
CASE(curves_pass_balls_and_discs_at_their_distance) {
  for (int dimensions = 2; dimensions <= 3; dimensions++) {
    const power_ball ball = {.axis = {0.5, 0.5, 0.5}, .power = 2.0, .dimensions = dimensions};
    const cprox_convex_function function = power_function(&ball);
    cprox_body *body = made(&function, 0.1);
    const vec3 past[2] = {vec(-2, 1, 0), vec(2, 1, 0)}, through[2] = {vec(-2, 0.3, 0), vec(2, 0.3, 0)};
    cprox_curve *far = bezier(past, 2), *near = bezier(through, 2);
    const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    cprox_result got;
    assert_int_equal(cprox_distance(cprox_tube_along(far, 0.05), target, NULL, ws, &got), CPROX_OK);
    assert_true(got.lower <= 0.35 + 1e-12 && 0.35 - 1e-12 <= got.upper && got.upper - got.lower <= 1e-6);
    assert_int_equal(cprox_collision(cprox_tube_along(near, 0.0), target, NULL, ws, &got), CPROX_OK);
    assert_int_equal(got.verdict, CPROX_VERDICT_VIOLATED);
    cprox_curve_free(far);
    cprox_curve_free(near);
    cprox_body_free(body);
  }
}

/* Values are too large by 1e-9, so that the body seems too small: the interval is wider, and still holds the distance
 * of the exact set. */
CASE(values_that_are_off_by_what_was_stated_widen_the_interval) {
  const power_ball ball = {.axis = {0.5, 0.4, 0.3}, .power = 2.0, .off = 1e-9, .dimensions = 3};
  const power_ball exact = {.axis = {0.5, 0.4, 0.3}, .power = 2.0, .dimensions = 3};
  const cprox_convex_function function = power_function(&ball);
  cprox_body *body = made(&function, 0.0);
  rng r = rng_seed(43);
  for (int i = 0; i < 200; i++) {
    /* the tangent plane at a support point, .5 above it: the distance of a point over it */
    const vec3 u = rng_unit(&r);
    const double h = power_support(&exact, u);
    const vec3 at = vec(0.25 * u.x / h, 0.16 * u.y / h, 0.09 * u.z / h), point = vec_axpy(at, 0.5, u);
    cprox_body *lone = NULL;
    cprox_result got;
    const cprox_options options = accurate(1e-11);
    assert_int_equal(cprox_body_create_point(point, ws, &lone), CPROX_OK);
    assert_true(cprox_pair(cprox_obstacle_at(body, CPROX_POSE_IDENTITY), cprox_obstacle_at(lone, CPROX_POSE_IDENTITY),
                           &options, ws, &got) >= 0);
    assert_true(got.lower <= 0.5 + 1e-12 && 0.5 - 1e-12 <= got.upper && got.upper - got.lower <= 2e-6);
    cprox_body_free(lone);
  }
  cprox_body_free(body);
}

/* ---- what must be refused ---- */

typedef struct liar {
  int lie;
} liar;

static double lies(const void *user, const double x[3], double gradient[3], double hessian[6]) {
  const int lie = ((const liar *)user)->lie;
  double value = -0.25;
  for (int i = 0; i < 3; i++) value += x[i] * x[i], gradient[i] = 2.0 * x[i];
  for (int i = 0; i < 6; i++) hessian[i] = i == 0 || i == 3 || i == 5 ? 2.0 : 0.0;
  switch (lie) {
    case 1: return value + 1.0;              /* nothing inside */
    case 2: return NAN;                      /* never a number */
    case 3: hessian[4] = NAN; return value;  /* a Hessian that is none */
    case 4: return x[0] > 0.7 ? NAN : value; /* sometimes a number */
    case 5: gradient[1] = -gradient[1]; return value;
    case 6: /* a ring: not convex */
      for (int i = 0; i < 3; i++) gradient[i] *= 2.0 * (value - 0.5);
      return (value - 0.5) * (value - 0.5) - 0.7;
    default: return value;
  }
}

static void refuses(int lie, cprox_convex_function function, const char *words) {
  const liar user = {lie};
  cprox_body *body = NULL;
  function.evaluate = function.evaluate ? lies : NULL;
  function.user = &user;
  assert_int_equal(cprox_body_create_convex_function(&function, 0.0, ws, &body), CPROX_INVALID);
  assert_null(body);
  if (!strstr(cprox_workspace_error(ws), words)) fail_msg("'%s' lacks '%s'", cprox_workspace_error(ws), words);
}

CASE(functions_that_are_not_convex_are_refused_with_their_places) {
  const cprox_convex_function good = {.evaluate = lies, .radius = 1.0};
  cprox_convex_function bad = good;
  refuses(1, good, "is 0.75 at the interior point (0, 0, 0)");
  refuses(2, good, "is not finite at (");
  refuses(3, good, "is not finite at (");
  refuses(4, good, "is not finite at (");
  refuses(5, good, "the function is not convex, or its gradient is wrong");
  bad.radius = 1.5;
  refuses(6, bad, "the function is not convex, or its gradient is wrong");
  bad.radius = 0.4;
  refuses(0, bad, "the body must lie within the radius");
  bad.radius = 0.0;
  refuses(0, bad, "radius is 0, must be > 0");
  bad = good, bad.interior = vec(NAN, 0, 0);
  refuses(0, bad, "centre is not finite");
  bad = good, bad.error = -1.0;
  refuses(0, bad, "error is -1");
  bad = good, bad.error = 0.1;
  refuses(0, bad, "its error is too large");
  bad = good, bad.planar = true, bad.interior.z = 0.1;
  refuses(0, bad, "interior.z is 0.1, must be 0 in the plane");
  bad = good, bad.evaluate = NULL;
  refuses(0, bad, "the convex function is NULL");
  assert_int_equal(cprox_body_create_convex_function(&good, 0.0, ws, NULL), CPROX_INVALID);
}

/* It behaves while the body is made, and lies later. */
CASE(functions_that_fail_later_are_refused_by_the_query) {
  liar user = {0};
  const cprox_convex_function function = {.evaluate = lies, .user = &user, .radius = 1.0};
  cprox_body *body = made(&function, 0.0);
  const vec3 p[2] = {vec(-2, 1, 0), vec(2, 1, 0)};
  cprox_curve *curve = bezier(p, 2);
  const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  cprox_result got;
  assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_OK);
  assert_true(got.lower <= 0.5 && 0.5 <= got.upper);
  user.lie = 2;
  assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_INVALID);
  user.lie = 5;
  assert_int_equal(cprox_distance(cprox_tube_along(curve, 0.0), target, NULL, ws, &got), CPROX_INVALID);
  cprox_curve_free(curve);
  cprox_body_free(body);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
