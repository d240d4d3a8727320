/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies carried along curves, against bodies, compounds and curves: intervals, verdicts, witnesses, cost. Polyhedra
 * are held against the hull of all differences of vertices in long double; the other kinds against static pairs at many
 * parameters, which know nothing of curves. */
#include <stdlib.h>

#include "base/rounding.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

static cprox_curve *random_bezier(rng *r, size_t degree, vec3 middle, double size, vec3 *points) {
  for (size_t i = 0; i <= degree; i++) points[i] = vec_add(middle, rng_in_cube(r, size));
  return bezier(points, degree + 1);
}

static cprox_body *polytope(const vec3 *v, size_t n) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polytope(v, n, ws, &body), CPROX_OK);
  return body;
}

/* ---- polyhedra, in long double ---- */

enum { MOST_DIFFERENCES = 16 };

static long double volume(vec3l a, vec3l b, vec3l c) {
  return ref_dot(a, ref_cross(b, c));
}

static bool encloses(const vec3l *v) {
  const long double whole = volume(ref_sub(v[0], v[3]), ref_sub(v[1], v[3]), ref_sub(v[2], v[3]));
  if (whole == 0.0L) return false;
  for (int i = 0; i < 4; i++) {
    vec3l w[4] = {v[0], v[1], v[2], v[3]};
    w[i] = (vec3l){0, 0, 0};
    if (volume(ref_sub(w[0], w[3]), ref_sub(w[1], w[3]), ref_sub(w[2], w[3])) / whole < 0.0L) return false;
  }
  return true;
}

/* The distance of 0 from the hull of v: all triangles, unless a tetrahedron encloses it. */
static long double distance_of_hull(const vec3l *v, size_t n) {
  const vec3l origin = {0, 0, 0};
  if (n == 1) return ref_norm(v[0]);
  if (n == 2) return ref_point_segment(origin, v[0], v[1]);
  long double nearest = HUGE_VALL;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      for (size_t k = j + 1; k < n; k++) {
        nearest = fminl(nearest, ref_point_triangle(origin, v[i], v[j], v[k]));
        for (size_t l = k + 1; l < n; l++)
          if (encloses((vec3l[]){v[i], v[j], v[k], v[l]})) return 0.0L;
      }
  return nearest;
}

/* Every case is a curve in a cube of the scale, carrying at most 4 vertices past a posed hull of at most 4. The world
 * is `away` from the origin, on a grid on which differences are exact. */
typedef struct polyhedra {
  size_t degree, n_carried, n_standing;
  vec3 points[8], carried[4], standing[4];
  cprox_pose pose;
  double radius, margin, scale;
} polyhedra;

static polyhedra polyhedra_random(rng *r) {
  polyhedra p = {.degree = 1 + rng_index(r, 6), .n_carried = 1 + rng_index(r, 4), .n_standing = 1 + rng_index(r, 4)};
  p.scale = rng_log_uniform(r, 1e-6, 1e6);
  const double far = rng_index(r, 2) ? 0.0 : p.scale * rng_log_uniform(r, 1.0, 1e6);
  const double step = ldexp(1.0, ilogb(p.scale + far) - 48);
  const vec3 away = rng_in_cube(r, far);
  for (size_t i = 0; i <= p.degree; i++) p.points[i] = vec_add(away, rng_in_cube(r, 2.0 * p.scale));
  const double size = p.scale * rng_log_uniform(r, 1e-3, 1.0), other = p.scale * rng_log_uniform(r, 1e-3, 1.0);
  const vec3 offset = rng_index(r, 2) ? vec(0, 0, 0) : rng_in_cube(r, p.scale);
  for (size_t i = 0; i < p.n_carried; i++) p.carried[i] = vec_add(offset, rng_in_cube(r, size));
  for (size_t i = 0; i < p.n_standing; i++) p.standing[i] = rng_in_cube(r, other);
  p.pose = rng_pose(r, 2.0 * p.scale);
  if (rng_index(r, 4) == 0) p.pose.orientation = (cprox_quat){1, 0, 0, 0};
  p.pose.position = vec_add(p.pose.position, away);
  vec3 *grid[] = {&p.pose.position, p.points,     p.points + 1, p.points + 2,
                  p.points + 3,     p.points + 4, p.points + 5, p.points + 6};
  for (size_t i = 0; i <= p.degree + 1; i++) {
    vec3 *g = grid[i];
    *g = vec(step * nearbyint(g->x / step), step * nearbyint(g->y / step), step * nearbyint(g->z / step));
  }
  p.radius = rng_index(r, 2) ? 0.0 : 0.1 * size;
  p.margin = rng_index(r, 2) ? 0.0 : 0.1 * other;
  return p;
}

static long double polyhedra_distance(const polyhedra *p, double t) {
  vec3 near[8];
  for (size_t i = 0; i <= p->degree; i++) near[i] = vec_sub(p->points[i], p->pose.position);
  const vec3l at = ref_bezier(near, p->degree, t, 0);
  vec3l v[MOST_DIFFERENCES];
  size_t n = 0;
  for (size_t i = 0; i < p->n_carried; i++)
    for (size_t j = 0; j < p->n_standing; j++)
      v[n++] = ref_sub(ref_add(at, ref_vec(p->carried[i])), pose_turn(&p->pose, ref_vec(p->standing[j])));
  return distance_of_hull(v, n) - (long double)p->radius - (long double)p->margin;
}

/* Seed 31, 300 cases, 12 parameters and the reported one each: exact but for long double, 1e-3 u of all sizes. */
CASE(intervals_of_carried_polytopes_contain_the_distance_in_long_double) {
  rng r = rng_seed(31);
  const size_t cases = test_cases(300);
  for (size_t k = 0; k < cases; k++) {
    const polyhedra p = polyhedra_random(&r);
    cprox_curve *curve = bezier(p.points, p.degree + 1);
    cprox_body *carried = polytope(p.carried, p.n_carried), *standing = polytope(p.standing, p.n_standing);
    cprox_mover mover = cprox_body_along(carried, curve);
    mover.radius = p.radius;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = p.scale * rng_log_uniform(&r, 1e-12, 1e-3);
    cprox_result result;
    const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(standing, p.pose), p.margin);
    const cprox_status status = cprox_distance(mover, target, &options, ws, &result);
    assert_in_range(status, CPROX_OK, CPROX_PRECISION);
    if (status == CPROX_OK) assert_true(result.upper - result.lower <= options.epsilon);
    const long double hair = 1e-3L * ROUND_U * 10.0L * (long double)p.scale;
    const long double here = polyhedra_distance(&p, result.t);
    assert_true((long double)result.upper >= fmaxl(here, 0.0L) - hair);
    assert_true((long double)result.upper <= fmaxl(here, 0.0L) + 1e-9L * (long double)p.scale);
    for (int i = 0; i < 12; i++) {
      const double t =
          i < 6 ? rng_uniform(&r, 0.0, 1.0) : fmin(fmax(result.t + 1e-3 * rng_uniform(&r, -1.0, 1.0), 0.0), 1.0);
      assert_true((long double)result.lower <= fmaxl(polyhedra_distance(&p, t), 0.0L) + hair);
    }
    cprox_body_free(carried);
    cprox_body_free(standing);
    cprox_curve_free(curve);
  }
}

/* ---- every kind, against static pairs ---- */

/* The pair at parameter t; its lower bound is on minus the depth where they overlap. */
static cprox_result pair_at(const cprox_mover *mover, const cprox_obstacle *target, double t) {
  cprox_obstacle moved = {.body = mover->body, .margin = mover->radius};
  moved.pose = CPROX_POSE_IDENTITY;
  assert_int_equal(cprox_curve_evaluate(mover->curve, t, ws, &moved.pose.position, NULL, NULL), CPROX_OK);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 0.0;
  cprox_result result;
  assert_true(cprox_pair(moved, *target, &options, ws, &result) >= 0);
  return result;
}

static void assert_agrees_with_pairs(rng *r, const cprox_mover *mover, const cprox_obstacle *target,
                                     const cprox_result *result, double hair) {
  for (int i = 0; i < 24; i++) {
    const double t =
        i < 12 ? rng_uniform(r, 0.0, 1.0) : fmin(fmax(result->t + 0.01 * rng_uniform(r, -1.0, 1.0), 0.0), 1.0);
    assert_true(result->lower <= fmax(pair_at(mover, target, t).upper, 0.0) + hair);
  }
  const cprox_result here = pair_at(mover, target, result->t);
  assert_true(result->upper >= here.lower - hair);
  assert_true(fmax(result->upper, 0.0) <= fmax(here.upper, 0.0) + 1e-8 * (1.0 + fabs(here.upper)));
}

/* The distance of a world point from a placed body, by the public evaluation. */
static double distance_from(const cprox_body *body, const cprox_pose *pose, vec3 p) {
  const vec3l local = ref_to_local(pose, ref_vec(p));
  return cprox_body_nearest(body, vec((double)local.x, (double)local.y, (double)local.z), NULL);
}

/* Seed 32: all pairs of bounded kinds, the halfspace too as what stands, 6 cases each; unit sizes, so that 1e-13 is a
 * thousand u. */
CASE(every_kind_is_carried_past_every_kind) {
  rng r = rng_seed(32);
  const size_t cases = test_cases(6);
  for (int a = 0; a < TEST_N_BOUNDED; a++)
    for (int b = 0; b <= TEST_N_BOUNDED; b++)
      for (size_t k = 0; k < cases; k++) {
        test_shape carried, standing;
        cprox_body *halfspace = NULL;
        shape_make(&r, TEST_BOUNDED[a], 0.3, 10.0, &carried);
        shape_make(&r, TEST_BOUNDED[b % TEST_N_BOUNDED], 0.6, 10.0, &standing);
        if (b == TEST_N_BOUNDED)
          assert_int_equal(cprox_body_create_halfspace(rng_unit(&r), rng_uniform(&r, 0.0, 1.0), ws, &halfspace),
                           CPROX_OK);
        vec3 points[8];
        cprox_curve *curve = random_bezier(&r, 1 + rng_index(&r, 6), rng_in_cube(&r, 1.0), 1.0, points);
        cprox_mover mover = cprox_body_along(carried.body, curve);
        mover.radius = rng_index(&r, 2) ? 0.0 : 0.05;
        cprox_pose pose = rng_pose(&r, 1.0);
        if (rng_index(&r, 3) == 0) pose.orientation = (cprox_quat){1, 0, 0, 0};
        const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(halfspace ? halfspace : standing.body, pose),
                                                        rng_index(&r, 2) ? 0.0 : 0.1);
        cprox_options options = CPROX_OPTIONS_DEFAULT;
        options.epsilon = 1e-9;
        cprox_result result, verdict;
        const cprox_status status = cprox_distance(mover, target, &options, ws, &result);
        assert_in_range(status, CPROX_OK, CPROX_PRECISION);
        assert_agrees_with_pairs(&r, &mover, &target, &result, 1e-13);

        /* witnesses lie on what they are said to lie on, and as far apart as they should */
        vec3 at;
        assert_int_equal(cprox_curve_evaluate(curve, result.t, ws, &at, NULL, NULL), CPROX_OK);
        const cprox_pose there = {.position = at, .orientation = {1, 0, 0, 0}};
        assert_true(distance_from(carried.body, &there, result.witness_mover) <= mover.radius + 1e-7);
        assert_true(distance_from(target.body, &pose, result.witness_obstacle) <= target.margin + 1e-7);
        const double apart = vec_norm(vec_sub(result.witness_mover, result.witness_obstacle));
        assert_true(fabs(apart - result.upper) <= 2e-7);

        /* verdicts agree */
        if (result.upper > 0.01) {
          assert_int_equal(cprox_tolerance(mover, target, 0.99 * result.lower, NULL, ws, &verdict), CPROX_OK);
          assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
          assert_int_equal(cprox_tolerance(mover, target, 1.01 * result.upper, NULL, ws, &verdict), CPROX_OK);
          assert_int_equal(verdict.verdict, CPROX_VERDICT_VIOLATED);
          assert_int_equal(cprox_collision(mover, target, NULL, ws, &verdict), CPROX_OK);
          assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
        }
        cprox_body_free(halfspace);
        cprox_body_free(carried.body);
        cprox_body_free(standing.body);
        cprox_curve_free(curve);
      }
}

/* Seed 33, 60 cases: compounds of three parts either way. */
CASE(compounds_are_carried_and_stand_as_the_nearest_of_their_parts) {
  rng r = rng_seed(33);
  const size_t cases = test_cases(60);
  for (size_t k = 0; k < cases; k++) {
    test_shape shape[3];
    const cprox_body *parts[3];
    cprox_pose poses[3];
    for (int i = 0; i < 3; i++) {
      shape_make(&r, TEST_BOUNDED[rng_index(&r, TEST_N_BOUNDED)], 0.3, 5.0, &shape[i]);
      parts[i] = shape[i].body;
      poses[i] = rng_pose(&r, 0.5);
    }
    cprox_body *compound = NULL;
    assert_int_equal(cprox_body_create_compound(parts, poses, 3, ws, &compound), CPROX_OK);
    vec3 points[8];
    cprox_curve *curve = random_bezier(&r, 4, rng_in_cube(&r, 2.0), 1.5, points);
    const cprox_mover mover = cprox_body_along(compound, curve);
    const cprox_obstacle target = cprox_obstacle_at(compound, rng_pose(&r, 2.0));
    cprox_result result;
    assert_int_equal(cprox_distance(mover, target, NULL, ws, &result), CPROX_OK);
    assert_agrees_with_pairs(&r, &mover, &target, &result, 1e-13);
    assert_in_range(result.mover_part, 0, 2);

    cprox_body_free(compound);
    for (int i = 0; i < 3; i++) cprox_body_free(shape[i].body);
    cprox_curve_free(curve);
  }
}

/* Seed 34, 10 kinds x 12 cases: a curve as the target, at its own parameter, 16 x 16 pairs of parameters and those
 * about the best. */
/* Seed 34, 20,000 cases: a part far out in a compound that stands as far out the other way, so that the two shifts
 * cancel and their rounding is most of the error. A ball carried past a ball, and a box past a box whose rotation is
 * undone: both have their distance from a segment in closed form. */
CASE(a_part_is_placed_by_two_poses_within_their_rounding) {
  rng r = rng_seed(34);
  double nearest = 0.0;
  for (int k = 0; k < 20000; k++) {
    const double far = rng_log_uniform(&r, 1.0, 1e9), carried_radius = rng_uniform(&r, 0.1, 0.3);
    const bool boxes = rng_index(&r, 2);
    cprox_pose inner = rng_pose(&r, far), outer = rng_pose(&r, 1.0);
    const double norm = rng_log_uniform(&r, 1e-3, 1e3);
    outer.orientation.w *= norm, outer.orientation.x *= norm, outer.orientation.y *= norm, outer.orientation.z *= norm;
    if (boxes) { /* the inverse of the outer rotation */
      inner.orientation = outer.orientation;
      inner.orientation.w = -inner.orientation.w;
    }
    const vec3l out = ref_to_world(&outer, ref_vec(inner.position));
    outer.position = vec_sub(outer.position, vec((double)out.x, (double)out.y, (double)out.z));
    const vec3l centre = ref_to_world(&outer, ref_vec(inner.position));
    const vec3 middle = vec((double)centre.x, (double)centre.y, (double)centre.z);
    const double size = rng_uniform(&r, 0.1, 0.3);
    cprox_body *part = NULL, *carried = NULL, *compound = NULL;
    if (boxes) {
      assert_int_equal(cprox_body_create_box(vec(2 * size, 2 * size, 2 * size), ws, &part), CPROX_OK);
      assert_int_equal(cprox_body_create_box(vec(0.5, 0.5, 0.5), ws, &carried), CPROX_OK);
    } else {
      assert_int_equal(cprox_body_create_sphere(size, ws, &part), CPROX_OK);
      assert_int_equal(cprox_body_create_sphere(carried_radius, ws, &carried), CPROX_OK);
    }
    assert_int_equal(cprox_body_create_compound((const cprox_body *const[]){part}, &inner, 1, ws, &compound), CPROX_OK);

    /* the boxes' faces look along x: the curve ends nearest to them */
    vec3 points[2] = {vec_add(middle, vec(rng_uniform(&r, 1, 2), 0, 0)),
                      vec_add(middle, vec(rng_uniform(&r, 2, 3), 0, 0))};
    if (!boxes) points[1] = vec_add(middle, vec_scale(3.0, rng_unit(&r)));
    cprox_curve *curve = bezier(points, 2);
    const long double apart =
        boxes ? (long double)points[0].x - centre.x : ref_point_segment(centre, ref_vec(points[0]), ref_vec(points[1]));
    const long double truth = apart - (long double)size - (boxes ? 0.25L : (long double)carried_radius);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 0.0;
    cprox_result x;
    assert_true(
        cprox_distance(cprox_body_along(carried, curve), cprox_obstacle_at(compound, outer), &options, ws, &x) >= 0);
    if (truth > 1e-3L) {
      const double scale = far + 3.0;
      assert_true(x.lower <= truth && truth <= x.upper && x.upper - x.lower <= 1e-12 * scale);
      nearest =
          fmax(nearest, fabs(0.5 * (x.lower + x.upper) - (double)truth) / fmax(0.5 * (x.upper - x.lower), 1e-300));
    }
    cprox_curve_free(curve);
    cprox_body_free(compound);
    cprox_body_free(carried);
    cprox_body_free(part);
  }
  print_message("largest error: %.3f of half the interval\n", nearest);
  assert_true(nearest > 0.05);
}

CASE(a_carried_body_is_measured_against_a_curve) {
  rng r = rng_seed(34);
  const size_t cases = test_cases(12);
  for (int kind = 0; kind < TEST_N_BOUNDED; kind++)
    for (size_t k = 0; k < cases; k++) {
      test_shape carried;
      shape_make(&r, TEST_BOUNDED[kind], 0.4, 10.0, &carried);
      vec3 points[8], others[8];
      cprox_curve *curve = random_bezier(&r, 1 + rng_index(&r, 5), rng_in_cube(&r, 1.0), 1.0, points);
      cprox_curve *other = random_bezier(&r, 1 + rng_index(&r, 5), vec(0, 0, 0), 1.0, others);
      const cprox_mover mover = cprox_body_along(carried.body, curve);
      cprox_obstacle target = cprox_obstacle_curve(other, rng_index(&r, 2) ? 0.0 : 0.05);
      if (rng_index(&r, 2)) target.pose = rng_pose(&r, 1.0);
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-7;
      cprox_result result;
      const cprox_status status = cprox_distance(mover, target, &options, ws, &result);
      assert_in_range(status, CPROX_OK, CPROX_PRECISION);
      for (int i = 0; i < 17; i++)
        for (int j = 0; j < 17; j++) {
          const bool best = i == 16 && j == 16;
          const double s = i < 16 ? rng_uniform(&r, 0, 1) : result.t,
                       t = j < 16 ? rng_uniform(&r, 0, 1) : result.t_obstacle;
          vec3 p, q;
          assert_int_equal(cprox_curve_evaluate(curve, s, ws, &p, NULL, NULL), CPROX_OK);
          assert_int_equal(cprox_curve_evaluate(other, t, ws, &q, NULL, NULL), CPROX_OK);
          const vec3l world = ref_to_world(&target.pose, ref_vec(q));
          const cprox_pose there = {.position = p, .orientation = {1, 0, 0, 0}};
          const double d = distance_from(carried.body, &there, vec((double)world.x, (double)world.y, (double)world.z)) -
                           target.margin;
          /* what a search for a nearest point leaves between its bounds on a callback */
          assert_true(result.lower <= fmax(d, 0.0) + 1e-9);
          if (best) assert_true(fabs(result.upper - fmax(d, 0.0)) <= 1e-8);
        }
      cprox_body_free(carried.body);
      cprox_curve_free(curve);
      cprox_curve_free(other);
    }
}

/* ---- arguments, memory, cost ---- */

CASE(an_unbounded_body_is_not_carried) {
  cprox_body *halfspace = NULL;
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0.0, ws, &halfspace), CPROX_OK);
  cprox_curve *curve = bezier((vec3[]){{0, 0, 0}, {1, 0, 0}}, 2);
  cprox_result result = {.lower = -7.0};
  const cprox_obstacle target = cprox_obstacle_at(halfspace, CPROX_POSE_IDENTITY);
  assert_int_equal(cprox_distance(cprox_body_along(halfspace, curve), target, NULL, ws, &result), CPROX_INVALID);
  assert_true(result.lower == -7.0);
  assert_string_equal(cprox_workspace_error(ws), "the mover's body is a halfspace or has one: it must be bounded");
  cprox_body_free(halfspace);
  cprox_curve_free(curve);
}

static int by_count(const void *a, const void *b) {
  return *(const uint32_t *)a < *(const uint32_t *)b ? -1 : *(const uint32_t *)a > *(const uint32_t *)b;
}

/* Seed 35, 200 problems a pair of kinds, quintics in the unit cube, epsilon 1e-9. No allocation once the first is
 * answered. */
CASE(medians_stay_within_8_nodes_and_14_distance_queries) {
  enum { PROBLEMS = 200 };
  rng r = rng_seed(35);
  const cprox_body_kind kinds[][2] = {{CPROX_BODY_BOX, CPROX_BODY_BOX},
                                      {CPROX_BODY_BOX, CPROX_BODY_CYLINDER},
                                      {CPROX_BODY_CAPSULE, CPROX_BODY_POLYTOPE},
                                      {CPROX_BODY_ELLIPSOID, CPROX_BODY_CONE}};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    uint32_t nodes[PROBLEMS], distance_queries[PROBLEMS];
    size_t n = 0, before = 0;
    while (n < PROBLEMS) {
      test_shape carried, standing;
      shape_make(&r, kinds[k][0], 0.2, 3.0, &carried);
      shape_make(&r, kinds[k][1], 0.3, 3.0, &standing);
      vec3 points[8];
      cprox_curve *curve = random_bezier(&r, 5, vec(0, 0, 0), 1.0, points);
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-9;
      cprox_result result;
      before = allocations_made();
      assert_int_equal(cprox_distance(cprox_body_along(carried.body, curve),
                                      cprox_obstacle_at(standing.body, rng_pose(&r, 1.5)), &options, ws, &result),
                       CPROX_OK);
      if (n > PROBLEMS / 2) assert_int_equal(allocations_made(), before);
      if (result.upper > 0.0) {
        nodes[n] = result.nodes;
        distance_queries[n++] = result.distance_queries;
      }
      cprox_body_free(carried.body);
      cprox_body_free(standing.body);
      cprox_curve_free(curve);
    }
    qsort(nodes, PROBLEMS, sizeof *nodes, by_count);
    qsort(distance_queries, PROBLEMS, sizeof *distance_queries, by_count);
    print_message("%s past %s: median %u nodes, %u distance queries; 95 %%: %u, %u; most: %u, %u\n",
                  cprox_body_kind_name(kinds[k][0]), cprox_body_kind_name(kinds[k][1]), nodes[PROBLEMS / 2],
                  distance_queries[PROBLEMS / 2], nodes[PROBLEMS * 19 / 20], distance_queries[PROBLEMS * 19 / 20],
                  nodes[PROBLEMS - 1], distance_queries[PROBLEMS - 1]);
    assert_true(nodes[PROBLEMS / 2] <= 8);
    assert_true(distance_queries[PROBLEMS / 2] <= 14);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
