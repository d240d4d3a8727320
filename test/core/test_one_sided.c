/* SPDX-License-Identifier: BSD-3-Clause */
/* A hull bounds from one side only: signed distances of solid meshes that are not convex, against their triangles and
 * winding numbers in long double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"

/* ---- meshes that are not convex ---- */

/* A prism along y over an outline in the plane y = 0 that a fan about its first corner fills. */
static test_mesh prism(const double (*outline)[2], size_t n, double length) {
  test_mesh mesh = {.n = 2 * n, .m = 4 * n - 4};
  mesh.vertices = malloc(mesh.n * sizeof *mesh.vertices);
  mesh.triangles = malloc(mesh.m * sizeof *mesh.triangles);
  assert_true(mesh.vertices && mesh.triangles);
  for (size_t k = 0; k < mesh.n; k++)
    mesh.vertices[k] = vec(outline[k % n][0], k < n ? 0.0 : length, outline[k % n][1]);
  size_t m = 0;
  for (uint32_t k = 1; k + 1 < n; k++) {
    const uint32_t near[3] = {0, k, k + 1}, far[3] = {(uint32_t)n, (uint32_t)n + k + 1, (uint32_t)n + k};
    memcpy(mesh.triangles[m++], near, sizeof near);
    memcpy(mesh.triangles[m++], far, sizeof far);
  }
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t next = (k + 1) % (uint32_t)n, up = (uint32_t)n;
    const uint32_t side[2][3] = {{k, next + up, next}, {k, k + up, next + up}};
    memcpy(mesh.triangles[m], side, sizeof side);
    m += 2;
  }
  return mesh;
}

/* A block with a V-groove along y: 1 wide, 0.5 high, the groove's bottom at (0.5, y, 0.1). */
static test_mesh groove(double bottom) {
  const double outline[5][2] = {{0.5, bottom}, {0.0, 0.5}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.5}};
  return prism(outline, 5, 0.5);
}

static test_mesh any_hollow(rng *r) {
  const double thick = rng_uniform(r, 0.05, 0.4);
  const double angle[6][2] = {{thick, thick}, {thick, 1.0}, {0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, thick}};
  switch (rng_index(r, 3)) {
    case 0: return groove(rng_uniform(r, 0.05, 0.4));
    case 1: return prism(angle, 6, rng_uniform(r, 0.1, 1.0));
    default: return mesh_torus(6, 4, 0.6, 0.25, rng_uniform(r, 0.0, 0.2));
  }
}

typedef struct solid {
  test_mesh mesh;
  cprox_body *body, *fill, *hull;
} solid;

static solid solid_of(test_mesh mesh) {
  solid s = {.mesh = mesh, .fill = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws)};
  assert_true(cprox_body_get_info(s.fill).is_solid);
  assert_int_equal(cprox_body_create_polytope(mesh.vertices, mesh.n, ws, &s.hull), CPROX_OK);
  assert_int_equal(cprox_body_create_lod(s.hull, 0.0, s.fill, ws, &s.body), CPROX_OK);
  return s;
}

static void solid_free(solid *s) {
  cprox_body_free(s->body);
  cprox_body_free(s->hull);
  cprox_body_free(s->fill);
  mesh_free(&s->mesh);
}

/* ---- what is asked, and what is true ---- */

/* How far a ball about x is from the solid. Negative where they overlap: no shorter shift leads out. */
static double true_clearance(const test_mesh *mesh, vec3 x, double radius) {
  const vec3l p = ref_vec(x);
  const double away = (double)mesh_distance(mesh, p);
  return (fabsl(mesh_winding(mesh, p)) > 0.5L ? -away : away) - radius;
}

/* The interval holds of a clearance that is known between two numbers; where it is apart it is as narrow as asked. */
static void expect_contains(size_t i, const char *what, const cprox_result *r, double least, double most) {
  const double noise = 1e-9;
  if (r->lower > most + noise || r->upper < least - noise)
    fail_msg("%zu, %s: [%.9g, %.9g], truth in [%.9g, %.9g]", i, what, r->lower, r->upper, least, most);
  if (least > noise && (r->status != CPROX_OK || !(r->upper - r->lower <= 1e-6)))
    fail_msg("%zu, %s: [%.9g, %.9g], %s, though apart", i, what, r->lower, r->upper, cprox_status_name(r->status));
  if (most < -noise && r->status != CPROX_OVERLAP && !(r->status == CPROX_OK && r->upper - r->lower <= 1e-6))
    fail_msg("%zu, %s: [%.9g, %.9g], %s, though deep", i, what, r->lower, r->upper, cprox_status_name(r->status));
}

/* A ball on three slides, from one place to another. */
typedef struct slider {
  cprox_robot *robot;
  cprox_motion *motion;
} slider;

static slider slider_make(const cprox_body *ball, vec3 from, vec3 to) {
  cprox_link links[3];
  for (int i = 0; i < 3; i++)
    links[i] = (cprox_link){.parent = i - 1,
                            .type = CPROX_JOINT_PRISMATIC,
                            .origin = CPROX_POSE_IDENTITY,
                            .axis = vec(i == 0, i == 1, i == 2),
                            .variable = i,
                            .multiplier = 1.0};
  const cprox_link_geometry geometry = {.body = ball, .pose = CPROX_POSE_IDENTITY, .link = 2};
  slider s = {0};
  if (cprox_robot_create(links, 3, &geometry, 1, 3, ws, &s.robot) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  static const int32_t ALL[3] = {0, 1, 2};
  const double begin[3] = {from.x, from.y, from.z}, end[3] = {to.x, to.y, to.z};
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = begin}, {.time = 1.0, .positions = end}};
  const cprox_motion_description d = {
      .kind = CPROX_MOTION_WAYPOINTS, .variables = ALL, .n_variables = 3, .waypoints = points, .n_waypoints = 2};
  assert_int_equal(cprox_motion_create(s.robot, &d, ws, &s.motion), CPROX_OK);
  return s;
}

static void slider_free(slider *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
}

static cprox_options with_depth(void) {
  cprox_options options = accurate(1e-6);
  options.signed_distance = true;
  return options;
}

/* ---- cases ---- */

/* The ball hangs in the groove, 0.2533 clear of both walls, and 0.07 deep in the hull. */
CASE(a_ball_in_a_groove_is_as_far_as_from_its_walls) {
  solid s = solid_of(groove(0.1));
  const double wanted = 0.35 * 0.5 / hypot(0.5, 0.4) - 0.02;
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.02, ws, &ball), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(s.body, CPROX_POSE_IDENTITY);
  const cprox_options options = with_depth();
  const vec3 ends[2] = {{0.5, 0.2, 0.45}, {0.5, 0.3, 0.45}};
  cprox_curve *along = bezier(ends, 2);
  cprox_result r;

  cprox_pose pose = CPROX_POSE_IDENTITY;
  pose.position = ends[0];
  assert_int_equal(cprox_pair(cprox_obstacle_at(ball, pose), target, &options, ws, &r), CPROX_OK);
  assert_true(r.lower <= wanted && wanted <= r.upper);
  assert_int_equal(cprox_distance(cprox_tube_along(along, 0.02), target, &options, ws, &r), CPROX_OK);
  assert_true(r.lower <= wanted && wanted <= r.upper);
  slider robot = slider_make(ball, ends[0], ends[1]);
  assert_int_equal(cprox_distance(cprox_robot_along(robot.motion, NULL, 0), target, &options, ws, &r), CPROX_OK);
  assert_true(r.lower <= wanted && wanted <= r.upper);
  cprox_options hulls = options; /* the hull alone: it is 0.05 deep with its centre */
  hulls.max_lod = CPROX_LOD_HULL;
  assert_int_equal(cprox_distance(cprox_tube_along(along, 0.02), target, &hulls, ws, &r), CPROX_OK);
  assert_true(fabs(r.lower + 0.07) < 2e-6);
  slider_free(&robot);
  cprox_curve_free(along);
  cprox_body_free(ball);
  solid_free(&s);
}

/* 10,000 balls (seed 3901) beside, in and through grooves, angles and tori: a pair, a tube along a curve, a robot. The
 * truth is that of SAMPLES places, and of what lies between them by how far the ball moves. */
CASE(signed_intervals_contain_the_truth_of_solid_meshes) {
  enum { SAMPLES = 9 };
  rng r = rng_seed(3901);
  size_t apart = 0, deep = 0, in_hull = 0;
  for (size_t i = 0; i < test_cases(10000); i++) {
    solid s = solid_of(any_hollow(&r));
    const double radius = rng_log_uniform(&r, 0.01, 0.3);
    const cprox_pose pose = rng_pose(&r, 0.2);
    test_mesh placed = {.n = s.mesh.n, .m = s.mesh.m, .triangles = s.mesh.triangles};
    placed.vertices = malloc(placed.n * sizeof *placed.vertices);
    assert_non_null(placed.vertices);
    memcpy(placed.vertices, s.mesh.vertices, placed.n * sizeof *placed.vertices);
    mesh_move(&placed, &pose);
    const vec3 from = rng_in_cube(&r, 1.0), to = vec_axpy(from, rng_log_uniform(&r, 0.01, 0.5), rng_unit(&r));
    double most = INFINITY, first = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
      const double t = k / (SAMPLES - 1.0);
      const double here = true_clearance(&placed, vec_axpy(vec_scale(1.0 - t, from), t, to), radius);
      most = fmin(most, here);
      if (k == 0) first = here;
    }
    const double least = most - 0.5 * vec_norm(vec_sub(to, from)) / (SAMPLES - 1.0);

    cprox_body *ball = NULL;
    assert_int_equal(cprox_body_create_sphere(radius, ws, &ball), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(s.body, pose);
    const cprox_options options = with_depth();
    cprox_pose at = CPROX_POSE_IDENTITY;
    at.position = from;
    cprox_result pair, hulls, curve, robot;
    assert_true(cprox_pair(cprox_obstacle_at(ball, at), target, &options, ws, &pair) >= 0);
    expect_contains(i, "pair", &pair, first, first);
    assert_true(cprox_pair(cprox_obstacle_at(ball, at), cprox_obstacle_at(s.hull, pose), &options, ws, &hulls) >= 0);
    assert_true(pair.upper < 0.0 || pair.lower >= hulls.lower - 2e-6 || pair.lower > 0.0);
    const vec3 ends[2] = {from, to};
    cprox_curve *along = bezier(ends, 2);
    assert_true(cprox_distance(cprox_tube_along(along, radius), target, &options, ws, &curve) >= 0);
    expect_contains(i, "curve", &curve, least, most);
    slider moved = slider_make(ball, from, to);
    assert_true(cprox_distance(cprox_robot_along(moved.motion, NULL, 0), target, &options, ws, &robot) >= 0);
    expect_contains(i, "robot", &robot, least, most);
    apart += pair.lower > 0.0, deep += first<0.0, in_hull += pair.lower> 0.0 && hulls.upper < 0.0;
    slider_free(&moved);
    cprox_curve_free(along);
    cprox_body_free(ball);
    free(placed.vertices);
    solid_free(&s);
  }
  print_message("%zu apart, %zu of them inside of the hull, %zu deep\n", apart, in_hull, deep);
  assert_true(10 * in_hull > test_cases(1000) && 10 * deep > test_cases(1000));
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
