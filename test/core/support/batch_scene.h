/* SPDX-License-Identifier: BSD-3-Clause */
/* What the tests of batches share: a scene with obstacles and movers of every kind, and the three queries of it. */
#ifndef CPROX_TEST_BATCH_SCENE_H
#define CPROX_TEST_BATCH_SCENE_H

#include <stdbool.h>

#include "curve_proximity/cprox.h"
#include "support/random.h"
#include "support/shapes.h"

enum { MOVERS = 64, TARGETS = 12 };

/* A scene with every kind of obstacle, and movers of every kind. */
typedef struct batch_scene {
  cprox_body *bodies[TARGETS];
  cprox_obstacle obstacles[TARGETS];
  size_t n_obstacles;
  cprox_curve *curves[MOVERS];
  cprox_mover movers[MOVERS];
  cprox_body *carried, *ball;
  cprox_curve *standing;
  test_shape shapes[TARGETS];
} batch_scene;

/* planar: polygons in z = 0 and curves in it; else one of each convex kind, a compound, a curve. */
void batch_scene_targets(rng *r, bool planar, cprox_workspace *workspace, batch_scene *s);
void batch_scene_movers(rng *r, bool planar, cprox_workspace *workspace, batch_scene *s);
void batch_scene_free(batch_scene *s);

typedef enum query_type { DISTANCE, TOLERANCE, COLLISION, QUERY_TYPES } query_type;
static const double DELTA = 0.1;

/* A query of the movers first … last - 1 by the batch. */
cprox_status batch_ask(query_type v, const cprox_obstacles *batch, const batch_scene *s, size_t first, size_t last,
                       cprox_workspace *workspace, cprox_result *results);

/* The same query of mover i without a batch. */
void batch_ask_alone(query_type v, const batch_scene *s, size_t i, cprox_workspace *workspace, cprox_result *r);

/* Whether two answers are equal in every member. */
bool same_answer(const cprox_result *a, const cprox_result *b);

#endif
