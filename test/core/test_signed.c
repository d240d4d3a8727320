/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distance along curves: minus the deepest overlap. Boxes, capsules and hulls are held against closed forms and
 * planes in long double; every kind, carried or not, against static pairs at many parameters, whose depth test_depth
 * holds against long double. */
#include <stdlib.h>

#include "base/rounding.h"
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

static cprox_options asked(double epsilon) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  options.signed_distance = true;
  return options;
}

/* ---- long double ---- */

static long double signed_box(vec3l p, vec3 half) {
  const long double x = fabsl(p.x) - half.x, y = fabsl(p.y) - half.y, z = fabsl(p.z) - half.z;
  const long double inside = fmaxl(x, fmaxl(y, z));
  return inside < 0 ? inside : ref_point_box(p, half);
}

/* Inside: the nearest of the planes through three vertices that have all the others on one side. */
static long double signed_hull(vec3l p, const vec3 *v, size_t n) {
  const long double outside = ref_point_hull(p, v, n);
  if (outside > 0) return outside;
  long double depth = HUGE_VALL;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      for (size_t k = j + 1; k < n; k++) {
        const vec3l a = ref_vec(v[i]), normal = ref_cross(ref_sub(ref_vec(v[j]), a), ref_sub(ref_vec(v[k]), a));
        long double least = HUGE_VALL, most = -HUGE_VALL;
        for (size_t m = 0; m < n; m++) {
          if (m == i || m == j || m == k) continue;
          const long double h = ref_dot(normal, ref_sub(ref_vec(v[m]), a));
          least = fminl(least, h), most = fmaxl(most, h);
        }
        if (least < 0 && most > 0) continue;
        depth = fminl(depth, fabsl(ref_dot(normal, ref_sub(p, a))) / ref_norm(normal));
      }
  return -depth;
}

typedef struct problem {
  int kind; /* box, capsule, hull */
  size_t n;
  vec3 half, v[6];
  cprox_pose pose;
  cprox_body *body;
} problem;

static problem problem_random(rng *r) {
  problem p = {.kind = (int)rng_index(r, 3), .n = 4 + rng_index(r, 3), .pose = rng_pose(r, 0.3)};
  p.half = vec(rng_uniform(r, 0.1, 1), rng_uniform(r, 0.1, 1), rng_uniform(r, 0.1, 1));
  for (size_t i = 0; i < p.n; i++) p.v[i] = rng_in_cube(r, 1.0);
  if (p.kind == 0) assert_int_equal(cprox_body_create_box(vec_scale(2.0, p.half), ws, &p.body), CPROX_OK);
  if (p.kind == 1) assert_int_equal(cprox_body_create_capsule(2.0 * p.half.z, p.half.x, ws, &p.body), CPROX_OK);
  if (p.kind == 2) assert_int_equal(cprox_body_create_polytope(p.v, p.n, ws, &p.body), CPROX_OK);
  return p;
}

static long double truth(const problem *p, vec3l world) {
  const vec3l y = ref_to_local(&p->pose, world);
  if (p->kind == 0) return signed_box(y, p->half);
  if (p->kind == 2) return signed_hull(y, p->v, p->n);
  return ref_point_segment(y, (vec3l){0, 0, -p->half.z}, (vec3l){0, 0, p->half.z}) - (long double)p->half.x;
}

/* Seed 91, 1500 curves of degree 1 to 7 through and about unit bodies; 30 parameters and the reported one. Tolerance:
 * 1e-17, long double's own. */
CASE(the_interval_contains_minus_the_deepest_overlap) {
  rng r = rng_seed(91);
  size_t deep = 0;
  for (size_t k = 0; k < test_cases(1500); k++) {
    problem p = problem_random(&r);
    vec3 points[8];
    const size_t degree = 1 + rng_index(&r, 7);
    for (size_t i = 0; i <= degree; i++) points[i] = rng_in_cube(&r, 1.5);
    cprox_curve *curve = bezier(points, degree + 1);
    const double radius = rng_index(&r, 2) ? 0.0 : 0.1, margin = rng_index(&r, 2) ? 0.0 : 0.05;
    const cprox_options options = asked(rng_log_uniform(&r, 1e-12, 1e-3));
    cprox_result result;
    const cprox_status status =
        cprox_distance(cprox_tube_along(curve, radius), cprox_with_margin(cprox_obstacle_at(p.body, p.pose), margin),
                       &options, ws, &result);
    assert_int_equal(status, CPROX_OK);
    assert_true(result.upper - result.lower <= options.epsilon);
    const long double offset = (long double)radius + (long double)margin, hair = 1e-17L;
    const long double here = truth(&p, ref_bezier(points, degree, result.t, 0)) - offset;
    assert_true((long double)result.upper >= here - hair);
    assert_true((long double)result.upper <= here + 1e-12L + (long double)options.epsilon);
    for (int i = 0; i < 30; i++) {
      const double t = i < 15 ? rng_uniform(&r, 0, 1) : fmin(fmax(result.t + 1e-2 * rng_uniform(&r, -1, 1), 0.0), 1.0);
      assert_true((long double)result.lower <= truth(&p, ref_bezier(points, degree, t, 0)) - offset + hair);
    }
    /* the two ends of the way out */
    const vec3 out = vec_sub(result.witness_mover, result.witness_obstacle);
    assert_true(fabs(vec_norm(out) - fabs(result.upper)) < 1e-9 + options.epsilon);
    if (result.upper < -1e-6) {
      assert_true(vec_dot(out, result.normal) < 0.0);
      deep++;
    }
    cprox_body_free(p.body);
    cprox_curve_free(curve);
  }
  assert_true(deep > 300 || test_cases(100) < 100);
}

/* ---- every kind ---- */

static cprox_result pair_at(const cprox_mover *mover, const cprox_obstacle *target, double t) {
  cprox_body *point = NULL;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
  cprox_obstacle moved = {.body = mover->body ? mover->body : point, .margin = mover->radius};
  moved.pose = CPROX_POSE_IDENTITY;
  assert_int_equal(cprox_curve_evaluate(mover->curve, t, ws, &moved.pose.position, NULL, NULL), CPROX_OK);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  cprox_result result;
  assert_true(cprox_pair(moved, *target, &options, ws, &result) >= 0);
  cprox_body_free(point);
  return result;
}

/* Seed 92: all pairs of bounded kinds, the first carried; and each kind by itself against points; 4 cases each, through
 * one another. */
CASE(every_kind_knows_how_deep_it_goes) {
  rng r = rng_seed(92);
  size_t asked_for = 0, open = 0, deep = 0;
  for (int a = -1; a < TEST_N_BOUNDED; a++)
    for (int b = 0; b < TEST_N_BOUNDED; b++)
      for (size_t k = 0; k < test_cases(4); k++) {
        test_shape carried = {0}, standing;
        if (a >= 0) shape_make(&r, TEST_BOUNDED[a], 0.5, 4.0, &carried);
        shape_make(&r, TEST_BOUNDED[b], 0.8, 4.0, &standing);
        vec3 points[6];
        const size_t degree = 1 + rng_index(&r, 5);
        for (size_t i = 0; i <= degree; i++) points[i] = rng_in_cube(&r, 1.0);
        cprox_curve *curve = bezier(points, degree + 1);
        const cprox_mover mover = carried.body ? cprox_body_along(carried.body, curve) : cprox_point_along(curve);
        const cprox_obstacle target = cprox_obstacle_at(standing.body, rng_pose(&r, 0.3));
        const cprox_options options = asked(1e-7);
        cprox_result result;
        const cprox_status status = cprox_distance(mover, target, &options, ws, &result);
        assert_in_range(status, CPROX_OK, CPROX_PRECISION);
        asked_for++;
        open += status != CPROX_OK;
        deep += result.upper < 0.0;
        for (int i = 0; i < 16; i++) {
          const double t =
              i < 8 ? rng_uniform(&r, 0, 1) : fmin(fmax(result.t + 0.02 * rng_uniform(&r, -1, 1), 0.0), 1.0);
          assert_true(result.lower <= pair_at(&mover, &target, t).upper + 1e-13);
        }
        assert_true(result.upper >= pair_at(&mover, &target, result.t).lower - 1e-13);
        cprox_body_free(carried.body);
        cprox_body_free(standing.body);
        cprox_curve_free(curve);
      }
  print_message("open %zu of %zu, overlapping %zu\n", open, asked_for, deep);
  assert_true(open * 50 <= asked_for && 4 * deep > asked_for);
}

CASE(a_compound_is_as_deep_as_its_deepest_part) {
  cprox_body *small = NULL, *large = NULL, *both = NULL;
  assert_int_equal(cprox_body_create_sphere(0.25, ws, &small), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(2, 2, 2), ws, &large), CPROX_OK);
  cprox_pose poses[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
  poses[0].position = vec(-3, 0, 0);
  assert_int_equal(cprox_body_create_compound((const cprox_body *[]){small, large}, poses, 2, ws, &both), CPROX_OK);
  /* along x at y = 0.25: 0.25 from the ball's centre, so at its surface; 0.75 deep in the box */
  cprox_curve *curve = bezier((vec3[]){{-5, 0.25, 0}, {0.5, 0.25, 0}}, 2);
  const cprox_options options = asked(1e-9);
  cprox_result result;
  assert_int_equal(
      cprox_distance(cprox_point_along(curve), cprox_obstacle_at(both, CPROX_POSE_IDENTITY), &options, ws, &result),
      CPROX_OK);
  assert_true(result.lower <= -0.75 && -0.75 <= result.upper && result.obstacle_part == 1);
  cprox_result nearest, each[2];
  const cprox_obstacle targets[2] = {cprox_obstacle_at(small, poses[0]), cprox_obstacle_at(large, poses[1])};
  assert_int_equal(distance_of_list(cprox_tube_along(curve, 0.1), targets, 2, &options, ws, &nearest, each), CPROX_OK);
  assert_true(each[0].lower <= -0.1 && -0.1 <= each[0].upper && nearest.obstacle_index == 1);
  assert_true(nearest.lower <= -0.85 && -0.85 <= nearest.upper);
  assert_int_equal(distance_of_list(cprox_tube_along(curve, 0.1), targets, 2, &options, ws, &nearest, NULL), CPROX_OK);
  assert_true(nearest.lower <= -0.85 && -0.85 <= nearest.upper);
  cprox_body_free(both);
  cprox_body_free(small);
  cprox_body_free(large);
  cprox_curve_free(curve);
}

/* Cells have an inside, but trees of them do not measure it: the status says so, and lower is a bound all the same. */
CASE(bodies_that_cannot_tell_their_depth_say_so) {
  cprox_body *cells = NULL;
  const vec3 low[2] = {{-1, -1, -1}, {3, 0, 0}}, high[2] = {{1, 1, 1}, {4, 1, 1}};
  assert_int_equal(cprox_body_create_boxes(low, high, 2, SIZE_MAX, ws, &cells), CPROX_OK);
  cprox_curve *through = bezier((vec3[]){{-3, 0, 0}, {3, 0.5, 0}}, 2),
              *past = bezier((vec3[]){{-3, 3, 0}, {3, 3, 0}}, 2);
  const cprox_obstacle target = cprox_obstacle_at(cells, CPROX_POSE_IDENTITY);
  const cprox_options options = asked(1e-9);
  cprox_result result;
  assert_int_equal(cprox_distance(cprox_point_along(through), target, &options, ws, &result), CPROX_OVERLAP);
  assert_true(result.lower <= -0.7 && result.upper <= 1e-12);
  assert_string_not_equal(cprox_workspace_error(ws), "");
  assert_int_equal(cprox_distance(cprox_point_along(past), target, &options, ws, &result), CPROX_OK);
  assert_true(result.lower <= 2.0 && 2.0 <= result.upper);
  cprox_body_free(cells);
  cprox_curve_free(through);
  cprox_curve_free(past);
}

/* Tubes about two curves that cross: minus the sum of the radii. */
CASE(tubes_that_cross_are_as_deep_as_their_radii) {
  cprox_curve *first = bezier((vec3[]){{-1, 0, 0}, {1, 0, 0}}, 2),
              *second = bezier((vec3[]){{0, -1, 0}, {0.1, 1, 0}}, 2);
  const cprox_options options = asked(1e-9);
  cprox_result result;
  assert_int_equal(
      cprox_distance(cprox_tube_along(first, 0.125), cprox_obstacle_curve(second, 0.25), &options, ws, &result),
      CPROX_OK);
  assert_true(result.lower <= -0.375 && -0.375 <= result.upper && result.upper - result.lower <= 1e-9);
  cprox_curve_free(first);
  cprox_curve_free(second);
}

static int by_count(const void *a, const void *b) {
  return *(const uint32_t *)a < *(const uint32_t *)b ? -1 : *(const uint32_t *)a > *(const uint32_t *)b;
}

/* Seed 93, 300 quintics through a hull of 32 vertices and through a box, epsilon 1e-9. The deepest point mostly lies
 * where two faces are equally near, and there only bisection closes the interval: about four nodes a digit. */
CASE(medians_stay_within_60_nodes) {
  enum { PROBLEMS = 300 };
  rng r = rng_seed(93);
  for (int kind = 0; kind < 2; kind++) {
    uint32_t nodes[PROBLEMS];
    for (size_t k = 0; k < PROBLEMS;) {
      vec3 cloud[32], points[6];
      for (int i = 0; i < 32; i++) cloud[i] = rng_unit(&r);
      for (int i = 0; i < 6; i++) points[i] = rng_in_cube(&r, 1.5);
      cprox_body *body = NULL;
      if (kind == 0) assert_int_equal(cprox_body_create_polytope(cloud, 32, ws, &body), CPROX_OK);
      if (kind == 1) assert_int_equal(cprox_body_create_box(vec(1, 1.5, 2), ws, &body), CPROX_OK);
      cprox_curve *curve = bezier(points, 6);
      const cprox_options options = asked(1e-9);
      cprox_result result;
      assert_int_equal(
          cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, rng_pose(&r, 0.2)), &options, ws, &result),
          CPROX_OK);
      if (result.upper < 0.0) nodes[k++] = result.nodes;
      cprox_body_free(body);
      cprox_curve_free(curve);
    }
    qsort(nodes, PROBLEMS, sizeof *nodes, by_count);
    print_message("%s: median %u nodes; 95 %%: %u; most: %u\n", kind ? "box" : "32-vertex hull", nodes[PROBLEMS / 2],
                  nodes[PROBLEMS * 19 / 20], nodes[PROBLEMS - 1]);
    assert_true(nodes[PROBLEMS / 2] <= 60);
  }
}

/* A curve in the plane of a face touches the face between two of its edges. The nearest sample lies on one of the
 * edges, and its plane leans over that edge; at the other edge the search must find the plane of the face and end. */
CASE(a_curve_that_slides_on_a_face_beside_an_edge_ends_soon) {
  rng r = rng_seed(94);
  uint32_t most = 0;
  for (int k = 0; k < 20000; k++) {
    const vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {rng_uniform(&r, -1, 1), rng_uniform(&r, -1, 1), -1}};
    vec3 points[5];
    for (int i = 0; i < 5; i++) points[i] = vec(rng_uniform(&r, -0.3, 1.3), rng_uniform(&r, -0.3, 1.3), 0.0);
    points[0] = vec(rng_uniform(&r, -0.3, -0.01), rng_uniform(&r, 0.0, 0.5), 0.0);
    points[4] = vec(rng_uniform(&r, 0.5, 1.0), rng_uniform(&r, 0.5, 1.0), 0.0);
    cprox_body *body = NULL;
    assert_int_equal(cprox_body_create_polytope(corner, 4, ws, &body), CPROX_OK);
    cprox_curve *curve = bezier(points, 5);
    cprox_options options = asked(rng_log_uniform(&r, 1e-12, 1e-6));
    options.max_nodes = 2000;
    cprox_result result;
    assert_int_equal(
        cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &result),
        CPROX_OK);
    assert_true(result.upper - result.lower <= options.epsilon);
    if (result.nodes > most) most = result.nodes;
    cprox_body_free(body);
    cprox_curve_free(curve);
  }
  print_message("most nodes: %u\n", most);
  assert_true(most <= 200);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
