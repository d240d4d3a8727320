/* SPDX-License-Identifier: BSD-3-Clause */
/* Which targets are close, and how close each interval of a curve is: against one query a target, and against sampling.
 * */
#include <stdio.h>
#include <stdlib.h>

#include "base/round_down.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/quad.h"
#include "support/random.h"
#include "support/reference.h"

enum { MOST_TARGETS = 24 };

typedef struct world {
  cprox_curve *curve;
  vec3 points[8];
  size_t degree, n;
  double half[MOST_TARGETS];
  cprox_body *body[MOST_TARGETS];
  cprox_obstacle target[MOST_TARGETS];
  cprox_mover mover;
} world;

/* Cubes anywhere about a random curve of degree 1 to 7. */
static world world_make(rng *r) {
  world w = {.degree = 1 + rng_index(r, 7), .n = 1 + rng_index(r, MOST_TARGETS)};
  for (size_t i = 0; i <= w.degree; i++) w.points[i] = rng_in_cube(r, 2.0);
  assert_int_equal(curve_from(describe_bezier(w.points, w.degree + 1, 0.0, 1.0), ws, &w.curve), CPROX_OK);
  for (size_t i = 0; i < w.n; i++) {
    w.half[i] = rng_uniform(r, 0.02, 0.4);
    const double edge = 2.0 * w.half[i];
    assert_int_equal(cprox_body_create_box(vec(edge, edge, edge), ws, &w.body[i]), CPROX_OK);
    w.target[i] = cprox_obstacle_at(w.body[i], rng_pose(r, 3.0));
  }
  w.mover = cprox_tube_along(w.curve, rng_index(r, 2) ? rng_uniform(r, 0.0, 0.2) : 0.0);
  return w;
}

static void world_free(world *w) {
  for (size_t i = 0; i < w->n; i++) cprox_body_free(w->body[i]);
  cprox_curve_free(w->curve);
}

static long double clearance_at(const world *w, long double t) {
  long double least = INFINITY;
  for (size_t i = 0; i < w->n; i++) {
    const vec3 half = vec(w->half[i], w->half[i], w->half[i]);
    const vec3l p = ref_to_local(&w->target[i].pose, ref_bezier(w->points, w->degree, t, 0));
    least = fminl(least, ref_point_box(p, half) - (long double)w->mover.radius);
  }
  return fmaxl(least, 0.0L);
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* 600 worlds, seed 1: the i-th result is within epsilon of the i-th least of the distances asked one by one. */
CASE(the_k_nearest_are_the_least_of_all_distances) {
  rng r = rng_seed(1);
  for (size_t i = 0, cases = test_cases(600); i < cases; i++) {
    world w = world_make(&r);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    double all[MOST_TARGETS];
    for (size_t j = 0; j < w.n; j++) {
      cprox_result one;
      assert_int_equal(cprox_distance(w.mover, w.target[j], &options, ws, &one), CPROX_OK);
      all[j] = one.upper;
    }
    qsort(all, w.n, sizeof *all, ascending);
    const size_t k = 1 + rng_index(&r, 6);
    cprox_result nearest[6];
    size_t count = 99;
    assert_int_equal(nearest_of_list(w.mover, w.target, w.n, k, &options, ws, nearest, &count), CPROX_OK);
    assert_int_equal(count, k < w.n ? k : w.n);
    for (size_t j = 0; j < count; j++) {
      assert_true(fabs(nearest[j].upper - all[j]) <= 1e-9);
      assert_true(j == 0 || nearest[j - 1].upper <= nearest[j].upper);
      for (size_t m = 0; m < j; m++) assert_true(nearest[m].obstacle_index != nearest[j].obstacle_index);
    }
    world_free(&w);
  }
}

/* 600 worlds, seed 2: who is listed and who is not, against the distances asked one by one. */
CASE(within_lists_exactly_those_within) {
  rng r = rng_seed(2);
  size_t listed = 0, left_out = 0;
  for (size_t i = 0, cases = test_cases(600); i < cases; i++) {
    world w = world_make(&r);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-7;
    const double delta = rng_index(&r, 4) ? rng_uniform(&r, 0.0, 2.0) : 0.0;
    cprox_result near[MOST_TARGETS];
    size_t count = 99, next = 0;
    assert_int_equal(within_of_list(w.mover, w.target, w.n, delta, &options, ws, near, &count), CPROX_OK);
    for (size_t j = 0; j < w.n; j++) {
      cprox_result one;
      assert_int_equal(cprox_distance(w.mover, w.target[j], &options, ws, &one), CPROX_OK);
      if (next < count && near[next].obstacle_index == (int32_t)j) {
        assert_true(one.lower <= delta + 1e-7);
        assert_true(near[next].verdict == CPROX_VERDICT_UNDECIDED ||
                    (one.lower <= delta && near[next].upper - near[next].lower <= 1e-7));
        next++, listed++;
      } else {
        assert_true(one.upper > delta);
        left_out++;
      }
    }
    assert_int_equal(next, count);
    world_free(&w);
  }
  assert_true(listed > 500 && left_out > 500);
}

/* 200 worlds, seed 3, up to 12 intervals each, some as short as 1e-9: the least clearance sampled in long double at 40
 * parameters of an interval is never below its lower bound, and the whole is the least of the parts. */
CASE(a_profile_holds_on_every_interval_and_adds_up_to_the_whole) {
  rng r = rng_seed(3);
  for (size_t i = 0, cases = test_cases(200); i < cases; i++) {
    world w = world_make(&r);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-8;
    const size_t n = 1 + rng_index(&r, 12);
    double breaks[13] = {0};
    for (size_t k = 1; k < n; k++)
      breaks[k] =
          rng_index(&r, 8) ? rng_uniform(&r, 0.001, 0.999) : fmin(breaks[k - 1] + 1e-9, 0.99 + 1e-4 * (double)k);
    breaks[n] = 1.0;
    qsort(breaks, n + 1, sizeof *breaks, ascending);
    cprox_profile_interval interval[12];
    const cprox_status status = profile_of_list(w.mover, w.target, w.n, breaks, n, &options, ws, interval);
    if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
    double least = INFINITY;
    for (size_t k = 0; k < n; k++) {
      assert_true(interval[k].upper - interval[k].lower <= 1e-8);
      assert_true(interval[k].t >= breaks[k] && interval[k].t <= breaks[k + 1]);
      assert_true(fabs((double)clearance_at(&w, interval[k].t) - interval[k].upper) <= 1e-13);
      const double between = vec_norm(vec_sub(interval[k].witness_mover, interval[k].witness_obstacle));
      assert_true(fabs(between - interval[k].upper) <= 1e-13);
      for (int m = 0; m <= 40; m++) {
        const long double t =
            (long double)breaks[k] + ((long double)breaks[k + 1] - (long double)breaks[k]) * m / 40.0L;
        const long double d = clearance_at(&w, t);
        if (d < (long double)interval[k].lower - 1e-14L)
          fail_msg("case %zu, interval %zu: %.17Lg < %.17g", i, k, d, interval[k].lower);
      }
      least = fmin(least, interval[k].upper);
    }
    cprox_result whole;
    assert_int_equal(distance_of_list(w.mover, w.target, w.n, &options, ws, &whole, NULL), CPROX_OK);
    assert_true(least >= whole.lower && least <= whole.upper + 1e-8);
    world_free(&w);
  }
}

/* 400 worlds, seed 10: with a horizon every interval is as without, or proven to be beyond. */
CASE(clearance_beyond_a_horizon_is_only_bounded) {
  enum { INTERVALS = 5 };
  rng r = rng_seed(10);
  size_t near = 0, wide = 0;
  for (size_t i = 0, cases = test_cases(400); i < cases; i++) {
    world w = world_make(&r);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = rng_log_uniform(&r, 1e-9, 0.1);
    options.relative_epsilon = rng_index(&r, 2) ? rng_log_uniform(&r, 1e-6, 2.0) : 0.0;
    const double horizon = rng_index(&r, 8) ? rng_uniform(&r, 0.0, 2.0) : 0.0;
    const double breaks[INTERVALS + 1] = {0.0, 0.1, 0.3, 0.6, 0.8, 1.0};
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(w.target, w.n, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    cprox_profile_interval whole[INTERVALS], some[INTERVALS];
    assert_int_equal(cprox_obstacles_profile(all, w.mover, breaks, INTERVALS, INFINITY, NULL, ws, whole), CPROX_OK);
    assert_int_equal(cprox_obstacles_profile(all, w.mover, breaks, INTERVALS, horizon, &options, ws, some), CPROX_OK);
    for (int k = 0; k < INTERVALS; k++) {
      assert_true(some[k].lower <= whole[k].upper && some[k].upper >= whole[k].lower);
      const double asked = fmax(options.epsilon, options.relative_epsilon * some[k].upper);
      const bool narrow = some[k].upper - some[k].lower <= asked;
      if (!narrow && !(some[k].lower > horizon))
        fail_msg("case %zu: [%.17g, %.17g], horizon %.17g", i, some[k].lower, some[k].upper, horizon);
      narrow ? near++ : wide++;
    }
    cprox_obstacles_free(all);
    world_free(&w);
  }
  assert_true(near > 200 && wide > 200);
}

/* A spline of 60 pieces whose clearance over a floor is known, in intervals that cut pieces anywhere. */
/* seed 68: curves that touch a face of a cube, epsilon 0: ok is what is exact, or beyond the horizon. */
CASE(a_profile_of_width_0_is_ok_where_it_is_exact_or_beyond_the_horizon) {
  enum { INTERVALS = 6 };
  rng r = rng_seed(68);
  cprox_body *cube = NULL;
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &cube), CPROX_OK);
  for (int i = 0; i < 200; i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1.0), away = i % 2 ? 0.0 : rng_log_uniform(&r, 1e-18, 1e-2);
    const vec3 points[3] = {vec(-scale, 0.1, 0.5 + scale), vec(0.0, 0.1, 0.5 - scale + away),
                            vec(scale, 0.1, 0.5 + scale)};
    cprox_curve *curve = bezier(points, 3);
    const cprox_obstacle target = cprox_obstacle_at(cube, CPROX_POSE_IDENTITY);
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    const cprox_options options = accurate(0.0);
    const double horizon = i % 3 ? 0.0 : rng_log_uniform(&r, 1e-18, 1e-2);
    for (int k = 0; k < INTERVALS; k++) {
      const double breaks[2] = {(double)k / INTERVALS, k + 1 == INTERVALS ? 1.0 : (double)(k + 1) / INTERVALS};
      cprox_profile_interval x;
      const cprox_status status =
          cprox_obstacles_profile(all, cprox_point_along(curve), breaks, 1, horizon, &options, ws, &x);
      assert_true(status >= CPROX_OK);
      if (status == CPROX_OK && x.lower <= horizon && x.lower != x.upper)
        fail_msg("ok with [%g, %g], horizon %g", x.lower, x.upper, horizon);
    }
    cprox_obstacles_free(all);
    cprox_curve_free(curve);
  }
  cprox_body_free(cube);
}

CASE(intervals_may_begin_and_end_inside_pieces) {
  enum { N = 63, INTERVALS = 17 };
  vec3 p[N];
  double knots[N + 4], breaks[INTERVALS + 1];
  for (int i = 0; i < N; i++) p[i] = vec(i, 0, 1.0 + 0.1 * i);
  for (int i = 0; i < N + 4; i++) knots[i] = i;
  for (int i = 0; i <= INTERVALS; i++) breaks[i] = 3.0 + 60.0 * i / INTERVALS;
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(p, N, 3, knots, N + 4, 3, N), ws, &curve), CPROX_OK);
  cprox_body *floor = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0, ws, &floor), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(floor, CPROX_POSE_IDENTITY);
  cprox_profile_interval interval[INTERVALS];
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  assert_int_equal(profile_of_list(cprox_point_along(curve), &target, 1, breaks, INTERVALS, &options, ws, interval),
                   CPROX_OK);
  for (int i = 0; i < INTERVALS; i++) {
    /* z(t) = 1 + 0.1 (t - 2) */
    const double least = 1.0 + 0.1 * (breaks[i] - 2.0);
    assert_true(interval[i].lower <= least + 1e-12 && interval[i].upper >= least - 1e-12 &&
                interval[i].upper <= least + 1e-6);
  }
  cprox_body_free(floor);
  cprox_curve_free(curve);
}

/* 10^6 parameters of pieces anywhere, as short as a few doubles, seed 8: in 113 bits (or long double's 64) the
 * fractions of a section lie on the far sides of the parameter, and within 16 roundings of it. */
CASE(the_fractions_of_a_section_are_rounded_outward) {
  rng r = rng_seed(8);
  for (size_t i = 0, cases = test_cases(1000000); i < cases; i++) {
    const double t0 = rng_index(&r, 4) ? rng_uniform(&r, -2.0, 2.0) : rng_uniform(&r, 1.6e9, 1.7e9);
    const double t1 = fmax(t0 + rng_log_uniform(&r, 1e-12, 1e3), nextafter(nextafter(t0, INFINITY), INFINITY));
    const double t = fmin(fmax(t0 + rng_uniform(&r, 0.0, 1.0) * (t1 - t0), nextafter(t0, INFINITY)), nextafter(t1, t0));
    const quad length = (quad)t1 - (quad)t0, way = (quad)t - (quad)t0;
    const double below = round_fraction_below(t0, t1, t), above = round_fraction_above(t0, t1, t);
    assert_true((quad)below * length <= way && (quad)above * length >= way);
    assert_true(above - below <= 16.0 * 0x1p-53 * above + 2e-300);
  }
  assert_true(round_fraction_below(1.0, 2.0, 1.0) == 0.0 && round_fraction_above(1.0, 2.0, 2.0) == 1.0);
}

/* 2000 curves, seed 9, cut at a parameter where a point stands on the curve: neither of the intervals that share the
 * cut is free. With a width of 0 the status says that the intervals are wider. So of
 * a tube, which the point is inside of. */
CASE(both_stretches_at_a_break_see_the_point_at_the_break) {
  rng r = rng_seed(9);
  for (size_t i = 0, cases = test_cases(2000); i < cases; i++) {
    vec3 p[8];
    const size_t degree = 1 + rng_index(&r, 7);
    for (size_t k = 0; k <= degree; k++) p[k] = rng_in_cube(&r, 2.0);
    const double t0 = rng_uniform(&r, -1.0, 1.0), t1 = t0 + rng_log_uniform(&r, 1e-3, 1e3);
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(p, degree + 1, t0, t1), ws, &curve), CPROX_OK);
    const double cut = t0 + rng_uniform(&r, 0.01, 0.99) * (t1 - t0);
    const long double s = ((long double)cut - t0) / ((long double)t1 - t0);
    const vec3l at = ref_bezier(p, degree, s, 0);
    cprox_body *point = NULL;
    const vec3 rounded = vec((double)at.x, (double)at.y, (double)at.z);
    assert_int_equal(cprox_body_create_point(rounded, ws, &point), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(point, CPROX_POSE_IDENTITY);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 0.0;
    cprox_profile_interval interval[2];
    for (int k = 0; k < 4; k++) {
      const cprox_mover mover = k < 2 ? cprox_point_along(curve) : cprox_tube_along(curve, 0.01);
      const cprox_status status =
          profile_of_list(mover, &target, 1, (double[]){t0, cut, t1}, 2, &options, ws, interval);
      const cprox_profile_interval *x = &interval[k % 2];
      assert_true(status >= 0 && (status != CPROX_OK || x->upper == x->lower));
      if (!(x->lower <= 4.0 * 0x1p-53 * vec_norm(rounded) && x->upper <= 1e-12))
        fail_msg("case %zu, interval %d: [%.17g, %.17g]", i, k, x->lower, x->upper);
    }
    cprox_body_free(point);
    cprox_curve_free(curve);
  }
}

CASE(unusable_arguments_are_named) {
  rng r = rng_seed(5);
  world w = world_make(&r);
  cprox_result result[MOST_TARGETS];
  cprox_profile_interval interval[2];
  size_t count = 7;
  assert_int_equal(nearest_of_list(w.mover, w.target, w.n, 0, NULL, ws, result, &count), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "k is 0: ask for at least one obstacle");
  assert_int_equal(within_of_list(w.mover, w.target, w.n, -1.0, NULL, ws, result, &count), CPROX_INVALID);
  assert_int_equal(count, 7);
  assert_int_equal(profile_of_list(w.mover, w.target, w.n, (double[]){0, 0.5, 0.5}, 2, NULL, ws, interval),
                   CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "break 2 is 0.5, not above break 1 at 0.5");
  assert_int_equal(profile_of_list(w.mover, w.target, w.n, (double[]){0, 1.5}, 1, NULL, ws, interval), CPROX_INVALID);
  assert_int_equal(profile_of_list(w.mover, w.target, w.n, (double[]){0, NAN}, 1, NULL, ws, interval), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_profile(NULL, w.mover, (double[]){0, 1}, 1, NAN, NULL, ws, interval), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "horizon is nan, must be 0 or more, or infinity");
  world_free(&w);
}

CASE(with_no_targets_everything_is_infinitely_far) {
  rng r = rng_seed(6);
  world w = world_make(&r);
  cprox_result result[1];
  cprox_profile_interval interval[1];
  size_t count = 7;
  assert_int_equal(nearest_of_list(w.mover, NULL, 0, 3, NULL, ws, result, &count), CPROX_OK);
  assert_int_equal(count, 0);
  assert_int_equal(profile_of_list(w.mover, NULL, 0, (double[]){0, 1}, 1, NULL, ws, interval), CPROX_OK);
  assert_true(isinf(interval[0].lower) && isinf(interval[0].upper) && interval[0].obstacle_index == -1);
  world_free(&w);
}

CASE(nothing_is_allocated_once_the_workspace_has_grown) {
  rng r = rng_seed(7);
  world w = world_make(&r);
  cprox_result result[MOST_TARGETS], first;
  cprox_profile_interval interval[4];
  size_t before = 0;
  cprox_listed listed;
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(w.target, w.n, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  for (int round = 0; round < 3; round++) {
    assert_int_equal(cprox_obstacles_nearest(all, w.mover, 3, NULL, ws, result, &listed), CPROX_OK);
    assert_int_equal(cprox_obstacles_within(all, w.mover, 1.0, NULL, ws, result, &listed), CPROX_OK);
    assert_int_equal(cprox_obstacles_profile(all, w.mover, (double[]){0, 0.2, 0.7, 1}, 3, 0.5, NULL, ws, interval),
                     CPROX_OK);
    assert_int_equal(cprox_obstacles_time_of_contact(all, w.mover, NULL, ws, &first), CPROX_OK);
    if (round == 1) before = allocations_made();
  }
  assert_int_equal(allocations_made(), before);
  cprox_obstacles_free(all);
  world_free(&w);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
