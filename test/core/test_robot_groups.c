/* SPDX-License-Identifier: BSD-3-Clause */
/* Groups of a robot's parts: which pairs they hold, against the list of all pairs; where their parts are and how far
 * these move, against long double; and whole searches with groups against those with a list. Random robots have every
 * type of joint and up to three geometries a link. */
#include <math.h>
#include <string.h>

#include "problem/problem.h"
#include "robot_query/groups.h"
#include "robot_query/oracle.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { MOST_GEOMETRIES = 3 * TEST_MAX_LINKS, MOST_PAIRS = MOST_GEOMETRIES * MOST_GEOMETRIES, SAMPLES = 6 };

/* A random robot whose links carry several geometries, each that of some link at its own place there. */
typedef struct crowded_robot {
  test_robot t;
  size_t n;
  size_t like[MOST_GEOMETRIES]; /* the link that the geometry hangs on, and that it was drawn for */
  cprox_robot *robot;
  cprox_motion *motion;
} crowded_robot;

static void make_crowded(rng *r, double speed, bool state, crowded_robot *c) {
  robot_make(r, speed, &c->t);
  cprox_link_geometry geometries[MOST_GEOMETRIES];
  c->n = 0;
  const size_t most = 2 + rng_index(r, 3 * c->t.n_links - 1);
  while (c->n < most) {
    const size_t link = rng_index(r, c->t.n_links);
    geometries[c->n] = c->t.geometries[link];
    c->like[c->n++] = link;
  }
  assert_int_equal(cprox_robot_create(c->t.links, c->t.n_links, geometries, c->n, c->t.n_variables, ws, &c->robot),
                   CPROX_OK);
  double values[TEST_MAX_VARIABLES + 1];
  cprox_motion_evaluate(c->t.motion, cprox_motion_get_info(c->t.motion).t0, values);
  const cprox_joined_motion one = {.motion = c->t.motion};
  const cprox_motion_description d =
      state ? (cprox_motion_description){.kind = CPROX_MOTION_STATE, .rest = values}
            : (cprox_motion_description){.kind = CPROX_MOTION_JOINED, .joined = &one, .n_joined = 1};
  if (cprox_motion_create(c->robot, &d, ws, &c->motion) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static void free_crowded(crowded_robot *c) {
  cprox_motion_free(c->motion);
  cprox_robot_free(c->robot);
  robot_free(&c->t);
}

/* Some pairs, or all (NULL). */
static cprox_robot_pair *draw_pairs(rng *r, const crowded_robot *c, cprox_robot_pair *pairs, size_t *n) {
  *n = 0;
  if (rng_index(r, 2)) return NULL;
  for (size_t i = 0; i < c->n; i++)
    for (size_t k = 0; k < i; k++)
      if (rng_index(r, 3) == 0)
        pairs[(*n)++] =
            rng_index(r, 2) ? (cprox_robot_pair){(int32_t)i, (int32_t)k} : (cprox_robot_pair){(int32_t)k, (int32_t)i};
  return pairs;
}

/* ---- which pairs ---- */

/* Opens everything: the numbers of the parts of each pair that comes out. */
static size_t list_all(robot_scene *s, int32_t (*parts)[2]) {
  group_pair stack[GROUP_STACK] = {{{0, 0}}};
  size_t count = s->groups ? 1 : 0, n = 0;
  while (count > 0) {
    const group_pair top = stack[--count];
    if (robot_groups_are_parts(s, top)) {
      const int32_t index = robot_groups_pair(s, top);
      assert_true(index >= 0 && n < MOST_PAIRS);
      parts[n][0] = s->pairs[index].moving, parts[n++][1] = s->pairs[index].standing;
      continue;
    }
    count += robot_groups_open(s, top, stack + count);
    assert_true(count <= GROUP_STACK);
  }
  return n;
}

CASE(groups_hold_the_pairs_of_the_list_each_once) {
  rng r = rng_seed(1801);
  size_t checked = 0, without = 0;
  for (size_t i = 0; i < test_cases(3000); i++) {
    crowded_robot c;
    make_crowded(&r, 1.0, rng_index(&r, 4) == 0, &c);
    static cprox_robot_pair given[MOST_PAIRS];
    size_t n_given;
    const cprox_robot_pair *pairs = draw_pairs(&r, &c, given, &n_given);
    const query q = query_create(cprox_robot_self(c.motion, pairs, n_given), NULL, 0, -1.0, NULL, ws);
    static int listed[MOST_GEOMETRIES][MOST_GEOMETRIES];
    memset(listed, 0, sizeof listed);
    robot_scene scene;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, 0, SIZE_MAX, INFINITY));
    assert_null(scene.groups);
    const size_t n_listed = scene.n_pairs;
    for (size_t k = 0; k < n_listed; k++) listed[scene.pairs[k].moving][scene.pairs[k].standing]++;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, 0, 0, INFINITY));
    robot_scene_enter(&scene, 0, 0.0, 1.0);
    static int32_t parts[MOST_PAIRS][2];
    const size_t n = list_all(&scene, parts);
    assert_int_equal(n, n_listed);
    for (size_t k = 0; k < n; k++) assert_int_equal(listed[parts[k][0]][parts[k][1]]--, 1);
    checked += n, without += n == 0;
    free_crowded(&c);
  }
  assert_true(checked > 10 * without);
  print_message("%zu pairs of %zu robots, %zu with none\n", checked, test_cases(3000), without);
}

/* ---- where they are ---- */

/* Points of the bodies of all geometries at a time: vertices, and points between them. */
enum { POINTS = TEST_VERTICES + 2 };

typedef struct placed_points {
  ref_pose links[TEST_MAX_LINKS];
  vec3l at[MOST_GEOMETRIES][POINTS];
} placed_points;

static void place_points(const crowded_robot *c, long double time, placed_points *p) {
  long double values[TEST_MAX_VARIABLES + 1];
  robot_ref_values(&c->t, time, values);
  robot_ref_links(&c->t, values, p->links);
  for (size_t g = 0; g < c->n; g++) {
    robot_ref_vertices(&c->t, p->links, c->like[g], p->at[g]);
    for (size_t k = TEST_VERTICES; k < POINTS; k++)
      p->at[g][k] = ref_scale(0.5L, ref_add(p->at[g][k - TEST_VERTICES], p->at[g][k - TEST_VERTICES + 2]));
  }
}

/* At random parts of random segments, and over random spans. */
static void enter_somewhere(rng *r, robot_scene *s) {
  const size_t n = s->motion->n_segments, first = rng_index(r, n);
  if (n > 1 && rng_index(r, 3) == 0) {
    const motion_interval over = {.b = 1.0, .first = first, .last = first + 1 + rng_index(r, n - first)};
    robot_scene_enter_span(s, &over);
    return;
  }
  const double width = rng_log_uniform(r, 1e-4, 1.0), a = rng_uniform(r, 0.0, 1.0 - width);
  robot_scene_enter(s, first, a, fmin(a + width, 1.0));
}

/* The time at a share of the interval, whatever the speed. */
static long double time_within(const robot_scene *s, long double share) {
  const motion_interval *over = &s->over;
  const double *t = s->motion->times;
  const long double t0 = t[over->first] + (long double)over->a * ((long double)t[over->first + 1] - t[over->first]),
                    t1 = t[over->last - 1] + (long double)over->b * ((long double)t[over->last] - t[over->last - 1]);
  return t0 + share * (t1 - t0);
}

static long double time_of_middle(const robot_scene *s) {
  const double *t = s->motion->times;
  return t[s->centre.segment] +
         (long double)s->centre.u * ((long double)t[s->centre.segment + 1] - t[s->centre.segment]);
}

/* The link with an axis, -1 for the world. */
static int link_of_axis(const crowded_robot *c, int32_t axis) {
  for (int l = 0; l < (int)c->t.n_links && axis >= 0; l++)
    if (c->robot->links[l].axis == axis) return l;
  return -1;
}

/* Where a point would be if the axis, at its link, stood still since the middle. */
static vec3l seen_from(const placed_points *middle, const placed_points *now, int link, vec3l x) {
  return link < 0 ? x : ref_pose_apply(&middle->links[link], ref_pose_undo(&now->links[link], x));
}

/* Long double is off by less than this of lengths of a few metres. */
static const long double ROOM = 1e-16L;

static void check_group(const crowded_robot *c, robot_scene *s, int32_t group, int32_t from,
                        const placed_points *middle, const placed_points *now, double *nearest) {
  const part_group *of = &c->robot->groups.at[group];
  const double most = robot_group_displacement(s, group, from);
  const int link = link_of_axis(c, from);
  for (int32_t p = of->first; p < of->last; p++) {
    const int32_t g = c->robot->parts[c->robot->groups.part[p]].geometry;
    for (int k = 0; k < POINTS; k++) {
      const long double way = ref_norm(ref_sub(seen_from(middle, now, link, now->at[g][k]), middle->at[g][k]));
      if (!(way <= most + ROOM)) fail_msg("a point of group %d moves %.17Lg, at most %.17g", group, way, most);
      if (most > 0.0) *nearest = fmax(*nearest, (double)(way / most));
    }
  }
}

static void check_pair(const crowded_robot *c, robot_scene *s, group_pair pair, const placed_points *now) {
  const part_groups *groups = &c->robot->groups;
  const double lower = robot_groups_apart(s, pair) - robot_groups_displacement(s, pair);
  const part_group *a = &groups->at[pair.group[0]], *b = &groups->at[pair.group[1]];
  for (int32_t p = a->first; p < a->last; p++)
    for (int32_t q = b->first; q < b->last; q++) {
      const int32_t g = c->robot->parts[groups->part[p]].geometry, h = c->robot->parts[groups->part[q]].geometry;
      for (int k = 0; k < POINTS; k++)
        for (int l = 0; l < POINTS; l++) {
          const long double apart = ref_norm(ref_sub(now->at[g][k], now->at[h][l])) - 2.0L * c->t.margin;
          if (!(lower <= apart + ROOM))
            fail_msg("groups %d and %d are %.17Lg apart, said to be %.17g", pair.group[0], pair.group[1], apart, lower);
        }
    }
}

/* Whether no part is in both. */
static bool are_apart(const part_groups *groups, group_pair pair) {
  const part_group *a = &groups->at[pair.group[0]], *b = &groups->at[pair.group[1]];
  return a->last <= b->first || b->last <= a->first;
}

/* 1e5 pairs of groups by hand at CPROX_TEST_SCALE=10. */
CASE(no_part_leaves_what_its_group_says) {
  rng r = rng_seed(1802);
  size_t groups = 0, pairs = 0;
  double nearest = 0.0;
  for (size_t i = 0; i < test_cases(300); i++) {
    crowded_robot c;
    make_crowded(&r, rng_log_uniform(&r, 0.05, 3), false, &c);
    const query q = query_create(cprox_robot_self(c.motion, NULL, 0), NULL, 0, -1.0, NULL, ws);
    robot_scene scene;
    assert_true(robot_scene_begin(&scene, &q, NULL, 0, 0, 0, INFINITY));
    const size_t n = scene.groups ? c.robot->groups.n : 0;
    for (int k = 0; k < 4 && n > 0; k++) {
      enter_somewhere(&r, &scene);
      static placed_points middle, now[SAMPLES + 1];
      place_points(&c, time_of_middle(&scene), &middle);
      for (int t = 0; t <= SAMPLES; t++) place_points(&c, time_within(&scene, (long double)t / SAMPLES), &now[t]);
      for (int m = 0; m < 16; m++) {
        const group_pair pair = {{(int32_t)rng_index(&r, n), (int32_t)rng_index(&r, n)}};
        /* any axis of a link above the group, in any order: what is known of the way up must not matter */
        int32_t from = c.robot->groups.at[pair.group[0]].axis;
        for (size_t up = rng_index(&r, 4); up > 0 && from >= 0; up--) {
          do from = c.robot->axes[from].parent;
          while (from >= 0 && link_of_axis(&c, from) < 0);
        }
        for (int t = 0; t <= SAMPLES; t++) check_group(&c, &scene, pair.group[0], from, &middle, &now[t], &nearest);
        groups++;
        if (!are_apart(&c.robot->groups, pair)) continue;
        for (int t = 0; t <= SAMPLES; t++) check_pair(&c, &scene, pair, &now[t]);
        pairs++;
      }
    }
    free_crowded(&c);
  }
  print_message("%zu groups, %zu pairs of groups; largest way / bound: %.3f\n", groups, pairs, nearest);
  assert_true(nearest > 0.5);
}

/* ---- whole searches ---- */

typedef struct searched {
  double lower, upper, free_until, touch;
  cprox_status status;
} searched;

static searched search(const crowded_robot *c, search_goal goal, size_t most_listed) {
  query q = query_create(cprox_robot_self(c->motion, NULL, 0), NULL, 0, -1.0, NULL, ws);
  query_ask_whole(&q);
  static robot_search o;
  assert_true(robot_scene_begin(&o.scene, &q, NULL, 0, 0, most_listed, INFINITY));
  robot_search_begin(&o, &goal);
  const motion_interval over = {.b = 1.0, .last = c->motion->n_segments};
  search_node root;
  assert_true(robot_search_root(&o, &over, &over, &root));
  const search_oracle oracle = robot_search_oracle(&o);
  search_outcome found;
  searched s;
  s.status = search_run(&o.goal, &oracle, root, ws, &found);
  assert_true(s.status >= 0);
  s.upper = o.best_bound.upper;
  s.lower = fmin(fmax(fmin(found.lower, o.dropped), 0.0), s.upper);
  s.free_until = found.free_until, s.touch = o.touch_at;
  return s;
}

/* Neither way is the reference: where both answer, they must not contradict each other. */
CASE(searches_by_groups_agree_with_searches_by_lists) {
  rng r = rng_seed(1803);
  size_t decided = 0;
  const size_t n = test_cases(120);
  for (size_t i = 0; i < n; i++) {
    crowded_robot c;
    make_crowded(&r, rng_log_uniform(&r, 0.05, 1), false, &c);
    search_goal goal = {.order = SEARCH_BEST_FIRST,
                        .limit = -1.0,
                        .cutoff = INFINITY,
                        .time_cutoff = INFINITY,
                        .epsilon = 1e-4,
                        .max_nodes = 3000};
    const searched list = search(&c, goal, SIZE_MAX), groups = search(&c, goal, 0);
    if (!(list.lower <= groups.upper && groups.lower <= list.upper))
      fail_msg("robot %zu: [%.17g, %.17g] by groups, [%.17g, %.17g] by a list", i, groups.lower, groups.upper,
               list.lower, list.upper);
    if (isfinite(list.upper) && list.status == CPROX_OK)
      assert_true(groups.upper - groups.lower <= goal.epsilon || groups.status != CPROX_OK);

    goal.order = SEARCH_DEPTH_FIRST;
    for (int k = 0; k < 2; k++) {
      goal.limit = isfinite(list.upper) ? list.upper * (k == 0 ? 0.9 : 1.1) : 0.1;
      const searched one = search(&c, goal, SIZE_MAX), other = search(&c, goal, 0);
      assert_false(one.lower > goal.limit && other.upper <= goal.limit);
      assert_false(other.lower > goal.limit && one.upper <= goal.limit);
      decided += other.lower > goal.limit || other.upper <= goal.limit;
    }

    goal.order = SEARCH_LEFT_TO_RIGHT;
    goal.limit = 0.0;
    const searched one = search(&c, goal, SIZE_MAX), other = search(&c, goal, 0);
    assert_true(one.free_until <= other.touch && other.free_until <= one.touch);
    free_crowded(&c);
  }
  print_message("%zu of %zu verdicts decided\n", decided, 2 * n);
  assert_true(decided > n);
}

/* ---- the tree of axes ---- */

static bool is_above(const cprox_robot *robot, int32_t axis, int32_t other) {
  while (other > axis) other = robot->axes[other].parent;
  return other == axis;
}

/* By the definition: above both, and none under it is. */
CASE(the_axis_above_two_others_is_the_nearest_that_carries_both) {
  rng r = rng_seed(1804);
  for (size_t i = 0; i < test_cases(300); i++) {
    test_robot t;
    robot_make(&r, 0.1, &t);
    const int32_t n = (int32_t)t.robot->n_axes;
    for (int32_t a = -1; a < n; a++)
      for (int32_t b = -1; b < n; b++) {
        int32_t nearest = -1;
        for (int32_t axis = 0; axis < n; axis++)
          if (is_above(t.robot, axis, a) && is_above(t.robot, axis, b)) nearest = axis;
        assert_int_equal(robot_common_axis(t.robot, a, b), nearest);
        assert_int_equal(robot_axis_carries(t.robot, a, b), a < 0 || is_above(t.robot, a, b));
      }
    robot_free(&t);
  }
}

/* ---- what a long chain costs ---- */

/* Far groups want a node cut only until they may be opened: finer pieces make all that is near be looked at again. */
CASE(a_chain_of_96_links_takes_few_nodes) {
  enum { LINKS = 96 };
  static cprox_link links[LINKS];
  static cprox_link_geometry bodies[LINKS];
  static double values[3][LINKS];
  int32_t variables[LINKS];
  rng r = rng_seed(91);
  cprox_body *capsule = NULL;
  assert_int_equal(cprox_body_create_capsule(0.12, 0.03, ws, &capsule), CPROX_OK);
  for (int32_t i = 0; i < LINKS; i++) {
    links[i] = (cprox_link){.parent = i - 1,
                            .origin = {.position = {0, 0, i > 0 ? 0.15 : 0.0}, .orientation = {.w = 1.0}},
                            .type = CPROX_JOINT_REVOLUTE,
                            .axis = {i % 2, 1 - i % 2, 0},
                            .variable = i,
                            .multiplier = 1.0};
    bodies[i] = (cprox_link_geometry){
        .link = i, .body = capsule, .pose = {.position = {0, 0, 0.075}, .orientation = {.w = 1.0}}};
    for (int k = 0; k < 3; k++) values[k][i] = rng_uniform(&r, -0.3, 0.3);
    variables[i] = i;
  }
  const cprox_waypoint points[3] = {
      {.time = 0, .positions = values[0]}, {.time = 1, .positions = values[1]}, {.time = 2, .positions = values[2]}};
  const cprox_motion_description d = {.variables = variables,
                                      .n_variables = LINKS,
                                      .waypoints = points,
                                      .n_waypoints = 3,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  assert_int_equal(cprox_robot_create(links, LINKS, bodies, LINKS, LINKS, ws, &robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  cprox_result found;
  assert_int_equal(distance_of_list(cprox_robot_self(motion, NULL, 0), NULL, 0, &options, ws, &found, NULL), CPROX_OK);
  print_message("%u nodes, %u distances\n", found.nodes, found.distance_queries);
  assert_true(found.nodes <= 16);
  assert_true(found.distance_queries <= 150);
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  cprox_body_free(capsule);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
