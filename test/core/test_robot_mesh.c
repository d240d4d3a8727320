/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots whose links are meshes, with and without hulls, past points, meshes and clouds: against every triangle in long
 * double. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/of_list.h"
#include "support/robot_case.h"
#include "support/robots.h"

enum { POINTS = 4, SAMPLES = 40 };

/* A robot of meshes: what its links carry, as surfaces and as level-of-detail bodies. */
typedef struct mesh_robot {
  test_robot robot;
  test_mesh mesh[TEST_MAX_LINKS];
  cprox_body *surface[TEST_MAX_LINKS], *hull[TEST_MAX_LINKS], *lod[TEST_MAX_LINKS];
} mesh_robot;

static test_mesh any_mesh(rng *r) {
  if (rng_index(r, 2)) return mesh_soup(r, 10 + rng_index(r, 40), 0.2, 0.1);
  return mesh_torus(8 + rng_index(r, 6), 5, rng_uniform(r, 0.1, 0.2), 0.05, rng_uniform(r, 0.0, 0.3));
}

static cprox_body *hull_of(const test_mesh *mesh) {
  cprox_body *hull = NULL;
  assert_int_equal(cprox_body_create_polytope(mesh->vertices, mesh->n, ws, &hull), CPROX_OK);
  return hull;
}

static void mesh_robot_make(rng *r, mesh_robot *m) {
  test_robot *t = &m->robot;
  robot_make(r, rng_log_uniform(r, 0.1, 2), t);
  for (size_t i = 0; i < t->n_links; i++) {
    m->mesh[i] = any_mesh(r);
    m->surface[i] = mesh_body(&m->mesh[i], CPROX_MESH_FILL_SURFACE, ws);
    m->hull[i] = hull_of(&m->mesh[i]);
    m->lod[i] = NULL;
    assert_int_equal(cprox_body_create_lod(m->hull[i], 0.0, m->surface[i], ws, &m->lod[i]), CPROX_OK);
    cprox_body_free((cprox_body *)t->geometries[i].body);
    t->geometries[i].body = m->surface[i];
  }
  robot_rebuild(t);
}

static void carry(mesh_robot *m, cprox_body *const *bodies) {
  for (size_t i = 0; i < m->robot.n_links; i++) m->robot.geometries[i].body = bodies[i];
  robot_rebuild(&m->robot);
}

static void mesh_robot_free(mesh_robot *m) {
  for (size_t i = 0; i < m->robot.n_links; i++) {
    cprox_body_free(m->lod[i]);
    cprox_body_free(m->hull[i]);
    mesh_free(&m->mesh[i]);
    m->robot.geometries[i].body = m->surface[i]; /* robot_free() takes these */
  }
  robot_free(&m->robot);
}

/* Of the points from all meshes at a time. Poses of geometries are exact in neither: 1e-15 of a metre. */
static long double distance_at(const mesh_robot *m, long double time, const vec3 *points) {
  const test_robot *t = &m->robot;
  long double values[TEST_MAX_VARIABLES + 1], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, time, values);
  robot_ref_links(t, values, links);
  for (size_t g = 0; g < t->n_links; g++) {
    for (int i = 0; i < POINTS; i++) {
      const vec3l on_link = ref_pose_undo(&links[g], ref_vec(points[i]));
      const long double d = mesh_distance(&m->mesh[g], ref_to_local(&t->geometries[g].pose, on_link));
      least = fminl(least, fmaxl(d - t->margin, 0.0L));
    }
  }
  return least;
}

static cprox_result ask(const mesh_robot *m, const cprox_obstacle *targets, size_t n) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-5;
  cprox_result r;
  const cprox_status status =
      distance_of_list(cprox_robot_along(m->robot.motion, NULL, 0), targets, n, &options, ws, &r, NULL);
  if (status != CPROX_OK) fail_msg("%s: %s", cprox_status_name(status), cprox_workspace_error(ws));
  return r;
}

CASE(points_are_as_far_as_every_triangle_says) {
  rng r = rng_seed(7001);
  size_t climbed = 0;
  for (size_t i = 0; i < test_cases(40); i++) {
    mesh_robot m;
    vec3 points[POINTS];
    mesh_robot_make(&r, &m);
    for (int k = 0; k < POINTS; k++) points[k] = rng_in_cube(&r, 1.0);
    cprox_body *cloud = NULL;
    assert_int_equal(cprox_body_create_points(points, POINTS, 0.0, SIZE_MAX, ws, &cloud), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(cloud, CPROX_POSE_IDENTITY);
    const cprox_result d = ask(&m, &target, 1);
    carry(&m, m.lod);
    const cprox_result by_lod = ask(&m, &target, 1);
    if (d.obstacle_index >= 0) {
      climbed += by_lod.lod == CPROX_LOD_MESH;
      assert_true(by_lod.lower <= d.upper && d.lower <= by_lod.upper);
      assert_true(fabsl(distance_at(&m, d.t, points) - d.upper) <= 1e-9L);
      cprox_result first, near, far;
      const cprox_mover mover = cprox_robot_along(m.robot.motion, NULL, 0);
      assert_true(time_of_contact_of_list(mover, &target, 1, NULL, ws, &first) >= 0);
      const cprox_motion_info info = cprox_motion_get_info(m.robot.motion);
      const double t0 = info.t0, t1 = info.t1;
      for (int k = 0; k <= SAMPLES; k++) {
        const long double time = t0 + ((long double)t1 - t0) * k / SAMPLES, at = distance_at(&m, time, points);
        if (at < d.lower) fail_msg("robot %zu: %.12Lg at %.12Lg, lower is %.12g", i, at, time, d.lower);
        assert_true(at > 0.0L || time >= first.t_contact_lower);
      }
      if (d.lower > 0.0) {
        assert_true(tolerance_of_list(mover, &target, 1, 0.99 * d.lower, NULL, ws, &near, NULL) >= 0);
        assert_true(tolerance_of_list(mover, &target, 1, 1.01 * d.upper, NULL, ws, &far, NULL) >= 0);
        assert_true(near.verdict == CPROX_VERDICT_CLEAR && far.verdict == CPROX_VERDICT_VIOLATED &&
                    first.verdict == CPROX_VERDICT_CLEAR);
      }

      /* the hulls are no farther */
      carry(&m, m.hull);
      const cprox_result by_hull = ask(&m, &target, 1);
      assert_true(by_hull.lower <= d.upper);
    }
    cprox_body_free(cloud);
    mesh_robot_free(&m);
  }
  assert_true(climbed > test_cases(40) / 3);
}

/* Meshes past meshes: a target of triangles is as far as all of its triangles as convex bodies of their own. */
CASE(meshes_are_as_far_as_their_triangles_one_by_one) {
  enum { MOST = 400 };
  rng r = rng_seed(7002);
  for (size_t i = 0; i < test_cases(15); i++) {
    mesh_robot m;
    mesh_robot_make(&r, &m);
    test_mesh standing = any_mesh(&r);
    cprox_pose pose = rng_pose(&r, 0.6);
    cprox_body *surface = mesh_body(&standing, CPROX_MESH_FILL_SURFACE, ws), *hull = hull_of(&standing), *lod = NULL;
    assert_int_equal(cprox_body_create_lod(hull, 0.0, surface, ws, &lod), CPROX_OK);
    static cprox_obstacle triangles[MOST];
    assert_true(standing.m < MOST);
    for (size_t k = 0; k < standing.m; k++) {
      vec3 v[3];
      for (int c = 0; c < 3; c++) v[c] = standing.vertices[standing.triangles[k][c]];
      cprox_body *triangle = NULL;
      assert_int_equal(cprox_body_create_polytope(v, 3, ws, &triangle), CPROX_OK);
      triangles[k] = cprox_obstacle_at(triangle, pose);
    }
    carry(&m, m.lod);
    const cprox_obstacle whole[] = {cprox_obstacle_at(surface, pose), cprox_obstacle_at(lod, pose)};
    const cprox_result one_by_one = ask(&m, triangles, standing.m);
    for (int k = 0; k < 2; k++) {
      const cprox_result d = ask(&m, &whole[k], 1);
      if (!(one_by_one.lower <= d.upper && d.lower <= one_by_one.upper))
        fail_msg("robot %zu: [%.10g, %.10g], triangles [%.10g, %.10g]", i, d.lower, d.upper, one_by_one.lower,
                 one_by_one.upper);
    }
    for (size_t k = 0; k < standing.m; k++) cprox_body_free((cprox_body *)triangles[k].body);
    cprox_body_free(lod);
    cprox_body_free(hull);
    cprox_body_free(surface);
    mesh_free(&standing);
    mesh_robot_free(&m);
  }
}

/* What stops at the hull says what a robot of hulls says. */
CASE(the_finest_lod_may_be_the_hull_or_the_ball) {
  rng r = rng_seed(7003);
  for (size_t i = 0; i < test_cases(20); i++) {
    mesh_robot m;
    mesh_robot_make(&r, &m);
    cprox_body *ball = NULL;
    assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(ball, rng_pose(&r, 1.0));
    cprox_result d[3];
    carry(&m, m.lod);
    const cprox_mover mover = cprox_robot_along(m.robot.motion, NULL, 0);
    for (int lod = CPROX_LOD_SPHERE; lod <= CPROX_LOD_MESH; lod++) {
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.max_lod = (cprox_lod)lod;
      cprox_result *one = &d[lod - CPROX_LOD_SPHERE];
      assert_int_equal(distance_of_list(mover, &target, 1, &options, ws, one, NULL), CPROX_OK);
      assert_true((int)one->lod <= lod);
    }
    if (d[0].obstacle_index >= 0) assert_true(d[0].lower <= d[1].upper && d[1].lower <= d[2].upper);
    carry(&m, m.hull);
    const cprox_result by_hull = ask(&m, &target, 1);
    assert_true(by_hull.lower <= d[1].upper && d[1].lower <= by_hull.upper);
    cprox_body_free(ball);
    mesh_robot_free(&m);
  }
}

/* ---- real robots ---- */

static double milliseconds(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Meshes are inside their hulls: no nearer than those. Verdicts on either side of the distance are right. */
CASE(meshes_of_real_robots_are_no_nearer_than_their_hulls) {
  FILE *f = fopen(TEST_DATA_DIR "/motion/cases.txt", "r");
  assert_non_null(f);
  size_t n, farther = 0, count = 0;
  double ratio[64];
  assert_int_equal(fscanf(f, "%zu", &n), 1);
  for (size_t i = 0; i < n; i++) {
    robot_case c;
    assert_true(robot_case_read(f, TEST_DATA_DIR "/motion", &c));
    const bool wanted = i % 4 == 0 || i + 2 >= n; /* every fourth, and the robots that come last */
    for (size_t k = 0; wanted && k < c.n_answers; k++) {
      const bool self = c.answers[k].self;
      cprox_mover mover[2];
      for (int m = 0; m < 2; m++) {
        const cprox_motion *motion = m ? c.mesh_motion : c.motion;
        mover[m] = self ? cprox_robot_self(motion, c.self_pairs, c.n_self_pairs) : cprox_robot_along(motion, NULL, 0);
      }
      cprox_result r[2];
      double spent[2];
      for (int m = 0; m < 2; m++) {
        spent[m] = milliseconds();
        const cprox_status status =
            distance_of_list(mover[m], c.targets, self ? 0 : c.n_targets, NULL, ws, &r[m], NULL);
        spent[m] = milliseconds() - spent[m];
        if (status != CPROX_OK) fail_msg("%s: %s", c.name, cprox_workspace_error(ws));
      }
      assert_true(r[0].lower <= r[1].upper && r[1].upper - r[1].lower <= 1e-6);
      farther += r[1].lower > r[0].upper + 1e-6;
      ratio[count++] = spent[1] / spent[0];
      if (r[1].lower > 0.0) {
        cprox_result near, far;
        const size_t targets = self ? 0 : c.n_targets;
        assert_true(tolerance_of_list(mover[1], c.targets, targets, 0.99 * r[1].lower, NULL, ws, &near, NULL) >= 0);
        assert_true(tolerance_of_list(mover[1], c.targets, targets, 1.01 * r[1].upper, NULL, ws, &far, NULL) >= 0);
        assert_true(near.verdict == CPROX_VERDICT_CLEAR && far.verdict == CPROX_VERDICT_VIOLATED);
      }
    }
    robot_case_free(&c);
  }
  fclose(f);
  qsort(ratio, count, sizeof *ratio, ascending);
  print_message("%zu answers, %zu farther than the hulls'; time over theirs: %.2g in the median, %.2g at most\n", count,
                farther, ratio[count / 2], ratio[count - 1]);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
