/* SPDX-License-Identifier: BSD-3-Clause */
/* Level-of-detail bodies: the hull answers what it can, the mesh the rest, and both agree. */
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/meshes.h"
#include "support/of_list.h"

/* ---- builders ---- */

typedef struct test_lod {
  cprox_body *hull, *mesh, *body;
} test_lod;

static test_lod lod_make(const test_mesh *mesh) {
  test_lod l = {0};
  l.mesh = mesh_body(mesh, CPROX_MESH_FILL_SURFACE, ws);
  assert_int_equal(cprox_body_create_polytope(mesh->vertices, mesh->n, ws, &l.hull), CPROX_OK);
  if (cprox_body_create_lod(l.hull, 0.0, l.mesh, ws, &l.body) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return l;
}

static void lod_free(test_lod *l) {
  cprox_body_free(l->body);
  cprox_body_free(l->mesh);
  cprox_body_free(l->hull);
}

static cprox_curve *random_curve(rng *r, double reach) {
  vec3 points[5];
  for (size_t k = 0; k < 5; k++) points[k] = rng_in_cube(r, reach);
  return bezier(points, 5);
}

static cprox_options up_to(cprox_lod lod, double epsilon) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_lod = lod;
  options.epsilon = epsilon;
  return options;
}

/* An angle: two thick plates that meet, as L-shaped brackets are; 0.1 thick, 1 long. Their hull fills the corner. */
static test_mesh mesh_bracket(void) {
  static const double outline[6][2] = {{0, 0}, {1, 0}, {1, 0.1}, {0.1, 0.1}, {0.1, 1}, {0, 1}};
  static const uint32_t faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  test_mesh mesh = {.n = 12, .m = 20};
  mesh.vertices = malloc(mesh.n * sizeof *mesh.vertices);
  mesh.triangles = malloc(mesh.m * sizeof *mesh.triangles);
  for (size_t k = 0; k < 12; k++) mesh.vertices[k] = vec(outline[k % 6][0], outline[k % 6][1], k < 6 ? -0.2 : 0.2);
  size_t m = 0;
  for (uint32_t k = 0; k < 4; k++) {
    for (uint32_t side = 0; side < 2; side++, m++)
      for (uint32_t c = 0; c < 3; c++) mesh.triangles[m][side ? c : 2 - c] = faces[k][c] + 6 * side;
  }
  for (uint32_t k = 0; k < 6; k++) {
    const uint32_t next = (k + 1) % 6;
    const uint32_t quad[2][3] = {{k, next, next + 6}, {k, next + 6, k + 6}};
    memcpy(mesh.triangles[m], quad, sizeof quad);
    m += 2;
  }
  return mesh;
}

/* ---- levels of detail ---- */

/* 400 curves (seed 81) past tori and a bracket at any pose, epsilon 1e-7. A coarser model contains the finer one: ball
 * <= hull <= mesh but for epsilon, each by the interval of its own body, and the level-of-detail body's own answer is
 * the mesh's. */
CASE(lods_contain_each_other_and_are_what_they_are_called) {
  rng r = rng_seed(81);
  test_mesh torus = mesh_torus(16, 10, 1.0, 0.3, 0.1), bracket = mesh_bracket();
  test_lod lods[2] = {lod_make(&torus), lod_make(&bracket)};
  for (size_t i = 0; i < test_cases(400); i++) {
    const test_lod *l = &lods[i % 2];
    const cprox_pose pose = rng_pose(&r, 1.0);
    cprox_curve *curve = random_curve(&r, 2.5);
    const cprox_mover mover = cprox_tube_along(curve, i % 3 ? 0.0 : 0.02);
    const cprox_obstacle target = cprox_with_margin(cprox_obstacle_at(l->body, pose), i % 5 ? 0.0 : 0.01);
    cprox_result by[4], alone[4];
    for (cprox_lod lod = CPROX_LOD_SPHERE; lod <= CPROX_LOD_MESH; lod++) {
      const cprox_options options = up_to(lod, 1e-7);
      assert_int_equal(cprox_distance(mover, target, &options, ws, &by[lod]), CPROX_OK);
      assert_int_equal(by[lod].lod, lod);
      cprox_obstacle own = target;
      own.body = lod == CPROX_LOD_MESH ? l->mesh : l->hull;
      if (lod == CPROX_LOD_SPHERE) continue;
      assert_int_equal(cprox_distance(mover, own, NULL, ws, &alone[lod]), CPROX_OK);
      if (by[lod].lower > alone[lod].upper || alone[lod].lower > by[lod].upper)
        fail_msg("case %zu, %s: [%.9g, %.9g], alone [%.9g, %.9g]", i, cprox_lod_name(lod), by[lod].lower, by[lod].upper,
                 alone[lod].lower, alone[lod].upper);
    }
    assert_true(by[CPROX_LOD_SPHERE].lower <= by[CPROX_LOD_HULL].upper);
    assert_true(by[CPROX_LOD_HULL].lower <= by[CPROX_LOD_MESH].upper);

    /* the ball's distance, by the distance of its centre */
    const cprox_body_info info = cprox_body_get_info(l->body);
    const vec3 centre = info.centre;
    const double radius = info.radius;
    cprox_body *point = NULL;
    cprox_result to_centre;
    assert_int_equal(cprox_body_create_point(centre, ws, &point), CPROX_OK);
    cprox_obstacle middle = target;
    middle.body = point;
    assert_int_equal(cprox_distance(mover, middle, NULL, ws, &to_centre), CPROX_OK);
    const double wanted = fmax(to_centre.upper - radius, 0.0);
    assert_true(fabs(by[CPROX_LOD_SPHERE].upper - wanted) < 3e-6);
    cprox_body_free(point);
    cprox_curve_free(curve);
  }
  for (int k = 0; k < 2; k++) lod_free(&lods[k]);
  mesh_free(&torus);
  mesh_free(&bracket);
}

/* 300 curves (seed 83), Delta and time of contact: the level-of-detail body's verdict is that of the mesh alone
 * wherever that has one, t_contact_lower agrees with the mesh's to epsilon / the curve's least speed near contact (1e-5
 * here), and "clear" by the hull is level of detail hull. */
CASE(verdicts_are_those_of_the_mesh) {
  rng r = rng_seed(83);
  test_mesh torus = mesh_torus(16, 10, 1.0, 0.3, 0.1), bracket = mesh_bracket();
  test_lod lods[2] = {lod_make(&torus), lod_make(&bracket)};
  size_t by_hull = 0, by_mesh = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    const test_lod *l = &lods[i % 2];
    const cprox_pose pose = rng_pose(&r, 1.0);
    cprox_curve *curve = random_curve(&r, 2.5);
    const cprox_mover mover = cprox_tube_along(curve, i % 3 ? 0.0 : 0.02);
    const cprox_obstacle lod = cprox_obstacle_at(l->body, pose), mesh = cprox_obstacle_at(l->mesh, pose),
                         hull = cprox_obstacle_at(l->hull, pose);
    const double delta = rng_uniform(&r, 0.0, 0.5);
    cprox_result a, b, h;
    assert_int_equal(cprox_tolerance(mover, lod, delta, NULL, ws, &a), CPROX_OK);
    assert_int_equal(cprox_tolerance(mover, mesh, delta, NULL, ws, &b), CPROX_OK);
    assert_int_equal(cprox_tolerance(mover, hull, delta, NULL, ws, &h), CPROX_OK);
    assert_int_equal(a.verdict, b.verdict);
    if (h.verdict == CPROX_VERDICT_CLEAR) assert_true(a.lod <= CPROX_LOD_HULL);
    by_hull += a.lod == CPROX_LOD_HULL, by_mesh += a.lod == CPROX_LOD_MESH;
    /* the witness is the mesh's own */
    cprox_result all;
    assert_int_equal(cprox_distance(mover, mesh, NULL, ws, &all), CPROX_OK);
    assert_true(a.lower <= all.upper && all.lower <= a.upper);

    cprox_result first, own;
    const cprox_status met = cprox_time_of_contact(mover, lod, NULL, ws, &first);
    assert_true(met >= 0);
    assert_true(cprox_time_of_contact(mover, mesh, NULL, ws, &own) >= 0);
    assert_int_equal(first.verdict, own.verdict);
    if (first.lod == CPROX_LOD_MESH) assert_true(first.t_contact_lower == own.t_contact_lower);
    assert_true(fabs(first.t_contact_lower - own.t_contact_lower) < 1e-5);
    cprox_curve_free(curve);
  }
  if (by_hull < 20 || by_mesh < 20) fail_msg("%zu by the hull, %zu by the mesh", by_hull, by_mesh);
  for (int k = 0; k < 2; k++) lod_free(&lods[k]);
  mesh_free(&torus);
  mesh_free(&bracket);
}

/* Along the inside of the bracket's corner: within the hull, 0.2 off the mesh. Through the torus's hole: likewise. */
CASE(a_curve_through_the_hull_but_clear_of_the_mesh_is_clear) {
  test_mesh bracket = mesh_bracket(), torus = mesh_torus(32, 16, 1.0, 0.3, 0.0);
  test_lod lods[2] = {lod_make(&bracket), lod_make(&torus)};
  const vec3 ways[2][2] = {{{0.3, 0.3, -1}, {0.3, 0.3, 1}}, {{0.1, 0, -1}, {-0.1, 0, 1}}};
  const double clear[2] = {0.2, 0.6};
  for (int i = 0; i < 2; i++) {
    cprox_curve *curve = bezier(ways[i], 2);
    const cprox_obstacle target = cprox_obstacle_at(lods[i].body, CPROX_POSE_IDENTITY);
    const cprox_options coarse = up_to(CPROX_LOD_HULL, 1e-6);
    cprox_result r;
    assert_int_equal(cprox_collision(cprox_point_along(curve), target, &coarse, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    assert_int_equal(r.lod, CPROX_LOD_HULL);
    assert_int_equal(cprox_collision(cprox_point_along(curve), target, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
    assert_int_equal(r.lod, CPROX_LOD_MESH);
    assert_int_equal(cprox_time_of_contact(cprox_point_along(curve), target, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
    assert_int_equal(cprox_tolerance(cprox_point_along(curve), target, clear[i] * 0.9, NULL, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
    cprox_curve_free(curve);
    lod_free(&lods[i]);
  }
  mesh_free(&bracket);
  mesh_free(&torus);
}

/* ---- what the hull spares ---- */

/* 30 tori (seed 87) in a cube, their bounding spheres overlapping; 60 curves. All ways to ask about many answer as the
 * meshes would. Together with a small box the answer is level of detail hull, no mesh looked into, where every hull is
 * farther than the box by the hundredth part that ranking may give away; where one is nearer, level of detail mesh. */
CASE(a_distance_climbs_only_where_the_hull_is_nearer_than_the_best) {
  enum { N = 30 };
  rng r = rng_seed(87);
  test_mesh torus = mesh_torus(24, 16, 0.4, 0.05, 0.1);
  test_lod l = lod_make(&torus);
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.1, 0.1, 0.1), ws, &box), CPROX_OK);
  cprox_obstacle lods[N + 1], meshes[N], hulls[N];
  for (int k = 0; k < N; k++) {
    const cprox_pose pose = rng_pose(&r, 2.5);
    lods[k] = cprox_obstacle_at(l.body, pose), meshes[k] = cprox_obstacle_at(l.mesh, pose),
    hulls[k] = cprox_obstacle_at(l.hull, pose);
  }
  lods[N] = cprox_obstacle_at(box, rng_pose(&r, 1.5));
  const vec3 there = lods[N].pose.position;
  size_t spared = 0, climbed = 0;
  for (size_t i = 0; i < 60; i++) {
    const vec3 way[2] = {vec_add(there, rng_in_cube(&r, 0.2)), vec_add(there, rng_in_cube(&r, 0.2))};
    cprox_curve *curve = i % 2 ? bezier(way, 2) : random_curve(&r, 2.5);
    cprox_result a, b, c, d;
    assert_int_equal(distance_of_list(cprox_point_along(curve), lods, N + 1, NULL, ws, &a, NULL), CPROX_OK);
    assert_int_equal(cprox_distance(cprox_point_along(curve), lods[N], NULL, ws, &b), CPROX_OK);
    assert_int_equal(distance_of_list(cprox_point_along(curve), hulls, N, NULL, ws, &c, NULL), CPROX_OK);
    assert_int_equal(distance_of_list(cprox_point_along(curve), meshes, N, NULL, ws, &d, NULL), CPROX_OK);
    const double upper = fmin(d.upper, b.upper), lower = fmin(d.lower, b.lower);
    assert_true(a.lower <= upper && lower <= a.upper && a.upper - a.lower <= 1e-6);
    if (0.99 * c.lower > b.upper + 1e-6) {
      spared++;
      assert_int_equal(a.lod, CPROX_LOD_HULL);
    }
    if (c.upper < b.lower - 1e-6) {
      climbed++;
      assert_int_equal(a.lod, CPROX_LOD_MESH);
    }
    cprox_curve_free(curve);
  }
  if (spared < 3 || climbed < 3) fail_msg("%zu were spared, %zu climbed", spared, climbed);
  for (size_t i = 0; i < 20; i++) {
    cprox_curve *curve = random_curve(&r, 1.0);
    cprox_result near[3], near_mesh[3];
    size_t n = 0, m;
    assert_int_equal(nearest_of_list(cprox_point_along(curve), lods, N, 3, NULL, ws, near, &n), CPROX_OK);
    assert_int_equal(nearest_of_list(cprox_point_along(curve), meshes, N, 3, NULL, ws, near_mesh, &m), CPROX_OK);
    assert_int_equal(n, 3);
    for (int k = 0; k < 3; k++) assert_true(fabs(near[k].upper - near_mesh[k].upper) <= 2e-6);
    cprox_result within[N], within_mesh[N];
    assert_int_equal(within_of_list(cprox_point_along(curve), lods, N, 0.3, NULL, ws, within, &n), CPROX_OK);
    assert_int_equal(within_of_list(cprox_point_along(curve), meshes, N, 0.3, NULL, ws, within_mesh, &m), CPROX_OK);
    assert_int_equal(n, m);
    for (size_t k = 0; k < n; k++) assert_int_equal(within[k].obstacle_index, within_mesh[k].obstacle_index);
    const double breaks[3] = {0.0, 0.3, 1.0};
    cprox_profile_interval p[2], q[2];
    assert_int_equal(profile_of_list(cprox_point_along(curve), lods, N, breaks, 2, NULL, ws, p), CPROX_OK);
    assert_int_equal(profile_of_list(cprox_point_along(curve), meshes, N, breaks, 2, NULL, ws, q), CPROX_OK);
    for (int k = 0; k < 2; k++) assert_true(p[k].lower <= q[k].upper && q[k].lower <= p[k].upper);
    cprox_curve_free(curve);
  }
  cprox_body_free(box);
  lod_free(&l);
  mesh_free(&torus);
}

/* Within the bracket's bounding sphere and 0.495 off its hull, a box 0.25 away: the ball says bracket first, the hull
 * says that it need not be looked into. */
CASE(a_mesh_waits_until_it_is_the_nearest_by_its_hull) {
  test_mesh bracket = mesh_bracket();
  test_lod l = lod_make(&bracket);
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.1, 0.1, 0.1), ws, &box), CPROX_OK);
  const vec3 way[2] = {{0.9, 0.9, -0.1}, {0.9, 0.9, 0.1}};
  cprox_curve *curve = bezier(way, 2);
  cprox_obstacle targets[2] = {cprox_obstacle_at(l.body, CPROX_POSE_IDENTITY),
                               cprox_obstacle_at(box, CPROX_POSE_IDENTITY)};
  targets[1].pose.position = vec(1.2, 0.9, 0.0);
  cprox_result r;
  assert_int_equal(distance_of_list(cprox_point_along(curve), targets, 2, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(r.lower <= 0.25 && 0.25 <= r.upper);
  assert_int_equal(r.obstacle_index, 1);
  assert_int_equal(r.lod, CPROX_LOD_HULL);
  cprox_curve_free(curve);
  cprox_body_free(box);
  lod_free(&l);
  mesh_free(&bracket);
}

/* A compound of 12 level-of-detail bodies (seed 89) against boxes and balls: cprox_pair is that of the meshes; by hulls
 * alone it is no farther. */
CASE(pairs_climb_too) {
  enum { N = 12 };
  rng r = rng_seed(89);
  test_mesh torus = mesh_torus(12, 8, 0.4, 0.1, 0.1);
  test_lod l = lod_make(&torus);
  const cprox_body *parts[N], *mesh_parts[N];
  cprox_pose poses[N];
  for (int k = 0; k < N; k++) parts[k] = l.body, mesh_parts[k] = l.mesh, poses[k] = rng_pose(&r, 2.0);
  cprox_body *all = NULL, *meshes = NULL, *box = NULL;
  assert_int_equal(cprox_body_create_compound(parts, poses, N, ws, &all), CPROX_OK);
  assert_int_equal(cprox_body_create_compound(mesh_parts, poses, N, ws, &meshes), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &box), CPROX_OK);
  for (size_t i = 0; i < 60; i++) {
    const cprox_obstacle other = cprox_obstacle_at(box, rng_pose(&r, 2.5));
    const cprox_options hull = up_to(CPROX_LOD_HULL, 1e-9), ball = up_to(CPROX_LOD_SPHERE, 1e-9);
    cprox_result a, b, c, d;
    assert_true(cprox_pair(cprox_obstacle_at(all, CPROX_POSE_IDENTITY), other, NULL, ws, &a) >= 0);
    assert_true(cprox_pair(cprox_obstacle_at(meshes, CPROX_POSE_IDENTITY), other, NULL, ws, &b) >= 0);
    assert_true(cprox_pair(cprox_obstacle_at(all, CPROX_POSE_IDENTITY), other, &hull, ws, &c) >= 0);
    assert_true(cprox_pair(cprox_obstacle_at(all, CPROX_POSE_IDENTITY), other, &ball, ws, &d) >= 0);
    assert_true(a.lower <= b.upper && b.lower <= a.upper);
    assert_true(c.lower <= b.upper && d.lower <= c.upper);
    assert_int_equal(a.lod, CPROX_LOD_MESH);
    assert_int_equal(c.lod, CPROX_LOD_HULL);
    assert_int_equal(d.lod, CPROX_LOD_SPHERE);
  }
  cprox_body_free(all);
  cprox_body_free(meshes);
  cprox_body_free(box);
  lod_free(&l);
  mesh_free(&torus);
}

/* ---- bad input ---- */

static void expect_reason(cprox_status status, const char *words) {
  assert_int_equal(status, CPROX_INVALID);
  if (!strstr(cprox_workspace_error(ws), words)) fail_msg("'%s' does not say '%s'", cprox_workspace_error(ws), words);
}

CASE(bad_input_is_refused_with_a_message) {
  test_mesh torus = mesh_torus(12, 8, 1.0, 0.3, 0.0);
  test_lod l = lod_make(&torus);
  cprox_body *ball = NULL, *made = NULL, *halfspace = NULL;
  assert_int_equal(cprox_body_create_sphere(1.0, ws, &ball), CPROX_OK);
  assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0.0, ws, &halfspace), CPROX_OK);
  expect_reason(cprox_body_create_lod(ball, 0.1, l.mesh, ws, &made), "beyond the hull");
  expect_reason(cprox_body_create_lod(l.hull, -1.0, l.mesh, ws, &made), "excess");
  expect_reason(cprox_body_create_lod(l.mesh, 0.0, l.mesh, ws, &made), "must be convex");
  expect_reason(cprox_body_create_lod(halfspace, 0.0, l.mesh, ws, &made), "must be convex");
  expect_reason(cprox_body_create_lod(l.hull, 0.0, l.hull, ws, &made), "must be a mesh");
  expect_reason(cprox_body_create_lod(NULL, 0.0, l.mesh, ws, &made), "hull is NULL");
  assert_null(made);
  /* a hull that is too small, made up for by the excess */
  assert_int_equal(cprox_body_create_lod(ball, 0.31, l.mesh, ws, &made), CPROX_OK);
  const vec3 way[2] = {{2, -1, 0}, {2, 1, 0}};
  cprox_curve *curve = bezier(way, 2);
  const cprox_obstacle target = cprox_obstacle_at(made, CPROX_POSE_IDENTITY);
  cprox_result r;
  const cprox_options coarse = up_to(CPROX_LOD_HULL, 1e-6), wrong = up_to((cprox_lod)9, 1e-6);
  assert_int_equal(cprox_distance(cprox_point_along(curve), target, &coarse, ws, &r), CPROX_OK);
  assert_true(fabs(r.upper - (2.0 - 1.0 - 0.31)) < 2e-6);
  expect_reason(cprox_distance(cprox_point_along(curve), target, &wrong, ws, &r), "max_lod");
  expect_reason(cprox_distance(cprox_body_along(l.body, curve), target, NULL, ws, &r), "carried");

  /* carried, and past a level-of-detail body, by the hulls where that is allowed: the same as the hulls themselves */
  cprox_result own;
  assert_int_equal(
      cprox_distance(cprox_body_along(l.body, curve), cprox_obstacle_at(l.body, CPROX_POSE_IDENTITY), &coarse, ws, &r),
      CPROX_OK);
  assert_int_equal(cprox_distance(cprox_body_along(l.hull, curve), cprox_obstacle_at(l.hull, CPROX_POSE_IDENTITY),
                                  &coarse, ws, &own),
                   CPROX_OK);
  assert_true(r.lower <= own.upper && own.lower <= r.upper);
  cprox_body_free(made);
  cprox_body_free(ball);
  cprox_body_free(halfspace);
  cprox_curve_free(curve);
  lod_free(&l);
  mesh_free(&torus);
}

/* ---- one answer for all ---- */

static cprox_status ask_all(int query_type, cprox_mover mover, const cprox_obstacle *targets, size_t n,
                            const cprox_options *options, cprox_result *all, cprox_result *each) {
  if (query_type == 0) return distance_of_list(mover, targets, n, options, ws, all, each);
  if (query_type == 1) return tolerance_of_list(mover, targets, n, 0.3, options, ws, all, each);
  return collision_of_list(mover, targets, n, options, ws, all, each);
}

/* Whether an interval is what the options or the verdict ask for. */
static bool is_enough(int query_type, const cprox_options *options, const cprox_result *r) {
  const double limit = query_type == 1 ? 0.3 : 0.0;
  if (query_type > 0 && (r->upper <= limit || r->lower > limit)) return true;
  return !(r->upper - r->lower > fmax(options->epsilon, options->relative_epsilon * r->upper));
}

/* Seed 84, 1500 queries of three queries about up to 6 level-of-detail bodies and hulls, most with a budget that is too
 * small for some of them: the answer to all is the union of the answers to each, with the finest level of detail among
 * them, and it is called short where its own interval is. */
CASE(the_answer_to_all_is_the_union_of_the_answers_to_each) {
  rng r = rng_seed(84);
  test_mesh torus = mesh_torus(16, 10, 1.0, 0.3, 0.1), bracket = mesh_bracket();
  test_lod lods[2] = {lod_make(&torus), lod_make(&bracket)};
  size_t finer = 0, enough = 0, shorter = 0;
  for (size_t i = 0; i < test_cases(1500); i++) {
    const int query_type = (int)rng_index(&r, 3);
    const size_t n = 2 + rng_index(&r, 5);
    cprox_obstacle targets[6];
    for (size_t k = 0; k < n; k++) {
      const test_lod *l = &lods[rng_index(&r, 2)];
      targets[k] = cprox_obstacle_at(rng_index(&r, 3) ? l->body : l->hull, rng_pose(&r, 2.5));
    }
    cprox_curve *curve = random_curve(&r, 2.5);
    cprox_options options = up_to(CPROX_LOD_MESH, rng_log_uniform(&r, 1e-9, 1e-2));
    if (rng_index(&r, 2)) options.relative_epsilon = rng_log_uniform(&r, 1e-6, 1e-1);
    if (rng_index(&r, 4)) options.max_nodes = 1 + (uint32_t)rng_index(&r, 30);

    cprox_result all, each[6];
    const cprox_status status = ask_all(query_type, cprox_tube_along(curve, 0.02), targets, n, &options, &all, each);
    assert_true(status >= 0 && status == all.status);
    cprox_result expected = {.lower = INFINITY, .upper = INFINITY};
    cprox_status blamed = CPROX_OK, worst = CPROX_OK;
    for (size_t k = 0; k < n; k++) {
      if (each[k].lower < expected.lower) expected.lower = each[k].lower, blamed = each[k].status;
      expected.upper = fmin(expected.upper, each[k].upper);
      if (each[k].lod > expected.lod) expected.lod = each[k].lod;
      if (each[k].status > worst) worst = each[k].status;
      expected.nodes += each[k].nodes, expected.distance_queries += each[k].distance_queries;
    }
    expected.lower = fmin(expected.lower, expected.upper);
    if (!(all.lower == expected.lower && all.upper == expected.upper && all.nodes == expected.nodes &&
          all.distance_queries == expected.distance_queries))
      fail_msg("case %zu: [%.17g, %.17g], not [%.17g, %.17g]", i, all.lower, all.upper, expected.lower, expected.upper);
    if (all.lod != expected.lod)
      fail_msg("case %zu: %s, but %s was needed", i, cprox_lod_name(all.lod), cprox_lod_name(expected.lod));
    if (status != (is_enough(query_type, &options, &all) ? CPROX_OK : blamed))
      fail_msg("case %zu: %s, [%.17g, %.17g]", i, cprox_status_name(status), all.lower, all.upper);
    assert_true((status == CPROX_OK) == (cprox_workspace_error(ws)[0] == '\0'));
    assert_int_equal(all.obstacle_index < 0, isinf(all.upper));
    if (all.obstacle_index >= 0) assert_true(all.upper == each[all.obstacle_index].upper);
    finer += all.obstacle_index >= 0 && all.lod > each[all.obstacle_index].lod;
    enough += status == CPROX_OK && worst != CPROX_OK, shorter += status != CPROX_OK;
    cprox_curve_free(curve);
  }
  print_message(
      "%zu needed a finer model than their nearest, %zu were enough though one of them was not, %zu fell short\n",
      finer, enough, shorter);
  assert_true(finer > 20 && enough > 20 && shorter > 20);
  for (int i = 0; i < 2; i++) lod_free(&lods[i]);
  mesh_free(&torus);
  mesh_free(&bracket);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
