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

/* ---- against what is not convex ---- */

enum { TRIANGLES = 40, GRID = 400 };

/* Triangles, or as many points, in a cube. */
typedef struct soup {
  bool points;
  vec3 corner[3 * TRIANGLES];
  cprox_pose pose;
  cprox_body *body;
} soup;

static soup soup_random(rng *r, bool points) {
  soup b = {.points = points, .pose = rng_pose(r, 0.5)};
  uint32_t index[TRIANGLES][3];
  for (size_t i = 0; i < TRIANGLES; i++) {
    const vec3 middle = rng_in_cube(r, 1.0);
    for (size_t k = 0; k < 3; k++) {
      index[i][k] = (uint32_t)(3 * i + k);
      b.corner[3 * i + k] = vec_add(middle, rng_in_cube(r, 0.2));
    }
  }
  const size_t n = sizeof b.corner / sizeof *b.corner;
  const cprox_status made = points ? cprox_body_create_points(b.corner, n, 0.0, SIZE_MAX, ws, &b.body)
                                   : cprox_body_create_mesh(b.corner, n, (const uint32_t(*)[3])index, TRIANGLES,
                                                            CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &b.body);
  assert_int_equal(made, CPROX_OK);
  return b;
}

static long double soup_distance(const soup *b, vec3l world) {
  const vec3l p = ref_to_local(&b->pose, world);
  long double least = INFINITY;
  for (size_t i = 0; i < TRIANGLES; i++) {
    const vec3 *v = b->corner + 3 * i;
    for (size_t k = 0; b->points && k < 3; k++) least = fminl(least, ref_norm(ref_sub(p, ref_vec(v[k]))));
    if (!b->points) least = fminl(least, ref_point_triangle(p, ref_vec(v[0]), ref_vec(v[1]), ref_vec(v[2])));
  }
  return least;
}

/* A radius that begins small and may grow until it touches. */
static tube tube_growing(rng *r, double most) {
  tube t = tube_random(r, rng_in_cube(r, 1.5), 0.7, 0.0);
  cprox_curve_free(t.radius);
  t.radius_degree = 3;
  for (int i = 0; i < 4; i++) t.radii[i] = vec(rng_uniform(r, 0.0, 0.02 + most * i), rng_uniform(r, -1.0, 1.0), 0.0);
  assert_int_equal(curve_from(describe_bezier(t.radii, 4, 0.0, 2.0), ws, &t.radius), CPROX_OK);
  return t;
}

/* Seed 7, 200 cases: meshes and clouds of 40 triangles and 120 points; the distance less the radius in long double at
 * 100 parameters and at the reported one. Tolerances as above. */
CASE(meshes_and_clouds_are_as_far_as_brute_force_says) {
  rng r = rng_seed(7);
  const size_t cases = test_cases(200);
  int apart = 0;
  for (size_t k = 0; k < cases; k++) {
    tube t = tube_growing(&r, 0.03);
    soup b = soup_random(&r, k % 2);
    cprox_options options = accurate(rng_log_uniform(&r, 1e-9, 1e-3));
    cprox_result found;
    assert_int_equal(cprox_distance(mover_of(&t, 0.01), cprox_obstacle_at(b.body, b.pose), &options, ws, &found),
                     CPROX_OK);
    assert_true(found.upper - found.lower <= options.epsilon);
    for (int i = 0; i <= 100; i++) {
      const long double s = i < 100 ? 0.01L * i : 0.5L * (long double)found.t;
      const long double value = fmaxl(soup_distance(&b, tube_point(&t, s)) - tube_radius(&t, s) - 0.01L, 0.0L);
      assert_true((long double)found.lower <= value + 1e-13L);
      if (i == 100) assert_true(fabsl(value - (long double)found.upper) <= 1e-11L);
    }
    if (found.upper > 0.0)
      assert_true(fabs(vec_norm(vec_sub(found.witness_mover, found.witness_obstacle)) - found.upper) <= 1e-10);
    apart += found.lower > 0.0;
    cprox_body_free(b.body);
    tube_free(&t);
  }
  assert_true(apart > 0);
}

/* Seed 8, 100 cases: a ball that grows past a curve that stands, held against 400 by 400 pairs of points. */
CASE(curves_that_stand_are_as_far_as_brute_force_says) {
  rng r = rng_seed(8);
  const size_t cases = test_cases(100);
  int apart = 0;
  for (size_t k = 0; k < cases; k++) {
    tube t = tube_growing(&r, 0.05), other = tube_random(&r, vec(0, 0, 0), 0.7, 0.1);
    cprox_obstacle target = cprox_obstacle_curve(other.curve, 0.02);
    target.pose = rng_pose(&r, 1.0);
    cprox_options options = accurate(rng_log_uniform(&r, 1e-9, 1e-3));
    cprox_result found;
    assert_int_equal(cprox_distance(mover_of(&t, 0.01), target, &options, ws, &found), CPROX_OK);
    vec3 point[GRID + 1];
    for (int i = 0; i <= GRID; i++) {
      const vec3l p = ref_to_world(&target.pose, tube_point(&other, (long double)i / GRID));
      point[i] = vec((double)p.x, (double)p.y, (double)p.z);
    }
    double least = INFINITY;
    for (int i = 0; i <= GRID; i++) {
      const vec3l p = tube_point(&t, (long double)i / GRID);
      const vec3 at = vec((double)p.x, (double)p.y, (double)p.z);
      const double radii = 0.03 + (double)tube_radius(&t, (long double)i / GRID);
      for (int j = 0; j <= GRID; j++) least = fmin(least, vec_norm(vec_sub(at, point[j])) - radii);
    }
    assert_true(found.lower <= fmax(least, 0.0) + 1e-12);
    const long double s = 0.5L * (long double)found.t, u = 0.5L * (long double)found.t_obstacle;
    const long double between = ref_norm(ref_sub(tube_point(&t, s), ref_to_world(&target.pose, tube_point(&other, u))));
    assert_true(fabsl(fmaxl(between - tube_radius(&t, s) - 0.03L, 0.0L) - (long double)found.upper) <= 1e-11L);
    apart += found.lower > 0.0;
    tube_free(&t);
    tube_free(&other);
  }
  assert_true(apart > 0);
}

/* A ball that stands, known by its distance alone. */
static double distance_to_ball(const void *shape, const double p[3]) {
  return vec_norm(vec(p[0], p[1], p[2])) - *(const double *)shape;
}

/* Seed 9, 60 cases: the same ball by a distance function and as a convex body. */
CASE(a_set_known_by_its_distance_is_as_far_as_the_body) {
  rng r = rng_seed(9);
  const double radius = 0.4;
  cprox_body *by_function = NULL, *ball = NULL;
  assert_int_equal(cprox_body_create_distance(distance_to_ball, &radius, vec(0, 0, 0), 0.4, 1.0, 0.0, ws, &by_function),
                   CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.4, ws, &ball), CPROX_OK);
  for (size_t k = 0; k < test_cases(60); k++) {
    tube t = tube_growing(&r, 0.05);
    const cprox_pose pose = rng_pose(&r, 1.0);
    cprox_options options = accurate(1e-6);
    cprox_result a, b;
    assert_int_equal(cprox_distance(mover_of(&t, 0.0), cprox_obstacle_at(by_function, pose), &options, ws, &a),
                     CPROX_OK);
    assert_int_equal(cprox_distance(mover_of(&t, 0.0), cprox_obstacle_at(ball, pose), &options, ws, &b), CPROX_OK);
    assert_true(a.lower <= b.upper + 1e-12 && b.lower <= a.upper + 1e-12);
    tube_free(&t);
  }
  cprox_body_free(by_function);
  cprox_body_free(ball);
}

/* ---- time of contact ---- */

/* Seed 10, 400 cases: against a body, a mesh, a cloud, a curve. Nothing touches before the time that is proven free:
 * brute force at 300 parameters. A contact that is reported is one. Balls that touch deeply are never called clear. */
CASE(contact_of_a_growing_ball_is_never_late) {
  rng r = rng_seed(10);
  const size_t cases = test_cases(400);
  int met = 0, clear = 0;
  for (size_t k = 0; k < cases; k++) {
    tube t = tube_growing(&r, 0.1), other = tube_random(&r, vec(0, 0, 0), 0.7, 0.1);
    standing convex = standing_random(&r, 1.0);
    soup set = soup_random(&r, k % 4 == 1);
    const int kind = (int)(k % 4); /* a mesh, a cloud, a body, a curve */
    cprox_obstacle target = kind == 2   ? cprox_obstacle_at(convex.body, convex.pose)
                            : kind == 3 ? cprox_obstacle_curve(other.curve, 0.0)
                                        : cprox_obstacle_at(set.body, set.pose);
    if (kind == 3) target.pose = set.pose;
    vec3l point[GRID + 1];
    for (int j = 0; kind == 3 && j <= GRID; j++)
      point[j] = ref_to_world(&target.pose, tube_point(&other, (long double)j / GRID));
    cprox_options options = accurate(1e-6);
    cprox_result found;
    assert_int_equal(cprox_time_of_contact(mover_of(&t, 0.005), target, &options, ws, &found), CPROX_OK);
    long double deepest = INFINITY;
    for (int i = 0; i <= 300; i++) {
      const long double s = i < 300 ? i / 299.0L : 0.5L * (long double)found.t;
      if (isnan(s)) continue;
      const vec3l p = tube_point(&t, s);
      long double apart = INFINITY;
      for (int j = 0; kind == 3 && j <= GRID; j++) apart = fminl(apart, ref_norm(ref_sub(p, point[j])));
      if (kind == 2) apart = standing_distance(&convex, p);
      if (kind < 2) apart = soup_distance(&set, p);
      const long double value = apart - tube_radius(&t, s) - 0.005L;
      if (i < 300 && 2.0L * s < (long double)found.t_contact_lower) assert_true(value > -1e-12L);
      deepest = fminl(deepest, value);
      if (i == 300 && found.verdict == CPROX_VERDICT_VIOLATED && kind != 3) assert_true(value <= 1e-12L);
    }
    if (deepest < -1e-3L) assert_int_equal(found.verdict, CPROX_VERDICT_VIOLATED);
    if (found.verdict == CPROX_VERDICT_CLEAR) assert_true(deepest > 0.0L);
    met += found.verdict == CPROX_VERDICT_VIOLATED, clear += found.verdict == CPROX_VERDICT_CLEAR;
    cprox_body_free(convex.body);
    cprox_body_free(set.body);
    tube_free(&t);
    tube_free(&other);
  }
  assert_true(met > 0 && clear > 0);
}

/* A ball of radius t at the origin, and one that stands 2 m away: contact at t = 2 - 0.25, in closed form. */
CASE(a_ball_that_grows_in_place_touches_when_it_is_large_enough) {
  const vec3 stands[2] = {{0, 0, 0}, {0, 0, 0}}, grows[2] = {{0, 0, 0}, {4, 0, 0}};
  cprox_curve *curve = NULL, *radius = NULL;
  cprox_body *ball = NULL;
  assert_int_equal(curve_from(describe_bezier(stands, 2, 0.0, 4.0), ws, &curve), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(grows, 2, 0.0, 4.0), ws, &radius), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.25, ws, &ball), CPROX_OK);
  cprox_mover mover = cprox_point_along(curve);
  mover.radius_curve = radius;
  const cprox_obstacle target = cprox_obstacle_at(ball, (cprox_pose){{2, 0, 0}, {1, 0, 0, 0}});
  cprox_result found;
  assert_int_equal(cprox_time_of_contact(mover, target, NULL, ws, &found), CPROX_OK);
  assert_int_equal(found.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(found.t_contact_lower <= 1.75 && found.t_contact_lower >= 1.75 - 2e-6);
  assert_true(found.t >= 1.75 - 1e-12 && found.t <= 1.75 + 1e-9);
  cprox_body_free(ball);
  cprox_curve_free(curve);
  cprox_curve_free(radius);
}

/* ---- depths, sets, gradients ---- */

/* Seed 11, 200 cases: a ball that passes through a ball: |x| - r - R in long double, above 0 or below. */
CASE(signed_distances_know_the_radius) {
  rng r = rng_seed(11);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.4, ws, &ball), CPROX_OK);
  int deep = 0;
  for (size_t k = 0; k < test_cases(200); k++) {
    tube t = tube_growing(&r, 0.1);
    const cprox_pose pose = rng_pose(&r, 1.0);
    cprox_options options = accurate(1e-9);
    options.signed_distance = true;
    cprox_result found;
    assert_int_equal(cprox_distance(mover_of(&t, 0.0), cprox_obstacle_at(ball, pose), &options, ws, &found), CPROX_OK);
    assert_true(found.upper - found.lower <= options.epsilon);
    for (int i = 0; i <= 100; i++) {
      const long double s = i < 100 ? 0.01L * i : 0.5L * (long double)found.t;
      const long double value = ref_norm(ref_to_local(&pose, tube_point(&t, s))) - tube_radius(&t, s) - 0.4L;
      assert_true((long double)found.lower <= value + 1e-13L);
      if (i == 100) assert_true(fabsl(value - (long double)found.upper) <= 1e-11L);
    }
    deep += found.upper < 0.0;
    tube_free(&t);
  }
  assert_true(deep > 0);
  cprox_body_free(ball);
}

/* Seed 12, 60 cases: sets with a BVH of 30 bodies, one of them on the clock, answer as lists do. */
CASE(sets_with_a_bvh_answer_as_lists_do) {
  enum { BODIES = 30 };
  rng r = rng_seed(12);
  for (size_t k = 0; k < test_cases(60); k++) {
    tube t = tube_growing(&r, 0.05), clock = tube_random(&r, vec(2, 0, 0), 0.7, 0.1);
    standing b[BODIES];
    cprox_obstacle list[BODIES + 1];
    for (int i = 0; i < BODIES; i++) {
      b[i] = standing_random(&r, 0.4);
      b[i].pose.position = rng_in_cube(&r, 3.0);
      list[i] = cprox_obstacle_at(b[i].body, b[i].pose);
    }
    list[BODIES] = cprox_synchronized(mover_of(&clock, 0.01));
    cprox_obstacles *set = NULL, *plain = NULL;
    assert_int_equal(cprox_obstacles_create(list, BODIES + 1, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
    assert_int_equal(cprox_obstacles_create(list, BODIES + 1, CPROX_INDEX_NONE, ws, &plain), CPROX_OK);
    cprox_options options = accurate(1e-9);
    cprox_result a, c;
    assert_int_equal(cprox_obstacles_distance(set, mover_of(&t, 0.0), &options, ws, &a, NULL), CPROX_OK);
    assert_int_equal(cprox_obstacles_distance(plain, mover_of(&t, 0.0), &options, ws, &c, NULL), CPROX_OK);
    assert_true(fabs(a.upper - c.upper) <= 2e-9);
    cprox_obstacles_free(set);
    cprox_obstacles_free(plain);
    for (int i = 0; i < BODIES; i++) cprox_body_free(b[i].body);
    tube_free(&t);
    tube_free(&clock);
  }
}

/* Seed 13, 200 cases: the gradient by the obstacle's position is the central difference of distances that are known to
 * 1e-12, at steps of 1e-5: 1e-4 is what the third derivatives and the division leave; bodies, meshes, curves. */
CASE(gradients_are_differences_of_distances) {
  static const double STEP = 1e-5;
  rng r = rng_seed(13);
  int valid = 0;
  for (size_t k = 0; k < test_cases(200); k++) {
    tube t = tube_growing(&r, 0.03), other = tube_random(&r, vec(0, 0, 0), 0.7, 0.1);
    standing convex = standing_random(&r, 1.0);
    soup set = soup_random(&r, false);
    cprox_obstacle target = k % 3 == 0   ? cprox_obstacle_at(convex.body, convex.pose)
                            : k % 3 == 1 ? cprox_obstacle_at(set.body, set.pose)
                                         : cprox_obstacle_curve(other.curve, 0.01);
    if (k % 3 == 2) target.pose = set.pose;
    cprox_options options = accurate(1e-12);
    cprox_result found;
    cprox_gradient gradient;
    assert_true(cprox_distance(mover_of(&t, 0.0), target, &options, ws, &found) >= 0);
    assert_int_equal(cprox_distance_gradient(mover_of(&t, 0.0), target, &options, &found, ws, &gradient), CPROX_OK);
    if (gradient.valid && found.lower > 0.01) {
      const double own[3] = {gradient.position.x, gradient.position.y, gradient.position.z};
      for (int i = 0; i < 3; i++) {
        cprox_result moved[2];
        for (int side = 0; side < 2; side++) {
          cprox_obstacle there = target;
          const double d = side ? STEP : -STEP;
          there.pose.position = vec_add(there.pose.position, vec(i == 0 ? d : 0.0, i == 1 ? d : 0.0, i == 2 ? d : 0.0));
          assert_true(cprox_distance(mover_of(&t, 0.0), there, &options, ws, &moved[side]) >= 0);
        }
        const double difference = (moved[1].upper - moved[0].upper) / (2.0 * STEP);
        assert_true(fabs(difference - own[i]) <= 1e-3);
      }
      valid++;
    }
    cprox_body_free(convex.body);
    cprox_body_free(set.body);
    tube_free(&t);
    tube_free(&other);
  }
  assert_true(valid > 0);
}

static void assert_refused(cprox_status status, const char *why) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), why)) fail_msg("%s", cprox_workspace_error(ws));
}

CASE(what_has_no_answer_is_refused_in_a_line) {
  rng r = rng_seed(5);
  tube t = tube_random(&r, vec(0, 0, 0), 1.0, 0.1);
  const vec3 dips[4] = {{0.1, 0, 0}, {-0.3, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}};
  cprox_curve *negative = NULL, *elsewhere = NULL;
  cprox_body *ball = NULL;
  assert_int_equal(curve_from(describe_bezier(dips, 4, 0.0, 2.0), ws, &negative), CPROX_OK);
  assert_int_equal(curve_from(describe_bezier(t.radii, 3, 0.0, 1.0), ws, &elsewhere), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);
  cprox_mover mover = mover_of(&t, 0.0);
  cprox_result found;
  mover.radius_curve = negative;
  assert_refused(cprox_distance(mover, target, NULL, ws, &found), "the mover's radius is -0.");
  mover.radius = 0.2; /* and the sum is not negative */
  assert_int_equal(cprox_distance(mover, target, NULL, ws, &found), CPROX_OK);
  mover.radius_curve = elsewhere;
  assert_refused(cprox_distance(mover, target, NULL, ws, &found), "runs over [0, 1], and the curve over [0, 2]");
  mover.radius_curve = t.radius;
  cprox_certificate *certificate = cprox_certificate_create();
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.certificate = certificate;
  assert_int_equal(cprox_distance(mover, target, &options, ws, &found), CPROX_OK);
  assert_true(cprox_certificate_get_info(certificate).size > 0);
  cprox_certificate_free(certificate);
  cprox_obstacle stands = target;
  stands.radius_curve = t.radius;
  assert_refused(cprox_distance(mover, stands, NULL, ws, &found), "is not synchronized");
  cprox_body_free(ball);
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
