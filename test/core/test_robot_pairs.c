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
      size_t count = 0, fewer = 0;
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
      for (size_t k = 3; k < count; k++) assert_true(all[k].upper >= few[2].upper - 2e-6);
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

static bool is_among(const cprox_result *one, const cprox_result *results, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (results[i].mover_part == one->mover_part && results[i].obstacle_index == one->obstacle_index) return true;
  return false;
}

static size_t looks_left;

static bool stop_at_a_look(void *user) {
  (void)user;
  if (looks_left == 0) return true;
  looks_left--;
  return false;
}

/* Whatever the budget, the look at which it is stopped, k and delta: no pair twice, each interval true, and every other
 * pair at least as far as is said of the others; unless something ended it as far as the list says. */
CASE(few_nodes_leave_true_intervals_of_the_nearest_pairs) {
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  size_t n;
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  robot_case c;
  assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &c));
  fclose(f);
  static cprox_result all[MOST_PAIRS], few[MOST_PAIRS];
  size_t count = 0, fewer = 0, short_of = 0, stopped = 0;
  const cprox_mover movers[] = {cprox_robot_self(c.motion, c.self_pairs, c.n_self_pairs),
                                cprox_robot_self(c.motion, NULL, 0), cprox_robot_along(c.motion, NULL, 0),
                                cprox_robot_along(c.mesh_motion, NULL, 0)};
  for (size_t m = 0; m < 4; m++) {
    const size_t targets = m < 2 ? 0 : c.n_targets;
    assert_int_equal(nearest_pairs_of_list(movers[m], c.targets, targets, MOST_PAIRS, INFINITY, NULL, ws, all, &count),
                     CPROX_OK);
    for (uint32_t nodes = 1; nodes <= 4096; nodes *= 4) {
      for (int i = 0; i < 12; i++) {
        const size_t k = (const size_t[]){1, 3, 10}[i % 3];
        const double delta = i % 6 < 3 ? INFINITY : 1.001 * all[4].upper + 1e-5;
        cprox_options options = CPROX_OPTIONS_DEFAULT;
        if (i < 6) options.max_nodes = nodes;
        if (i >= 6) options.stop = stop_at_a_look, looks_left = nodes / 4;
        cprox_listed listed;
        const cprox_status status =
            nearest_pairs_of_list_and_others(movers[m], c.targets, targets, k, delta, &options, ws, few, &listed);
        fewer = listed.count;
        assert_true(status == CPROX_OK || status == (i < 6 ? CPROX_BUDGET : CPROX_STOPPED));
        short_of += status == CPROX_BUDGET, stopped += status == CPROX_STOPPED;
        assert_true(fewer <= k && (isfinite(delta) || status == CPROX_STOPPED || fewer == k));
        for (size_t a = 0; a < count; a++)
          if (!is_among(&all[a], few, fewer)) assert_true(listed.others <= all[a].upper);
        if (status == CPROX_OK)
          assert_true(listed.others >= fmin(delta, fewer == k ? few[k - 1].upper - 1e-6 : INFINITY));
        for (size_t j = 0; j < fewer; j++) {
          assert_false(is_among(&few[j], few, j));
          assert_true(j == 0 || few[j - 1].upper <= few[j].upper);
          assert_true(few[j].lower <= delta);
          for (size_t a = 0; a < count; a++)
            if (is_among(&all[a], &few[j], 1))
              assert_true(few[j].lower <= all[a].upper && all[a].lower <= few[j].upper);
        }
        for (size_t a = 0; a < count && status == CPROX_OK; a++) {
          if (is_among(&all[a], few, fewer)) continue;
          const double nearest = fewer == k ? few[k - 1].upper - 1e-6 : INFINITY;
          assert_true(all[a].upper > delta || all[a].upper >= nearest);
        }
      }
    }
  }
  assert_true(short_of > 0);
  robot_case_free(&c);
}

typedef struct poll_counter {
  size_t polls;
} poll_counter;

/* Every search asks whether it shall stop when it begins, and after each 16 nodes. */
static bool count_poll(void *user) {
  ((poll_counter *)user)->polls++;
  return false;
}

CASE(few_pairs_are_searched_for_the_nearest_ones) {
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  size_t n;
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  robot_case c;
  assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &c));
  fclose(f);
  static cprox_result nearest[MOST_PAIRS];
  size_t count = 0, polls[2];
  for (int i = 0; i < 2; i++) {
    poll_counter counter = {0};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.stop = count_poll, options.stop_user = &counter;
    assert_int_equal(nearest_pairs_of_list(cprox_robot_along(c.motion, NULL, 0), c.targets, c.n_targets,
                                           i == 0 ? 3 : MOST_PAIRS, INFINITY, &options, ws, nearest, &count),
                     CPROX_OK);
    polls[i] = counter.polls;
  }
  print_message("3 nearest pairs: %zu polls; all %zu pairs: %zu\n", polls[0], count, polls[1]);
  assert_true(polls[1] > count);
  assert_true(3 * polls[0] < polls[1]);
  robot_case_free(&c);
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

CASE(what_is_no_query_about_pairs_gets_a_message) {
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
