/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches against the queries of one mover and against dense sampling. */
#include <curve_proximity/cprox.h>
#include <math.h>

#include "shape/body.h"
#include "support/batch_scene.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/reference.h"

/* The least distance over many parameters, by the plain nearest-point function of bodies: an upper bound on the truth.
 */
static double sampled_distance(const batch_scene *s, size_t i) {
  enum { STEPS = 200 };
  double least = INFINITY, t0, t1;
  t0 = cprox_curve_get_info(s->curves[i]).t0, t1 = cprox_curve_get_info(s->curves[i]).t1;
  for (int k = 0; k <= STEPS; k++) {
    cprox_vec3 at;
    cprox_curve_evaluate(s->curves[i], t0 + (t1 - t0) * k / STEPS, NULL, &at, NULL, NULL);
    for (size_t j = 0; j < s->n_obstacles; j++) {
      const cprox_obstacle *obstacle = &s->obstacles[j];
      if (!obstacle->body) continue;
      const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
      double error = 0.0;
      const double d = cprox_body_nearest(obstacle->body, frame_to_local(&f, at, &error), NULL);
      least = fmin(least, d - obstacle->margin - s->movers[i].radius);
    }
  }
  return fmax(least, 0.0);
}

/* Seed 11, 20 scenes of 64 movers; the two answers are of one truth, so their intervals share a point. A verdict that
 * one gives and the other does not, though both are within their epsilon, is counted: none is met at this seed. */
CASE(answers_agree_with_those_of_one_mover) {
  rng r = rng_seed(11);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t settled_by_balls = 0, answers = 0;
  for (size_t round = 0; round < test_cases(20); round++) {
    batch_scene s = {0};
    const bool planar = round % 2;
    batch_scene_targets(&r, planar, workspace, &s);
    batch_scene_movers(&r, planar, workspace, &s);
    if (round % 4 >= 2) s.n_obstacles = 1 + rng_index(&r, TARGETS - 2); /* sparse: more verdicts are "clear" */
    cprox_obstacles *batch = NULL;
    assert_int_equal(cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &batch),
                     CPROX_OK);
    for (int v = 0; v < QUERY_TYPES; v++) {
      cprox_result results[MOVERS];
      assert_int_equal(batch_ask((query_type)v, batch, &s, 0, MOVERS, workspace, results), CPROX_OK);
      for (size_t i = 0; i < MOVERS; i++) {
        const cprox_result *one = &results[i];
        cprox_result alone;
        batch_ask_alone((query_type)v, &s, i, workspace, &alone);
        assert_int_equal(one->status, CPROX_OK);
        assert_int_equal(one->verdict, alone.verdict);
        assert_true(one->lower <= alone.upper && alone.lower <= one->upper && one->lower <= one->upper);
        if (v == DISTANCE) assert_true(one->upper - one->lower <= 1e-6);
        settled_by_balls += one->distance_queries == 0 && one->upper == 0.0;
        answers++;
        if (s.movers[i].body || s.n_obstacles == TARGETS) continue;
        /* plain evaluation is within 1e-12 at this scale */
        const double sampled = sampled_distance(&s, i);
        assert_true(one->lower <= sampled + 1e-12);
        if (v == TOLERANCE && one->verdict == CPROX_VERDICT_CLEAR) assert_true(sampled > DELTA - 1e-12);
        if (v == COLLISION && one->verdict == CPROX_VERDICT_CLEAR) assert_true(sampled > 0.0);
      }
    }
    cprox_obstacles_free(batch);
    batch_scene_free(&s);
  }
  /* both ways of answering are exercised */
  assert_true(settled_by_balls > answers / 20 && settled_by_balls < answers / 2);
  cprox_workspace_free(workspace);
}

/* A witness is where it says: the mover's surface point is within its radius of the curve's point, and both points are
 * `upper` apart or one. Seed 12; 1e-9 is the plain evaluation's own rounding, amply. */
CASE(witnesses_lie_where_they_say) {
  rng r = rng_seed(12);
  cprox_workspace *workspace = cprox_workspace_create();
  batch_scene s = {0};
  batch_scene_targets(&r, false, workspace, &s);
  batch_scene_movers(&r, false, workspace, &s);
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  for (int v = 0; v < QUERY_TYPES; v++) {
    cprox_result results[MOVERS];
    batch_ask((query_type)v, batch, &s, 0, MOVERS, workspace, results);
    for (size_t i = 0; i < MOVERS; i++) {
      const cprox_result *one = &results[i];
      if (one->obstacle_index < 0 || s.movers[i].body) continue;
      cprox_vec3 at;
      cprox_curve_evaluate(s.curves[i], one->t, NULL, &at, NULL, NULL);
      assert_true(vec_norm(vec_sub(at, one->witness_mover)) <= s.movers[i].radius + 1e-9);
      assert_true(fabs(vec_norm(vec_sub(one->witness_mover, one->witness_obstacle)) - one->upper) <= 1e-9);
      const cprox_obstacle *obstacle = &s.obstacles[one->obstacle_index];
      if (!obstacle->body) continue;
      const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
      double error = 0.0;
      const vec3 local = frame_to_local(&f, one->witness_obstacle, &error);
      assert_true(cprox_body_nearest(obstacle->body, local, NULL) <= obstacle->margin + 1e-9);
    }
  }
  cprox_obstacles_free(batch);
  batch_scene_free(&s);
  cprox_workspace_free(workspace);
}

/* A polygon of width 1 in the plane z = 0: curves 0.05 above it, across it, and in it. */
CASE(a_disc_tells_nothing_of_curves_off_its_plane) {
  cprox_workspace *workspace = cprox_workspace_create();
  const double square[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polygon(square, 4, workspace, &body), CPROX_OK);
  const cprox_obstacle obstacle = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(&obstacle, 1, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  const cprox_vec3 points[3][3] = {{{-1, 0, 0.05}, {0, 0.1, 0.05}, {1, 0, 0.05}},
                                   {{-0.2, 0, 0.05}, {0, 0.1, 0.1}, {0.2, 0, 0.1}},
                                   {{-1, 0, 0}, {0, 0.1, 0}, {1, 0, 0}}};
  const double distance[3] = {0.05, 0.05, 0.0};
  for (int i = 0; i < 3; i++) {
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(points[i], 3, 0, 1), workspace, &curve), CPROX_OK);
    const cprox_mover mover = cprox_point_along(curve);
    cprox_result r;
    assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 0, 1, NULL, workspace, &r), CPROX_OK);
    assert_true(r.lower <= distance[i] && distance[i] <= r.upper && r.upper - r.lower <= 1e-6);
    assert_int_equal(cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, 0.0, NULL, workspace, &r), CPROX_OK);
    assert_int_equal(r.verdict, i == 2 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
    cprox_curve_free(curve);
  }
  cprox_obstacles_free(batch);
  cprox_body_free(body);
  cprox_workspace_free(workspace);
}

/* Seed 18, 4000 balls, each part of a compound, 1e6 m from the compound's origin, which stands as far off the other
 * way: where the ball stands depends on the rounding of both, 1e-10 m. Limits are nearly as near to the truth as that.
 * The reference's own error is 1e-12. */
CASE(parts_far_from_their_compound_stay_where_the_interval_is) {
  rng r = rng_seed(18);
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(1.0, workspace, &ball), CPROX_OK);
  size_t settled_by_points = 0;
  for (size_t i = 0; i < test_cases(4000); i++) {
    const cprox_pose inner = rng_pose(&r, 1e6);
    cprox_pose outer = {.position = {0, 0, 0}, .orientation = rng_quat(&r)};
    const vec3l turned = ref_to_world(&outer, ref_vec(inner.position));
    outer.position = vec_add(vec(-(double)turned.x, -(double)turned.y, -(double)turned.z), rng_in_cube(&r, 1.0));
    const vec3l centre = ref_to_world(&outer, ref_vec(inner.position));
    const cprox_body *part = ball;
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_compound(&part, &inner, 1, workspace, &body), CPROX_OK);
    const cprox_obstacle obstacle = cprox_obstacle_at(body, outer);
    cprox_obstacles *batch = NULL;
    assert_int_equal(cprox_obstacles_create(&obstacle, 1, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);

    /* a segment that begins where it is nearest */
    const vec3 out = rng_unit(&r), at = vec((double)centre.x, (double)centre.y, (double)centre.z);
    const vec3 near = vec_axpy(at, rng_uniform(&r, 1.1, 2.0), out), ends[2] = {near, vec_axpy(near, 1.0, out)};
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(ends, 2, 0, 1), workspace, &curve), CPROX_OK);
    const long double truth = ref_point_segment(centre, ref_vec(ends[0]), ref_vec(ends[1])) - 1.0L;
    const cprox_mover mover = cprox_point_along(curve);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 0.0;
    cprox_result answers[2];
    const double delta = (double)truth + rng_uniform(&r, -1e-8, 1e-8);
    cprox_obstacles_distance_batch(batch, &mover, 0, 1, &options, workspace, &answers[0]);
    cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, delta, &options, workspace, &answers[1]);
    for (int k = 0; k < 2; k++) {
      assert_true((long double)answers[k].lower <= truth + 1e-12L);
      assert_true(truth - 1e-12L <= (long double)answers[k].upper);
    }
    settled_by_points += answers[1].distance_queries == 0 && answers[1].verdict == CPROX_VERDICT_VIOLATED;
    cprox_curve_free(curve);
    cprox_obstacles_free(batch);
    cprox_body_free(body);
  }
  assert_true(settled_by_points > 0);
  cprox_body_free(ball);
  cprox_workspace_free(workspace);
}

/* A large ball, deep in the box of a triangle and off the triangle. */
CASE(a_box_about_a_shape_is_not_the_shape) {
  static const double corners[3][2] = {{0, 0}, {10, 0}, {0, 10}};
  static const vec3 points[3] = {{9, 10.5, 0.5}, {10, 9.5, 1}, {10.5, 9, 0.5}};
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *body = NULL;
  cprox_curve *curve = NULL;
  assert_int_equal(cprox_body_create_polygon(corners, 3, workspace, &body), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(points, 3, 0, 1), workspace, &curve), CPROX_OK);
  const cprox_obstacle obstacle = cprox_obstacle_at(body, (cprox_pose){{0, 0, 0}, {1, 0, 0, 0}});
  const cprox_mover mover = cprox_tube_along(curve, 3.0);
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(&obstacle, 1, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  cprox_result one, alone;
  assert_int_equal(cprox_obstacles_distance_batch(batch, &mover, 0, 1, NULL, workspace, &one), CPROX_OK);
  assert_int_equal(cprox_distance(mover, obstacle, NULL, workspace, &alone), CPROX_OK);
  assert_true(alone.lower > 3.0 && one.lower <= alone.upper && alone.lower <= one.upper);
  assert_int_equal(cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, 0.0, NULL, workspace, &one), CPROX_OK);
  assert_int_equal(one.verdict, CPROX_VERDICT_CLEAR);
  cprox_obstacles_free(batch);
  cprox_curve_free(curve);
  cprox_body_free(body);
  cprox_workspace_free(workspace);
}

/* Seed 22: 300 quintics, some of them tubes, through 80 small boxes: the verdicts of the queries of one mover, in
 * intervals that share a point with theirs; what is called a hit has a point of the tube within a box, or within the
 * limit of it. Bricks leave next to no verdict and next to no contact to search. */
CASE(small_boxes_are_met_or_passed_without_a_search) {
  enum { CURVES = 300, BOXES = 80 };
  rng r = rng_seed(22);
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *bodies[BOXES];
  cprox_obstacle obstacles[BOXES];
  for (size_t k = 0; k < BOXES; k++) {
    const vec3 edges = vec(rng_uniform(&r, .01, .06), rng_uniform(&r, .01, .06), rng_uniform(&r, .01, .06));
    assert_int_equal(cprox_body_create_box(edges, workspace, &bodies[k]), CPROX_OK);
    obstacles[k] = cprox_obstacle_at(bodies[k], rng_pose(&r, 0.5));
    if (k % 4 == 0) obstacles[k].margin = 0.004;
  }
  cprox_obstacles *batch = NULL;
  assert_int_equal(cprox_obstacles_create(obstacles, BOXES, CPROX_INDEX_BATCH, workspace, &batch), CPROX_OK);
  size_t searched = 0, hits = 0;
  for (size_t i = 0; i < CURVES; i++) {
    const vec3 p[6] = {vec(-0.7, 0, 0),      vec(-0.5, 0, 0), rng_in_cube(&r, 0.5),
                       rng_in_cube(&r, 0.5), vec(0.5, 0, 0),  vec(0.7, 0, 0)};
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_bezier(p, 6, 0, 1), workspace, &curve), CPROX_OK);
    const cprox_mover mover = cprox_tube_along(curve, i % 3 ? 0.005 : 0.0);
    for (int v = DISTANCE; v < QUERY_TYPES; v++) {
      const double delta = v == TOLERANCE ? 0.01 : 0.0;
      cprox_result one, alone;
      if (v == DISTANCE) {
        cprox_obstacles_distance_batch(batch, &mover, 0, 1, NULL, workspace, &one);
        distance_of_list(mover, obstacles, BOXES, NULL, workspace, &alone, NULL);
        assert_true(one.upper - one.lower <= 1e-6);
      } else if (v == TOLERANCE) {
        cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, delta, NULL, workspace, &one);
        tolerance_of_list(mover, obstacles, BOXES, delta, NULL, workspace, &alone, NULL);
      } else {
        cprox_obstacles_tolerance_batch(batch, &mover, 0, 1, 0.0, NULL, workspace, &one);
        collision_of_list(mover, obstacles, BOXES, NULL, workspace, &alone, NULL);
      }
      assert_int_equal(one.verdict, alone.verdict);
      assert_true(one.lower <= alone.upper && alone.lower <= one.upper && one.lower <= one.upper);
      searched += one.nodes > 0 && (v != DISTANCE || one.upper == 0.0);
      if (v == DISTANCE ? one.upper > 0.0 : one.verdict != CPROX_VERDICT_VIOLATED) continue;
      hits++;
      cprox_vec3 at;
      cprox_curve_evaluate(curve, one.t, NULL, &at, NULL, NULL);
      const cprox_obstacle *obstacle = &obstacles[one.obstacle_index];
      const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
      double error = 0.0;
      const double d = cprox_body_nearest(obstacle->body, frame_to_local(&f, at, &error), NULL);
      assert_true(d - obstacle->margin - mover.radius <= one.upper + 1e-12 && one.upper <= delta);
      const double surface = cprox_body_nearest(obstacle->body, frame_to_local(&f, one.witness_obstacle, &error), NULL);
      assert_true(surface <= obstacle->margin + 1e-12);
      assert_true(vec_norm(vec_sub(one.witness_mover, at)) <= mover.radius + 1e-12);
      assert_true(fabs(vec_norm(vec_sub(one.witness_mover, one.witness_obstacle)) - one.upper) <= 1e-12);
    }
    cprox_curve_free(curve);
  }
  assert_true(hits > CURVES / 2 && hits < 2 * CURVES);
  assert_true(searched <= 3 * CURVES / 50);
  cprox_obstacles_free(batch);
  for (size_t k = 0; k < BOXES; k++) cprox_body_free(bodies[k]);
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
