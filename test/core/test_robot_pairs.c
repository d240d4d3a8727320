/* SPDX-License-Identifier: BSD-3-Clause */
/* The pairs of a robot that come closest, against a search for each pair alone; the range of variables against samples
 * in long double. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robot_case.h"
#include "support/robots.h"

enum { CASES = 4, MOST_PAIRS = 700 };

/* Every pair of the first real robots, then the same with fewer and nearer ones. */
CASE(the_nearest_pairs_are_those_of_single_queries) {
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  size_t n;
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  static cprox_result all[MOST_PAIRS], few[MOST_PAIRS];
  for (size_t i = 0; i < CASES; i++) {
    robot_case c;
    assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &c));
    for (int self = 0; self < 2; self++) {
      const cprox_mover mover =
          self ? cprox_robot_self(c.motion, c.self_pairs, c.n_self_pairs) : cprox_robot_along(c.motion, NULL, 0);
      const size_t targets = self ? 0 : c.n_targets;
      size_t count, fewer;
      assert_int_equal(nearest_pairs_of_list(mover, c.targets, targets, MOST_PAIRS, INFINITY, NULL, ws, all, &count),
                       CPROX_OK);
      assert_true(count > 10 && count < MOST_PAIRS);
      if (self) assert_int_equal(count, c.n_self_pairs);
      for (size_t k = 0; k < count; k++) {
        const cprox_robot_pair pair = {all[k].mover_part, all[k].obstacle_index};
        const cprox_mover alone = self ? cprox_robot_self(c.motion, &pair, 1) : cprox_robot_along(c.motion, &pair, 1);
        cprox_result r;
        assert_int_equal(distance_of_list(alone, c.targets, targets, NULL, ws, &r, NULL), CPROX_OK);
        assert_true(r.lower <= all[k].upper && all[k].lower <= r.upper);
        assert_true(k == 0 || all[k - 1].upper <= all[k].upper);
      }
      cprox_result whole;
      assert_int_equal(distance_of_list(mover, c.targets, targets, NULL, ws, &whole, NULL), CPROX_OK);
      assert_true(whole.lower <= all[0].upper && all[0].lower <= whole.upper);

      /* the best three, and those within what the third is at */
      assert_int_equal(nearest_pairs_of_list(mover, c.targets, targets, 3, INFINITY, NULL, ws, few, &fewer), CPROX_OK);
      assert_int_equal(fewer, 3);
      for (size_t k = 0; k < 3; k++) assert_true(few[k].lower <= all[k].upper + 1e-6 && all[k].lower <= few[k].upper);
      const double delta = 1.001 * all[5].upper + 1e-5;
      assert_int_equal(nearest_pairs_of_list(mover, c.targets, targets, MOST_PAIRS, delta, NULL, ws, few, &fewer),
                       CPROX_OK);
      size_t within = 0;
      for (size_t k = 0; k < count; k++) within += all[k].upper <= delta;
      assert_true(fewer >= within);
      for (size_t k = 0; k < fewer; k++) assert_true(few[k].lower <= delta);
    }
    robot_case_free(&c);
  }
  fclose(f);
}

/* 100 random motions; 1e-8: nine digits of the largest coefficient, which is below 10. */
CASE(a_range_holds_all_values_and_is_reached) {
  rng r = rng_seed(811);
  for (size_t i = 0; i < test_cases(100); i++) {
    test_robot t;
    robot_make(&r, 1.0, &t);
    cprox_variable_info range[TEST_MAX_VARIABLES];
    long double values[TEST_MAX_VARIABLES], least[TEST_MAX_VARIABLES], most[TEST_MAX_VARIABLES];
    const cprox_motion_info info = cprox_motion_get_info(t.motion);
    const double t0 = info.t0, t1 = info.t1;
    for (size_t v = 0; v < t.n_variables; v++) {
      range[v] = cprox_motion_get_variable_info(t.motion, v);
      least[v] = INFINITY, most[v] = -INFINITY;
    }
    const int n = 4000 + (int)t.n_points; /* at the waypoints too: motions bend there */
    for (int s = 0; s <= n; s++) {
      const long double at = s <= 4000 ? t0 + ((long double)t1 - t0) * s / 4000 : (long double)t.times[s - 4001];
      if (at < t0 || at > t1) continue;
      robot_ref_values(&t, at, values);
      for (size_t v = 0; v < t.n_variables; v++) {
        least[v] = fminl(least[v], values[v]), most[v] = fmaxl(most[v], values[v]);
        assert_true(values[v] >= range[v].lowest - 1e-13L && values[v] <= range[v].highest + 1e-13L);
      }
    }
    /* between samples a polynomial of degree 9 rises by no more than its second derivative allows: 1e-4 is ten times
     * that */
    for (size_t v = 0; v < t.n_variables; v++)
      assert_true(least[v] - range[v].lowest <= 1e-4L && range[v].highest - most[v] <= 1e-4L);
    robot_free(&t);
  }
}

CASE(what_is_no_query_about_pairs_gets_a_sentence) {
  rng r = rng_seed(3);
  test_robot t;
  robot_make(&r, 1.0, &t);
  cprox_result result;
  size_t count;
  const cprox_mover mover = cprox_robot_self(t.motion, NULL, 0);
  assert_int_equal(nearest_pairs_of_list(mover, NULL, 0, 0, 1.0, NULL, ws, &result, &count), CPROX_INVALID);
  assert_int_equal(nearest_pairs_of_list(mover, NULL, 0, 1, NAN, NULL, ws, &result, &count), CPROX_INVALID);
  assert_int_equal(nearest_pairs_of_list(mover, NULL, 0, 1, -1.0, NULL, ws, &result, &count), CPROX_INVALID);
  robot_free(&t);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
