/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves and bodies are shared by threads, workspaces are not. Also run under ThreadSanitizer, which sees a race even
 * where it changes no answer. */
#include <curve_proximity/cprox.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#include "support/cases.h"
#include "support/make_curve.h"
#include "support/of_list.h"

enum { THREADS = 4, ROUNDS = 50, TARGETS = 6, ANSWERS = 3 };

typedef struct {
  const cprox_curve *curve;
  cprox_obstacle targets[TARGETS];
} shared_world;

typedef struct {
  const shared_world *world;
  cprox_result results[ANSWERS];
  bool steady; /* every round gave the answers of the first */
} client;

/* Answers that were given are compared field by field: a struct's margin means nothing. */
static bool same(const cprox_result *a, const cprox_result *b) {
  return a->status == b->status && a->verdict == b->verdict && a->lower == b->lower && a->upper == b->upper &&
         a->t == b->t && a->obstacle_index == b->obstacle_index && a->nodes == b->nodes &&
         a->distance_queries == b->distance_queries;
}

static void ask(const shared_world *world, cprox_workspace *workspace, cprox_result *results) {
  const cprox_mover tube = cprox_tube_along(world->curve, 0.01);
  memset(results, 0, ANSWERS * sizeof *results);
  distance_of_list(tube, world->targets, TARGETS, NULL, workspace, &results[0], NULL);
  tolerance_of_list(tube, world->targets, TARGETS, 0.05, NULL, workspace, &results[1], NULL);
  collision_of_list(tube, world->targets, TARGETS, NULL, workspace, &results[2], NULL);
}

static void *run(void *argument) {
  client *self = argument;
  cprox_workspace *workspace = cprox_workspace_create();
  ask(self->world, workspace, self->results);
  self->steady = true;
  for (int round = 1; round < ROUNDS; ++round) {
    cprox_result again[ANSWERS];
    ask(self->world, workspace, again);
    for (int i = 0; i < ANSWERS; ++i) self->steady = self->steady && same(&again[i], &self->results[i]);
  }
  cprox_workspace_free(workspace);
  return NULL;
}

CASE(threads_that_share_bodies_and_curves_get_the_answers_of_one_thread) {
  cprox_workspace *workspace = cprox_workspace_create();

  /* A B-spline that weaves through a body of each of six kinds. */
  cprox_vec3 points[24];
  double knots[24 + 4];
  for (int i = 0; i < 24; ++i) points[i] = (cprox_vec3){0.2 * i, 0.6 * sin(0.9 * i), 0.4 * cos(0.7 * i)};
  for (int i = 0; i < 28; ++i) knots[i] = (double)i;
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(points, 24, 3, knots, 28, 3.0, 24.0), workspace, &curve), CPROX_OK);
  const cprox_vec3 corners[5] = {
      {0.0, 0.0, 0.3}, {0.2, 0.0, 0.0}, {0.0, 0.2, 0.0}, {-0.2, -0.1, 0.0}, {0.1, -0.2, 0.1}};
  cprox_body *bodies[TARGETS] = {0};
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.3, 0.2, 0.1}, workspace, &bodies[0]), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, workspace, &bodies[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_cylinder(0.3, 0.1, workspace, &bodies[2]), CPROX_OK);
  assert_int_equal(cprox_body_create_cone(0.3, 0.1, workspace, &bodies[3]), CPROX_OK);
  assert_int_equal(cprox_body_create_ellipsoid((cprox_vec3){0.2, 0.1, 0.05}, workspace, &bodies[4]), CPROX_OK);
  assert_int_equal(cprox_body_create_polytope(corners, 5, workspace, &bodies[5]), CPROX_OK);
  shared_world world = {.curve = curve};
  for (int i = 0; i < TARGETS; ++i) {
    cprox_pose pose = CPROX_POSE_IDENTITY;
    pose.position = (cprox_vec3){0.5 + 0.6 * i, 0.8, 0.7};
    world.targets[i] = cprox_obstacle_at(bodies[i], pose);
  }

  /* What one thread answers, and what several answer at once. */
  cprox_result alone[ANSWERS];
  ask(&world, workspace, alone);
  assert_true(alone[0].status == CPROX_OK && alone[0].obstacle_index >= 0);
  pthread_t threads[THREADS];
  client clients[THREADS];
  for (int i = 0; i < THREADS; ++i) {
    clients[i] = (client){.world = &world};
    assert_int_equal(pthread_create(&threads[i], NULL, run, &clients[i]), 0);
  }
  for (int i = 0; i < THREADS; ++i) {
    assert_int_equal(pthread_join(threads[i], NULL), 0);
    assert_true(clients[i].steady);
    for (int k = 0; k < ANSWERS; ++k) assert_true(same(&clients[i].results[k], &alone[k]));
  }

  for (int i = 0; i < TARGETS; ++i) cprox_body_free(bodies[i]);
  cprox_curve_free(curve);
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
