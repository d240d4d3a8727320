/* SPDX-License-Identifier: BSD-3-Clause */
/* What is proven to touch is reported by one point of both, at a parameter where both are there. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { CORNERS = 24, MOST_POINTS = 5 };

/* Sizes are 1 m, places at most 10 m from the origin: what 64 roundings of double make of that. */
static const double ROUNDING = 1e-13;

/* ---- flat bodies of radius 1 about z ---- */

static void disc_support(const void *shape, const double direction[3], double point[3]) {
  (void)shape;
  const double length = hypot(direction[0], direction[1]);
  point[0] = length > 0.0 ? direction[0] / length : 0.0;
  point[1] = length > 0.0 ? direction[1] / length : 0.0;
  point[2] = 0.0;
}

enum { POLYGON, POLYTOPE, SUPPORT, MESH, FLAT_KINDS };

static cprox_body *flat_body(int kind) {
  cprox_body *body = NULL;
  double plane[CORNERS][2];
  vec3 corner[CORNERS];
  uint32_t triangles[CORNERS - 2][3];
  for (uint32_t i = 0; i < CORNERS; i++) {
    const double angle = 6.283185307179586 * i / CORNERS;
    corner[i] = vec(cos(angle), sin(angle), 0.0);
    plane[i][0] = corner[i].x, plane[i][1] = corner[i].y;
    if (i < 2) continue;
    triangles[i - 2][0] = 0, triangles[i - 2][1] = i - 1, triangles[i - 2][2] = i;
  }
  cprox_status status = CPROX_INVALID;
  if (kind == POLYGON) status = cprox_body_create_polygon((const double(*)[2])plane, CORNERS, ws, &body);
  if (kind == POLYTOPE) status = cprox_body_create_polytope(corner, CORNERS, ws, &body);
  if (kind == SUPPORT) status = cprox_body_create_support(disc_support, NULL, vec(0, 0, 0), 1.0, 0.0, 0.0, ws, &body);
  if (kind == MESH)
    status = cprox_body_create_mesh(corner, CORNERS, (const uint32_t(*)[3])triangles, CORNERS - 2,
                                    CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &body);
  assert_int_equal(status, CPROX_OK);
  return body;
}

/* From one side of the body to the other, within half of its radius of the axis. */
static cprox_curve *curve_through(rng *r, const cprox_pose *pose) {
  vec3 points[MOST_POINTS];
  const size_t n = 2 + rng_index(r, MOST_POINTS - 1);
  for (size_t i = 0; i < n; i++) {
    const double height = i == 0       ? rng_uniform(r, -1.0, -1e-3)
                          : i == n - 1 ? rng_uniform(r, 1e-3, 1.0)
                                       : rng_uniform(r, -1.0, 1.0);
    const vec3l place = ref_to_world(pose, ref_vec(vec(rng_uniform(r, -0.5, 0.5), rng_uniform(r, -0.5, 0.5), height)));
    points[i] = vec((double)place.x, (double)place.y, (double)place.z);
  }
  return bezier(points, n);
}

/* ---- queries ---- */

enum { TOLERANCE, COLLISION, BATCH, SET, CONTACT, QUERIES };

static cprox_result ask(int query, const cprox_curve *curve, const cprox_body *body, cprox_pose pose) {
  const cprox_options options = accurate(1e-9);
  const cprox_mover mover = cprox_point_along(curve);
  const cprox_obstacle at = cprox_obstacle_at(body, pose);
  cprox_result result = {.status = CPROX_INVALID};
  cprox_obstacles *obstacles = NULL;
  const cprox_obstacle_index index = query == BATCH ? CPROX_INDEX_BATCH : CPROX_INDEX_BVH;
  assert_int_equal(cprox_obstacles_create(&at, 1, index, ws, &obstacles), CPROX_OK);
  cprox_status status = CPROX_INVALID;
  if (query == TOLERANCE) status = cprox_tolerance(mover, at, 0.0, &options, ws, &result);
  if (query == COLLISION) status = cprox_collision(mover, at, &options, ws, &result);
  if (query == CONTACT) status = cprox_time_of_contact(mover, at, &options, ws, &result);
  if (query == BATCH) status = cprox_obstacles_tolerance_batch(obstacles, &mover, 0, 1, 0.0, &options, ws, &result);
  if (query == SET) status = cprox_obstacles_collision(obstacles, mover, &options, ws, &result, NULL);
  assert_true(status >= CPROX_OK);
  cprox_obstacles_free(obstacles);
  return result;
}

static double apart(vec3 a, vec3 b) {
  return vec_norm(vec_sub(a, b));
}

CASE(a_curve_through_a_flat_body_is_reported_where_it_goes_through) {
  rng r = rng_seed(3901);
  for (int i = 0; i < 400; i++) {
    const cprox_pose pose = rng_pose(&r, 5.0);
    cprox_body *body = flat_body(i % FLAT_KINDS);
    cprox_curve *curve = curve_through(&r, &pose);
    for (int query = 0; query < QUERIES; query++) {
      const cprox_result result = ask(query, curve, body, pose);
      assert_int_equal(result.verdict, CPROX_VERDICT_VIOLATED);
      assert_true(result.upper == 0.0);
      assert_true(apart(result.witness_mover, result.witness_obstacle) == 0.0);
      const vec3l place = ref_to_local(&pose, ref_vec(result.witness_obstacle));
      assert_true(fabsl(place.z) <= ROUNDING && hypotl(place.x, place.y) < 1.0L);
      vec3 there;
      assert_int_equal(cprox_curve_evaluate(curve, result.t, ws, &there, NULL, NULL), CPROX_OK);
      /* first contact: by t they certainly have met, which takes the curve beyond what rounding hides */
      const double room = query == CONTACT ? 100.0 * ROUNDING : ROUNDING;
      if (!(apart(there, result.witness_mover) <= room))
        fail_msg("query %d: at t the curve is %g from the witness point", query, apart(there, result.witness_mover));
    }
    cprox_curve_free(curve);
    cprox_body_free(body);
  }
}

static double off_segment(vec3 half, vec3 place) {
  const double along = vec_dot(place, half) / vec_norm2(half);
  return vec_norm(vec_axpy(place, -fmin(1.0, fmax(-1.0, along)), half));
}

/* The difference of two segments is flat. */
CASE(segments_carried_through_each_other_share_the_point) {
  rng r = rng_seed(3903);
  for (int i = 0; i < 400; i++) {
    cprox_body *body[2];
    vec3 half[2];
    for (int k = 0; k < 2; k++) {
      half[k] = rng_unit(&r);
      const vec3 corners[3] = {half[k], vec(0, 0, 0), vec_neg(half[k])};
      assert_int_equal(cprox_body_create_polytope(corners, 3, ws, &body[k]), CPROX_OK);
    }
    /* from one side of their common plane to the other, near the middle */
    const vec3 n = vec_cross(half[0], half[1]), at = rng_unit(&r);
    vec3 points[4];
    for (int k = 0; k < 4; k++) {
      const double height = k == 0 ? -1.0 : k == 3 ? 1.0 : rng_uniform(&r, -1.0, 1.0);
      points[k] = vec_axpy(vec_axpy(at, rng_uniform(&r, -0.5, 0.5), half[0]), rng_uniform(&r, -0.5, 0.5), half[1]);
      points[k] = vec_axpy(points[k], height, n);
    }
    cprox_curve *curve = bezier(points, 4);
    const cprox_options options = accurate(1e-3);
    const cprox_obstacle obstacle = cprox_obstacle_at(body[1], (cprox_pose){at, {1, 0, 0, 0}});
    cprox_result result;
    assert_true(cprox_collision(cprox_body_along(body[0], curve), obstacle, &options, ws, &result) >= CPROX_OK);
    assert_int_equal(result.verdict, CPROX_VERDICT_VIOLATED);
    assert_true(apart(result.witness_mover, result.witness_obstacle) == 0.0);
    vec3 there;
    assert_int_equal(cprox_curve_evaluate(curve, result.t, ws, &there, NULL, NULL), CPROX_OK);
    const double off[2] = {off_segment(half[0], vec_sub(result.witness_mover, there)),
                           off_segment(half[1], vec_sub(result.witness_mover, at))};
    if (!(off[0] <= 1e-12 && off[1] <= 1e-12))
      fail_msg("%d: the point is %g and %g off the segments", i, off[0], off[1]);
    cprox_curve_free(curve);
    for (int k = 0; k < 2; k++) cprox_body_free(body[k]);
  }
}

/* ---- margins ---- */

CASE(the_witness_point_of_overlapping_margins_lies_in_both) {
  rng r = rng_seed(3902);
  for (int i = 0; i < 300; i++) {
    vec3 semi[2], exponents[2];
    cprox_body *body[2];
    for (int k = 0; k < 2; k++) {
      semi[k] = vec(rng_uniform(&r, 0.2, 1.0), rng_uniform(&r, 0.2, 1.0), rng_uniform(&r, 0.2, 1.0));
      exponents[k] = vec(rng_uniform(&r, 1.5, 5.0), rng_uniform(&r, 1.5, 5.0), rng_uniform(&r, 1.5, 5.0));
      assert_int_equal(cprox_body_create_superquadric(semi[k], exponents[k], ws, &body[k]), CPROX_OK);
    }
    const vec3 start = vec(rng_uniform(&r, 1.5, 4.0), rng_uniform(&r, -1.0, 1.0), rng_uniform(&r, -1.0, 1.0));
    const vec3 ends[2] = {start, vec_add(start, vec(0.1, 0.2, 0.0))};
    cprox_curve *curve = bezier(ends, 2);
    const cprox_options options = accurate(1e-9);
    cprox_mover mover = cprox_body_along(body[0], curve);
    cprox_obstacle obstacle = cprox_obstacle_at(body[1], rng_pose(&r, 0.0));
    cprox_result bare, result;
    assert_int_equal(cprox_distance(mover, obstacle, &options, ws, &bare), CPROX_OK);
    const double margins = bare.upper * rng_uniform(&r, 1.05, 1.5), share = rng_uniform(&r, 0.0, 1.0);
    mover.radius = share * margins, obstacle.margin = margins - mover.radius;
    assert_int_equal(cprox_distance(mover, obstacle, &options, ws, &result), CPROX_OK);
    assert_true(result.upper == 0.0);
    assert_true(apart(result.witness_mover, result.witness_obstacle) == 0.0);

    /* as a lower bound of its distance from either says */
    cprox_body *point = NULL;
    assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
    cprox_pose mover_pose = {.orientation = {1, 0, 0, 0}};
    assert_int_equal(cprox_curve_evaluate(curve, result.t, ws, &mover_pose.position, NULL, NULL), CPROX_OK);
    for (int k = 0; k < 2; k++) {
      const cprox_pose pose = k == 0 ? mover_pose : obstacle.pose;
      const double margin = k == 0 ? mover.radius : obstacle.margin;
      const cprox_obstacle at = {.body = point,
                                 .pose = {.position = result.witness_mover, .orientation = {1, 0, 0, 0}}};
      cprox_result off;
      assert_true(cprox_pair(cprox_obstacle_at(body[k], pose), at, &options, ws, &off) >= CPROX_OK);
      if (!(off.lower <= margin + 1e-8))
        fail_msg("%d: the witness point is %g from body %d, whose margin is %g", i, off.lower, k, margin);
    }
    cprox_body_free(point);
    cprox_curve_free(curve);
    for (int k = 0; k < 2; k++) cprox_body_free(body[k]);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
