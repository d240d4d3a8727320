/* SPDX-License-Identifier: BSD-3-Clause */
/* Verdicts about robots, which lanes look at first: held against the certified distance of the same motion, and against
 * the verdict of the search alone. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "edges/first_level.h"
#include "kinematics/motion.h"
#include "problem/problem.h"
#include "robot_query/answer.h"
#include "solve/robot_verdict.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/robots.h"

enum { GEOMETRIES = 2 * TEST_MAX_LINKS, OBSTACLES = 6, POINTS = 10, PAIRS = GEOMETRIES * GEOMETRIES };

typedef struct scene {
  test_robot t; /* its links */
  cprox_link_geometry geometries[GEOMETRIES];
  size_t n_geometries, n;
  vec3 base; /* all stands about here */
  cprox_obstacle targets[OBSTACLES];
  cprox_robot_pair pairs[PAIRS], selves[PAIRS];
  size_t n_pairs, n_selves;
  bool round;
  cprox_robot *robot;
  cprox_motion *motion;
} scene;

static cprox_body *random_body(rng *r, double size, bool round) {
  cprox_body *b = NULL;
  const double a = size * rng_uniform(r, 0.2, 1.0), c = size * rng_uniform(r, 0.2, 1.0);
  vec3 points[12];
  for (int k = 0; k < 12; k++) points[k] = rng_in_cube(r, size);
  cprox_status status;
  uint32_t triangles[4][3];
  for (int k = 0; k < 12; k++) triangles[k / 3][k % 3] = (uint32_t)k;
  switch (round ? 2 * rng_index(r, 2) : rng_index(r, 7)) {
    case 0: status = cprox_body_create_sphere(a, ws, &b); break;
    case 1: status = cprox_body_create_box(vec(a, c, size * rng_uniform(r, 0.01, 1.0)), ws, &b); break;
    case 2: status = cprox_body_create_capsule(2.0 * c, 0.5 * a, ws, &b); break;
    case 3: status = cprox_body_create_cylinder(a, 2.0 * c, ws, &b); break;
    case 4: status = cprox_body_create_cone(a, 2.0 * c, ws, &b); break;
    case 5: status = cprox_body_create_polytope(points, 12, ws, &b); break;
    default:
      status = cprox_body_create_mesh(points, 12, (const uint32_t(*)[3])triangles, 4, CPROX_MESH_FILL_SURFACE, SIZE_MAX,
                                      ws, &b);
  }
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return b;
}

/* A state, a line, a cubic, a quintic, a B-spline of any degree and one segment, or lines and cubics between waypoints.
 */
static void make_motion(rng *r, double scale, scene *s) {
  double values[POINTS][TEST_MAX_VARIABLES + 1], knots[2 * POINTS];
  int32_t variables[TEST_MAX_VARIABLES + 1];
  const size_t n = s->t.n_variables, kind = rng_index(r, 5), degree = 1 + rng_index(r, POINTS - 1);
  const double speed = rng_log_uniform(r, 1e-3, 2.0), t0 = rng_uniform(r, -2, 2), t1 = t0 + rng_log_uniform(r, 0.1, 10);
  for (size_t i = 0; i < n; i++) {
    variables[i] = (int32_t)i;
    const double middle = rng_uniform(r, -2, 2);
    const bool stands = rng_index(r, 5) == 0;
    for (size_t k = 0; k < POINTS; k++) values[k][i] = middle + (stands ? 0.0 : speed * rng_uniform(r, -1, 1));
    for (size_t k = 0; k < s->t.n_links; k++) {
      const cprox_link *l = &s->t.links[k];
      const bool shifts = l->type == CPROX_JOINT_PRISMATIC || l->type == CPROX_JOINT_PLANAR;
      if (!shifts || (size_t)l->variable != i) continue;
      for (size_t p = 0; p < POINTS; p++) values[p][i] *= scale;
      break;
    }
  }
  cprox_waypoint ends[2] = {{.time = t0, .positions = values[0]}, {.time = t1, .positions = values[1]}};
  for (int k = 0; k < 2; k++) ends[k].velocities = values[2 + k], ends[k].accelerations = values[4 + k];
  double control[POINTS * (TEST_MAX_VARIABLES + 1)];
  for (size_t k = 0; k <= degree; k++) memcpy(control + k * n, values[k], n * sizeof *control);
  for (size_t k = 0; k < 2 * (degree + 1); k++) knots[k] = k <= degree ? t0 : t1;
  cprox_motion_description d = {.variables = variables, .n_variables = n, .waypoints = ends, .n_waypoints = 2};
  cprox_waypoint many[POINTS];
  d.kind = CPROX_MOTION_WAYPOINTS;
  d.interpolation = kind == 1   ? CPROX_INTERPOLATION_LINEAR
                    : kind == 2 ? CPROX_INTERPOLATION_CUBIC
                                : CPROX_INTERPOLATION_QUINTIC;
  if (kind == 0 || n == 0) d = (cprox_motion_description){.kind = CPROX_MOTION_STATE, .rest = values[0]};
  if (kind == 4 && n > 0)
    d = (cprox_motion_description){.kind = CPROX_MOTION_BSPLINE,
                                   .variables = variables,
                                   .n_variables = n,
                                   .control = control,
                                   .n_control = degree + 1,
                                   .degree = degree,
                                   .knots = knots,
                                   .n_knots = 2 * (degree + 1)};
  if (kind == 3 && rng_index(r, 2) && n > 0) { /* waypoints, with all that they may know or less */
    for (size_t k = 0; k < POINTS; k++)
      many[k] = (cprox_waypoint){.time = t0 + (double)k * (t1 - t0) / POINTS, .positions = values[k]};
    for (size_t k = 0; k + 2 < POINTS && rng_index(r, 2); k++) many[k].velocities = values[k + 2];
    d.interpolation = CPROX_INTERPOLATION_BY_WAYPOINTS;
    d.waypoints = many, d.n_waypoints = 2 + rng_index(r, POINTS - 1);
  }
  if (cprox_motion_create(s->robot, &d, ws, &s->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static void make_scene(rng *r, double scale, scene *s) {
  robot_make(r, 0.5, &s->t);
  const double away = rng_index(r, 3) ? 0.0 : scale * rng_log_uniform(r, 1e2, 1e14);
  s->base = vec_scale(away, rng_unit(r));
  const bool round = s->round = rng_index(r, 3); /* links of spheres and capsules, but for a few */
  s->n_geometries = s->n_pairs = s->n_selves = 0;
  for (size_t i = 0; i < s->t.n_links; i++) {
    cprox_link *l = &s->t.links[i];
    if (l->type == CPROX_JOINT_FLOATING && rng_index(r, 8)) l->type = CPROX_JOINT_FIXED;
    l->origin.position = vec_scale(scale, l->origin.position);
    if (l->parent < 0) l->origin.position = vec_add(s->base, l->origin.position);
    for (size_t k = rng_index(r, 3); k-- > 0; s->n_geometries++) {
      s->geometries[s->n_geometries] =
          (cprox_link_geometry){.body = random_body(r, 0.15 * scale, round && rng_index(r, 10)),
                                .pose = rng_pose(r, 0.2 * scale),
                                .link = (int32_t)i};
      if (rng_index(r, 4) == 0) s->geometries[s->n_geometries].margin = scale * rng_uniform(r, 0, 0.05);
    }
  }
  if (cprox_robot_create(s->t.links, s->t.n_links, s->geometries, s->n_geometries, s->t.n_variables, ws, &s->robot) !=
      CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  s->n = 1 + rng_index(r, OBSTACLES);
  for (size_t i = 0; i < s->n; i++) {
    s->targets[i] = cprox_obstacle_at(random_body(r, 0.4 * scale, false), rng_pose(r, 1.5 * scale));
    s->targets[i].pose.position = vec_add(s->base, s->targets[i].pose.position);
    if (rng_index(r, 4) == 0) s->targets[i].margin = scale * rng_uniform(r, 0, 0.05);
  }
  for (size_t g = 0; g < s->n_geometries; g++) {
    for (size_t k = 0; k < s->n; k++)
      if (rng_index(r, 4)) s->pairs[s->n_pairs++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
    for (size_t k = 0; k < g; k++)
      if (rng_index(r, 2)) s->selves[s->n_selves++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
  }
  make_motion(r, scale, s);
}

static void free_scene(scene *s) {
  cprox_motion_free(s->motion);
  cprox_robot_free(s->robot);
  for (size_t i = 0; i < s->n; i++) cprox_body_free((cprox_body *)s->targets[i].body);
  for (size_t i = 0; i < s->n_geometries; i++) cprox_body_free((cprox_body *)s->geometries[i].body);
  robot_free(&s->t);
}

static cprox_mover mover_of(rng *r, const scene *s, bool *targets) {
  const bool lists = rng_index(r, 2);
  const size_t kind = rng_index(r, 3);
  *targets = kind != 1;
  cprox_mover m = kind == 1 ? cprox_robot_self(s->motion, lists ? s->selves : NULL, lists ? s->n_selves : 0)
                            : cprox_robot_along(s->motion, lists ? s->pairs : NULL, lists ? s->n_pairs : 0);
  if (kind != 2) return m;
  m.kind = CPROX_MOVER_ROBOT_WHOLE;
  m.self_pairs = rng_index(r, 2) ? s->selves : NULL, m.n_self_pairs = m.self_pairs ? s->n_selves : 0;
  return m;
}

/* Does the result name two geometries of the robot as the list does, if there is one? */
static bool is_as_listed(const cprox_mover *m, size_t n, const cprox_result *r) {
  const bool whole = m->kind == CPROX_MOVER_ROBOT_WHOLE;
  const size_t first = whole ? n : 0;
  if (r->obstacle_index < 0 || m->kind == CPROX_MOVER_ROBOT || (whole && (size_t)r->obstacle_index < n)) return true;
  const cprox_robot_pair *list = whole ? m->self_pairs : m->pairs;
  const int32_t other = r->obstacle_index - (int32_t)first;
  if (!list) return true;
  for (size_t i = 0; i < (whole ? m->n_self_pairs : m->n_pairs); i++)
    if (list[i].geometry == r->mover_part && list[i].other == other) return true;
  return false;
}

/* 600 scenes (seed 411; sizes of 1e-2 to 1e2 m, a third of them 1e2 to 1e14 times as far from the origin), 12 verdicts
 * each, all of a distance of 0 or beside the true one by 1e-7 to 1e-1 of the size. The distance that is certified by
 * the search alone never contradicts a verdict or an interval, and what the search alone decides is decided, and is
 * the same. */
CASE(verdicts_and_intervals_agree_with_the_certified_distance) {
  rng r = rng_seed(411);
  size_t counts[3] = {0}, lanes[4] = {0};
  uint64_t nodes[2] = {0}; /* of verdicts of robots of hulls that lanes find clear, and of the search alone */
  for (size_t i = 0; i < test_cases(600); i++) {
    const double scale = rng_log_uniform(&r, 1e-2, 1e2);
    scene s;
    make_scene(&r, scale, &s);
    for (int k = 0; k < 12; k++) {
      bool about_targets;
      const cprox_mover mover = mover_of(&r, &s, &about_targets);
      const cprox_obstacle *targets = about_targets ? s.targets : NULL;
      const size_t n = about_targets ? s.n : 0;
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-7 * scale;
      const cprox_motion_info info = cprox_motion_get_info(s.motion);
      const double part[2] = {info.t0 + (info.t1 - info.t0) * rng_uniform(&r, 0, 0.4),
                              info.t0 + (info.t1 - info.t0) * rng_uniform(&r, 0.6, 1)};
      if (rng_index(&r, 3) == 0 && part[0] < part[1]) options.interval = part;

      query q = query_create(mover, targets, n, -1.0, &options, ws);
      assert_int_equal(query_begin(&q, (arguments_query){"the test", ~0u}), CPROX_OK);
      cprox_result exact, searched, r1;
      assert_true(robot_answer(&q, 0, n, INFINITY, &exact) >= 0);
      double delta = 0.0;
      if (rng_index(&r, 4) && isfinite(exact.upper))
        delta = fmax(exact.upper + scale * rng_log_uniform(&r, 1e-7, 1e-1) * (rng_index(&r, 2) ? 1 : -1), 0.0);

      q.limit = delta;
      edge_first first;
      workspace_forget_work(ws);
      const size_t by_lanes = edge_first_level(&q, 0, n, k % 2, &first) ? (size_t)first.verdict : 3;
      lanes[by_lanes]++;
      workspace_forget_work(ws);
      assert_true(robot_answer(&q, 0, n, INFINITY, &searched) >= 0);
      workspace_forget_work(ws);
      assert_true(robot_verdict(&q, 0, n, INFINITY, &r1) >= 0);
      counts[r1.verdict]++;
      if (!s.round && by_lanes == CPROX_VERDICT_CLEAR) nodes[0] += r1.nodes, nodes[1] += searched.nodes;

      const char *wrong = NULL;
      if (r1.verdict == CPROX_VERDICT_CLEAR && !(exact.upper > delta)) wrong = "clear";
      if (r1.verdict == CPROX_VERDICT_VIOLATED && !(exact.lower <= delta)) wrong = "violated";
      if (r1.lower > exact.upper) wrong = "lower";
      if (r1.upper < exact.lower) wrong = "upper";
      if (r1.lower > r1.upper) wrong = "interval";
      const bool within_epsilon =
          fabs(exact.upper - delta) <= 2.0 * options.epsilon + 4.0 * (exact.upper - exact.lower);
      if (searched.verdict != CPROX_VERDICT_UNDECIDED && r1.verdict != searched.verdict && !within_epsilon)
        wrong = "another verdict";
      if (searched.verdict != CPROX_VERDICT_UNDECIDED && r1.verdict != CPROX_VERDICT_UNDECIDED &&
          r1.verdict != searched.verdict)
        wrong = "the opposite verdict";
      if (r1.verdict == CPROX_VERDICT_CLEAR && !(r1.lower > delta)) wrong = "lower of clear";
      if (isfinite(r1.upper) && r1.upper > 0.0 && vec_norm(s.base) == 0.0) {
        const double apart = vec_norm(vec_sub(r1.witness_mover, r1.witness_obstacle));
        if (!(fabs(apart - r1.upper) <= 1e-6 * scale)) wrong = "witness";
        if (r1.mover_part < 0 || r1.obstacle_index < 0 || !(r1.t >= q.t0 && r1.t <= q.t1)) wrong = "place";
      }
      if (!is_as_listed(&mover, n, &searched)) wrong = "order of a pair in the search";
      if (!is_as_listed(&mover, n, &r1)) wrong = "order of a pair";
      if (wrong)
        fail_msg("scene %zu, %d: %s: [%.9g, %.9g] (%d), searched [%.9g, %.9g] (%d), exact [%.9g, %.9g], delta %.9g", i,
                 k, wrong, r1.lower, r1.upper, (int)r1.verdict, searched.lower, searched.upper, (int)searched.verdict,
                 exact.lower, exact.upper, delta);
    }
    free_scene(&s);
  }
  print_message("clear, undecided, violated: %zu %zu %zu; lanes %zu %zu %zu, not asked %zu\n",
                counts[CPROX_VERDICT_CLEAR], counts[CPROX_VERDICT_UNDECIDED], counts[CPROX_VERDICT_VIOLATED],
                lanes[CPROX_VERDICT_CLEAR], lanes[CPROX_VERDICT_UNDECIDED], lanes[CPROX_VERDICT_VIOLATED], lanes[3]);
  print_message("hulls that lanes find clear: %" PRIu64 " nodes, by the search alone %" PRIu64 "\n", nodes[0],
                nodes[1]);
  assert_true(2 * nodes[0] < nodes[1]);
}

/* A ball of radius .1 or .4 slides past another one, .4 m away: what the workspace keeps of one robot is not the other's,
 * however alike they are; nor where the first one is freed and the second one gets its memory. */
CASE(a_workspace_keeps_nothing_of_one_robot_for_another) {
  const double radii[2] = {0.1, 0.4};
  cprox_body *balls[2], *post;
  cprox_robot *robots[2];
  cprox_motion *motions[2];
  for (int k = 0; k < 2; k++) assert_int_equal(cprox_body_create_sphere(radii[k], ws, &balls[k]), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &post), CPROX_OK);
  const cprox_obstacle obstacle =
      cprox_obstacle_at(post, (cprox_pose){.position = vec(0, 0.4, 0), .orientation = {1, 0, 0, 0}});
  const cprox_link link = {.parent = -1,
                           .type = CPROX_JOINT_PRISMATIC,
                           .origin = CPROX_POSE_IDENTITY,
                           .axis = vec(1, 0, 0),
                           .multiplier = 1};
  const int32_t variable = 0;
  const double from = -1, to = 1;
  const cprox_waypoint ends[2] = {{.time = 0, .positions = &from}, {.time = 1, .positions = &to}};
  const cprox_motion_description line = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR,
                                         .variables = &variable,
                                         .n_variables = 1,
                                         .waypoints = ends,
                                         .n_waypoints = 2};
  for (int i = 0; i < 12; i++) {
    const int first = i % 2, both = i < 6;
    for (int k = 0; k < 2; k++) {
      const int which = k == 0 ? first : !first;
      const cprox_link_geometry geometry = {.body = balls[which], .pose = CPROX_POSE_IDENTITY};
      assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robots[k]), CPROX_OK);
      assert_int_equal(cprox_motion_create(robots[k], &line, ws, &motions[k]), CPROX_OK);
      cprox_result r;
      assert_int_equal(cprox_collision(cprox_robot_along(motions[k], NULL, 0), obstacle, NULL, ws, &r), CPROX_OK);
      assert_int_equal(r.verdict, which ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
      if (both && k == 0) continue;
      for (int j = both ? 0 : k; j <= k; j++) cprox_motion_free(motions[j]), cprox_robot_free(robots[j]);
    }
  }
  for (int k = 0; k < 2; k++) cprox_body_free(balls[k]);
  cprox_body_free(post);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
