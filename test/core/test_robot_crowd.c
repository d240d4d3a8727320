/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots among many targets that form a set: whatever the tree of their boxes leaves out, the answers are those of
 * single targets, one query each. Targets are boxes, balls, cylinders, compounds, surfaces, and among some a halfspace.
 */
#include <math.h>

#include "broadphase/obstacle_set.h"
#include "curve_proximity/cprox.h"
#include "problem/obstacles.h"
#include "robot_query/cluster.h"
#include "solve/solve.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { MOST_TARGETS = 300, KINDS = 6, ROBOTS = 24 };

typedef struct crowd {
  cprox_body *bodies[KINDS];
  cprox_obstacle targets[MOST_TARGETS];
  size_t n;
  cprox_obstacles *set;
} crowd;

static cprox_body *surface(rng *r) {
  cprox_vec3 v[12];
  uint32_t triangles[4][3];
  for (uint32_t i = 0; i < 12; i++) {
    v[i] = rng_in_cube(r, 0.1);
    triangles[i / 3][i % 3] = i;
  }
  cprox_body *mesh = NULL;
  assert_int_equal(
      cprox_body_create_mesh(v, 12, (const uint32_t(*)[3])triangles, 4, CPROX_MESH_FILL_SURFACE, SIZE_MAX, ws, &mesh),
      CPROX_OK);
  return mesh;
}

/* Nearer than `clear` to the robot's base stands nothing, but for the ground. */
static void make_crowd(rng *r, size_t n, double clear, double half, crowd *c) {
  *c = (crowd){.n = n};
  assert_int_equal(cprox_body_create_box((cprox_vec3){0.2, 0.1, 0.05}, ws, &c->bodies[0]), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.08, ws, &c->bodies[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_cylinder(0.3, 0.02, ws, &c->bodies[2]), CPROX_OK);
  const cprox_body *const parts[2] = {c->bodies[0], c->bodies[1]};
  const cprox_pose poses[2] = {rng_pose(r, 0.1), rng_pose(r, 0.2)};
  assert_int_equal(cprox_body_create_compound(parts, poses, 2, ws, &c->bodies[3]), CPROX_OK);
  c->bodies[4] = surface(r);
  assert_int_equal(cprox_body_create_halfspace((cprox_vec3){0, 0, 1}, -half, ws, &c->bodies[5]), CPROX_OK);
  for (size_t i = 0; i < n; i++) {
    cprox_pose pose = rng_pose(r, half);
    while (vec_norm(pose.position) < clear) pose = rng_pose(r, half);
    c->targets[i] = cprox_obstacle_at(c->bodies[rng_index(r, 5)], pose);
    c->targets[i].margin = rng_index(r, 3) ? 0.0 : 0.03;
  }
  if (rng_index(r, 2))
    c->targets[rng_index(r, n)] = cprox_obstacle_at(c->bodies[5], (cprox_pose){.orientation = {.w = 1}});
  assert_int_equal(cprox_obstacles_create(c->targets, n, CPROX_INDEX_BVH, ws, &c->set), CPROX_OK);
}

static void free_crowd(crowd *c) {
  cprox_obstacles_free(c->set);
  cprox_body_free(c->bodies[3]); /* first what is made of others */
  for (int i = 0; i < KINDS; i++)
    if (i != 3) cprox_body_free(c->bodies[i]);
}

/* The least of what single queries say. */
static cprox_result least_of(const crowd *c, cprox_mover mover, const cprox_options *o) {
  cprox_result least = {.lower = INFINITY, .upper = INFINITY};
  for (size_t i = 0; i < c->n; i++) {
    cprox_result one;
    if (cprox_distance(mover, c->targets[i], o, ws, &one) < 0) fail_msg("target %zu: %s", i, cprox_workspace_error(ws));
    least.lower = fmin(least.lower, one.lower), least.upper = fmin(least.upper, one.upper);
  }
  return least;
}

/* Both intervals hold the truth and are within epsilon of each other's ends; verdicts hold on both sides of it. */
CASE(a_set_is_answered_as_its_targets_one_by_one) {
  rng r = rng_seed(6601);
  size_t touching = 0, apart = 0;
  for (size_t i = 0; i < test_cases(ROBOTS); i++) {
    test_robot t;
    crowd c;
    robot_make(&r, rng_uniform(&r, 0.3, 2.5), &t);
    make_crowd(&r, 20 + rng_index(&r, MOST_TARGETS - 20), i % 2 ? 4.0 : 0.0, 6.0, &c);
    const cprox_options o = accurate(1e-5);
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    const cprox_result one = least_of(&c, mover, &o);
    cprox_result all, listed;
    assert_int_equal(cprox_obstacles_distance(c.set, mover, &o, ws, &all, NULL), CPROX_OK);
    if (isinf(one.lower)) assert_true(isinf(all.lower)); /* nothing of it moves */
    if (isfinite(one.lower) &&
        !(all.lower <= one.upper && all.upper >= one.lower && all.upper - all.lower <= o.epsilon))
      fail_msg("robot %zu: [%.9g, %.9g], one by one [%.9g, %.9g]", i, all.lower, all.upper, one.lower, one.upper);
    if (isinf(one.lower)) {
      free_crowd(&c);
      robot_free(&t);
      continue;
    }
    assert_int_equal(distance_of_list(mover, c.targets, c.n, &o, ws, &listed, NULL), CPROX_OK);
    assert_true(all.lower <= listed.upper && listed.lower <= all.upper);

    /* the target that is named is as near as is said */
    assert_in_range(all.obstacle_index, 0, c.n - 1);
    cprox_result named;
    cprox_distance(mover, c.targets[all.obstacle_index], &o, ws, &named);
    assert_true(named.lower <= all.upper && named.upper >= all.lower);

    cprox_result verdict;
    cprox_obstacles_collision(c.set, mover, NULL, ws, &verdict, NULL);
    assert_int_equal(verdict.verdict, one.upper <= 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR);
    touching += one.upper <= 0.0, apart += one.lower > 0.0;
    if (one.lower > 0.0) {
      cprox_obstacles_tolerance(c.set, mover, 0.99 * one.lower, NULL, ws, &verdict, NULL);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
      cprox_obstacles_tolerance(c.set, mover, 1.01 * one.upper, NULL, ws, &verdict, NULL);
      assert_int_equal(verdict.verdict, CPROX_VERDICT_VIOLATED);
    }
    free_crowd(&c);
    robot_free(&t);
  }
  if (test_cases(ROBOTS) >= ROBOTS) assert_true(touching >= 3 && apart >= 3);
}

static bool count_look(void *user) {
  ++*(size_t *)user;
  return false;
}

/* A chain of 100 balls that swings to and fro under 100 others: 10,000 pairs, which all count as long as the search has
 * one node. A search that is to stop does not wait for all of them. */
CASE(the_stop_function_is_asked_within_a_node_of_many_pairs) {
  enum { LINKS = 100, POINTS = 20 };
  cprox_body *small = NULL, *large = NULL;
  assert_int_equal(cprox_body_create_sphere(0.02, ws, &small), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &large), CPROX_OK);
  cprox_link links[LINKS];
  cprox_link_geometry geometries[LINKS];
  cprox_obstacle targets[LINKS];
  for (int32_t i = 0; i < LINKS; i++) {
    links[i] = (cprox_link){.parent = i - 1,
                            .type = CPROX_JOINT_REVOLUTE,
                            .origin = {{i ? 0.05 : 0.0, 0, 0}, {1, 0, 0, 0}},
                            .axis = {0, 0, 1},
                            .variable = i,
                            .multiplier = 1.0};
    geometries[i] = (cprox_link_geometry){.body = small, .pose = {{0, 0, 0}, {1, 0, 0, 0}}, .link = i};
    targets[i] = cprox_obstacle_at(large, (cprox_pose){{0.05 * i, 0.0, 0.5}, {1, 0, 0, 0}});
  }
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_robot_create(links, LINKS, geometries, LINKS, LINKS, ws, &robot), CPROX_OK);
  double positions[POINTS];
  cprox_waypoint points[POINTS];
  for (size_t i = 0; i < POINTS; i++) {
    positions[i] = i % 2 ? 1.0 : -1.0;
    points[i] = (cprox_waypoint){.time = (double)i, .positions = &positions[i]};
  }
  const int32_t variable = 1;
  const double rest[LINKS] = {0};
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = &variable,
                                      .n_variables = 1,
                                      .waypoints = points,
                                      .n_waypoints = POINTS,
                                      .rest = rest};
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
  cprox_obstacles *list = NULL;
  assert_int_equal(cprox_obstacles_create(targets, LINKS, CPROX_INDEX_NONE, ws, &list), CPROX_OK);
  size_t looks = 0;
  cprox_options o = accurate(1e-5);
  o.max_nodes = 1, o.stop = count_look, o.stop_user = &looks;
  cprox_result result;
  assert_true(cprox_obstacles_tolerance(list, cprox_robot_along(motion, NULL, 0), 0.37, &o, ws, &result, NULL) >= 0);
  assert_true(looks >= 30);
  cprox_obstacles_free(list);
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(large);
  cprox_body_free(small);
}

/* Never later than the earliest contact with a single target, and no earlier than epsilon away from one. */
CASE(time_of_contact_with_a_set_is_the_earliest_of_its_targets) {
  rng r = rng_seed(6602);
  for (size_t i = 0; i < test_cases(6); i++) {
    test_robot t;
    crowd c;
    robot_make(&r, 1.0, &t);
    make_crowd(&r, 60, 0.5, 3.0, &c);
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    const cprox_options o = accurate(1e-5);
    double contact = INFINITY, free = INFINITY;
    bool clear = true;
    for (size_t k = 0; k < c.n; k++) {
      cprox_result one;
      cprox_time_of_contact(mover, c.targets[k], &o, ws, &one);
      if (one.verdict == CPROX_VERDICT_VIOLATED) contact = fmin(contact, one.t);
      free = fmin(free, one.t_contact_lower);
      clear = clear && one.verdict == CPROX_VERDICT_CLEAR;
    }
    cprox_result all;
    cprox_obstacles_time_of_contact(c.set, mover, &o, ws, &all);
    assert_true(all.t_contact_lower <= contact);
    if (all.verdict == CPROX_VERDICT_VIOLATED) assert_true(all.t >= free);
    assert_int_equal(all.verdict == CPROX_VERDICT_CLEAR, clear);
    free_crowd(&c);
    robot_free(&t);
  }
}

/* Beneath a node of the tree nothing is nearer than the node's lane says. A ball that slides straight at balls: its
 * travel is half of the way and not less, boxes touch the balls where it comes from, so that a bound with any of the
 * terms missing is too high. 1e-12 is the rounding of the truth, which is told by hand; boxes are widened by 1e-9 of
 * what they are made of. */
static double lanes_below(robot_scene *scene, uint32_t at, double travel, const double *truth, size_t *seen) {
  cluster_lanes lanes;
  cluster_view view = cluster_see(scene, 0, false);
  view.displacement = travel;
  cluster_measure(&view, at, INFINITY, &lanes);
  double least = INFINITY;
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    if (!(lanes.live >> l & 1u)) continue;
    const bool leaf = (at & TREE_LEAF) != 0;
    const double below =
        leaf ? truth[scene->q->set->of_box[lanes.under[l]]] : lanes_below(scene, lanes.under[l], travel, truth, seen);
    *seen += leaf;
    assert_true(lanes.lower[l] <= below + 1e-12);
    if (leaf) assert_true(lanes.lower[l] >= below - 1e-7);
    least = fmin(least, below);
  }
  return least;
}

/* The same by the box round a part, which stands askew: specks, whose boxes are no larger than they are, are as far
 * from it as a box in long double says, neither nearer nor farther. Specks are 1e-7 m wide. */
static void turned_lanes_below(const cluster_view *view, uint32_t at, double bar, const long double *truth,
                               const query *q, size_t *seen, size_t *raised, double *least) {
  cluster_lanes lanes;
  cluster_measure(view, at, bar, &lanes);
  if (at & TREE_LEAF) {
    const cluster_lanes ball = lanes;
    cluster_measure_boxes(view, at, bar, &lanes);
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      const long double exact = truth[q->set->of_box[lanes.under[l]]];
      if (lanes.live >> l & 1u) *seen += 1, *least = fmin(*least, (double)exact);
      *raised += lanes.lower[l] > ball.lower[l] + 1e-3;
      assert_true(lanes.lower[l] <= exact + 1e-12L);
      assert_true(lanes.lower[l] >= exact - 1e-6L);
    }
  }
  /* what is dropped is neither below the bar nor below what was seen of it */
  assert_true(lanes.dropped >= bar);
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    assert_true((lanes.live >> l & 1u) == 0 || lanes.lower[l] < bar);
    if (!(at & TREE_LEAF) && lanes.live >> l & 1u)
      turned_lanes_below(view, lanes.under[l], bar, truth, q, seen, raised, least);
  }
}

CASE(the_box_round_a_part_bounds_specks_exactly) {
  enum { SPECKS = 200 };
  rng r = rng_seed(6605);
  size_t raised = 0;
  for (size_t round = 0; round < test_cases(100); round++) {
    const vec3 half = vec(rng_log_uniform(&r, 0.01, 0.5), rng_log_uniform(&r, 0.01, 0.5), rng_uniform(&r, 0.01, 0.5));
    const double margin = round % 2 ? 0.03 : 0.0;
    cprox_body *box = NULL, *speck = NULL;
    assert_int_equal(cprox_body_create_box(vec_scale(2.0, half), ws, &box), CPROX_OK);
    assert_int_equal(cprox_body_create_sphere(5e-8, ws, &speck), CPROX_OK);
    const cprox_link link = {.parent = -1,
                             .type = CPROX_JOINT_REVOLUTE,
                             .origin = rng_pose(&r, 1.0),
                             .axis = rng_unit(&r),
                             .multiplier = 1.0};
    const cprox_link_geometry geometry = {.body = box, .pose = rng_pose(&r, 0.5), .margin = margin};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
    const double begin = -0.5, end = 0.5; /* the middle is the link's own frame */
    const int32_t variable = 0;
    const cprox_waypoint points[2] = {{.time = 0, .positions = &begin}, {.time = 1, .positions = &end}};
    const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                        .variables = &variable,
                                        .n_variables = 1,
                                        .waypoints = points,
                                        .n_waypoints = 2,
                                        .interpolation = CPROX_INTERPOLATION_LINEAR};
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);

    cprox_obstacle targets[SPECKS];
    long double truth[SPECKS];
    double nearest = INFINITY;
    for (size_t i = 0; i < SPECKS; i++) {
      const cprox_pose pose = {.position = rng_in_cube(&r, 2.0), .orientation = {.w = 1.0}};
      targets[i] = cprox_obstacle_at(speck, pose);
      const vec3l at = ref_to_local(&geometry.pose, ref_to_local(&link.origin, ref_vec(pose.position)));
      truth[i] = ref_point_box(at, half) - margin;
      nearest = fmin(nearest, (double)truth[i]);
    }
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(targets, SPECKS, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
    query q = query_create(cprox_robot_along(motion, NULL, 0), targets, SPECKS, -1.0, NULL, ws);
    q.set = set->bvh;
    robot_scene scene;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, SPECKS, SIZE_MAX, INFINITY));
    robot_scene_enter(&scene, 0, 0.0, 1.0);
    const cluster_view view = cluster_see(&scene, 0, false);
    for (int k = 0; k < 2; k++) { /* all of them, and those below a bar */
      size_t seen = 0;
      double least = INFINITY;
      turned_lanes_below(&view, 0, k == 0 ? INFINITY : nearest + 0.2, truth, &q, &seen, &raised, &least);
      assert_true(least == nearest);
      if (k == 0) assert_int_equal(seen, SPECKS);
    }
    cprox_obstacles_free(set);
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    cprox_body_free(box);
    cprox_body_free(speck);
  }
  assert_true(raised > 1000);
}

/* A box with a margin of its own size or more swings by +-0.1. Its corners move by the chord of the angle, in long
 * double; the margin about them adds nothing, and of the bound nothing may be missing either. */
CASE(no_corner_of_a_core_moves_farther_than_is_said_and_margins_add_nothing) {
  rng r = rng_seed(6606);
  double tightest = 0.0;
  for (size_t round = 0; round < test_cases(300); round++) {
    const double swing = 0.1, margin = rng_uniform(&r, 0.5, 2.0);
    const vec3 half = vec(rng_log_uniform(&r, 0.001, 0.5), rng_log_uniform(&r, 0.001, 0.5), rng_uniform(&r, 0.1, 0.5));
    const vec3 axis = rng_unit(&r);
    cprox_body *box = NULL;
    assert_int_equal(cprox_body_create_box(vec_scale(2.0, half), ws, &box), CPROX_OK);
    const cprox_link link = {
        .parent = -1, .type = CPROX_JOINT_REVOLUTE, .origin = CPROX_POSE_IDENTITY, .axis = axis, .multiplier = 1.0};
    const cprox_link_geometry geometry = {.body = box, .pose = rng_pose(&r, round % 2 ? 0.5 : 0.0), .margin = margin};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
    const double begin = -swing, end = swing;
    const int32_t variable = 0;
    const cprox_waypoint points[2] = {{.time = 0, .positions = &begin}, {.time = 1, .positions = &end}};
    const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                        .variables = &variable,
                                        .n_variables = 1,
                                        .waypoints = points,
                                        .n_waypoints = 2,
                                        .interpolation = CPROX_INTERPOLATION_LINEAR};
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
    const query q = query_create(cprox_robot_along(motion, NULL, 0), NULL, 0, -1.0, NULL, ws);
    robot_scene scene;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, 0, SIZE_MAX, INFINITY));
    robot_scene_enter(&scene, 0, 0.0, 1.0);
    const long double said = robot_scene_part_displacement(&scene, 0);

    long double moved = 0.0L;
    for (int k = 0; k < 8; k++) {
      const vec3 corner = vec(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
      const vec3l x = ref_to_world(&geometry.pose, ref_vec(corner));
      const long double arm = ref_norm(ref_cross(ref_vec(axis), x)) / ref_norm(ref_vec(axis));
      moved = fmaxl(moved, 2.0L * arm * sinl(0.5L * swing));
    }
    assert_true(said >= moved);
    const long double reach = ref_norm(ref_vec(geometry.pose.position)) + ref_norm(ref_vec(half));
    assert_true(said <= swing * reach * (1.0L + 1e-6L)); /* margins are larger than that */
    tightest = fmax(tightest, (double)(moved / said));
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    cprox_body_free(box);
  }
  assert_true(tightest > 0.98);
}

CASE(lanes_bound_what_is_under_them_over_the_whole_node) {
  enum { BALLS = 60 };
  rng r = rng_seed(6604);
  for (size_t round = 0; round < test_cases(200); round++) {
    const double own = rng_uniform(&r, 0.05, 0.2), other = rng_uniform(&r, 0.05, 0.2), way = rng_uniform(&r, 0.1, 2);
    const double margin = round % 2 ? 0.03 : 0.0;
    const vec3 axis = vec(round % 3 == 0, round % 3 == 1, round % 3 == 2);
    cprox_body *moving = NULL, *ball = NULL;
    assert_int_equal(cprox_body_create_sphere(own, ws, &moving), CPROX_OK);
    assert_int_equal(cprox_body_create_sphere(other, ws, &ball), CPROX_OK);
    const cprox_pose origin = CPROX_POSE_IDENTITY;
    const cprox_link link = {
        .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = origin, .axis = axis, .multiplier = 1.0};
    const cprox_link_geometry geometry = {.body = moving, .pose = origin, .margin = margin};
    cprox_robot *robot = NULL;
    assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
    const double begin = 0.0;
    const int32_t variable = 0;
    const cprox_waypoint points[2] = {{.time = 0, .positions = &begin}, {.time = 1, .positions = &way}};
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_motion_create(robot,
                                         &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                                     .variables = &variable,
                                                                     .n_variables = 1,
                                                                     .waypoints = points,
                                                                     .n_waypoints = 2,
                                                                     .interpolation = CPROX_INTERPOLATION_LINEAR},
                                         ws, &motion),
                     CPROX_OK);

    /* ahead of where the ball ends */
    cprox_obstacle targets[BALLS];
    double truth[BALLS];
    for (size_t i = 0; i < BALLS; i++) {
      cprox_pose pose = origin;
      const double at = way + 1.0 + 0.5 * (double)i;
      pose.position = vec_scale(at, axis);
      targets[i] = cprox_obstacle_at(ball, pose);
      truth[i] = at - way - own - margin - other;
    }
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(targets, BALLS, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
    query q = query_create(cprox_robot_along(motion, NULL, 0), targets, BALLS, -1.0, NULL, ws);
    q.set = set->bvh;
    robot_scene scene;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, BALLS, SIZE_MAX, INFINITY));
    robot_scene_enter(&scene, 0, 0.0, 1.0);
    size_t seen = 0;
    lanes_below(&scene, 0, robot_scene_part_displacement(&scene, 0), truth, &seen);
    assert_int_equal(seen, BALLS);
    cprox_obstacles_free(set);
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    cprox_body_free(moving);
    cprox_body_free(ball);
  }
}

/* A robot that moves among targets ten times as many looks at few more of them. */
CASE(the_work_hardly_grows_with_the_number_of_targets) {
  enum { MANY = 4000 };
  static cprox_obstacle targets[MANY];
  rng r = rng_seed(6603);
  test_robot t;
  robot_make(&r, 0.5, &t);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.02, ws, &ball), CPROX_OK);
  uint32_t distance_queries[2];
  for (int k = 0; k < 2; k++) {
    const size_t n = k ? MANY : MANY / 10;
    const double half = 3.0 * cbrt((double)n); /* as many in a place */
    for (size_t i = 0; i < n; i++) targets[i] = cprox_obstacle_at(ball, rng_pose(&r, half));
    cprox_obstacles *set = NULL;
    assert_int_equal(cprox_obstacles_create(targets, n, CPROX_INDEX_BVH, ws, &set), CPROX_OK);
    cprox_result all;
    assert_int_equal(cprox_obstacles_distance(set, cprox_robot_along(t.motion, NULL, 0), NULL, ws, &all, NULL),
                     CPROX_OK);
    distance_queries[k] = all.distance_queries + all.nodes;
    cprox_obstacles_free(set);
  }
  print_message("distances and nodes among %d targets: %u, among %d: %u\n", MANY / 10, distance_queries[0], MANY,
                distance_queries[1]);
  assert_true(distance_queries[1] <= 3 * distance_queries[0]);
  cprox_body_free(ball);
  robot_free(&t);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
