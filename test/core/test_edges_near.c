/* SPDX-License-Identifier: BSD-3-Clause */
/* Verdicts of edges that are near to change: thin obstacles, edges that graze, numbers that the caller rounded. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/edge_worlds.h"

/* Samples that leave out what is too far away find what all of them find: 30 worlds (seed 413); the pair that is nearest
 * is as far as kinematics in long double have it, capsules beside their ends. Tolerance: 1e-12 of the size, for poses. */
CASE(samples_leave_out_only_what_is_too_far) {
  rng r = rng_seed(413);
  for (size_t i = 0; i < test_cases(30); i++) {
    edge_world w;
    const double scale = rng_log_uniform(&r, 1e-2, 1e2);
    edge_world_make(&r, scale, i % 2, i % 3 == 0, &w);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1], at = 0.0, least = INFINITY;
    edge_robot_draw(&r, &w.b, scale, from, to);
    const double found = edge_world_least(&w, from, to, true, &at);
    for (int k = 0; k <= EDGE_WORLD_SAMPLES; k++)
      least = fmin(least, edge_world_distance(&w, from, to, (double)k / EDGE_WORLD_SAMPLES, true));
    assert_true(found <= least);
    if (isfinite(found)) assert_true(found == edge_world_distance(&w, from, to, at, true));
    ref_pose links[TEST_MAX_LINKS];
    edge_robot_links(&w.b, from, to, (long double)at, links);
    for (size_t k = 0; k < w.n_selves; k++) {
      const size_t a = (size_t)w.selves[k].geometry, z = (size_t)w.selves[k].other;
      const vec3l way = ref_sub(edge_robot_centre(&w.b, links, a, -1.0), edge_robot_centre(&w.b, links, z, -1.0));
      assert_true((double)ref_norm(way) - w.b.radius[a] - w.b.radius[z] >= found - 1e-12 * scale);
    }
    edge_world_free(&w);
  }
}

/* 120 worlds (seed 412), balls and capsules among wires, pins and plates. */
CASE(wires_pins_and_plates_are_never_missed) {
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0};
  edge_world_try(412, test_cases(120), true, counts, levels);
  if (test_cases(120) >= 60)
    assert_true(20 * counts[0] > EDGE_WORLD_EDGES * 120 && 20 * counts[1] > EDGE_WORLD_EDGES * 120);
}

/* The delta is drawn beside the least distance that was sampled, by 1e-5 to 1e-2 of the scene's size on either side
 * (1000 worlds, seed 405): the verdict is that side's. */
CASE(grazing_edges_are_decided_rightly) {
  rng r = rng_seed(405);
  size_t decided = 0, asked = 0;
  for (size_t i = 0; i < test_cases(1000); i++) {
    edge_world w;
    edge_world_make(&r, 1.0, false, false, &w);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1], at = 0.0;
    edge_robot_draw(&r, &w.b, 1.0, from, to);
    const bool self = rng_index(&r, 2);
    const double least = edge_world_least(&w, from, to, self, &at);
    const double beside = rng_log_uniform(&r, 1e-5, 1e-2) * (rng_index(&r, 2) ? 1.0 : -1.0);
    if (least + beside > 1e-6 && isfinite(least)) {
      const cprox_edge_query q = edge_world_asks(&w, self, least + beside);
      cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
      uint8_t verdict;
      cprox_edge_result result;
      assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
      edge_world_check(&w, &q, &result, verdict, from, to, 1.0, self, least);
      asked++, decided += verdict == (beside > 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      cprox_edge_checker_free(c);
    }
    edge_world_free(&w);
  }
  print_message("%zu grazing edges, none wrong\n", asked);
  if (test_cases(1000) >= 500) assert_true(asked > test_cases(1000) / 4 && decided * 100 >= 97 * asked);
}

/* What the caller's numbers may be off by (125 worlds, seed 411, 8 edges each). The
 * delta is drawn beside the least distance by up to three times that, or is 0. Clear is farther than both together,
 * violated is nearer than delta without it, and the verdicts are those of two checkers that are asked for the one and
 * for the other. Tolerance beside edge_world_check()'s: the search is undecided within its epsilon, 1e-6 of 1 m. */
CASE(rounding_of_the_caller_is_on_the_safe_side_of_both_verdicts) {
  rng r = rng_seed(411);
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0}, differ = 0, asked = 0;
  for (size_t i = 0; i < test_cases(125); i++) {
    edge_world w;
    edge_world_make(&r, 1.0, i % 8 == 0, false, &w);
    const bool self = rng_index(&r, 2);
    const size_t n = w.b.t.n_variables;
    double from[EDGE_WORLD_EDGES * TEST_MAX_VARIABLES + 1], to[EDGE_WORLD_EDGES * TEST_MAX_VARIABLES + 1],
        least[EDGE_WORLD_EDGES], at = 0.0;
    for (size_t k = 0; k < EDGE_WORLD_EDGES; k++) {
      edge_robot_draw(&r, &w.b, 1.0, from + k * n, to + k * n);
      least[k] = edge_world_least(&w, from + k * n, to + k * n, self, &at);
    }
    cprox_edge_query q = edge_world_asks(&w, self, 0.0), clear = q, hit = q;
    q.rounding = rng_log_uniform(&r, 1e-12, 1e-2);
    const double beside = least[rng_index(&r, EDGE_WORLD_EDGES)] + 3.0 * q.rounding * rng_uniform(&r, -1, 1);
    if (isfinite(beside) && rng_index(&r, 4)) q.delta = fmax(beside, 0.0);
    clear.delta = q.delta + q.rounding, hit.delta = fmax(q.delta - q.rounding, 0.0);
    uint8_t verdicts[3][EDGE_WORLD_EDGES];
    cprox_edge_result results[EDGE_WORLD_EDGES];
    for (int by = 0; by < 3; by++) {
      cprox_edge_checker *c = edge_world_checker(w.b.robot, by == 0 ? &q : by == 1 ? &clear : &hit);
      assert_true(cprox_robot_edges(c, from, to, EDGE_WORLD_EDGES, ws, verdicts[by], by == 0 ? results : NULL) >= 0);
      cprox_edge_checker_free(c);
    }
    for (size_t k = 0; k < EDGE_WORLD_EDGES; k++) {
      const uint8_t verdict = verdicts[0][k];
      edge_world_check(&w, verdict == CPROX_VERDICT_CLEAR ? &clear : &hit, &results[k], verdict, from + k * n,
                       to + k * n, 1.0, self, least[k]);
      const uint8_t both = verdicts[1][k] == CPROX_VERDICT_CLEAR      ? CPROX_VERDICT_CLEAR
                           : verdicts[2][k] == CPROX_VERDICT_VIOLATED ? CPROX_VERDICT_VIOLATED
                                                                      : CPROX_VERDICT_UNDECIDED;
      asked++, differ += verdict != both;
      if (verdict != both && fmin(fabs(least[k] - clear.delta), fabs(least[k] - hit.delta)) > 3e-6)
        fail_msg("%d, by two checkers %d: least %.9g, delta %.9g, rounding %.9g, level %d", (int)verdict, (int)both,
                 least[k], q.delta, q.rounding, (int)results[k].level);
      counts[verdict]++, levels[results[k].level]++;
    }
    edge_world_free(&w);
  }
  if (asked < 500) return;
  assert_true(counts[0] > asked / 10 && counts[1] > asked / 10 && differ * 1000 <= asked);
  if (asked >= 1000) assert_true(counts[2] > 0 && levels[CPROX_EDGE_MEASUREMENT] > 0 && levels[CPROX_EDGE_SEARCH] > 0);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
