/* SPDX-License-Identifier: BSD-3-Clause */
/* Verdicts of certified edges against dense samples and against the search, and what is refused. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "edges/edge_model.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/edge_worlds.h"

/* 120 worlds (seed 404), every kind of obstacle, balls and capsules. */
CASE(edge_verdicts_are_never_wrong) {
  size_t counts[3] = {0}, levels[CPROX_EDGE_SEARCH + 1] = {0};
  edge_world_try(404, test_cases(120), false, counts, levels);
  if (test_cases(120) < 60) return; /* what follows is about many */
  assert_true(counts[0] > EDGE_WORLD_EDGES * test_cases(120) / 10 &&
              counts[1] > EDGE_WORLD_EDGES * test_cases(120) / 10);
  assert_true(counts[2] * 100 < counts[0] + counts[1]);
  assert_true(levels[CPROX_EDGE_BALL] > 0 && levels[CPROX_EDGE_COVER] > 0);
  assert_true(levels[CPROX_EDGE_MEASUREMENT] + levels[CPROX_EDGE_SEARCH] > 0);
}

/* A ball whose velocity is all but 0 in the middle of the last of the eight intervals that a search begins with: a shift
 * along an axis that turns by W = .2 rad takes back what another shift does, and D = W h^2 is what the acceleration 2 W
 * moves it in half the interval, h = 1/16. It touches a small ball at the end of the edge alone. Its way there is 1.04 D
 * long, and all that is counted for it 1.4 D; with half the acceleration that would be .9 D. */
CASE(what_an_acceleration_alone_reaches_is_hit) {
  const double h = 0.0625, rate[4] = {0.3 * 0.2 * h, -1.0, 0.2, 1.0}, size = 0.02 * 0.2 * h * h;
  const vec3 axes[4] = {vec(0, 0, 1), vec(1, 0, 0), vec(0, 0, 1), vec(1, 0, 0)};
  cprox_link links[4];
  double from[4], to[4];
  for (int i = 0; i < 4; i++) {
    links[i] = (cprox_link){.parent = i - 1,
                            .type = i == 2 ? CPROX_JOINT_REVOLUTE : CPROX_JOINT_PRISMATIC,
                            .origin = CPROX_POSE_IDENTITY,
                            .axis = axes[i],
                            .variable = i,
                            .multiplier = 1.0};
    from[i] = -15.0 * h * rate[i], to[i] = h * rate[i];
  }
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(size, ws, &ball), CPROX_OK);
  const cprox_link_geometry moves = {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 3};
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, 4, &moves, 1, 4, ws, &robot), CPROX_OK);
  cprox_obstacle stands = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);
  stands.pose.position = vec(h * (cos(to[2]) - 1.0), h * sin(to[2]), to[0]);
  cprox_obstacles *set = NULL;
  assert_int_equal(cprox_obstacles_create(&stands, 1, CPROX_INDEX_NONE, ws, &set), CPROX_OK);
  cprox_edge_checker *c = edge_world_checker(robot, &(cprox_edge_query){.obstacles = set});
  uint8_t verdict;
  assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, NULL) >= 0);
  assert_int_equal(verdict, CPROX_VERDICT_VIOLATED);
  cprox_edge_checker_free(c);
  cprox_obstacles_free(set);
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* ---- input ---- */

CASE(an_edge_that_is_not_finite_is_refused_alone) {
  rng r = rng_seed(407);
  edge_world w;
  edge_world_make(&r, 1.0, false, false, &w);
  const cprox_edge_query q = edge_world_asks(&w, false, 0.0);
  cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
  assert_true(c->n_frames > 1);
  const size_t n = w.b.t.n_variables;
  double from[3 * TEST_MAX_VARIABLES] = {0}, to[3 * TEST_MAX_VARIABLES] = {0};
  to[n] = NAN;
  uint8_t verdicts[3];
  cprox_edge_result results[3];
  assert_int_equal(cprox_robot_edges(c, from, to, 3, ws, verdicts, results), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "edge 1"));
  assert_int_equal(verdicts[1], CPROX_VERDICT_UNDECIDED);
  assert_int_equal(results[1].status, CPROX_INVALID);
  assert_int_equal(results[1].level, CPROX_EDGE_NONE);
  assert_true(results[0].status >= 0 && results[2].status >= 0);
  assert_int_equal(verdicts[0], verdicts[2]);

  /* beyond single precision: by the search, or refused by it, never by lanes */
  to[n] = 0.0;
  for (size_t k = 0; k < n; k++) to[k] = 1e7;
  assert_true(cprox_robot_edges(c, from, to, 1, ws, verdicts, results) >= 0);
  assert_int_equal(results[0].intervals, 0);
  cprox_edge_checker_free(c);
  edge_world_free(&w);
}

CASE(what_is_asked_of_edges_is_checked) {
  rng r = rng_seed(408);
  edge_world w;
  edge_world_make(&r, 1.0, false, false, &w);
  cprox_edge_checker *c = NULL;
  cprox_edge_query q = edge_world_asks(&w, true, -1.0);
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  q.delta = 0.1, q.first = true;
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  static const double BAD[] = {-1e-9, NAN, INFINITY};
  for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
    q = edge_world_asks(&w, true, 0.1), q.rounding = BAD[i];
    assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "rounding is"));
  }
  q = edge_world_asks(&w, false, 0.0), q.first = true, q.rounding = 1e-9;
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  const cprox_robot_pair none = {0, (int32_t)w.n}, itself = {0, 0};
  q = (cprox_edge_query){.obstacles = w.set, .pairs = &none, .n_pairs = 1};
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  q = (cprox_edge_query){.self_pairs = &itself, .n_self_pairs = 1};
  assert_int_equal(cprox_edge_checker_create(w.b.robot, &q, ws, &c), CPROX_INVALID);
  assert_int_equal(cprox_edge_checker_create(NULL, NULL, ws, &c), CPROX_INVALID);
  assert_null(c);
  edge_world_free(&w);
}

/* Of edges that hit something t_free is never late, and t is where contact is proven (200 worlds, seed 409). */
CASE(the_first_contact_is_never_late) {
  rng r = rng_seed(409);
  size_t hits = 0;
  for (size_t i = 0; i < test_cases(200); i++) {
    edge_world w;
    edge_world_make(&r, 1.0, false, false, &w);
    cprox_edge_query q = edge_world_asks(&w, false, 0.0);
    q.first = true;
    cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
    double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
    edge_robot_draw(&r, &w.b, 1.0, from, to);
    uint8_t verdict;
    cprox_edge_result result;
    assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
    if (verdict == CPROX_VERDICT_CLEAR) assert_true(result.t_free == 1.0);
    for (int k = 0; k <= 256 && verdict == CPROX_VERDICT_VIOLATED; k++)
      if ((double)k / 256.0 < result.t_free)
        assert_true(edge_world_distance(&w, from, to, (double)k / 256.0, false) >= -1e-9);
    if (verdict == CPROX_VERDICT_VIOLATED) hits++, assert_true(result.t_free <= result.t);
    cprox_edge_checker_free(c);
    edge_world_free(&w);
  }
  if (test_cases(200) >= 100) assert_true(hits > test_cases(200) / 10);
}

/* Edges that lanes decide allocate nothing once the workspace has grown. */
CASE(edges_allocate_nothing) {
  rng r = rng_seed(410);
  edge_world w;
  edge_world_make(&r, 1.0, false, false, &w);
  const cprox_edge_query q = edge_world_asks(&w, true, 0.0);
  cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
  double from[TEST_MAX_VARIABLES + 1], to[TEST_MAX_VARIABLES + 1];
  uint8_t verdict;
  cprox_edge_result result;
  size_t by_lanes = 0;
  for (size_t i = 0; i < 100; i++) {
    edge_robot_draw(&r, &w.b, 1.0, from, to);
    const size_t before = allocations_made();
    assert_true(cprox_robot_edges(c, from, to, 1, ws, &verdict, &result) >= 0);
    if (i == 0 || result.level == CPROX_EDGE_SEARCH) continue;
    assert_true(allocations_made() == before);
    by_lanes++;
  }
  assert_true(by_lanes > 50);
  cprox_edge_checker_free(c);
  edge_world_free(&w);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
