/* SPDX-License-Identifier: BSD-3-Clause */
/* Every query that takes a stop function, stopped at its first, at its second and at its last look: what it answers
 * holds of the complete answer, names what it measured, and is said to be incomplete where it is. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/gradient_case.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/robots.h"

/* ---- stopping ---- */

typedef struct looks {
  unsigned seen, stop_at; /* 0: never */
} looks;

static bool look(void *user) {
  looks *l = user;
  l->seen++;
  return l->stop_at > 0 && l->seen >= l->stop_at;
}

/* ---- what is asked ---- */

enum { ROOM = 64, BODIES = 5, INTERVALS = 4 };

/* A mover, or several alike, among obstacles. */
typedef struct scene {
  cprox_mover mover;
  cprox_obstacle targets[BODIES];
  size_t n;
  bool is_self; /* it has no obstacles */
  cprox_obstacles *list, *set, *batch;
  double t0, t1, delta;
} scene;

/* What a query answered: results, or what else it has in the form of results. */
typedef struct reply {
  cprox_status status;
  cprox_result rows[ROOM];
  size_t n;
  double others; /* of lists: a bound of what is not among the rows; else infinity */
} reply;

static void no_rows(reply *a) {
  a->n = 0, a->others = INFINITY;
}

static void one_row(reply *a) {
  a->n = 1, a->others = INFINITY;
}

typedef cprox_status (*question)(const scene *s, const cprox_options *o, reply *a);

static const cprox_obstacles *all_of(const scene *s) {
  return s->is_self ? NULL : s->list;
}

static cprox_status ask_distance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_distance(all_of(s), s->mover, o, ws, a->rows, NULL);
}

static cprox_status ask_each(const scene *s, const cprox_options *o, reply *a) {
  a->n = s->n, a->others = INFINITY;
  cprox_result nearest;
  return cprox_obstacles_distance(s->list, s->mover, o, ws, &nearest, a->rows);
}

static cprox_status ask_first(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_distance(s->mover, s->targets[0], o, ws, a->rows);
}

static cprox_status ask_first_tolerance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_tolerance(s->mover, s->targets[0], s->delta, o, ws, a->rows);
}

static cprox_status ask_first_collision(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_collision(s->mover, s->targets[0], o, ws, a->rows);
}

static cprox_status ask_first_contact(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_time_of_contact(s->mover, s->targets[0], o, ws, a->rows);
}

static cprox_status ask_tolerance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_tolerance(all_of(s), s->mover, s->delta, o, ws, a->rows, NULL);
}

static cprox_status ask_collision(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_collision(all_of(s), s->mover, o, ws, a->rows, NULL);
}

static cprox_status ask_contact(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_time_of_contact(all_of(s), s->mover, o, ws, a->rows);
}

static cprox_status ask_set_distance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_distance(s->set, s->mover, o, ws, a->rows, NULL);
}

static cprox_status ask_set_tolerance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_tolerance(s->set, s->mover, s->delta, o, ws, a->rows, NULL);
}

static cprox_status ask_set_contact(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_time_of_contact(s->set, s->mover, o, ws, a->rows);
}

static cprox_status ask_batch_distance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_distance_batch(s->batch, &s->mover, 0, 1, o, ws, a->rows);
}

static cprox_status ask_batch_tolerance(const scene *s, const cprox_options *o, reply *a) {
  one_row(a);
  return cprox_obstacles_tolerance_batch(s->batch, &s->mover, 0, 1, s->delta, o, ws, a->rows);
}

static cprox_status listed(cprox_status status, const cprox_listed *got, reply *a) {
  a->n = got->count, a->others = got->others;
  return status;
}

static cprox_status ask_nearest(const scene *s, const cprox_options *o, reply *a) {
  cprox_listed got = {0, 0.0};
  return listed(cprox_obstacles_nearest(s->list, s->mover, 3, o, ws, a->rows, &got), &got, a);
}

static cprox_status ask_set_nearest(const scene *s, const cprox_options *o, reply *a) {
  cprox_listed got = {0, 0.0};
  return listed(cprox_obstacles_nearest(s->set, s->mover, 3, o, ws, a->rows, &got), &got, a);
}

static cprox_status ask_within(const scene *s, const cprox_options *o, reply *a) {
  cprox_listed got = {0, 0.0};
  return listed(cprox_obstacles_within(s->list, s->mover, s->delta, o, ws, a->rows, &got), &got, a);
}

static cprox_status ask_pairs(const scene *s, const cprox_options *o, reply *a) {
  cprox_listed got = {0, 0.0};
  return listed(cprox_obstacles_nearest_pairs(all_of(s), s->mover, 6, INFINITY, o, ws, a->rows, &got), &got, a);
}

static cprox_status ask_pairs_within(const scene *s, const cprox_options *o, reply *a) {
  cprox_listed got = {0, 0.0};
  return listed(cprox_obstacles_nearest_pairs(all_of(s), s->mover, ROOM, s->delta, o, ws, a->rows, &got), &got, a);
}

static cprox_status ask_profile(const scene *s, const cprox_options *o, reply *a) {
  double breaks[INTERVALS + 1];
  cprox_profile_interval intervals[INTERVALS];
  for (int i = 0; i <= INTERVALS; i++)
    breaks[i] = i == INTERVALS ? s->t1 : s->t0 + (s->t1 - s->t0) * (double)i / INTERVALS;
  const cprox_status status =
      cprox_obstacles_profile(all_of(s), s->mover, breaks, INTERVALS, INFINITY, o, ws, intervals);
  no_rows(a);
  for (int i = 0; i < INTERVALS && status >= 0; i++)
    a->rows[a->n++] = (cprox_result){.status = status,
                                     .verdict = CPROX_VERDICT_UNDECIDED,
                                     .lower = intervals[i].lower,
                                     .upper = intervals[i].upper,
                                     .t = intervals[i].t,
                                     .obstacle_index = intervals[i].obstacle_index,
                                     .mover_part = intervals[i].mover_part};
  return status;
}

static cprox_status ask_gradient(const scene *s, const cprox_options *o, reply *a) {
  cprox_motion_gradient g = {0};
  one_row(a);
  return cprox_robot_distance_gradient(all_of(s), s->mover, o, ws, a->rows, &g);
}

static cprox_status ask_rows(const scene *s, const cprox_options *o, reply *a) {
  const cprox_rows_query asked = {.horizon = s->delta, .per_pair = 2};
  cprox_motion_row rows[ROOM] = {{.interval = 0}};
  no_rows(a);
  const cprox_status status = cprox_robot_rows(all_of(s), s->mover, &asked, o, ws, rows, ROOM, &a->n);
  if (status < 0) return status;
  if (status == CPROX_STOPPED) a->others = 0.0; /* of what has no row then nothing is said */
  for (size_t i = 0; i < a->n; i++) a->rows[i] = rows[i].result, a->rows[i].reserved[0] = rows[i].interval;
  return status;
}

/* ---- what must hold ---- */

static bool is_complete(const reply *a) {
  return a->status == CPROX_OK || a->status == CPROX_PRECISION || a->status == CPROX_OVERLAP;
}

/* That of the same obstacle, or of the same pair of a robot, and of rows of the same interval. */
static const cprox_result *same_row(const reply *a, const cprox_result *of, bool by_part) {
  const cprox_result *best = NULL;
  for (size_t i = 0; i < a->n; i++) {
    const cprox_result *r = &a->rows[i];
    if (r->obstacle_index != of->obstacle_index || (by_part && r->mover_part != of->mover_part)) continue;
    if (r->reserved[0] == of->reserved[0]) best = r;
  }
  return best;
}

static void check_numbers(const char *name, const cprox_result *r) {
  const bool sound = r->lower <= r->upper && !isnan(r->t_contact_lower) && (isinf(r->upper) || isfinite(r->t));
  if (!sound) fail_msg("%s: [%g, %g] at %g", name, r->lower, r->upper, r->t);
  if (isfinite(r->upper) && r->obstacle_index < 0) fail_msg("%s: %g away from nothing", name, r->upper);
}

/* An interval of the same thing as a narrower one: they have the true distance in common. */
static void check_result(const char *name, const cprox_result *full, const cprox_result *cut) {
  if (!(cut->lower <= full->upper && full->lower <= cut->upper))
    fail_msg("%s: stopped [%g, %g], not stopped [%g, %g]", name, cut->lower, cut->upper, full->lower, full->upper);
  const cprox_verdict a = full->verdict, b = cut->verdict;
  if (a != b && a != CPROX_VERDICT_UNDECIDED && b != CPROX_VERDICT_UNDECIDED)
    fail_msg("%s: stopped %s, not stopped %s", name, cprox_verdict_name(b), cprox_verdict_name(a));
  /* first contact is never before what was said to be free; other queries say 0 */
  if (full->verdict == CPROX_VERDICT_VIOLATED && cut->t_contact_lower != 0.0 && cut->t_contact_lower > full->t)
    fail_msg("%s: stopped, and free until %g; contact is at %g", name, cut->t_contact_lower, full->t);
}

static void check_reply(const char *name, const reply *full, const reply *cut, bool is_list, bool of_pairs) {
  for (size_t i = 0; i < cut->n; i++) check_numbers(name, &cut->rows[i]);
  if (!is_list) {
    assert_int_equal(cut->n, full->n);
    for (size_t i = 0; i < cut->n; i++) check_result(name, &full->rows[i], &cut->rows[i]);
    return;
  }
  for (size_t i = 0; i < full->n; i++) {
    const cprox_result *row = &full->rows[i], *again = isinf(row->upper) ? NULL : same_row(cut, row, of_pairs);
    if (again) check_result(name, row, again);
    if (!again && cut->others > row->upper)
      fail_msg("%s: of %zu rows one is left out that is at most %g away; all others should be %g away", name, full->n,
               row->upper, cut->others);
    if (!again && is_complete(cut) && row->upper < full->others)
      fail_msg("%s: a row is left out, and the status is %s", name, cprox_status_name(cut->status));
  }
}

typedef struct named {
  const char *name;
  question ask;
  bool is_list, of_obstacles;
} named;

static const named QUESTIONS[] = {
    {"distance", ask_distance, false, false},
    {"each distance", ask_each, false, true},
    {"distance from one", ask_first, false, true},
    {"tolerance of one", ask_first_tolerance, false, true},
    {"collision with one", ask_first_collision, false, true},
    {"time of contact with one", ask_first_contact, false, true},
    {"tolerance", ask_tolerance, false, false},
    {"collision", ask_collision, false, false},
    {"time of contact", ask_contact, false, false},
    {"distance from a set", ask_set_distance, false, true},
    {"tolerance of a set", ask_set_tolerance, false, true},
    {"time of contact with a set", ask_set_contact, false, true},
    {"distance of a batch", ask_batch_distance, false, true},
    {"tolerance of a batch", ask_batch_tolerance, false, true},
    {"nearest", ask_nearest, true, true},
    {"nearest of a set", ask_set_nearest, true, true},
    {"within", ask_within, true, true},
    {"nearest pairs", ask_pairs, true, false},
    {"pairs within", ask_pairs_within, true, false},
    {"profile", ask_profile, false, false},
    {"gradient of a motion", ask_gradient, false, false},
    {"rows", ask_rows, true, false},
};
enum { N_QUESTIONS = sizeof QUESTIONS / sizeof *QUESTIONS, ROBOT_PAIRS = 17, PROFILE = 19 };

/* Stops a question at its first, second and last look. Returns how often it was stopped. */
static size_t stop_question(const named *q, const scene *s, double epsilon) {
  const bool of_pairs = !q->of_obstacles;
  static reply full, cut;
  looks counted = {0, 0};
  cprox_options options = accurate(epsilon);
  options.stop = look, options.stop_user = &counted;
  memset(&full, 0, sizeof full);
  full.status = q->ask(s, &options, &full);
  if (full.status < 0) return 0; /* not for this mover */
  const unsigned at[3] = {1, 2, counted.seen};
  size_t stopped = 0;
  for (int i = 0; i < 3; i++) {
    if (at[i] == 0 || at[i] > counted.seen) continue;
    looks l = {0, at[i]};
    options.stop_user = &l;
    memset(&cut, 0xff, sizeof cut); /* indices of -1, numbers that are none: what is not written shows */
    cut.status = q->ask(s, &options, &cut);
    assert_true(cut.status >= 0);
    assert_true(l.seen >= at[i]);
    check_reply(q->name, &full, &cut, q->is_list, of_pairs);
    stopped += cut.status == CPROX_STOPPED;
  }
  return stopped;
}

/* All that was ever within delta is within an interval of the stopped list, which goes on to the end. */
static size_t stop_violations(const scene *s, double epsilon) {
  cprox_violation whole[ROOM], part[ROOM];
  looks counted = {0, 0};
  cprox_options options = accurate(epsilon);
  options.stop = look, options.stop_user = &counted;
  const double resolution = (s->t1 - s->t0) / 500.0;
  cprox_violations full = {.list = whole, .room = ROOM};
  if (cprox_obstacles_violations(all_of(s), s->mover, s->delta, resolution, &options, ws, &full) < 0) return 0;
  const unsigned at[3] = {1, 2, counted.seen};
  size_t stopped = 0;
  for (int i = 0; i < 3; i++) {
    if (at[i] == 0 || at[i] > counted.seen) continue;
    looks l = {0, at[i]};
    options.stop_user = &l;
    cprox_violations cut = {.list = part, .room = ROOM};
    const cprox_status status =
        cprox_obstacles_violations(all_of(s), s->mover, s->delta, resolution, &options, ws, &cut);
    assert_true(status >= 0);
    stopped += status == CPROX_STOPPED;
    for (size_t k = 0; k < full.count; k++) {
      const cprox_violation *v = &whole[k];
      bool covered = v->verdict != CPROX_VERDICT_VIOLATED;
      for (size_t j = 0; j < cut.count; j++)
        covered = covered || (part[j].enter_lower <= v->enter_upper && v->leave_lower <= part[j].leave_upper);
      if (!covered) fail_msg("violations: [%g, %g] is left out", v->enter_upper, v->leave_lower);
    }
    for (size_t j = 0; j < cut.count; j++) {
      const cprox_violation *v = &part[j];
      assert_true(v->enter_lower <= v->enter_upper && v->leave_lower <= v->leave_upper);
      assert_true(isinf(v->upper) || (v->obstacle_index >= 0 && isfinite(v->t)));
    }
    if (status == CPROX_STOPPED && cut.count > 0) assert_true(part[cut.count - 1].leave_upper == s->t1);
  }
  return stopped;
}

static void stop_all(const scene *s, double epsilon, size_t stopped[N_QUESTIONS + 1]) {
  for (size_t i = 0; i < N_QUESTIONS; i++) {
    const named *q = &QUESTIONS[i];
    if (q->of_obstacles && s->is_self) continue;
    stopped[i] += stop_question(q, s, epsilon);
  }
  stopped[N_QUESTIONS] += stop_violations(s, epsilon);
}

static void scene_index(scene *s) {
  assert_int_equal(cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_NONE, ws, &s->list), CPROX_OK);
  assert_int_equal(cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_BVH, ws, &s->set), CPROX_OK);
  assert_int_equal(cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_BATCH, ws, &s->batch), CPROX_OK);
}

static void scene_free(scene *s) {
  cprox_obstacles_free(s->list);
  cprox_obstacles_free(s->set);
  cprox_obstacles_free(s->batch);
}

/* ---- the scenes ---- */

/* Convex bodies, a mesh, a curve, and another mover on the clock, about a curve that a point, a ball or a box rides. */
CASE(curves_may_be_stopped_at_any_look) {
  rng r = rng_seed(3913);
  test_mesh torus = mesh_torus(24, 16, 0.5, 0.15, 0.02);
  cprox_body *bodies[4], *box = NULL;
  bodies[0] = mesh_body(&torus, CPROX_MESH_FILL_SOLID, ws);
  assert_int_equal(cprox_body_create_cylinder(0.4, 0.2, ws, &bodies[1]), CPROX_OK);
  assert_int_equal(cprox_body_create_superquadric(vec(0.3, 0.2, 0.1), vec(3, 1.5, 4), ws, &bodies[2]), CPROX_OK);
  assert_int_equal(cprox_body_create_ellipsoid(vec(0.3, 0.2, 0.1), ws, &bodies[3]), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(0.2, 0.1, 0.05), ws, &box), CPROX_OK);
  size_t stopped[N_QUESTIONS + 1] = {0};
  for (int i = 0; i < 24; i++) {
    cprox_curve *curves[2];
    for (int k = 0; k < 2; k++) {
      vec3 points[6];
      for (int j = 0; j < 6; j++) points[j] = rng_in_cube(&r, 1.5);
      curves[k] = bezier(points, 6);
    }
    scene s = {.n = BODIES, .t0 = 0.0, .t1 = 1.0, .delta = rng_uniform(&r, 0.05, 0.6)};
    for (size_t k = 0; k < BODIES; k++) {
      const cprox_body *body = bodies[(k + (size_t)i) % 4];
      /* some apart, so that searches go on */
      const cprox_pose pose = rng_pose(&r, i % 3 ? 2.5 : 0.8);
      s.targets[k] = cprox_with_margin(cprox_obstacle_at(body, pose), k == 1 ? 0.02 : 0.0);
      if (k == 4 && i % 2) s.targets[k] = cprox_obstacle_curve(curves[1], 0.01);
      if (k == 4 && i % 4 == 2) s.targets[k] = cprox_synchronized(cprox_tube_along(curves[1], 0.05));
    }
    s.mover = i % 3 == 0   ? cprox_point_along(curves[0])
              : i % 3 == 1 ? cprox_tube_along(curves[0], 0.05)
                           : cprox_body_along(box, curves[0]);
    if (s.mover.body)
      for (size_t k = 0; k < BODIES; k++)
        if (s.targets[k].body == bodies[0]) s.targets[k].body = bodies[1];
    scene_index(&s);
    stop_all(&s, i % 2 ? 1e-9 : 1e-4, stopped);
    scene_free(&s);
    for (int k = 0; k < 2; k++) cprox_curve_free(curves[k]);
  }
  for (int k = 0; k < 4; k++) cprox_body_free(bodies[k]);
  cprox_body_free(box);
  mesh_free(&torus);
  for (size_t i = 0; i <= N_QUESTIONS; i++) {
    const bool of_robots = i >= ROBOT_PAIRS && i < N_QUESTIONS && i != PROFILE;
    assert_true(of_robots ? stopped[i] == 0 : stopped[i] > 0);
  }
}

/* Random robots among bodies and meshes, against themselves, and both. */
CASE(robots_may_be_stopped_at_any_look) {
  rng r = rng_seed(3914);
  size_t stopped[N_QUESTIONS + 1] = {0};
  for (size_t i = 0; i < test_cases(40); i++) {
    gradient_case p;
    gradient_case_make(&r, false, &p);
    const cprox_motion_info info = cprox_motion_get_info(p.robot.motion);
    scene s = {.n = GRADIENT_TARGETS,
               .t0 = info.t0,
               .t1 = info.t1,
               .delta = rng_uniform(&r, 0.01, 0.6),
               .is_self = p.kind == CPROX_MOVER_ROBOT_SELF};
    memcpy(s.targets, p.targets, sizeof p.targets);
    s.mover = s.is_self ? cprox_robot_self(p.robot.motion, NULL, 0) : cprox_robot_along(p.robot.motion, NULL, 0);
    s.mover.kind = p.kind;
    scene_index(&s);
    stop_all(&s, i % 2 ? 1e-9 : 1e-4, stopped);
    scene_free(&s);
    gradient_case_free(&p);
  }
  for (size_t i = 0; i <= N_QUESTIONS; i++) assert_true(stopped[i] > 0);
}

/* Pairs of bodies, of meshes too. */
CASE(pairs_may_be_stopped_at_any_look) {
  rng r = rng_seed(3915);
  test_mesh torus = mesh_torus(24, 16, 0.5, 0.15, 0.02), cube = mesh_box(vec(0.2, 0.3, 0.4));
  cprox_body *bodies[4], *compound = NULL;
  bodies[0] = mesh_body(&torus, CPROX_MESH_FILL_SOLID, ws), bodies[1] = mesh_body(&cube, CPROX_MESH_FILL_SURFACE, ws);
  assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &bodies[2]), CPROX_OK);
  const cprox_pose poses[2] = {{{0.3, 0, 0}, {1, 0, 0, 0}}, {{-0.3, 0, 0}, {1, 0, 0, 0}}};
  assert_int_equal(
      cprox_body_create_compound((const cprox_body *const[]){bodies[2], bodies[2]}, poses, 2, ws, &compound), CPROX_OK);
  bodies[3] = compound;
  size_t stopped = 0;
  for (int i = 0; i < 200; i++) {
    const cprox_obstacle a = cprox_obstacle_at(bodies[rng_index(&r, 4)], rng_pose(&r, i % 2 ? 2.0 : 0.3)),
                         b = cprox_obstacle_at(bodies[rng_index(&r, 4)], rng_pose(&r, 0.3));
    looks counted = {0, 0};
    cprox_options options = accurate(1e-9);
    options.stop = look, options.stop_user = &counted;
    cprox_result full, cut;
    assert_true(cprox_pair(a, b, &options, ws, &full) >= 0);
    const unsigned at[3] = {1, 2, counted.seen};
    for (int k = 0; k < 3; k++) {
      if (at[k] == 0 || at[k] > counted.seen) continue;
      looks l = {0, at[k]};
      options.stop_user = &l;
      assert_true(cprox_pair(a, b, &options, ws, &cut) >= 0);
      assert_true(!isnan(cut.upper) && cut.lower <= cut.upper);
      check_result("pair", &full, &cut);
      stopped += cut.status == CPROX_STOPPED;
    }
  }
  assert_true(stopped > 0);
  cprox_body_free(compound);
  for (int k = 0; k < 3; k++) cprox_body_free(bodies[k]);
  mesh_free(&torus);
  mesh_free(&cube);
}

/* Bodies that translate, states of a robot, gradients of curves, edges. */
CASE(translations_states_edges_and_gradients_may_be_stopped_at_any_look) {
  rng r = rng_seed(3916);
  cprox_body *bodies[2];
  assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &bodies[0]), CPROX_OK);
  assert_int_equal(cprox_body_create_superquadric(vec(0.3, 0.2, 0.1), vec(3, 1.5, 4), ws, &bodies[1]), CPROX_OK);
  for (int i = 0; i < 100; i++) {
    const cprox_translating a = {cprox_obstacle_at(bodies[i % 2], rng_pose(&r, 2.0)), rng_in_cube(&r, 1.0)},
                            b = {cprox_obstacle_at(bodies[i / 2 % 2], rng_pose(&r, 0.1)), vec(0, 0, 0)};
    looks counted = {0, 0};
    cprox_options options = accurate(1e-9);
    options.stop = look, options.stop_user = &counted;
    cprox_result full, cut;
    cprox_growth grown, less;
    assert_true(cprox_translating_contact(a, b, 2.0, &options, ws, &full) >= 0);
    for (unsigned at = 1; at <= counted.seen; at += counted.seen > 2 && at == 2 ? counted.seen - 2 : 1) {
      looks l = {0, at};
      options.stop_user = &l;
      assert_true(cprox_translating_contact(a, b, 2.0, &options, ws, &cut) >= 0);
      assert_true(!isnan(cut.upper) && cut.lower <= cut.upper);
      if (full.verdict == CPROX_VERDICT_VIOLATED) assert_true(cut.t_contact_lower <= full.t);
      if (cut.verdict == CPROX_VERDICT_CLEAR) assert_true(full.verdict != CPROX_VERDICT_VIOLATED);
    }
    counted = (looks){0, 0};
    options.stop_user = &counted;
    assert_true(cprox_growth_distance(a.from, b.from, &options, ws, &grown) >= 0);
    for (unsigned at = 1; at <= counted.seen; at += counted.seen > 2 && at == 2 ? counted.seen - 2 : 1) {
      looks l = {0, at};
      options.stop_user = &l;
      assert_true(cprox_growth_distance(a.from, b.from, &options, ws, &less) >= 0);
      assert_true(less.lower <= grown.upper && grown.lower <= less.upper);
    }
    /* a gradient of a curve: not valid unless all was looked at */
    const vec3 points[4] = {rng_in_cube(&r, 2.0), rng_in_cube(&r, 2.0), rng_in_cube(&r, 2.0), rng_in_cube(&r, 2.0)};
    cprox_curve *curve = bezier(points, 4);
    cprox_gradient gradient, again;
    options.stop = NULL;
    assert_true(cprox_distance(cprox_point_along(curve), b.from, &options, ws, &full) >= 0);
    counted = (looks){0, 0};
    options.stop = look, options.stop_user = &counted;
    assert_true(cprox_distance_gradient(cprox_point_along(curve), b.from, &options, &full, ws, &gradient) >= 0);
    for (unsigned at = 1; at <= counted.seen; at += counted.seen > 2 && at == 2 ? counted.seen - 2 : 1) {
      looks l = {0, at};
      options.stop_user = &l;
      assert_true(cprox_distance_gradient(cprox_point_along(curve), b.from, &options, &full, ws, &again) >= 0);
      if (again.valid) assert_true(gradient.valid && vec_norm(vec_sub(again.mover, gradient.mover)) < 1e-6);
    }
    cprox_curve_free(curve);
  }
  for (int k = 0; k < 2; k++) cprox_body_free(bodies[k]);

  for (size_t i = 0; i < test_cases(40); i++) {
    gradient_case p;
    gradient_case_make(&r, false, &p);
    test_robot *t = &p.robot;
    cprox_obstacles *all = NULL;
    assert_int_equal(cprox_obstacles_create(p.targets, GRADIENT_TARGETS, CPROX_INDEX_NONE, ws, &all), CPROX_OK);
    double states[3][TEST_MAX_VARIABLES + 1];
    double *const rows = &states[0][0];
    for (size_t k = 0; k < 3 * t->n_variables; k++) rows[k] = t->rest[k % t->n_variables] + rng_uniform(&r, -0.3, 0.3);
    for (int distance = 0; distance < 2; distance++) {
      looks counted = {0, 0};
      cprox_options options = accurate(1e-9);
      options.stop = look, options.stop_user = &counted;
      const cprox_state_query asked = {.obstacles = all, .delta = 0.1, .distance = distance, .options = &options};
      cprox_result full[3], cut[3];
      assert_true(cprox_robot_ask_states(t->robot, &asked, rows, 3, ws, full, NULL) >= 0);
      for (unsigned at = 1; at <= counted.seen; at += counted.seen > 2 && at == 2 ? counted.seen - 2 : 1) {
        looks l = {0, at};
        options.stop_user = &l;
        assert_true(cprox_robot_ask_states(t->robot, &asked, rows, 3, ws, cut, NULL) >= 0);
        for (int k = 0; k < 3; k++) {
          assert_true(!isnan(cut[k].upper) && cut[k].lower <= cut[k].upper);
          check_result("state", &full[k], &cut[k]);
        }
      }
      const cprox_edge_query edges = {.obstacles = all, .delta = 0.05, .options = &options};
      cprox_edge_checker *checker = NULL;
      counted = (looks){0, 0};
      options.stop_user = &counted;
      assert_int_equal(cprox_edge_checker_create(t->robot, &edges, ws, &checker), CPROX_OK);
      uint8_t verdicts[2], less[2];
      assert_true(cprox_robot_edges(checker, rows, rows + t->n_variables, 2, ws, verdicts, NULL) >= 0);
      for (unsigned at = 1; at <= counted.seen && at <= 4; at++) {
        counted = (looks){0, at};
        assert_true(cprox_robot_edges(checker, rows, rows + t->n_variables, 2, ws, less, NULL) >= 0);
        for (int k = 0; k < 2; k++)
          assert_true(less[k] == verdicts[k] || less[k] == CPROX_VERDICT_UNDECIDED ||
                      verdicts[k] == CPROX_VERDICT_UNDECIDED);
      }
      cprox_edge_checker_free(checker);
    }
    cprox_obstacles_free(all);
    gradient_case_free(&p);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
