/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls whose radius changes along the curve: intervals against long double at many parameters, two on one clock, and
 * what must be refused. */
#include <math.h>
#include <string.h>

#include "base/rounding.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/random.h"
#include "support/reference.h"

enum { MOST = 13, CORNERS = 6 };

/* A Bézier curve, and a radius of another degree on the same range. */
typedef struct tube {
  vec3 points[MOST], radii[MOST];
  size_t degree, radius_degree;
  cprox_curve *curve, *radius;
} tube;

/* Radii of at most `size`; y and z of the radius curve have no meaning and are noise. */
static tube tube_random(rng *r, vec3 about, double scale, double size) {
  tube t = {.degree = 1 + rng_index(r, MOST - 1), .radius_degree = 1 + rng_index(r, MOST - 1)};
  for (size_t i = 0; i < MOST; i++) {
    t.points[i] = vec_add(about, rng_in_cube(r, scale));
    t.radii[i] = vec(rng_index(r, 4) ? rng_uniform(r, 0.0, size) : 0.0, rng_uniform(r, -1.0, 1.0), 0.0);
  }
  assert_int_equal(curve_from(describe_bezier(t.points, t.degree + 1, 0.0, 2.0), ws, &t.curve), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(t.radii, t.radius_degree + 1, 0.0, 2.0), ws, &t.radius), CPROX_OK);
  return t;
}

static void tube_free(tube *t) {
  cprox_curve_free(t->curve);
  cprox_curve_free(t->radius);
}

static cprox_mover mover_of(const tube *t, double radius) {
  cprox_mover mover = cprox_tube_along(t->curve, radius);
  mover.radius_curve = t->radius;
  return mover;
}

static vec3l tube_point(const tube *t, long double s) {
  return ref_bezier(t->points, t->degree, s, 0);
}

static long double tube_radius(const tube *t, long double s) {
  return ref_bezier(t->radii, t->radius_degree, s, 0).x;
}

/* A body with an exact distance. */
typedef struct standing {
  int kind; /* a ball, a box, a hull */
  double radius;
  vec3 half, corner[CORNERS];
  cprox_pose pose;
  cprox_body *body;
} standing;

static standing standing_random(rng *r, double scale) {
  standing b = {.kind = (int)rng_index(r, 3), .radius = scale * rng_uniform(r, 0.01, 0.5), .pose = rng_pose(r, scale)};
  b.half = vec(scale * rng_uniform(r, 0.01, 0.5), scale * rng_uniform(r, 0.01, 0.5), scale * rng_uniform(r, 0.01, 0.5));
  for (int i = 0; i < CORNERS; i++) b.corner[i] = rng_in_cube(r, 0.5 * scale);
  const cprox_status made = b.kind == 0   ? cprox_body_create_sphere(b.radius, ws, &b.body)
                            : b.kind == 1 ? cprox_body_create_box(vec_scale(2.0, b.half), ws, &b.body)
                                          : cprox_body_create_polytope(b.corner, CORNERS, ws, &b.body);
  assert_int_equal(made, CPROX_OK);
  return b;
}

static long double standing_distance(const standing *b, vec3l world) {
  const vec3l p = ref_to_local(&b->pose, world);
  if (b->kind == 0) return fmaxl(ref_norm(p) - b->radius, 0.0L);
  return b->kind == 1 ? ref_point_box(p, b->half) : ref_point_hull(p, b->corner, CORNERS);
}

/* What the query bounds, at s: never below 0. */
static long double value_at(const tube *t, const standing *b, double constant, long double s) {
  return fmaxl(standing_distance(b, tube_point(t, s)) - tube_radius(t, s) - constant, 0.0L);
}

/* Seed 1, 500 cases, degrees 1 to 12 of both, sizes 1e-2 to 1e2: the distance less the radius in long double at 40
 * parameters and at the reported one. 1e-13 sizes: long double's own. 3e-12: the rounding bound that `upper` carries,
 * 1e-12 at degrees of 12. */
CASE(intervals_hold_the_distance_less_the_radius) {
  rng r = rng_seed(1);
  const size_t cases = test_cases(500);
  uint32_t most = 0;
  for (size_t k = 0; k < cases; k++) {
    const double scale = rng_log_uniform(&r, 1e-2, 1e2), constant = rng_index(&r, 2) ? 0.0 : 0.05 * scale;
    tube t = tube_random(&r, vec(0, 0, 0), scale, rng_index(&r, 3) ? 0.2 * scale : 0.01 * scale);
    standing b = standing_random(&r, scale);
    b.pose.position = vec_scale(1.5, b.pose.position);
    cprox_options options = accurate(scale * rng_log_uniform(&r, 1e-11, 1e-3));
    cprox_result found;
    const cprox_status status =
        cprox_distance(mover_of(&t, constant), cprox_obstacle_at(b.body, b.pose), &options, ws, &found);
    assert_int_equal(status, CPROX_OK);
    assert_true(found.upper - found.lower <= options.epsilon);
    const long double hair = 1e-13L * (long double)scale;
    for (int i = 0; i < 40; i++)
      assert_true(found.lower <= value_at(&t, &b, constant, (long double)rng_uniform(&r, 0.0, 1.0)) + hair);
    assert_true(fabsl(value_at(&t, &b, constant, 0.5L * (long double)found.t) - found.upper) <= 30.0L * hair);
    if (found.upper > 0.0)
      assert_true(fabs(vec_norm(vec_sub(found.witness_mover, found.witness_obstacle)) - found.upper) <= 1e-11 * scale);
    most = found.nodes > most ? found.nodes : most;
    cprox_body_free(b.body);
    tube_free(&t);
  }
  assert_in_range(most, 2, 400);
}

/* Seed 2, 300 cases: where a distance is known to 1e-9 of the size, verdicts on either side of it. */
CASE(verdicts_follow_the_distance) {
  rng r = rng_seed(2);
  const size_t cases = test_cases(300);
  int hits = 0;
  for (size_t k = 0; k < cases; k++) {
    tube t = tube_random(&r, vec(0, 0, 0), 1.0, 0.3);
    standing b = standing_random(&r, 1.0);
    const cprox_obstacle target = cprox_obstacle_at(b.body, b.pose);
    cprox_options options = accurate(1e-9);
    cprox_result found, verdict;
    assert_int_equal(cprox_distance(mover_of(&t, 0.0), target, &options, ws, &found), CPROX_OK);
    assert_true(cprox_tolerance(mover_of(&t, 0.0), target, found.upper + 1e-6, &options, ws, &verdict) >= 0);
    assert_int_equal(verdict.verdict, CPROX_VERDICT_VIOLATED);
    if (found.lower > 2e-6) {
      assert_true(cprox_tolerance(mover_of(&t, 0.0), target, found.lower - 1e-6, &options, ws, &verdict) >= 0);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      assert_true(cprox_collision(mover_of(&t, 0.0), target, &options, ws, &verdict) >= 0);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
    } else if (found.upper == 0.0) {
      assert_true(cprox_collision(mover_of(&t, 0.0), target, &options, ws, &verdict) >= 0);
      assert_int_not_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      hits += verdict.verdict == CPROX_VERDICT_VIOLATED;
    }
    cprox_body_free(b.body);
    tube_free(&t);
  }
  assert_true(hits > 0);
}

/* Seed 3, 500 cases: two balls on one clock, the second one's curve placed by a pose, either or both with a radius that
 * changes; with the pose a turn costs a few u. */
CASE(two_radii_that_change_on_one_clock_add_up) {
  rng r = rng_seed(3);
  const size_t cases = test_cases(500);
  for (size_t k = 0; k < cases; k++) {
    const size_t changes = 1 + rng_index(&r, 3);
    tube a = tube_random(&r, vec(0, 0, 0), 1.0, 0.3), b = tube_random(&r, vec(1.0, 0, 0), 1.0, 0.3);
    cprox_mover first = mover_of(&a, 0.01), second = mover_of(&b, 0.02);
    if (!(changes & 1)) first.radius_curve = NULL;
    if (!(changes & 2)) second.radius_curve = NULL;
    cprox_obstacle target = cprox_synchronized(second);
    target.pose = rng_pose(&r, 1.0);
    cprox_options options = accurate(rng_log_uniform(&r, 1e-11, 1e-3));
    cprox_result found;
    assert_int_equal(cprox_distance(first, target, &options, ws, &found), CPROX_OK);
    for (int i = 0; i < 41; i++) {
      const long double s = i < 40 ? (long double)rng_uniform(&r, 0.0, 1.0) : 0.5L * (long double)found.t;
      const long double apart = ref_norm(ref_sub(tube_point(&a, s), ref_to_world(&target.pose, tube_point(&b, s))));
      const long double radii =
          0.01L + 0.02L + (changes & 1 ? tube_radius(&a, s) : 0.0L) + (changes & 2 ? tube_radius(&b, s) : 0.0L);
      const long double value = fmaxl(apart - radii, 0.0L);
      assert_true(found.lower <= value + 1e-13L);
      if (i == 40) assert_true(fabsl(value - found.upper) <= 1e-11L);
    }
    assert_true(found.t_obstacle == found.t);
    tube_free(&a);
    tube_free(&b);
  }
}

/* Seed 4, 200 cases: splines with joints of their own, a margin that changes round a carried box, three bodies and a
 * compound at once; static pairs with the margin of that moment at 40 parameters. */
CASE(splines_and_carried_bodies_agree_with_static_pairs) {
  rng r = rng_seed(4);
  const size_t cases = test_cases(200);
  for (size_t k = 0; k < cases; k++) {
    vec3 points[12], radii[7];
    for (int i = 0; i < 12; i++) points[i] = rng_in_cube(&r, 1.0);
    for (int i = 0; i < 7; i++) radii[i] = vec(rng_uniform(&r, 0.0, 0.2), 0, 0);
    const double knots[16] = {0, 0, 0, 0, .1, .2, .3, .4, .5, .7, .8, .9, 1, 1, 1, 1},
                 radius_knots[10] = {0, 0, 0, .15, .3, .55, .8, 1, 1, 1};
    cprox_curve *curve = NULL, *radius = NULL;
    assert_int_equal(curve_from(describe_bspline(points, 12, 3, knots, 16, 0.0, 1.0), ws, &curve), CPROX_OK);
    assert_int_equal(curve_from(describe_bspline(radii, 7, 2, radius_knots, 10, 0.0, 1.0), ws, &radius), CPROX_OK);
    standing b[3];
    cprox_obstacle list[4];
    const cprox_body *parts[2];
    cprox_pose poses[2];
    for (int i = 0; i < 3; i++) {
      b[i] = standing_random(&r, 0.5);
      b[i].pose.position = rng_in_cube(&r, 2.0);
      list[i] = cprox_obstacle_at(b[i].body, b[i].pose);
      if (i < 2) parts[i] = b[i].body, poses[i] = rng_pose(&r, 1.0);
    }
    cprox_body *compound = NULL, *box = NULL;
    assert_int_equal(cprox_body_create_compound(parts, poses, 2, ws, &compound), CPROX_OK);
    assert_int_equal(cprox_body_create_box(vec(0.1, 0.05, 0.02), ws, &box), CPROX_OK);
    list[3] = cprox_obstacle_at(compound, rng_pose(&r, 2.0));
    cprox_mover mover = rng_index(&r, 2) ? cprox_body_along(box, curve) : cprox_point_along(curve);
    mover.radius_curve = radius;
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(list, 4, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    cprox_options options = accurate(1e-9);
    cprox_result found, each[4];
    assert_int_equal(cprox_obstacles_distance(all, mover, &options, ws, &found, NULL), CPROX_OK);
    double least = INFINITY;
    for (int i = 0; i < 4; i++) {
      assert_int_equal(cprox_distance(mover, list[i], &options, ws, &each[i]), CPROX_OK);
      least = fmin(least, each[i].upper);
    }
    assert_true(fabs(found.upper - least) <= 2e-9 && found.nodes > 0);
    cprox_body *point = NULL;
    assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
    for (int i = 0; i < 40; i++) {
      const double t = rng_uniform(&r, 0.0, 1.0);
      vec3 at, radius_there;
      cprox_curve_evaluate(curve, t, ws, &at, NULL, NULL);
      cprox_curve_evaluate(radius, t, ws, &radius_there, NULL, NULL);
      const cprox_obstacle moved = {.body = mover.body ? box : point,
                                    .pose = {.position = at, .orientation = {1, 0, 0, 0}},
                                    .margin = radius_there.x};
      cprox_result pair;
      for (int j = 0; j < 4; j++) {
        assert_true(cprox_pair(moved, list[j], NULL, ws, &pair) >= 0);
        assert_true(each[j].lower <= fmax(pair.upper, 0.0) + 1e-12);
      }
    }
    cprox_obstacles_free(all);
    cprox_body_free(point);
    cprox_body_free(compound);
    cprox_body_free(box);
    for (int i = 0; i < 3; i++) cprox_body_free(b[i].body);
    cprox_curve_free(curve);
    cprox_curve_free(radius);
  }
}

/* A ball of radius (1 - t)^2 + 1/4 passes 2 m above a floor: it is nearest at the ends, by 3/4. */
CASE(a_radius_that_touches_zero_is_no_error) {
  const vec3 line[2] = {{-1, 0, 1}, {1, 0, 1}}, square[3] = {{1, 0, 0}, {-2, 0, 0}, {1, 0, 0}};
  cprox_curve *curve = NULL, *radius = NULL;
  cprox_body *floor = NULL;
  assert_int_equal(curve_from(describe_bezier(line, 2, 0.0, 2.0), ws, &curve), CPROX_OK);
  assert_int_equal(curve_from(describe_polynomial(square, 3, 0.0, 2.0), ws, &radius), CPROX_OK); /* (1 - t)^2 */
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 1.0, ws, &floor), CPROX_OK);
  cprox_mover mover = cprox_tube_along(curve, 0.25);
  mover.radius_curve = radius;
  cprox_result found;
  assert_int_equal(cprox_distance(mover, cprox_obstacle_at(floor, CPROX_POSE_IDENTITY), NULL, ws, &found), CPROX_OK);
  assert_true(fabs(found.upper - 0.75) <= 1e-6 && fabs(found.lower - 0.75) <= 1e-6);
  assert_true(found.t == 0.0 || found.t == 2.0);
  cprox_body_free(floor);
  cprox_curve_free(curve);
  cprox_curve_free(radius);
}

static void assert_refused(cprox_status status, const char *why) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), why)) fail_msg("%s", cprox_workspace_error(ws));
}

CASE(what_has_no_answer_is_refused_in_a_line) {
  rng r = rng_seed(5);
  tube t = tube_random(&r, vec(0, 0, 0), 1.0, 0.1);
  const vec3 dips[4] = {{0.1, 0, 0}, {-0.3, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}},
             triangle[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const uint32_t corners[1][3] = {{0, 1, 2}};
  cprox_curve *negative = NULL, *elsewhere = NULL;
  cprox_body *ball = NULL, *mesh = NULL;
  assert_int_equal(curve_from(describe_bezier(dips, 4, 0.0, 2.0), ws, &negative), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(t.radii, 3, 0.0, 1.0), ws, &elsewhere), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  assert_int_equal(cprox_body_create_mesh(triangle, 3, corners, 1, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &mesh),
                   CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);
  cprox_mover mover = mover_of(&t, 0.0);
  cprox_result found;
  cprox_gradient gradient;
  mover.radius_curve = negative;
  assert_refused(cprox_distance(mover, target, NULL, ws, &found), "the mover's radius is -0.");
  mover.radius = 0.2; /* and the sum is not negative */
  assert_int_equal(cprox_distance(mover, target, NULL, ws, &found), CPROX_OK);
  mover.radius_curve = elsewhere;
  assert_refused(cprox_distance(mover, target, NULL, ws, &found), "runs over [0, 1], and the curve over [0, 2]");
  mover.radius_curve = t.radius;
  assert_refused(cprox_time_of_contact(mover, target, NULL, ws, &found), "does not apply to");
  assert_refused(cprox_distance_gradient(mover, target, NULL, &found, ws, &gradient), "does not apply to");
  assert_refused(cprox_distance(mover, cprox_obstacle_at(mesh, CPROX_POSE_IDENTITY), NULL, ws, &found),
                 "obstacle 0 is a curve, a mesh");
  assert_refused(cprox_distance(mover, cprox_obstacle_curve(t.curve, 0.1), NULL, ws, &found),
                 "obstacle 0 is a curve, a mesh");
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.signed_distance = true;
  assert_refused(cprox_distance(mover, target, &options, ws, &found), "no signed distance");
  cprox_obstacles *set = NULL;
  assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  assert_refused(cprox_obstacles_distance(set, mover, NULL, ws, &found, NULL), "does not apply to");
  cprox_obstacles_free(set);
  cprox_obstacle stands = target;
  stands.radius_curve = t.radius;
  assert_refused(cprox_distance(mover, stands, NULL, ws, &found), "is not synchronized");
  cprox_obstacle clock = cprox_synchronized(mover_of(&t, 0.0));
  assert_refused(cprox_time_of_contact(cprox_point_along(t.curve), clock, NULL, ws, &found), "does not apply to");
  assert_int_equal(cprox_obstacles_create(&clock, 1, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
  assert_refused(cprox_obstacles_distance(set, cprox_point_along(t.curve), NULL, ws, &found, NULL),
                 "does not apply to");
  cprox_obstacles_free(set);
  cprox_body_free(ball);
  cprox_body_free(mesh);
  cprox_curve_free(negative);
  cprox_curve_free(elsewhere);
  tube_free(&t);
}

/* Batches answer it too, by a search. */
CASE(batches_know_the_radius) {
  rng r = rng_seed(6);
  for (int k = 0; k < 20; k++) {
    tube t = tube_random(&r, vec(0, 0, 0), 1.0, 0.3);
    standing b = standing_random(&r, 1.0);
    const cprox_obstacle target = cprox_obstacle_at(b.body, b.pose);
    const cprox_mover mover = mover_of(&t, 0.0);
    cprox_obstacles *set = NULL;
    cprox_result one, of_batch;
    assert_int_equal(cprox_obstacles_create(&target, 1, CPROX_INDEX_BATCH, ws, &set), CPROX_OK);
    assert_int_equal(cprox_distance(mover, target, NULL, ws, &one), CPROX_OK);
    assert_true(cprox_obstacles_distance_batch(set, &mover, 0, 1, NULL, ws, &of_batch) >= 0);
    assert_true(of_batch.lower == one.lower && of_batch.upper == one.upper);
    cprox_obstacles_free(set);
    cprox_body_free(b.body);
    tube_free(&t);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
