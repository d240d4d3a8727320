/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches against the queries of one mover, against dense sampling, and against themselves in other splits and threads. */
#include <curve_proximity/cprox.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#include "batch/obstacles.h"
#include "problem/placed_pair.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/curves.h"
#include "support/reference.h"
#include "support/shapes.h"

enum { MOVERS = 64, TARGETS = 12, POLYGON_SIDES = 9 };

/* A scene with every kind of target, and movers of every kind. */
typedef struct scene {
  cprox_body *bodies[TARGETS];
  cprox_obstacle targets[TARGETS];
  size_t n_targets;
  cprox_curve *curves[MOVERS];
  cprox_mover movers[MOVERS];
  cprox_body *carried, *ball;
  cprox_curve *standing;
  test_shape shapes[TARGETS];
} scene;

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

/* planar: polygons in z = 0 and curves in it; else one of each convex kind, a compound, a curve. */
static void scene_targets(rng *r, bool planar, cprox_workspace *workspace, scene *s) {
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
      assert_int_equal(cprox_curve_create_bezier(points, 4, 0, 1, workspace, &s->standing), CPROX_OK);
      s->targets[i] = cprox_obstacle_curve(s->standing, 0.02);
      continue;
    }
    s->targets[i] = cprox_obstacle_at(s->bodies[i], pose);
    if (i % 3 == 2) s->targets[i].margin = 0.03;
  }
  s->n_targets = TARGETS;
}

static void scene_movers(rng *r, bool planar, cprox_workspace *workspace, scene *s) {
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
      assert_int_equal(cprox_curve_create_bspline(points, n, 3, knots, n + 4, 3, end, workspace, &s->curves[i]), 0);
    } else {
      const size_t n = 2 + rng_index(r, 9);
      assert_int_equal(cprox_curve_create_bezier(points, n, t0, t1, workspace, &s->curves[i]), CPROX_OK);
    }
    s->movers[i] = i % 4 == 1 ? cprox_tube_along(s->curves[i], 0.05) : cprox_point_along(s->curves[i]);
    if (!planar && i % 16 == 3) s->movers[i] = cprox_body_along(s->carried, s->curves[i]);
  }
}

static void scene_free(scene *s) {
  for (int i = TARGETS - 1; i >= 0; i--) cprox_body_free(s->bodies[i]);
  for (int i = 0; i < MOVERS; i++) cprox_curve_free(s->curves[i]);
  cprox_body_free(s->carried);
  cprox_curve_free(s->standing);
}

typedef enum query_type { DISTANCE, TOLERANCE, COLLISION, QUERY_TYPES } query_type;
static const double DELTA = 0.1;

static cprox_status ask_range(query_type v, const cprox_batch *batch, const scene *s, size_t first, size_t last,
                              cprox_workspace *workspace, cprox_result *results) {
  switch (v) {
    case DISTANCE: return cprox_batch_distance(batch, s->movers, first, last, NULL, workspace, results);
    case TOLERANCE: return cprox_batch_tolerance(batch, s->movers, first, last, DELTA, NULL, workspace, results);
    default: return cprox_batch_collision(batch, s->movers, first, last, NULL, workspace, results);
  }
}

static void ask_alone(query_type v, const scene *s, size_t i, cprox_workspace *workspace, cprox_result *r) {
  if (v == DISTANCE) cprox_distance_all(s->movers[i], s->targets, s->n_targets, NULL, workspace, r, NULL);
  if (v == TOLERANCE) cprox_tolerance_all(s->movers[i], s->targets, s->n_targets, DELTA, NULL, workspace, r, NULL);
  if (v == COLLISION) cprox_collision_all(s->movers[i], s->targets, s->n_targets, NULL, workspace, r, NULL);
}

static bool same(const cprox_result *a, const cprox_result *b) {
  const bool t_obstacle = a->t_obstacle == b->t_obstacle || (isnan(a->t_obstacle) && isnan(b->t_obstacle));
  return a->status == b->status && a->verdict == b->verdict && a->lower == b->lower && a->upper == b->upper &&
         a->t == b->t && t_obstacle && vec_equal(a->witness_mover, b->witness_mover) &&
         vec_equal(a->witness_obstacle, b->witness_obstacle) && vec_equal(a->normal, b->normal) &&
         a->obstacle_index == b->obstacle_index && a->obstacle_part == b->obstacle_part && a->lod == b->lod &&
         a->nodes == b->nodes && a->distance_queries == b->distance_queries;
}

/* The least distance over many parameters, by the plain nearest-point function of bodies: an upper bound on the truth. */
static double sampled_distance(const scene *s, size_t i) {
  enum { STEPS = 200 };
  double least = INFINITY, t0, t1;
  cprox_curve_domain(s->curves[i], &t0, &t1);
  for (int k = 0; k <= STEPS; k++) {
    cprox_vec3 at;
    cprox_curve_evaluate(s->curves[i], t0 + (t1 - t0) * k / STEPS, NULL, &at, NULL, NULL);
    for (size_t j = 0; j < s->n_targets; j++) {
      const cprox_obstacle *target = &s->targets[j];
      if (!target->body) continue;
      const frame f = frame_create(&target->pose, vec(0, 0, 0));
      double error = 0.0;
      const double d = cprox_body_nearest(target->body, frame_to_local(&f, at, &error), NULL);
      least = fmin(least, d - target->margin - s->movers[i].radius);
    }
  }
  return fmax(least, 0.0);
}

/* Seed 11, 20 scenes of 64 movers; the two answers are of one truth, so their intervals share a point. A verdict that one gives and
 * the other does not, though both are within their epsilon, is counted: none is met at this seed. */
CASE(answers_agree_with_those_of_one_mover) {
  rng r = rng_seed(11);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t settled_by_balls = 0, answers = 0;
  for (size_t round = 0; round < test_cases(20); round++) {
    scene s = {0};
    const bool planar = round % 2;
    scene_targets(&r, planar, workspace, &s);
    scene_movers(&r, planar, workspace, &s);
    if (round % 4 >= 2) s.n_targets = 1 + rng_index(&r, TARGETS - 2); /* sparse: more verdicts are "clear" */
    cprox_batch *batch = NULL;
    assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
    for (int v = 0; v < QUERY_TYPES; v++) {
      cprox_result results[MOVERS];
      assert_int_equal(ask_range((query_type)v, batch, &s, 0, MOVERS, workspace, results), CPROX_OK);
      for (size_t i = 0; i < MOVERS; i++) {
        const cprox_result *one = &results[i];
        cprox_result alone;
        ask_alone((query_type)v, &s, i, workspace, &alone);
        assert_int_equal(one->status, CPROX_OK);
        assert_int_equal(one->verdict, alone.verdict);
        assert_true(one->lower <= alone.upper && alone.lower <= one->upper && one->lower <= one->upper);
        if (v == DISTANCE) assert_true(one->upper - one->lower <= 1e-6);
        settled_by_balls += one->distance_queries == 0 && one->upper == 0.0;
        answers++;
        if (s.movers[i].body || s.n_targets == TARGETS) continue;
        /* plain evaluation is within 1e-12 at this scale */
        const double sampled = sampled_distance(&s, i);
        assert_true(one->lower <= sampled + 1e-12);
        if (v == TOLERANCE && one->verdict == CPROX_VERDICT_CLEAR) assert_true(sampled > DELTA - 1e-12);
        if (v == COLLISION && one->verdict == CPROX_VERDICT_CLEAR) assert_true(sampled > 0.0);
      }
    }
    cprox_batch_free(batch);
    scene_free(&s);
  }
  /* both ways of answering are exercised */
  assert_true(settled_by_balls > answers / 20 && settled_by_balls < answers / 2);
  cprox_workspace_free(workspace);
}

/* A witness is where it says: the mover's surface point is within its radius of the curve's point, and both points are `upper` apart
 * or one. Seed 12; 1e-9 is the plain evaluation's own rounding, amply. */
CASE(witnesses_lie_where_they_say) {
  rng r = rng_seed(12);
  cprox_workspace *workspace = cprox_workspace_create();
  scene s = {0};
  scene_targets(&r, false, workspace, &s);
  scene_movers(&r, false, workspace, &s);
  cprox_batch *batch = NULL;
  assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
  for (int v = 0; v < QUERY_TYPES; v++) {
    cprox_result results[MOVERS];
    ask_range((query_type)v, batch, &s, 0, MOVERS, workspace, results);
    for (size_t i = 0; i < MOVERS; i++) {
      const cprox_result *one = &results[i];
      if (one->obstacle_index < 0 || s.movers[i].body) continue;
      cprox_vec3 at;
      cprox_curve_evaluate(s.curves[i], one->t, NULL, &at, NULL, NULL);
      assert_true(vec_norm(vec_sub(at, one->witness_mover)) <= s.movers[i].radius + 1e-9);
      assert_true(fabs(vec_norm(vec_sub(one->witness_mover, one->witness_obstacle)) - one->upper) <= 1e-9);
      const cprox_obstacle *target = &s.targets[one->obstacle_index];
      if (!target->body) continue;
      const frame f = frame_create(&target->pose, vec(0, 0, 0));
      double error = 0.0;
      const vec3 local = frame_to_local(&f, one->witness_obstacle, &error);
      assert_true(cprox_body_nearest(target->body, local, NULL) <= target->margin + 1e-9);
    }
  }
  cprox_batch_free(batch);
  scene_free(&s);
  cprox_workspace_free(workspace);
}

/* A polygon of width 1 in the plane z = 0: curves 0.05 above it, across it, and in it. */
CASE(a_disc_tells_nothing_of_curves_off_its_plane) {
  cprox_workspace *workspace = cprox_workspace_create();
  const double square[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polygon(square, 4, workspace, &body), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(body, cprox_pose_identity());
  cprox_batch *batch = NULL;
  assert_int_equal(cprox_batch_create(&target, 1, workspace, &batch), CPROX_OK);
  const cprox_vec3 points[3][3] = {{{-1, 0, 0.05}, {0, 0.1, 0.05}, {1, 0, 0.05}},
                                   {{-0.2, 0, 0.05}, {0, 0.1, 0.1}, {0.2, 0, 0.1}},
                                   {{-1, 0, 0}, {0, 0.1, 0}, {1, 0, 0}}};
  const double distance[3] = {0.05, 0.05, 0.0};
  for (int i = 0; i < 3; i++) {
    cprox_curve *curve = NULL;
    assert_int_equal(cprox_curve_create_bezier(points[i], 3, 0, 1, workspace, &curve), CPROX_OK);
    const cprox_mover mover = cprox_point_along(curve);
    cprox_result r;
    assert_int_equal(cprox_batch_distance(batch, &mover, 0, 1, NULL, workspace, &r), CPROX_OK);
    assert_true(r.lower <= distance[i] && distance[i] <= r.upper && r.upper - r.lower <= 1e-6);
    assert_int_equal(cprox_batch_collision(batch, &mover, 0, 1, NULL, workspace, &r), CPROX_OK);
    assert_int_equal(r.verdict, i == 2 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
    cprox_curve_free(curve);
  }
  cprox_batch_free(batch);
  cprox_body_free(body);
  cprox_workspace_free(workspace);
}

/* Seed 18, 4000 balls, each part of a compound, 1e6 m from the compound's origin, which stands as far off the other way: where the ball
 * stands depends on the rounding of both, 1e-10 m. Limits are nearly as near to the truth as that. The reference's own error is 1e-12. */
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
    const cprox_obstacle target = cprox_obstacle_at(body, outer);
    cprox_batch *batch = NULL;
    assert_int_equal(cprox_batch_create(&target, 1, workspace, &batch), CPROX_OK);

    /* a segment that begins where it is nearest */
    const vec3 out = rng_unit(&r), at = vec((double)centre.x, (double)centre.y, (double)centre.z);
    const vec3 near = vec_axpy(at, rng_uniform(&r, 1.1, 2.0), out), ends[2] = {near, vec_axpy(near, 1.0, out)};
    cprox_curve *curve = NULL;
    assert_int_equal(cprox_curve_create_bezier(ends, 2, 0, 1, workspace, &curve), CPROX_OK);
    const long double truth = ref_point_segment(centre, ref_vec(ends[0]), ref_vec(ends[1])) - 1.0L;
    const cprox_mover mover = cprox_point_along(curve);
    cprox_options options = cprox_options_default();
    options.epsilon = 0.0;
    cprox_result answers[2];
    const double delta = (double)truth + rng_uniform(&r, -1e-8, 1e-8);
    cprox_batch_distance(batch, &mover, 0, 1, &options, workspace, &answers[0]);
    cprox_batch_tolerance(batch, &mover, 0, 1, delta, &options, workspace, &answers[1]);
    for (int k = 0; k < 2; k++) {
      assert_true((long double)answers[k].lower <= truth + 1e-12L);
      assert_true(truth - 1e-12L <= (long double)answers[k].upper);
    }
    settled_by_points += answers[1].distance_queries == 0 && answers[1].verdict == CPROX_VERDICT_VIOLATED;
    cprox_curve_free(curve);
    cprox_batch_free(batch);
    cprox_body_free(body);
  }
  assert_true(settled_by_points > 0);
  cprox_body_free(ball);
  cprox_workspace_free(workspace);
}

/* ---- splits and threads ------------------------------------------------------------------------------------------------- */

typedef struct worker {
  const cprox_batch *batch;
  const scene *scene;
  query_type query_type;
  size_t first, last;
  cprox_result *results;
} worker;

static void *work(void *argument) {
  const worker *w = argument;
  cprox_workspace *workspace = cprox_workspace_create();
  ask_range(w->query_type, w->batch, w->scene, w->first, w->last, workspace, w->results);
  cprox_workspace_free(workspace);
  return NULL;
}

/* Seed 13: 1 to 8 threads on ranges of random lengths, each with a workspace of its own, write into one array. */
CASE(results_are_the_same_for_every_split_and_number_of_threads) {
  rng r = rng_seed(13);
  cprox_workspace *workspace = cprox_workspace_create();
  for (int planar = 0; planar < 2; planar++) {
    scene s = {0};
    scene_targets(&r, planar, workspace, &s);
    scene_movers(&r, planar, workspace, &s);
    cprox_batch *batch = NULL;
    assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
    for (int v = 0; v < QUERY_TYPES; v++) {
      cprox_result whole[MOVERS], split[MOVERS];
      ask_range((query_type)v, batch, &s, 0, MOVERS, workspace, whole);
      for (size_t threads = 1; threads <= 8; threads++) {
        memset(split, 0, sizeof split);
        pthread_t thread[8];
        worker workers[8];
        size_t from = 0;
        for (size_t k = 0; k < threads; k++) {
          const size_t to = k + 1 == threads ? MOVERS : from + rng_index(&r, MOVERS - from + 1);
          workers[k] = (worker){batch, &s, (query_type)v, from, to, split};
          from = to;
          assert_int_equal(pthread_create(&thread[k], NULL, work, &workers[k]), 0);
        }
        for (size_t k = 0; k < threads; k++) assert_int_equal(pthread_join(thread[k], NULL), 0);
        for (size_t i = 0; i < MOVERS; i++) assert_true(same(&whole[i], &split[i]));
      }
    }
    cprox_batch_free(batch);
    scene_free(&s);
  }
  cprox_workspace_free(workspace);
}

/* ---- the loops ---------------------------------------------------------------------------------------------------------- */

/* Seed 14, 2000 sets of 13 balls, scales 1e-6 … 1e6, offsets to 1e6 of them: never above the distance in long double, and no
 * farther below than twice the rounding that the code states. */
CASE(ball_bounds_are_never_above_the_true_distance) {
  enum { BALLS = 13, PADDED = 16 };
  rng r = rng_seed(14);
  for (size_t round = 0; round < test_cases(2000); round++) {
    double numbers[5][PADDED] = {{0}}, lower[PADDED];
    const lanes_balls balls = {BALLS, PADDED, numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 offset = vec_scale(round % 2 ? 0.0 : 1e6 * scale, rng_unit(&r));
    curve_capsule c = {vec_add(offset, rng_in_cube(&r, scale)), vec_add(offset, rng_in_cube(&r, scale)), scale};
    if (round % 7 == 0) c.b = c.a;
    for (int k = 0; k < BALLS; k++) {
      const vec3 x = vec_add(offset, rng_in_cube(&r, 3 * scale));
      balls.x[k] = x.x, balls.y[k] = x.y, balls.z[k] = x.z;
      balls.reach[k] = rng_uniform(&r, 0, scale);
      balls.sizes[k] = vec_norm(x) + balls.reach[k];
    }
    lanes_ball_bounds(&balls, &c, 0.25 * scale, lower);
    for (int k = 0; k < BALLS; k++) {
      const vec3 x = vec(balls.x[k], balls.y[k], balls.z[k]);
      const long double apart = ref_point_segment(ref_vec(x), ref_vec(c.a), ref_vec(c.b));
      const long double truth =
          apart - (long double)c.radius - 0.25L * (long double)scale - (long double)balls.reach[k];
      assert_true((long double)lower[k] <= truth);
      assert_true((double)(truth - (long double)lower[k]) <= 128 * 0x1p-53 * (10 * scale + 4 * vec_norm(offset)));
    }
  }
}

/* Seed 15, 3000 pieces of all degrees: chords begin within (10 n + 16) u of de Casteljau's points in long double; the nearest point of
 * the chords is no farther and no nearer than that of each by itself, within 16 u of the sizes. */
CASE(chords_are_those_of_the_piece) {
  rng r = rng_seed(15);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(3000); round++) {
    const size_t degree = random_degree(&r);
    vec3 points[CPROX_MAX_DEGREE + 1], begin[CHORDS + 1];
    random_points(&r, degree + 1, points);
    const double *basis = lanes_basis(degree, workspace);
    lanes_chords chords;
    for (uint32_t first = 0; first < CHORDS; first += LANES) {
      const vec3 from = rng_in_cube(&r, 1.0);
      uint32_t nearest, again;
      const double square = lanes_points(basis, points, degree, false, first, from, &chords, &nearest);
      assert_true(square == lanes_nearest_point(&chords, first, from, &again) && nearest == again);
      for (uint32_t k = first; k < first + LANES; k++)
        assert_true(square <= vec_norm2(vec_sub(from, vec(chords.x[k], chords.y[k], chords.z[k]))));
    }
    lanes_join(&chords);
    const double size = ref_largest(points, degree + 1);
    const double allowed = (10.0 * (double)degree + 16) * 0x1p-53 * size;
    for (size_t k = 0; k < CHORDS; k++) {
      const vec3l exact = ref_bezier(points, degree, (long double)k / CHORDS, 0);
      begin[k] = vec(chords.x[k], chords.y[k], chords.z[k]);
      assert_true(ref_error(exact, begin[k]) <= allowed);
    }
    begin[CHORDS] = points[degree];
    const vec3 from = vec_axpy(points[0], size, rng_unit(&r));
    size_t chord;
    double s;
    const double distance = sqrt(lanes_closest(&chords, from, &chord, &s));
    long double least = INFINITY;
    for (size_t k = 0; k < CHORDS; k++)
      least = fminl(least, ref_point_segment(ref_vec(from), ref_vec(begin[k]), ref_vec(begin[k + 1])));
    assert_true(fabsl((long double)distance - least) <= 16 * 0x1p-53 * 3 * size);
    const vec3 at = vec_lerp(begin[chord], begin[chord + 1], s);
    assert_true(fabs(vec_norm(vec_sub(from, at)) - distance) <= 16 * 0x1p-53 * 3 * size);
  }
  cprox_workspace_free(workspace);
}

/* The square distance of a point from a box. */
static long double square_from_box(const lanes_box *box, vec3 p) {
  const long double beyond[3] = {
      fmaxl(fmaxl((long double)box->low.x - (long double)p.x, (long double)p.x - (long double)box->high.x), 0.0L),
      fmaxl(fmaxl((long double)box->low.y - (long double)p.y, (long double)p.y - (long double)box->high.y), 0.0L),
      fmaxl(fmaxl((long double)box->low.z - (long double)p.z, (long double)p.z - (long double)box->high.z), 0.0L)};
  return beyond[0] * beyond[0] + beyond[1] * beyond[1] + beyond[2] * beyond[2];
}

/* Seed 19, 3000 pieces of all degrees, 8 balls each, at offsets up to 1e6: the bound by boxes is never above the distance of the chords in them,
 * lies within 160 u of the sizes below that of the boxes, and lowers nothing. */
CASE(boxes_bound_the_chords_in_them) {
  enum { BALLS = 8 };
  rng r = rng_seed(19);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(3000); round++) {
    const vec3 offset = vec_scale(round % 3 == 0 ? 0.0 : pow(10.0, rng_uniform(&r, 0, 6)), rng_unit(&r));
    const size_t degree = random_degree(&r);
    vec3 points[CPROX_MAX_DEGREE + 1];
    random_points(&r, degree + 1, points);
    for (size_t i = 0; i <= degree; i++) points[i] = vec_add(points[i], offset);
    lanes_chords chords;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      lanes_points(lanes_basis(degree, workspace), points, degree, false, first, offset, &chords, &unused);
    lanes_box boxes[PACKET_INTERVALS];
    lanes_boxes(&chords, boxes);

    double x[BALLS], y[BALLS], z[BALLS], reach[BALLS], sizes[BALLS], lower[BALLS];
    for (int k = 0; k < BALLS; k++) {
      const vec3 c = vec_axpy(offset, rng_uniform(&r, 0, 4), rng_unit(&r));
      x[k] = c.x, y[k] = c.y, z[k] = c.z, reach[k] = rng_uniform(&r, 0, 0.5);
      sizes[k] = vec_norm(c) + reach[k];
      lower[k] = k == 0 ? 1e300 : -INFINITY;
    }
    const lanes_balls balls = {.n = BALLS, .padded = BALLS, .x = x, .y = y, .z = z, .reach = reach, .sizes = sizes};
    const double radius = rng_uniform(&r, 0, 0.5);
    lanes_box_bounds(&balls, boxes, PACKET_INTERVALS, radius, 0.0, lower);
    assert_true(lower[0] == 1e300);
    for (int k = 1; k < BALLS; k++) {
      const vec3 c = vec(x[k], y[k], z[k]);
      const long double margin = (long double)radius + (long double)reach[k];
      long double to_chords = INFINITY, to_boxes = INFINITY;
      for (size_t i = 0; i < CHORDS; i++) {
        const vec3 a = vec(chords.x[i], chords.y[i], chords.z[i]);
        const vec3 b = vec(chords.x[i + 1], chords.y[i + 1], chords.z[i + 1]);
        to_chords = fminl(to_chords, ref_point_segment(ref_vec(c), ref_vec(a), ref_vec(b)));
      }
      for (size_t i = 0; i < PACKET_INTERVALS; i++) to_boxes = fminl(to_boxes, sqrtl(square_from_box(&boxes[i], c)));
      assert_true((long double)lower[k] <= to_chords - margin);
      assert_true((double)(to_boxes - margin - (long double)lower[k]) <=
                  160 * 0x1p-53 * ((double)(to_boxes + margin) + sizes[k]));
    }
  }
  cprox_workspace_free(workspace);
}

/* Seed 20, 2000 pieces of all degrees: points within a chord are those of de Casteljau in long double, within (10 n + 16) u. */
CASE(chords_are_cut_again_where_the_piece_goes) {
  rng r = rng_seed(20);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(2000); round++) {
    const size_t degree = random_degree(&r), chord = rng_index(&r, CHORDS);
    vec3 points[CPROX_MAX_DEGREE + 1];
    random_points(&r, degree + 1, points);
    const double *basis = lanes_fine_basis(degree, chord, workspace);
    lanes_chords fine;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      lanes_points(basis, points, degree, false, first, vec(0, 0, 0), &fine, &unused);
    const double allowed = (10.0 * (double)degree + 16) * 0x1p-53 * ref_largest(points, degree + 1);
    for (size_t k = 0; k < CHORDS; k++) {
      const long double s = ((long double)chord + (long double)k / CHORDS) / CHORDS;
      const vec3 point = vec(fine.x[k], fine.y[k], fine.z[k]);
      assert_true(ref_error(ref_bezier(points, degree, s, 0), point) <= allowed);
    }
  }
  cprox_workspace_free(workspace);
}

/* The distance of a point of the chord from the OBB, in long double; the frame's matrix is taken as it is, which a rotation is but for 20 u. */
static long double from_obb(const lanes_obb *b, const lanes_chords *c, size_t k, long double s) {
  const long double v[3] = {(long double)c->x[k] + s * (long double)c->dx[k] - (long double)b->position.x,
                            (long double)c->y[k] + s * (long double)c->dy[k] - (long double)b->position.y,
                            (long double)c->z[k] + s * (long double)c->dz[k] - (long double)b->position.z};
  const long double centre[3] = {(long double)b->centre.x, (long double)b->centre.y, (long double)b->centre.z};
  const long double half[3] = {(long double)b->half.x, (long double)b->half.y, (long double)b->half.z};
  long double square = 0.0L;
  for (int i = 0; i < 3; i++) {
    long double y = -centre[i];
    for (int j = 0; j < 3; j++) y += (long double)b->r[3 * j + i] * v[j];
    const long double beyond = fmaxl(fabsl(y) - half[i], 0.0L);
    square += beyond * beyond;
  }
  return sqrtl(square);
}

/* Seed 21, 1000 OBBs anywhere, also flat ones and points, 1 to 1e6 m away: the bound of a chord is not above its distance, which is convex along the
 * chord and found by golden section to 1e-12 of it; it is the distance to 5 % and less for nine chords in ten that are apart; the point is where it says. */
CASE(obbs_bound_chords_from_below) {
  rng r = rng_seed(21);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t apart = 0, tight = 0;
  for (size_t round = 0; round < test_cases(1000); round++) {
    const size_t degree = 1 + rng_index(&r, 6);
    vec3 points[CPROX_MAX_DEGREE + 1];
    const double far = round % 2 ? rng_log_uniform(&r, 1.0, 1e6) : 0.0;
    const vec3 offset = vec_scale(far, rng_unit(&r));
    for (size_t i = 0; i <= degree; i++) points[i] = vec_add(offset, rng_in_cube(&r, 1.0));
    if (round % 11 == 0) points[1] = points[0];
    lanes_chords chords;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      lanes_points(lanes_basis(degree, workspace), points, degree, false, first, offset, &chords, &unused);
    lanes_join(&chords);
    const cprox_pose pose = rng_pose(&r, 1.0);
    const frame f = frame_create(&pose, vec(0, 0, 0));
    lanes_obb obb = {.position = vec_add(offset, pose.position), .centre = rng_in_cube(&r, 0.2)};
    memcpy(obb.r, f.r, sizeof obb.r);
    obb.half = vec(rng_uniform(&r, 0, 0.5), rng_uniform(&r, 0, 0.5), round % 5 ? rng_uniform(&r, 0, 0.5) : 0.0);
    if (round % 7 == 0) obb.half = vec(0, 0, 0);
    lanes_sample sight;
    lanes_see_obb(&chords, &obb, &sight);
    const long double allowed = 128 * 0x1p-53L * (long double)(far + 4.0);
    for (size_t k = 0; k < CHORDS; k++) {
      long double a = 0.0L, b = 1.0L;
      for (int step = 0; step < 60; step++) {
        const long double left = b - 0.6180339887498949L * (b - a), right = a + 0.6180339887498949L * (b - a);
        if (from_obb(&obb, &chords, k, left) <= from_obb(&obb, &chords, k, right))
          b = right;
        else
          a = left;
      }
      const long double least = from_obb(&obb, &chords, k, 0.5L * (a + b));
      assert_true((long double)sight.lower[k] <= least + 1e-12L + allowed);
      assert_true(sight.lower[k] >= 0.0 && sight.s[k] >= 0.0 && sight.s[k] <= 1.0);
      const long double at = from_obb(&obb, &chords, k, (long double)sight.s[k]);
      assert_true(fabsl(at - sqrtl((long double)sight.square[k])) <= allowed);
      apart += least > 1e-6L;
      tight += least > 1e-6L && (long double)sight.lower[k] >= 0.95L * least;
    }
  }
  assert_true(apart > 0 && 10 * tight >= 9 * apart);
  cprox_workspace_free(workspace);
}

/* Seed 23, 20 scenes: an OBB holds the points of its part that lie farthest in 100 directions, and each of its faces has one of them within a
 * third of its width; 1e-12 is the rounding of the poses here, amply. */
CASE(obbs_hold_their_parts) {
  rng r = rng_seed(23);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t obbs = 0;
  for (size_t round = 0; round < test_cases(20); round++) {
    scene s = {0};
    scene_targets(&r, round % 4 == 3, workspace, &s);
    cprox_batch *batch = NULL;
    assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
    const query q = {.targets = s.targets, .n = s.n_targets};
    for (size_t k = 0; k < batch->balls.n; k++) {
      const batch_core *core = &batch->cores[k];
      if (!core->has_obb) continue;
      obbs++;
      const placed_pair placed = placed_pair_resolve(&q, &batch->parts[k]);
      const cprox_body *body = placed.shape;
      const frame f = placed.frame;
      const frame own = {.position = core->obb.position, .centre = core->obb.centre, .rotated = true};
      frame obb = own;
      memcpy(obb.r, core->obb.r, sizeof obb.r);
      double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
      const double half[3] = {core->obb.half.x, core->obb.half.y, core->obb.half.z};
      for (int i = 0; i < 106; i++) {
        vec3 d = rng_unit(&r), at;
        if (i < 6) d = vec(i / 2 == 0, i / 2 == 1, i / 2 == 2);
        if (i < 6 && i % 2) d = vec_neg(d);
        body->shape.ops->support(&body->shape, d, NULL, &at);
        double error = 0.0;
        const vec3 y = frame_to_local(&obb, frame_to_world(&f, vec_axpy(at, body->shape.margin, d)), &error);
        const double inside[3] = {y.x, y.y, y.z};
        for (int j = 0; j < 3; j++) {
          assert_true(fabs(inside[j]) <= half[j] + 1e-12);
          least[j] = fmin(least[j], inside[j]), most[j] = fmax(most[j], inside[j]);
        }
      }
      for (int j = 0; j < 3; j++) assert_true(most[j] >= half[j] / 3 - 1e-12 && least[j] <= -half[j] / 3 + 1e-12);
    }
    cprox_batch_free(batch);
    scene_free(&s);
  }
  assert_true(obbs > 0);
  cprox_workspace_free(workspace);
}

/* Seed 24: 75 boxes, compounds of two, and two halfspaces, which have no balls. Each part is in one block; the bound of a block is above the distance of none
 * of its balls from 4 boxes, in long double, and no more than 160 u of the sizes below that of the box round its balls. */
CASE(blocks_hold_each_part_once_and_bound_it) {
  enum { N = 75, BOXES = 4 };
  rng r = rng_seed(24);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(100); round++) {
    const size_t n = 1 + rng_index(&r, N);
    cprox_body *box = NULL, *pair = NULL, *half = NULL;
    cprox_obstacle targets[N];
    assert_int_equal(cprox_body_create_box(vec(0.1, 0.2, 0.3), workspace, &box), CPROX_OK);
    assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0.0, workspace, &half), CPROX_OK);
    const cprox_pose poses[2] = {rng_pose(&r, 0.5), rng_pose(&r, 0.5)};
    assert_int_equal(cprox_body_create_compound((const cprox_body *[]){box, box}, poses, 2, workspace, &pair),
                     CPROX_OK);
    const double far = round % 2 ? rng_log_uniform(&r, 1.0, 1e5) : 0.0;
    const vec3 offset = vec_scale(far, rng_unit(&r));
    for (size_t i = 0; i < n; i++) {
      cprox_pose pose = rng_pose(&r, 2.0);
      pose.position = vec_add(pose.position, offset);
      targets[i] = cprox_obstacle_at(i % 40 == 20 ? half : i % 4 == 1 ? pair : box, pose);
      targets[i].margin = i % 3 == 0 ? 0.1 : 0.0;
    }
    cprox_batch *batch = NULL;
    assert_int_equal(cprox_batch_create(targets, n, workspace, &batch), CPROX_OK);
    int met[N][2] = {{0}};
    for (size_t k = 0; k < batch->balls.n; k++) met[batch->parts[k].target][batch->parts[k].part]++;
    for (size_t i = 0; i < n; i++) assert_true(met[i][0] == 1 && met[i][1] == (targets[i].body == pair));

    lanes_box boxes[BOXES];
    for (int i = 0; i < BOXES; i++) {
      const vec3 at = vec_add(offset, rng_in_cube(&r, 4.0)),
                 size = vec(rng_uniform(&r, 0, 1), rng_uniform(&r, 0, 1), 0);
      boxes[i] = (lanes_box){at, vec_add(at, size)};
    }
    double lower[N];
    const double radius = rng_uniform(&r, 0, 0.2);
    const lanes_blocks *blocks = &batch->blocks;
    assert_true(blocks->padded <= N && blocks->n == (batch->balls.n + BLOCK - 1) / BLOCK);
    lanes_block_bounds(blocks, boxes, BOXES, radius, 0.0, lower);
    for (size_t k = 0; k < batch->balls.n; k++) {
      const lanes_balls *balls = &batch->balls;
      if (isinf(balls->reach[k])) {
        assert_true(lower[k / BLOCK] == -INFINITY);
        continue;
      }
      const vec3 c = vec(balls->x[k], balls->y[k], balls->z[k]);
      long double least = INFINITY;
      for (int i = 0; i < BOXES; i++) least = fminl(least, square_from_box(&boxes[i], c));
      const long double truth = fmaxl(sqrtl(least) - (long double)balls->reach[k], 0.0L) - (long double)radius;
      assert_true((long double)lower[k / BLOCK] <= truth);
    }
    for (size_t b = 0; b < blocks->n; b++) {
      if (lower[b] == -INFINITY) continue;
      long double least = INFINITY;
      for (int i = 0; i < BOXES; i++) {
        const double low[3] = {boxes[i].low.x, boxes[i].low.y, boxes[i].low.z};
        const double high[3] = {boxes[i].high.x, boxes[i].high.y, boxes[i].high.z};
        long double square = 0.0L;
        for (int j = 0; j < 3; j++) {
          const long double over = (long double)low[j] - (long double)blocks->high[j][b];
          const long double under = (long double)blocks->low[j][b] - (long double)high[j];
          const long double gap = fmaxl(fmaxl(over, under), 0.0L);
          square += gap * gap;
        }
        least = fminl(least, square);
      }
      const long double below = sqrtl(least) - (long double)radius - (long double)lower[b];
      assert_true(below >= 0.0L && below <= 160 * 0x1p-53L * (sqrtl(least) + 1.0L + (long double)blocks->sizes[b]));
    }
    cprox_batch_free(batch);
    cprox_body_free(pair);
    cprox_body_free(box);
    cprox_body_free(half);
  }
  cprox_workspace_free(workspace);
}

/* ---- crowds -------------------------------------------------------------------------------------------------------------- */

/* Seed 22: 300 quintics, some of them tubes, through 80 small boxes: the verdicts of the queries of one mover, in intervals that share a point with
 * theirs; what is called a hit has a point of the tube within a box, or within the limit of it. Bricks leave next to no verdict and next to no contact to search. */
CASE(small_boxes_are_met_or_passed_without_a_search) {
  enum { CURVES = 300, BOXES = 80 };
  rng r = rng_seed(22);
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *bodies[BOXES];
  cprox_obstacle targets[BOXES];
  for (size_t k = 0; k < BOXES; k++) {
    const vec3 edges = vec(rng_uniform(&r, .01, .06), rng_uniform(&r, .01, .06), rng_uniform(&r, .01, .06));
    assert_int_equal(cprox_body_create_box(edges, workspace, &bodies[k]), CPROX_OK);
    targets[k] = cprox_obstacle_at(bodies[k], rng_pose(&r, 0.5));
    if (k % 4 == 0) targets[k].margin = 0.004;
  }
  cprox_batch *batch = NULL;
  assert_int_equal(cprox_batch_create(targets, BOXES, workspace, &batch), CPROX_OK);
  size_t searched = 0, hits = 0;
  for (size_t i = 0; i < CURVES; i++) {
    const vec3 p[6] = {vec(-0.7, 0, 0),      vec(-0.5, 0, 0), rng_in_cube(&r, 0.5),
                       rng_in_cube(&r, 0.5), vec(0.5, 0, 0),  vec(0.7, 0, 0)};
    cprox_curve *curve = NULL;
    assert_int_equal(cprox_curve_create_bezier(p, 6, 0, 1, workspace, &curve), CPROX_OK);
    const cprox_mover mover = cprox_tube_along(curve, i % 3 ? 0.005 : 0.0);
    for (int v = DISTANCE; v < QUERY_TYPES; v++) {
      const double delta = v == TOLERANCE ? 0.01 : 0.0;
      cprox_result one, alone;
      if (v == DISTANCE) {
        cprox_batch_distance(batch, &mover, 0, 1, NULL, workspace, &one);
        cprox_distance_all(mover, targets, BOXES, NULL, workspace, &alone, NULL);
        assert_true(one.upper - one.lower <= 1e-6);
      } else if (v == TOLERANCE) {
        cprox_batch_tolerance(batch, &mover, 0, 1, delta, NULL, workspace, &one);
        cprox_tolerance_all(mover, targets, BOXES, delta, NULL, workspace, &alone, NULL);
      } else {
        cprox_batch_collision(batch, &mover, 0, 1, NULL, workspace, &one);
        cprox_collision_all(mover, targets, BOXES, NULL, workspace, &alone, NULL);
      }
      assert_int_equal(one.verdict, alone.verdict);
      assert_true(one.lower <= alone.upper && alone.lower <= one.upper && one.lower <= one.upper);
      searched += one.nodes > 0 && (v != DISTANCE || one.upper == 0.0);
      if (v == DISTANCE ? one.upper > 0.0 : one.verdict != CPROX_VERDICT_VIOLATED) continue;
      hits++;
      cprox_vec3 at;
      cprox_curve_evaluate(curve, one.t, NULL, &at, NULL, NULL);
      const cprox_obstacle *target = &targets[one.obstacle_index];
      const frame f = frame_create(&target->pose, vec(0, 0, 0));
      double error = 0.0;
      const double d = cprox_body_nearest(target->body, frame_to_local(&f, at, &error), NULL);
      assert_true(d - target->margin - mover.radius <= one.upper + 1e-12 && one.upper <= delta);
      const double surface = cprox_body_nearest(target->body, frame_to_local(&f, one.witness_obstacle, &error), NULL);
      assert_true(surface <= target->margin + 1e-12);
      assert_true(vec_norm(vec_sub(one.witness_mover, at)) <= mover.radius + 1e-12);
      assert_true(fabs(vec_norm(vec_sub(one.witness_mover, one.witness_obstacle)) - one.upper) <= 1e-12);
    }
    cprox_curve_free(curve);
  }
  assert_true(hits > CURVES / 2 && hits < 2 * CURVES);
  assert_true(searched <= 3 * CURVES / 50);
  cprox_batch_free(batch);
  for (size_t k = 0; k < BOXES; k++) cprox_body_free(bodies[k]);
  cprox_workspace_free(workspace);
}

/* ---- input -------------------------------------------------------------------------------------------------------------- */

CASE(a_mover_that_is_unusable_fails_alone) {
  rng r = rng_seed(16);
  cprox_workspace *workspace = cprox_workspace_create();
  scene s = {0};
  scene_targets(&r, false, workspace, &s);
  scene_movers(&r, false, workspace, &s);
  cprox_batch *batch = NULL;
  assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
  cprox_result good[MOVERS], results[MOVERS];
  assert_int_equal(cprox_batch_distance(batch, s.movers, 0, MOVERS, NULL, workspace, good), CPROX_OK);
  s.movers[5].radius = NAN;
  s.movers[9].curve = NULL;
  assert_int_equal(cprox_batch_distance(batch, s.movers, 0, MOVERS, NULL, workspace, results), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(workspace), "mover 5: radius is nan"));
  for (size_t i = 0; i < MOVERS; i++) {
    const bool bad = i == 5 || i == 9;
    assert_true(bad ? results[i].status == CPROX_INVALID && results[i].lower == 0.0 && results[i].upper == INFINITY
                    : same(&results[i], &good[i]));
  }

  /* only the range is written */
  memset(results, 0x5a, sizeof results);
  cprox_result untouched;
  memset(&untouched, 0x5a, sizeof untouched);
  assert_int_equal(cprox_batch_distance(batch, s.movers, 20, 30, NULL, workspace, results), CPROX_OK);
  assert_string_equal(cprox_workspace_error(workspace), "");
  for (size_t i = 0; i < MOVERS; i++) {
    if (i >= 20 && i < 30)
      assert_true(same(&results[i], &good[i]));
    else
      assert_memory_equal(&results[i], &untouched, sizeof untouched);
  }
  cprox_batch_free(batch);
  scene_free(&s);
  cprox_workspace_free(workspace);
}

CASE(unusable_calls_are_refused_with_a_sentence) {
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_result result;
  cprox_batch *batch = NULL;
  const cprox_obstacle nothing = {0};
  assert_int_equal(cprox_batch_create(&nothing, 1, workspace, &batch), CPROX_INVALID);
  assert_null(batch);
  assert_non_null(strstr(cprox_workspace_error(workspace), "target 0"));
  assert_int_equal(cprox_batch_create(NULL, 3, workspace, &batch), CPROX_INVALID);
  assert_int_equal(cprox_batch_create(NULL, 0, NULL, &batch), CPROX_INVALID);

  assert_int_equal(cprox_batch_create(NULL, 0, workspace, &batch), CPROX_OK);
  cprox_curve *curve = NULL;
  const cprox_vec3 points[2] = {{0, 0, 0}, {1, 0, 0}};
  assert_int_equal(cprox_curve_create_bezier(points, 2, 0, 1, workspace, &curve), CPROX_OK);
  const cprox_mover mover = cprox_point_along(curve);
  assert_int_equal(cprox_batch_tolerance(batch, &mover, 0, 1, 0.1, NULL, workspace, &result), CPROX_OK);
  assert_true(result.lower == INFINITY && result.verdict == CPROX_VERDICT_CLEAR && result.obstacle_index == -1);
  assert_int_equal(cprox_batch_distance(batch, &mover, 0, 0, NULL, workspace, NULL), CPROX_OK);

  assert_int_equal(cprox_batch_distance(batch, &mover, 1, 0, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_batch_distance(NULL, &mover, 0, 1, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_batch_distance(batch, NULL, 0, 1, NULL, workspace, &result), CPROX_INVALID);
  assert_int_equal(cprox_batch_distance(batch, &mover, 0, 1, NULL, workspace, NULL), CPROX_INVALID);
  assert_int_equal(cprox_batch_distance(batch, &mover, 0, 1, NULL, NULL, &result), CPROX_INVALID);
  assert_int_equal(cprox_batch_tolerance(batch, &mover, 0, 1, -1, NULL, workspace, &result), CPROX_INVALID);
  cprox_options options = cprox_options_default();
  options.epsilon = NAN;
  assert_int_equal(cprox_batch_collision(batch, &mover, 0, 1, &options, workspace, &result), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(workspace), "epsilon"));
  cprox_batch_free(batch);
  cprox_batch_free(NULL);
  cprox_curve_free(curve);
  cprox_workspace_free(workspace);
}

CASE(a_warm_workspace_allocates_nothing_and_no_memory_is_reported) {
  rng r = rng_seed(17);
  cprox_workspace *workspace = cprox_workspace_create();
  scene s = {0};
  scene_targets(&r, true, workspace, &s);
  scene_movers(&r, true, workspace, &s);
  for (size_t k = 0; k < 5; k++) {
    cprox_batch *none = NULL;
    allocations_fail_after(k);
    const cprox_status status = cprox_batch_create(s.targets, s.n_targets, workspace, &none);
    allocations_allow();
    assert_int_equal(status, CPROX_MEMORY);
    assert_null(none);
  }
  cprox_batch *batch = NULL;
  assert_int_equal(cprox_batch_create(s.targets, s.n_targets, workspace, &batch), CPROX_OK);
  cprox_result results[MOVERS];
  for (int v = 0; v < QUERY_TYPES; v++) ask_range((query_type)v, batch, &s, 0, MOVERS, workspace, results);
  const size_t before = allocations_made();
  for (int v = 0; v < QUERY_TYPES; v++) ask_range((query_type)v, batch, &s, 0, MOVERS, workspace, results);
  assert_int_equal(allocations_made(), before);
  cprox_batch_free(batch);
  scene_free(&s);
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
