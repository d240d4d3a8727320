/* SPDX-License-Identifier: BSD-3-Clause */
/* What a batch refuses, and what it allocates. */
#include <curve_proximity/cprox.h>
#include <math.h>
#include <string.h>

#include "support/batch_scene.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"

CASE(a_mover_that_is_unusable_fails_alone) {
  rng r = rng_seed(16);
  cprox_workspace *workspace = cprox_workspace_create();
  batch_scene s = {0};
  batch_scene_targets(&r, false, workspace, &s);
  batch_scene_movers(&r, false, workspace, &s);
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  cprox_result good[MOVERS], results[MOVERS];
  assert_int_equal(cprox_obstacles_distance_batch(batch, s.movers, 0, MOVERS, NULL, workspace, good), CPROX_OK);
  s.movers[5].radius = NAN;
  s.movers[9].curve = NULL;
  assert_int_equal(cprox_obstacles_distance_batch(batch, s.movers, 0, MOVERS, NULL, workspace, results), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(workspace), "mover 5: radius is nan"));
  for (size_t i = 0; i < MOVERS; i++) {
    const bool bad = i == 5 || i == 9;
    assert_true(bad ? results[i].status == CPROX_INVALID && results[i].lower == 0.0 && results[i].upper == INFINITY
                    : same_answer(&results[i], &good[i]));
  }

  /* only the range is written */
  memset(results, 0x5a, sizeof results);
  cprox_result untouched;
  memset(&untouched, 0x5a, sizeof untouched);
  assert_int_equal(cprox_obstacles_distance_batch(batch, s.movers, 20, 30, NULL, workspace, results), CPROX_OK);
  assert_string_equal(cprox_workspace_error(workspace), "");
  for (size_t i = 0; i < MOVERS; i++) {
    if (i >= 20 && i < 30)
      assert_true(same_answer(&results[i], &good[i]));
    else
      assert_memory_equal(&results[i], &untouched, sizeof untouched);
  }
  cprox_obstacles_free(batch);
  batch_scene_free(&s);
  cprox_workspace_free(workspace);
}

CASE(unusable_calls_are_refused_with_a_message) {
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_result result;
  cprox_obstacles *batch = NULL;
  const cprox_obstacle nothing = {0};
  assert_int_equal(cprox_obstacles_create(&nothing, 1, CPROX_INDEX_BATCH, workspace, &batch), CPROX_INVALID);
  assert_null(batch);
  assert_non_null(strstr(cprox_workspace_error(workspace), "obstacle 0"));
  assert_int_equal(cprox_obstacles_create(NULL, 3, CPROX_INDEX_BATCH, workspace, &batch), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_create(NULL, 0, CPROX_INDEX_BATCH, NULL, &batch), CPROX_INVALID);

  assert_int_equal(cprox_obstacles_create(NULL, 0, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  cprox_curve *curve = NULL;
  const cprox_vec3 points[2] = {{0, 0, 0}, {1, 0, 0}};
  assert_int_equal(curve_from(describe_bezier(points, 2, 0, 1), workspace, &curve), CPROX_OK);
  const cprox_mover mover = cprox_point_along(curve);
  assert_int_equal(cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, 0.1, NULL, workspace, &result), CPROX_OK);
  assert_true(result.lower == INFINITY && result.verdict == CPROX_VERDICT_CLEAR && result.obstacle_index == -1);
  assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 0, 0, NULL, workspace, NULL), CPROX_OK);

  assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 1, 0, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_distance_batch(NULL, &mover, 0, 1, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_distance_batch(batch, NULL, 0, 1, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 0, 1, NULL, workspace, NULL), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 0, 1, NULL, NULL, &result), CPROX_INVALID);
  assert_int_equal(cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, -1, NULL, workspace, &result), CPROX_INVALID);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = NAN;
  assert_int_equal(cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, 0.0, &options, workspace, &result),
                   CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(workspace), "epsilon"));
  cprox_obstacles_free(batch);
  cprox_obstacles_free(NULL);
  cprox_curve_free(curve);
  cprox_workspace_free(workspace);
}

CASE(a_warm_workspace_allocates_nothing_and_no_memory_is_reported) {
  rng r = rng_seed(17);
  cprox_workspace *workspace = cprox_workspace_create();
  batch_scene s = {0};
  batch_scene_targets(&r, true, workspace, &s);
  batch_scene_movers(&r, true, workspace, &s);
  for (size_t k = 0; k < 5; k++) {
    cprox_obstacles *none = NULL;
    allocations_fail_after(k);
    const cprox_status status = cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &none);
    allocations_allow();
    assert_int_equal(status, CPROX_MEMORY);
    assert_null(none);
  }
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  cprox_result results[MOVERS];
  for (int v = 0; v < QUERY_TYPES; v++) batch_ask((query_type)v, batch, &s, 0, MOVERS, workspace, results);
  const size_t before = allocations_made();
  for (int v = 0; v < QUERY_TYPES; v++) batch_ask((query_type)v, batch, &s, 0, MOVERS, workspace, results);
  assert_int_equal(allocations_made(), before);
  cprox_obstacles_free(batch);
  batch_scene_free(&s);
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
