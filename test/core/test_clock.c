/* SPDX-License-Identifier: BSD-3-Clause */
/* Two movers synchronized: their distance at the same parameter, whatever they carry. */
#include <string.h>

#include "base/rounding.h"
#include "curve/relative_curve.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

static cprox_curve *bezier_on(const vec3 *points, size_t n, double t0, double t1) {
  cprox_curve *curve = NULL;
  if (curve_from(describe_bezier(points, n, t0, t1), ws, &curve) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

/* Seed 41, 2000 cases, degrees 1 to 12, sizes 1e-3 to 1e3, up to 1e6 sizes from the origin: |psi(t) - phi(t)| in long
 * double at 20 parameters and at the reported one. The points stand on a grid on which differences are exact, so the
 * room is long double's own. */
CASE(points_on_one_clock_are_as_near_as_long_double_says) {
  rng r = rng_seed(41);
  const size_t cases = test_cases(2000);
  for (size_t k = 0; k < cases; k++) {
    const size_t m = 1 + rng_index(&r, 12), n = 1 + rng_index(&r, 12);
    const double scale = rng_log_uniform(&r, 1e-3, 1e3),
                 far = rng_index(&r, 2) ? 0.0 : scale * rng_log_uniform(&r, 1.0, 1e6);
    const double step = ldexp(1.0, ilogb(2.0 * (scale + far)) - 50);
    const vec3 away = rng_in_cube(&r, far);
    vec3 p[13], q[13];
    for (size_t i = 0; i <= 12; i++) {
      vec3 *both[] = {&p[i], &q[i]};
      for (int j = 0; j < 2; j++) {
        const vec3 v = vec_add(away, rng_in_cube(&r, scale));
        *both[j] = vec(step * nearbyint(v.x / step), step * nearbyint(v.y / step), step * nearbyint(v.z / step));
      }
    }
    vec3 near_p[13], near_q[13];
    for (size_t i = 0; i <= 12; i++) {
      near_p[i] = vec_sub(p[i], p[0]);
      near_q[i] = vec_sub(q[i], p[0]);
    }
    const double t0 = rng_index(&r, 2) ? 0.0 : 1e9, t1 = t0 + rng_uniform(&r, 0.5, 20.0);
    cprox_curve *first = bezier_on(p, m + 1, t0, t1), *second = bezier_on(q, n + 1, t0, t1);
    cprox_mover mover = cprox_point_along(first), other = cprox_point_along(second);
    mover.radius = rng_index(&r, 2) ? 0.0 : 0.1 * scale;
    other.radius = rng_index(&r, 2) ? 0.0 : 0.1 * scale;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = scale * rng_log_uniform(&r, 1e-13, 1e-3);
    cprox_result result;
    const cprox_status status = cprox_distance(mover, cprox_synchronized(other), &options, ws, &result);
    assert_in_range(status, CPROX_OK, CPROX_PRECISION);
    if (status == CPROX_OK) assert_true(result.upper - result.lower <= options.epsilon);
    const long double radii = (long double)mover.radius + (long double)other.radius;
    const long double hair = 1e-2L * ROUND_U * (long double)scale;
    for (int i = 0; i < 21; i++) {
      const double s = i < 20 ? rng_uniform(&r, 0.0, 1.0) : (result.t - t0) / (t1 - t0);
      const long double d = ref_norm(ref_sub(ref_bezier(near_p, m, s, 0), ref_bezier(near_q, n, s, 0))) - radii;
      assert_true((long double)result.lower <= fmaxl(d, 0.0L) + hair);
      /* s from t near 1e9 s is off by 1e-7 s at most */
      if (i == 20)
        assert_true(fabsl((long double)result.upper - fmaxl(d, 0.0L)) <=
                    (t0 > 0.0 ? 1e-4L : 1e-9L) * (long double)scale);
    }
    assert_true(result.t_obstacle == result.t);
    cprox_curve_free(first);
    cprox_curve_free(second);
  }
}

/* Seed 45, 3000 cases, 10 parameters each: the converted piece, evaluated in long double, is within its error of R psi
 * - phi; and the error is no more than a hundred times what occurs. */
CASE(the_relative_curve_is_within_its_error) {
  rng r = rng_seed(45);
  const size_t cases = test_cases(3000);
  long double worst = 0.0L;
  for (size_t k = 0; k < cases; k++) {
    vec3 p[16], q[16];
    const size_t m = 1 + rng_index(&r, 15), n = 1 + rng_index(&r, 15);
    for (int i = 0; i < 16; i++) p[i] = rng_in_cube(&r, 1.0), q[i] = rng_in_cube(&r, 1.0);
    cprox_curve *first = bezier_on(p, m + 1, 0.0, 1.0), *second = bezier_on(q, n + 1, 0.0, 1.0);
    cprox_pose pose = rng_pose(&r, rng_index(&r, 2) ? 0.0 : 1.0);
    if (rng_index(&r, 2)) pose.orientation = (cprox_quat){1, 0, 0, 0};
    const double a = rng_index(&r, 2) ? 0.0 : rng_uniform(&r, 0.0, 0.9);
    const double b = a == 0.0 ? 1.0 : a + rng_uniform(&r, 0.01, 0.1);
    cprox_curve relative;
    assert_true(relative_create(first, second, &pose, a, b, ws, WORKSPACE_RELATIVE, &relative));
    assert_int_equal(relative.n_pieces, 1);
    for (int i = 0; i < 10; i++) {
      const long double s = (long double)rng_uniform(&r, 0.0, 1.0);
      const long double t = relative.breaks[0] + s * ((long double)relative.breaks[1] - relative.breaks[0]);
      const vec3l exact = ref_sub(ref_bezier(p, m, t, 0), ref_to_world(&pose, ref_bezier(q, n, t, 0)));
      const long double off = ref_norm(ref_sub(exact, ref_bezier(relative.points, relative.degree, s, 0)));
      assert_true(off <= relative.error[0] + 1e-2L * ROUND_U);
      worst = fmaxl(worst, off / relative.error[0]);
    }
    cprox_curve_free(first);
    cprox_curve_free(second);
  }
  assert_true(worst > 0.01L);
}

static cprox_result pair_at(const cprox_mover *mover, const cprox_obstacle *target, double t) {
  cprox_body *point = NULL;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
  cprox_obstacle a = {.body = mover->body ? mover->body : point, .margin = mover->radius};
  cprox_obstacle b = *target;
  b.synchronized = false, b.curve = NULL;
  if (!b.body) b.body = point;
  a.pose = CPROX_POSE_IDENTITY;
  vec3 at;
  assert_int_equal(cprox_curve_evaluate(mover->curve, t, ws, &a.pose.position, NULL, NULL), CPROX_OK);
  assert_int_equal(cprox_curve_evaluate(target->curve, t, ws, &at, NULL, NULL), CPROX_OK);
  const vec3l world = ref_to_world(&target->pose, ref_vec(at));
  b.pose.position = vec((double)world.x, (double)world.y, (double)world.z);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 0.0;
  cprox_result result;
  assert_true(cprox_pair(a, b, &options, ws, &result) >= 0);
  cprox_body_free(point);
  return result;
}

static cprox_curve *spline(rng *r, size_t n, size_t degree, double t1) {
  vec3 points[12];
  double knots[20];
  for (size_t i = 0; i < n; i++) points[i] = rng_in_cube(r, 1.0);
  for (size_t i = 0; i <= n + degree; i++) {
    const double inner = (double)(i - degree) / (double)(n - degree);
    knots[i] = i <= degree ? 0.0 : i >= n ? t1 : t1 * inner;
  }
  if (rng_index(r, 2) && degree > 1 && n > degree + 2) knots[degree + 2] = knots[degree + 1]; /* a double knot */
  cprox_curve *curve = NULL;
  if (curve_from(describe_bspline(points, n, degree, knots, n + degree + 1, 0.0, t1), ws, &curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

/* Seed 42, 400 cases: splines with joints of their own, turned targets, bodies of every kind or none on either side;
 * static pairs at 40 parameters. 1e-12: thousands of u of a few metres. */
CASE(splines_that_carry_bodies_agree_with_static_pairs) {
  rng r = rng_seed(42);
  const size_t cases = test_cases(400);
  for (size_t k = 0; k < cases; k++) {
    test_shape a, b;
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 0.3, 5.0, &a);
    shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 0.3, 5.0, &b);
    const size_t d = 1 + rng_index(&r, 4), e = 1 + rng_index(&r, 4);
    const double t1 = rng_uniform(&r, 0.5, 3.0);
    cprox_curve *first = spline(&r, d + 1 + rng_index(&r, 6), d, t1),
                *second = spline(&r, e + 1 + rng_index(&r, 6), e, t1);
    cprox_mover mover = cprox_point_along(first), other = cprox_point_along(second);
    if (rng_index(&r, 3)) mover.kind = CPROX_MOVER_BODY, mover.body = a.body;
    if (rng_index(&r, 3)) other.kind = CPROX_MOVER_BODY, other.body = b.body;
    mover.radius = rng_index(&r, 2) ? 0.0 : 0.05;
    cprox_obstacle target = cprox_synchronized(other);
    if (rng_index(&r, 2)) target.pose = rng_pose(&r, 1.0);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    cprox_result result;
    const cprox_status status = cprox_distance(mover, target, &options, ws, &result);
    assert_in_range(status, CPROX_OK, CPROX_PRECISION);
    for (int i = 0; i < 40; i++)
      assert_true(result.lower <= fmax(pair_at(&mover, &target, rng_uniform(&r, 0.0, t1)).upper, 0.0) + 1e-12);
    const cprox_result here = pair_at(&mover, &target, result.t);
    assert_true(result.upper >= here.lower - 1e-12);
    assert_true(result.upper <= fmax(here.upper, 0.0) + 1e-8);
    assert_true(fabs(vec_norm(vec_sub(result.witness_mover, result.witness_obstacle)) - result.upper) <= 1e-7);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
    cprox_curve_free(first);
    cprox_curve_free(second);
  }
}

CASE(two_that_cross_at_different_times_do_not_meet) {
  cprox_curve *first = bezier_on((vec3[]){{-1, 0, 0}, {1, 0, 0}}, 2, 0.0, 1.0);
  cprox_curve *second = bezier_on((vec3[]){{0, -1, 0}, {0, 3, 0}}, 2, 0.0, 1.0);
  cprox_result result;
  assert_int_equal(cprox_distance(cprox_point_along(first), cprox_obstacle_curve(second, 0.0), NULL, ws, &result),
                   CPROX_OK);
  assert_true(result.upper < 1e-6);
  /* at t they are at (2t - 1, 0) and (0, 4t - 1): least at t = 0.3, where that is (-0.4, 0) and (0, 0.2) */
  assert_int_equal(
      cprox_distance(cprox_point_along(first), cprox_synchronized(cprox_point_along(second)), NULL, ws, &result),
      CPROX_OK);
  assert_true(result.lower <= 0.44721359549995793 && 0.44721359549995793 <= result.upper);
  assert_true(fabs(result.t - 0.3) < 1e-9 && result.t_obstacle == result.t);
  assert_true(fabs(result.witness_mover.x + 0.4) < 1e-9 && fabs(result.witness_obstacle.y - 0.2) < 1e-9);
  cprox_curve_free(first);
  cprox_curve_free(second);
}

CASE(one_and_the_same_mover_is_at_distance_0) {
  rng r = rng_seed(43);
  cprox_curve *curve = spline(&r, 8, 3, 2.0);
  cprox_result result;
  assert_int_equal(
      cprox_distance(cprox_point_along(curve), cprox_synchronized(cprox_point_along(curve)), NULL, ws, &result),
      CPROX_OK);
  assert_true(result.lower == 0.0 && result.upper <= 1e-12);
  cprox_curve_free(curve);
}

CASE(different_domains_are_refused) {
  cprox_curve *first = bezier_on((vec3[]){{-1, 0, 0}, {1, 0, 0}}, 2, 0.0, 1.0);
  cprox_curve *second = bezier_on((vec3[]){{0, -1, 0}, {0, 3, 0}}, 2, 0.0, 1.5);
  cprox_result result = {.lower = -7.0};
  assert_int_equal(
      cprox_distance(cprox_point_along(first), cprox_synchronized(cprox_point_along(second)), NULL, ws, &result),
      CPROX_INVALID);
  assert_true(result.lower == -7.0);
  assert_string_equal(
      cprox_workspace_error(ws),
      "obstacle 0 is on the mover's clock, but its curve runs over [0, 1.5] and the mover's over [0, 1]");
  const cprox_obstacle nothing = {.synchronized = true, .pose = CPROX_POSE_IDENTITY};
  assert_int_equal(cprox_distance(cprox_point_along(first), nothing, NULL, ws, &result), CPROX_INVALID);
  cprox_curve_free(first);
  cprox_curve_free(second);
}

/* Among many targets, and again: the second time nothing is allocated. */
CASE(clocks_stand_among_other_targets_and_allocate_once) {
  rng r = rng_seed(44);
  cprox_curve *curve = spline(&r, 9, 3, 1.0), *other[8];
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.1, 0.2, 0.3), ws, &box), CPROX_OK);
  cprox_obstacle targets[9];
  for (int i = 0; i < 8; i++) {
    other[i] = spline(&r, 5 + rng_index(&r, 6), 1 + rng_index(&r, 4), 1.0);
    targets[i] = cprox_synchronized(cprox_body_along(box, other[i]));
  }
  targets[8] = cprox_obstacle_at(box, rng_pose(&r, 2.0));
  cprox_result nearest, each[9];
  size_t before = 0;
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(targets, 9, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  for (int round = 0; round < 2; round++) {
    before = allocations_made();
    assert_int_equal(cprox_obstacles_distance(all, cprox_tube_along(curve, 0.01), NULL, ws, &nearest, each), CPROX_OK);
  }
  assert_int_equal(allocations_made(), before);
  cprox_obstacles_free(all);
  double least = 1e9;
  for (int i = 0; i < 9; i++) least = fmin(least, each[i].upper);
  assert_true(nearest.upper == least);
  for (int i = 0; i < 8; i++) cprox_curve_free(other[i]);
  cprox_curve_free(curve);
  cprox_body_free(box);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
