/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/batch_scene.h"

#include <math.h>

#include "support/cases.h"
#include "support/make_curve.h"
#include "support/of_list.h"

enum { POLYGON_SIDES = 9 };

static cprox_body *polygon(rng *r, cprox_workspace *workspace) {
  double vertices[POLYGON_SIDES][2];
  const double radius = rng_uniform(r, 0.1, 0.4);
  for (int i = 0; i < POLYGON_SIDES; i++) {
    vertices[i][0] = radius * cos(6.283185307179586 * i / POLYGON_SIDES);
    vertices[i][1] = radius * sin(6.283185307179586 * i / POLYGON_SIDES);
  }
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polygon((const double(*)[2])vertices, POLYGON_SIDES, workspace, &body), CPROX_OK);
  return body;
}

void batch_scene_targets(rng *r, bool planar, cprox_workspace *workspace, batch_scene *s) {
  for (int i = 0; i < TARGETS; i++) {
    cprox_pose pose = rng_pose(r, 1.0);
    if (planar) {
      s->bodies[i] = polygon(r, workspace);
      pose = (cprox_pose){.position = {rng_uniform(r, -1, 1), rng_uniform(r, -1, 1), 0},
                          .orientation = {cos(i), 0, 0, sin(i)}};
    } else if (i < TEST_N_BOUNDED) {
      shape_make(r, TEST_BOUNDED[i], 0.3, 3.0, &s->shapes[i]);
      s->bodies[i] = s->shapes[i].body;
    } else if (i == TEST_N_BOUNDED) {
      const cprox_pose poses[2] = {rng_pose(r, 0.2), rng_pose(r, 0.2)};
      const cprox_body *parts[2] = {s->bodies[1], s->bodies[2]};
      assert_int_equal(cprox_body_create_compound(parts, poses, 2, workspace, &s->bodies[i]), CPROX_OK);
    } else {
      const cprox_vec3 points[4] = {rng_in_cube(r, 1), rng_in_cube(r, 1), rng_in_cube(r, 1), rng_in_cube(r, 1)};
      assert_int_equal(curve_from(describe_bezier(points, 4, 0, 1), workspace, &s->standing), CPROX_OK);
      s->obstacles[i] = cprox_obstacle_curve(s->standing, 0.02);
      continue;
    }
    s->obstacles[i] = cprox_obstacle_at(s->bodies[i], pose);
    if (i % 3 == 2) s->obstacles[i].margin = 0.03;
  }
  s->n_obstacles = TARGETS;
}

void batch_scene_movers(rng *r, bool planar, cprox_workspace *workspace, batch_scene *s) {
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.1, 0.05, 0.02}, workspace, &s->carried), CPROX_OK);
  for (int i = 0; i < MOVERS; i++) {
    cprox_vec3 points[40];
    double knots[44];
    for (int k = 0; k < 40; k++) {
      points[k] = rng_in_cube(r, 1.2);
      if (planar) points[k].z = 0;
    }
    const double t0 = rng_uniform(r, -2, 0), t1 = t0 + rng_uniform(r, 0.5, 3);
    if (i % 8 == 7) { /* splines of 2 and of 37 pieces */
      const size_t n = i % 16 == 7 ? 5 : 40;
      for (size_t k = 0; k < n + 4; k++) knots[k] = (double)k;
      const double end = (double)n;
      assert_int_equal(curve_from(describe_bspline(points, n, 3, knots, n + 4, 3, end), workspace, &s->curves[i]), 0);
    } else {
      const size_t n = 2 + rng_index(r, 9);
      assert_int_equal(curve_from(describe_bezier(points, n, t0, t1), workspace, &s->curves[i]), CPROX_OK);
    }
    s->movers[i] = i % 4 == 1 ? cprox_tube_along(s->curves[i], 0.05) : cprox_point_along(s->curves[i]);
    if (!planar && i % 16 == 3) s->movers[i] = cprox_body_along(s->carried, s->curves[i]);
  }
}

void batch_scene_free(batch_scene *s) {
  for (int i = TARGETS - 1; i >= 0; i--) cprox_body_free(s->bodies[i]);
  for (int i = 0; i < MOVERS; i++) cprox_curve_free(s->curves[i]);
  cprox_body_free(s->carried);
  cprox_curve_free(s->standing);
}

cprox_status batch_ask(query_type v, const cprox_obstacles *batch, const batch_scene *s, size_t first, size_t last,
                       cprox_workspace *workspace, cprox_result *results) {
  switch (v) {
    case DISTANCE: return cprox_obstacles_distance_batch(batch, s->movers, first, last, NULL, workspace, results);
    case TOLERANCE:
      return cprox_obstacles_tolerance_batch(batch, s->movers, first, last, DELTA, NULL, workspace, results);
    default: return cprox_obstacles_tolerance_batch(batch, s->movers, first, last, 0.0, NULL, workspace, results);
  }
}

void batch_ask_alone(query_type v, const batch_scene *s, size_t i, cprox_workspace *workspace, cprox_result *r) {
  if (v == DISTANCE) distance_of_list(s->movers[i], s->obstacles, s->n_obstacles, NULL, workspace, r, NULL);
  if (v == TOLERANCE) tolerance_of_list(s->movers[i], s->obstacles, s->n_obstacles, DELTA, NULL, workspace, r, NULL);
  if (v == COLLISION) collision_of_list(s->movers[i], s->obstacles, s->n_obstacles, NULL, workspace, r, NULL);
}

bool same_answer(const cprox_result *a, const cprox_result *b) {
  const bool t_obstacle = a->t_obstacle == b->t_obstacle || (isnan(a->t_obstacle) && isnan(b->t_obstacle));
  return a->status == b->status && a->verdict == b->verdict && a->lower == b->lower && a->upper == b->upper &&
         a->t == b->t && t_obstacle && vec_equal(a->witness_mover, b->witness_mover) &&
         vec_equal(a->witness_obstacle, b->witness_obstacle) && vec_equal(a->normal, b->normal) &&
         a->obstacle_index == b->obstacle_index && a->obstacle_part == b->obstacle_part && a->lod == b->lod &&
         a->nodes == b->nodes && a->distance_queries == b->distance_queries;
}
