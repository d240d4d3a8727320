/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distance of robots along motions: minus the deepest overlap. Polytopes are held against planes in long double
 * at many times, every other convex kind against static pairs, whose depth test_depth holds against long double. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/of_list.h"
#include "support/robots.h"
#include "support/shapes.h"

#define MOST_MARGIN 0.05 /* of either side, as robot_make() has it */

enum { SAMPLES = 60, TARGETS = 2, MOST_PAIRS = TEST_MAX_LINKS * TEST_MAX_LINKS };

static cprox_options asked(double epsilon) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  options.signed_distance = true;
  return options;
}

/* ---- long double ---- */

typedef struct corners {
  vec3l v[TEST_VERTICES];
} corners;

static void extent(const corners *h, vec3l n, long double *least, long double *most) {
  *least = HUGE_VALL, *most = -HUGE_VALL;
  for (int i = 0; i < TEST_VERTICES; i++) {
    const long double height = ref_dot(n, h->v[i]);
    *least = fminl(height, *least), *most = fmaxl(height, *most);
  }
}

/* How far the two are apart along n or against it; n of any length, and 0 says nothing. */
static long double apart_along(const corners *a, const corners *b, vec3l n) {
  const long double length = ref_norm(n);
  if (!(length > 1e-12L)) return -HUGE_VALL;
  long double a0, a1, b0, b1;
  extent(a, n, &a0, &a1);
  extent(b, n, &b0, &b1);
  return fmaxl(a0 - b1, b0 - a1) / length;
}

static long double apart_along_faces(const corners *of, const corners *a, const corners *b) {
  long double best = -HUGE_VALL;
  for (int i = 0; i < TEST_VERTICES; i++)
    for (int j = i + 1; j < TEST_VERTICES; j++)
      for (int k = j + 1; k < TEST_VERTICES; k++)
        best = fmaxl(apart_along(a, b, ref_cross(ref_sub(of->v[j], of->v[i]), ref_sub(of->v[k], of->v[i]))), best);
  return best;
}

/* Where they overlap minus the depth: a facet of the Minkowski difference is that of a face or of two edges. Where they
 * are apart no more than the distance. */
static long double ref_signed(const corners *a, const corners *b) {
  long double best = fmaxl(apart_along_faces(a, a, b), apart_along_faces(b, a, b));
  for (int i = 0; i < TEST_VERTICES; i++)
    for (int j = i + 1; j < TEST_VERTICES; j++)
      for (int k = 0; k < TEST_VERTICES; k++)
        for (int m = k + 1; m < TEST_VERTICES; m++)
          best = fmaxl(apart_along(a, b, ref_cross(ref_sub(a->v[j], a->v[i]), ref_sub(b->v[m], b->v[k]))), best);
  return best;
}

/* ---- problems ---- */

/* Where a geometry stands at a time. */
static cprox_pose geometry_at(const test_robot *t, size_t geometry, double time) {
  long double values[TEST_MAX_VARIABLES];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, time, values);
  robot_ref_links(t, values, links);
  const cprox_link_geometry *g = &t->geometries[geometry];
  const ref_pose *link = &links[g->link];
  const vec3l at = ref_pose_apply(link, ref_vec(g->pose.position));
  const long double *a = link->q; /* x, y, z, w */
  const cprox_quat b = g->pose.orientation;
  return (cprox_pose){.position = vec((double)at.x, (double)at.y, (double)at.z),
                      .orientation = {.w = (double)(a[3] * b.w - a[0] * b.x - a[1] * b.y - a[2] * b.z),
                                      .x = (double)(a[3] * b.x + a[0] * b.w + a[1] * b.z - a[2] * b.y),
                                      .y = (double)(a[3] * b.y + a[1] * b.w + a[2] * b.x - a[0] * b.z),
                                      .z = (double)(a[3] * b.z + a[2] * b.w + a[0] * b.y - a[1] * b.x)}};
}

/* Beside where one of the robot's geometries once is. */
static cprox_pose pose_on_the_way(rng *r, const test_robot *t, size_t geometry) {
  const cprox_motion_info info = cprox_motion_get_info(t->motion);
  cprox_pose pose = rng_pose(r, 0.2);
  const cprox_pose there = geometry_at(t, geometry, rng_uniform(r, info.t0, info.t1));
  pose.position = vec_add(pose.position, there.position);
  return pose;
}

typedef struct problem {
  test_robot robot;
  vec3 corners[TARGETS][TEST_VERTICES];
  cprox_obstacle targets[TARGETS];
  bool self;
  cprox_robot_pair pairs[MOST_PAIRS];
  size_t n_pairs;
} problem;

static void problem_make(rng *r, problem *p) {
  *p = (problem){.self = rng_index(r, 3) == 0};
  const double speed = rng_log_uniform(r, 0.02, 1.5);
  if (rng_index(r, 4) > 0)
    robot_make(r, speed, &p->robot);
  else
    robot_make_turning(r, speed, (cprox_turning)rng_index(r, 3), 2 + rng_index(r, TEST_WAYPOINTS - 1), &p->robot);
  for (int i = 0; i < TARGETS; i++) {
    cprox_body *body = NULL;
    for (int k = 0; k < TEST_VERTICES; k++) p->corners[i][k] = rng_in_cube(r, 0.6);
    assert_int_equal(cprox_body_create_polytope(p->corners[i], TEST_VERTICES, NULL, &body), CPROX_OK);
    p->targets[i] = cprox_obstacle_at(body, pose_on_the_way(r, &p->robot, rng_index(r, p->robot.n_links)));
    p->targets[i].margin = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0, MOST_MARGIN);
  }
  for (size_t i = 0; i < p->robot.n_links; i++)
    for (size_t k = 0; k < (p->self ? i : TARGETS); k++)
      p->pairs[p->n_pairs++] = (cprox_robot_pair){(int32_t)i, (int32_t)k};
}

static void problem_free(problem *p) {
  robot_free(&p->robot);
  for (int i = 0; i < TARGETS; i++) cprox_body_free((cprox_body *)p->targets[i].body);
}

static cprox_status ask(const problem *p, const cprox_options *options, cprox_result *r) {
  const cprox_motion *motion = p->robot.motion;
  const cprox_mover mover =
      p->self ? cprox_robot_self(motion, p->pairs, p->n_pairs) : cprox_robot_along(motion, p->pairs, p->n_pairs);
  cprox_obstacles *all = NULL;
  assert_int_equal(cprox_obstacles_create(p->targets, p->self ? 0 : TARGETS, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
  const cprox_status status = cprox_obstacles_distance(all, mover, options, ws, r, NULL);
  cprox_obstacles_free(all);
  return status;
}

/* The least at a time of all pairs that overlap without their margins; infinity where none does. */
static long double ref_at(const problem *p, double t) {
  const test_robot *robot = &p->robot;
  long double values[TEST_MAX_VARIABLES], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(robot, t, values);
  robot_ref_links(robot, values, links);
  for (size_t i = 0; i < p->n_pairs; i++) {
    corners a, b;
    const size_t other = (size_t)p->pairs[i].other;
    robot_ref_vertices(robot, links, (size_t)p->pairs[i].geometry, a.v);
    for (int k = 0; k < TEST_VERTICES && !p->self; k++)
      b.v[k] = ref_to_world(&p->targets[other].pose, ref_vec(p->corners[other][k]));
    if (p->self) robot_ref_vertices(robot, links, other, b.v);
    const double margins = robot->margin + (p->self ? robot->margin : p->targets[other].margin);
    const long double apart = ref_signed(&a, &b);
    if (apart < 0) least = fminl(apart - margins, least);
  }
  return least;
}

/* ---- bounds ---- */

/* Seed 2101, 150 problems, 60 times each and the one of `upper`. The tolerance is the rounding of the reference. */
CASE(minus_the_deepest_overlap_is_between_lower_and_upper) {
  rng r = rng_seed(2101);
  size_t deep = 0, exact = 0;
  uint32_t most = 0;
  for (size_t i = 0; i < test_cases(150); i++) {
    problem p;
    problem_make(&r, &p);
    cprox_result found;
    const cprox_options options = asked(rng_log_uniform(&r, 1e-9, 1e-3));
    const cprox_status status = p.n_pairs ? ask(&p, &options, &found) : CPROX_OK;
    if (status != CPROX_OK) fail_msg("%zu: %d %s", i, (int)status, cprox_workspace_error(ws));
    if (p.n_pairs && found.upper < 0.0) {
      deep++;
      most = found.nodes > most ? found.nodes : most;
      assert_true(found.upper - found.lower <= options.epsilon);
      const cprox_motion_info info = cprox_motion_get_info(p.robot.motion);
      for (int k = 0; k <= SAMPLES; k++) {
        const double t = k == SAMPLES ? info.t1 : info.t0 + (info.t1 - info.t0) * k / SAMPLES;
        const long double here = ref_at(&p, t);
        if (!(here >= found.lower - 1e-13L)) fail_msg("%zu: %.17Lg at %g, lower %.17g", i, here, t, found.lower);
      }
      const long double there = ref_at(&p, found.t);
      const bool is_exact = found.upper < -2.0 * MOST_MARGIN;
      exact += is_exact;
      if (is_exact && !(there <= found.upper + 1e-13L && there >= found.upper - options.epsilon - 1e-13L))
        fail_msg("%zu: %.17Lg at %g, upper %.17g", i, there, found.t, found.upper);
      /* the way out is as long as the depth, along the normal */
      const vec3 way = vec_sub(found.witness_mover, found.witness_obstacle);
      assert_true(fabs(vec_norm(way) + found.upper) <= options.epsilon && vec_dot(way, found.normal) < 0.0);
    }
    problem_free(&p);
  }
  print_message("%zu overlap, %zu without their margins; %u nodes at most\n", deep, exact, most);
  assert_true(4 * deep > test_cases(150) && 5 * exact > test_cases(150));
}

/* ---- every kind ---- */

static const cprox_body_kind KINDS[] = {CPROX_BODY_SPHERE, CPROX_BODY_BOX,  CPROX_BODY_CAPSULE,  CPROX_BODY_CYLINDER,
                                        CPROX_BODY_POINT,  CPROX_BODY_CONE, CPROX_BODY_POLYTOPE, CPROX_BODY_ELLIPSOID};

/* One in nine is a halfspace. */
static cprox_body *standing_random(rng *r) {
  test_shape s;
  const size_t kind = rng_index(r, 9);
  if (kind < 8) {
    shape_make(r, KINDS[kind], 0.5, 3.0, &s);
    return s.body;
  }
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_halfspace(rng_unit(r), rng_uniform(r, -0.5, 0.5), ws, &body), CPROX_OK);
  return body;
}

/* Seed 2102: 120 robots, one link of any shape against one obstacle of any shape. */
CASE(every_convex_kind_has_the_depth_of_its_static_pairs) {
  rng r = rng_seed(2102);
  size_t deep = 0, wide = 0;
  for (size_t i = 0; i < test_cases(120); i++) {
    test_robot t;
    test_shape moving;
    robot_make(&r, rng_log_uniform(&r, 0.02, 1.0), &t);
    shape_make(&r, KINDS[rng_index(&r, 8)], 0.3, 3.0, &moving);
    cprox_body *standing = standing_random(&r);
    const size_t link = rng_index(&r, t.n_links);
    cprox_body_free((cprox_body *)t.geometries[link].body);
    t.geometries[link].body = moving.body;
    robot_rebuild(&t);
    cprox_obstacle target = cprox_obstacle_at(standing, pose_on_the_way(&r, &t, link));
    target.margin = 0.02;
    const cprox_robot_pair pair = {(int32_t)link, 0};
    const cprox_options options = asked(1e-6);
    cprox_result found;
    const cprox_status status = cprox_distance(cprox_robot_along(t.motion, &pair, 1), target, &options, ws, &found);
    if (status < 0) fail_msg("%zu: %s", i, cprox_workspace_error(ws));
    wide += status != CPROX_OK;
    deep += found.upper < 0.0;
    const cprox_motion_info info = cprox_motion_get_info(t.motion);
    for (int k = 0; k <= SAMPLES; k++) {
      const double at = k == SAMPLES ? found.t : info.t0 + (info.t1 - info.t0) * k / SAMPLES;
      cprox_obstacle body = cprox_obstacle_at(moving.body, geometry_at(&t, link, at));
      body.margin = t.margin;
      cprox_result here;
      assert_true(cprox_pair(body, target, &options, ws, &here) >= 0);
      if (!(here.upper >= found.lower - 1e-12)) fail_msg("%zu: %g at %g, lower %g", i, here.upper, at, found.lower);
      if (k == SAMPLES && !(here.lower <= found.upper + 1e-12 && here.upper >= found.upper - 2e-6))
        fail_msg("%zu: [%g, %g], upper %g", i, here.lower, here.upper, found.upper);
    }
    robot_free(&t);
    cprox_body_free(standing);
  }
  print_message("%zu overlap, %zu are not answered as narrowly\n", deep, wide);
  assert_true(4 * deep > test_cases(120) && 50 * wide <= test_cases(120));
}

/* ---- what goes by hulls, and what has none ---- */

/* A mesh that is apart has its own distance. In contact its hull says how deep at most, and the
 * result says so; of what has no hull the reason does. */
CASE(meshes_are_at_most_as_deep_as_their_hulls) {
  rng r = rng_seed(2103);
  size_t apart = 0, touching = 0;
  test_mesh torus = mesh_torus(12, 9, 0.5, 0.2, 0.1);
  cprox_body *hull = NULL, *lod = NULL, *mesh = mesh_body(&torus, CPROX_MESH_FILL_SURFACE, ws), *cloud = NULL;
  assert_int_equal(cprox_body_create_polytope(torus.vertices, torus.n, NULL, &hull), CPROX_OK);
  assert_int_equal(cprox_body_create_lod(hull, 0.0, mesh, ws, &lod), CPROX_OK);
  assert_int_equal(cprox_body_create_points(torus.vertices, torus.n, 0.01, SIZE_MAX, ws, &cloud), CPROX_OK);
  for (size_t i = 0; i < test_cases(30); i++) {
    test_robot t;
    robot_make(&r, 0.5, &t);
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    const cprox_options options = asked(1e-6);
    const cprox_pose pose = rng_pose(&r, 1.0);
    cprox_result by_hull, by_lod, by_mesh, no;
    assert_int_equal(cprox_distance(mover, cprox_obstacle_at(hull, pose), &options, ws, &by_hull), CPROX_OK);
    assert_int_equal(cprox_distance(mover, cprox_obstacle_at(lod, pose), NULL, ws, &by_mesh), CPROX_OK);
    const cprox_status status = cprox_distance(mover, cprox_obstacle_at(lod, pose), &options, ws, &by_lod);
    if (by_mesh.lower > 0.0) {
      assert_int_equal(status, CPROX_OK);
      assert_true(by_lod.lower == by_mesh.lower && by_lod.upper == by_mesh.upper);
      apart++;
    } else {
      assert_int_equal(status, CPROX_OVERLAP);
      assert_true(by_lod.lower == by_hull.lower && by_lod.upper == by_mesh.upper);
      assert_int_equal(by_lod.lod, CPROX_LOD_HULL);
      touching++;
    }

    /* a set with a BVH says the same; mesh and cloud are refused, in a set too */
    cprox_obstacle both[2] = {cprox_obstacle_at(lod, pose), cprox_obstacle_at(hull, rng_pose(&r, 3.0))};
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(both, 2, CPROX_INDEX_BVH, ws, &all), CPROX_OK);
    assert_int_equal(cprox_obstacles_distance(all, mover, &options, ws, &no, NULL), status);
    assert_true(no.lower <= by_lod.upper && no.upper <= by_lod.upper + 1e-12);
    cprox_obstacles_free(all);
    const cprox_body *const flat[] = {mesh, cloud};
    for (int k = 0; k < 2; k++) {
      both[1] = cprox_obstacle_at(flat[k], pose);
      assert_int_equal(cprox_obstacles_create(both, 2, k ? CPROX_INDEX_BVH : CPROX_INDEX_NONE, ws, &all), CPROX_OK);
      assert_int_equal(cprox_obstacles_distance(all, mover, &options, ws, &no, NULL), CPROX_INVALID);
      assert_non_null(strstr(cprox_workspace_error(ws), "obstacle 1 is a mesh without a hull"));
      cprox_obstacles_free(all);
    }
    robot_free(&t);
  }
  cprox_body *const bodies[] = {hull, lod, mesh, cloud};
  for (int k = 0; k < 4; k++) cprox_body_free(bodies[k]);
  mesh_free(&torus);
  print_message("%zu apart, %zu in contact\n", apart, touching);
  assert_true(apart > 0 && touching > 0);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
