/* SPDX-License-Identifier: BSD-3-Clause */
/* All intervals in which something is at most delta away: balls along curves and on joints, against boxes and balls,
 * whose distances are computed in long double at many places. */
#include <math.h>
#include <string.h>

#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

enum { ROOM = 64, SAMPLES = 4000, POINTS = 6 };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};

/* ---- what is true ---- */

typedef long double (*clearance_at)(const void *scene, long double t);

/* Nothing outside of the violations is within delta, and all that is said to be within is; a hair apart for rounding.
 * What is neither is as near to delta as `near`. Returns how many were told. */
static size_t check_violations(const cprox_violations *v, clearance_at clearance, const void *scene, double delta,
                               double near, double t0, double t1, size_t *within) {
  const long double hair = 1e-11L;
  for (size_t i = 0; i < v->count; i++) {
    const cprox_violation *one = &v->list[i];
    assert_true(one->enter_lower >= t0 && one->leave_upper <= t1 && one->enter_lower <= one->leave_upper);
    assert_true(one->enter_lower <= one->enter_upper && one->leave_lower <= one->leave_upper);
    if (i > 0) assert_true(one->enter_lower >= v->list[i - 1].leave_lower);
    if (one->verdict == CPROX_VERDICT_UNDECIDED) {
      assert_true(fabsl(clearance(scene, one->enter_lower) - delta) <= near);
      continue;
    }
    assert_true(one->enter_upper <= one->leave_lower);
    for (int k = 0; k <= 50 && one->enter_upper < one->leave_lower; k++) {
      const long double s = k / 50.0L, before = one->enter_lower + s * (one->enter_upper - one->enter_lower),
                        after = one->leave_lower + s * (one->leave_upper - one->leave_lower);
      const bool enters = one->enter_lower < one->enter_upper, leaves = one->leave_lower < one->leave_upper;
      if ((enters && fabsl(clearance(scene, before) - delta) > near) ||
          (leaves && fabsl(clearance(scene, after) - delta) > near))
        fail_msg("%.17Lg at %.17Lg or %.17Lg at %.17Lg is open, and far from %.17g", clearance(scene, before), before,
                 clearance(scene, after), after, delta);
    }
    assert_true(one->upper <= delta && clearance(scene, one->t) <= one->upper + hair);
    for (int k = 0; k <= 50; k++) {
      const long double t = one->enter_upper + (one->leave_lower - (long double)one->enter_upper) * k / 50;
      if (!(clearance(scene, t) <= delta + hair))
        fail_msg("%.17Lg at %.17Lg, said to be at most %.17g", clearance(scene, t), t, delta);
    }
  }
  for (int k = 0; k <= SAMPLES; k++) {
    const long double t = t0 + ((long double)t1 - t0) * k / SAMPLES;
    bool told = false;
    for (size_t i = 0; i < v->count; i++) told = told || (t >= v->list[i].enter_lower && t <= v->list[i].leave_upper);
    const long double d = clearance(scene, t);
    *within += d <= delta;
    if (!told && !(d > delta - hair)) fail_msg("%.17Lg at %.17Lg, said to be above %.17g", d, t, delta);
  }
  return v->count;
}

/* Ends that are crossed at more than a hundredth of the speed and belong to one violation are as narrow as asked.
 * Returns how many that are. */
static size_t check_ends(const cprox_violations *v, clearance_at clearance, const void *scene, double resolution,
                         double speed) {
  size_t steep = 0;
  for (size_t i = 0; i < v->count; i++) {
    const cprox_violation *one = &v->list[i];
    if (one->verdict != CPROX_VERDICT_VIOLATED) continue;
    const double ends[2][2] = {{one->enter_lower, one->enter_upper}, {one->leave_lower, one->leave_upper}};
    for (size_t k = 0; k < 2; k++) {
      const bool shared = k == 0 ? i > 0 && v->list[i - 1].leave_upper > one->enter_lower
                                 : i + 1 < v->count && one->leave_upper > v->list[i + 1].enter_lower;
      const double width = ends[k][1] - ends[k][0];
      if (shared || !(width > 0.0)) continue;
      const double change = (double)fabsl(clearance(scene, ends[k][1]) - clearance(scene, ends[k][0]));
      if (!(change > 0.01 * speed * width)) continue;
      steep++;
      if (width > resolution)
        fail_msg("an end is %.17g wide, %.17g was asked: %.17g to %.17g", width, resolution, ends[k][0], ends[k][1]);
    }
  }
  return steep;
}

/* ---- curves ---- */

typedef struct ride {
  vec3 control[POINTS];
  double radius;
  vec3 half, ball;
  double ball_radius;
} ride;

static long double box_distance(vec3l x, vec3 half) {
  const long double dx = fmaxl(fabsl(x.x) - half.x, 0), dy = fmaxl(fabsl(x.y) - half.y, 0),
                    dz = fmaxl(fabsl(x.z) - half.z, 0);
  return sqrtl(dx * dx + dy * dy + dz * dz);
}

static long double ride_clearance(const void *scene, long double t) {
  const ride *s = scene;
  vec3l p[POINTS];
  for (size_t i = 0; i < POINTS; i++) p[i] = ref_vec(s->control[i]);
  for (size_t r = 1; r < POINTS; r++)
    for (size_t i = 0; i + r < POINTS; i++) p[i] = ref_add(ref_scale(1 - t, p[i]), ref_scale(t, p[i + 1]));
  const long double ball = ref_norm(ref_sub(p[0], ref_vec(s->ball))) - s->ball_radius;
  return fmaxl(fminl(box_distance(p[0], s->half), ball) - s->radius, 0);
}

/* Balls of radius r along Bézier curves past a box and a ball: they go in and out, many touch both. */
CASE(a_ball_along_a_curve_is_within_delta_where_it_is_said_to_be) {
  rng r = rng_seed(9001);
  size_t told = 0, within = 0, steep = 0;
  for (size_t i = 0; i < test_cases(150); i++) {
    ride s = {.half = vec(rng_uniform(&r, 0.1, 0.8), rng_uniform(&r, 0.1, 0.8), rng_uniform(&r, 0.1, 0.8)),
              .radius = i % 2 ? 0.0 : 0.1,
              .ball = rng_in_cube(&r, 1.5),
              .ball_radius = rng_uniform(&r, 0.05, 0.3)};
    for (size_t k = 0; k < POINTS; k++) s.control[k] = rng_in_cube(&r, 2.0);
    cprox_curve *curve = bezier(s.control, POINTS);
    cprox_body *box = NULL, *ball = NULL;
    assert_int_equal(cprox_body_create_box(vec_scale(2.0, s.half), NULL, &box), CPROX_OK);
    assert_int_equal(cprox_body_create_sphere(s.ball_radius, NULL, &ball), CPROX_OK);
    const cprox_obstacle targets[2] = {cprox_obstacle_at(box, HERE),
                                       cprox_obstacle_at(ball, (cprox_pose){s.ball, HERE.orientation})};
    cprox_violation list[ROOM];
    cprox_violations v = {.list = list, .room = ROOM};
    const double delta = rng_uniform(&r, 0.01, 0.4), resolution = rng_log_uniform(&r, 1e-7, 1e-2);
    const cprox_options o = accurate(1e-9);
    const cprox_mover mover = cprox_tube_along(curve, s.radius);
    assert_int_equal(violations_of_list(mover, targets, 2, delta, resolution, &o, ws, &v), CPROX_OK);
    double speed = 0.0;
    for (size_t k = 1; k < POINTS; k++)
      speed = fmax(speed, (POINTS - 1) * vec_norm(vec_sub(s.control[k], s.control[k - 1])));
    told += check_violations(&v, ride_clearance, &s, delta, 4.0 * speed * resolution + 2e-9, 0, 1, &within);
    steep += check_ends(&v, ride_clearance, &s, resolution, speed);
    cprox_curve_free(curve);
    cprox_body_free(box);
    cprox_body_free(ball);
  }
  print_message("%zu violations, %zu places within delta, %zu steep ends\n", told, within, steep);
  assert_true(told > 100 && within > 1000 && steep > 100);
}

/* ---- movers ---- */

typedef struct flight {
  double from[2][7], to[2][7], start[2], radius[2];
} flight;

static vec3l place_of(const flight *f, int who, long double t) {
  const long double s = fminl(fmaxl(t - f->start[who], 0), 1);
  const double *p = f->from[who], *q = f->to[who];
  return (vec3l){p[0] + s * (q[0] - (long double)p[0]), p[1] + s * (q[1] - (long double)p[1]),
                 p[2] + s * (q[2] - (long double)p[2])};
}

static long double flight_clearance(const void *scene, long double t) {
  const flight *f = scene;
  const long double apart = ref_norm(ref_sub(place_of(f, 0, t), place_of(f, 1, t)));
  return fmaxl(apart - f->radius[0] - f->radius[1], 0);
}

/* Two balls on one clock; of delta 0 only single places are proven. */
CASE(two_movers_are_within_delta_where_they_are_said_to_be) {
  rng r = rng_seed(9002);
  size_t told = 0, within = 0;
  for (size_t i = 0; i < test_cases(150); i++) {
    flight f = {.start = {0, rng_uniform(&r, -0.5, 0.5)}};
    cprox_body *bodies[2];
    cprox_robot *robots[2], *both = NULL;
    cprox_motion *motions[2], *motion = NULL;
    static const int32_t ALL[7] = {0, 1, 2, 3, 4, 5, 6};
    for (int k = 0; k < 2; k++) {
      const vec3 a = rng_in_cube(&r, 1.0), b = rng_in_cube(&r, 1.0);
      const double from[7] = {a.x, a.y, a.z, 0, 0, 0, 1}, to[7] = {b.x, b.y, b.z, 0, 0, 0.6, 0.8};
      memcpy(f.from[k], from, sizeof from);
      memcpy(f.to[k], to, sizeof to);
      f.radius[k] = rng_uniform(&r, 0.05, 0.3);
      const cprox_link link = {.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = HERE};
      assert_int_equal(cprox_body_create_sphere(f.radius[k], NULL, &bodies[k]), CPROX_OK);
      const cprox_link_geometry geometry = {.body = bodies[k], .pose = HERE};
      assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 7, ws, &robots[k]), CPROX_OK);
      const cprox_waypoint ends[2] = {{.time = 0, .positions = f.from[k]}, {.time = 1, .positions = f.to[k]}};
      const cprox_motion_description d = {
          .variables = ALL, .n_variables = 7, .waypoints = ends, .n_waypoints = 2, .turning = CPROX_TURNING_SLERP};
      assert_int_equal(cprox_motion_create(robots[k], &d, ws, &motions[k]), CPROX_OK);
    }
    const cprox_joined_motion joined[2] = {{motions[0], f.start[0], 0.0}, {motions[1], f.start[1], 0.0}};
    const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = joined, .n_joined = 2};
    assert_int_equal(cprox_robot_join((const cprox_robot *const *)robots, NULL, 2, ws, &both), CPROX_OK);
    assert_int_equal(cprox_motion_create(both, &d, ws, &motion), CPROX_OK);
    const cprox_motion_info info = cprox_motion_get_info(motion);
    cprox_violation list[ROOM];
    cprox_violations v = {.list = list, .room = ROOM};
    const double delta = i % 4 == 0 ? 0.0 : rng_uniform(&r, 0.05, 0.6), resolution = rng_log_uniform(&r, 1e-6, 1e-2);
    const cprox_options o = accurate(1e-9);
    const cprox_mover mover = cprox_robot_self(motion, &(cprox_robot_pair){0, 1}, 1);
    assert_true(violations_of_list(mover, NULL, 0, delta, delta > 0.0 ? resolution : 1e-2, &o, ws, &v) >= 0);
    if (delta > 0.0) {
      /* no faster than 3.5 m/s each, and half a turn of a radius of 0.3 m */
      told +=
          check_violations(&v, flight_clearance, &f, delta, 4.0 * 9.0 * resolution + 2e-9, info.t0, info.t1, &within);
    } else {
      for (int k = 0; k <= SAMPLES; k++) {
        const long double t = info.t0 + ((long double)info.t1 - info.t0) * k / SAMPLES;
        bool outside = true;
        for (size_t j = 0; j < v.count; j++)
          outside = outside && !(t >= list[j].enter_lower && t <= list[j].leave_upper);
        if (outside) assert_true(flight_clearance(&f, t) > 0);
      }
    }
    cprox_motion_free(motion);
    cprox_robot_free(both);
    for (int k = 0; k < 2; k++) {
      cprox_motion_free(motions[k]);
      cprox_robot_free(robots[k]);
      cprox_body_free(bodies[k]);
    }
  }
  print_message("%zu violations, %zu places within delta\n", told, within);
  assert_true(told > 30 && within > 1000);
}

/* ---- depths ---- */

/* What a query finds where it makes its own variables. */
static __attribute__((noinline)) double fill_stack(double value) {
  volatile double place[40000];
  for (size_t i = 0; i < 40000; i++) place[i] = value;
  return place[0];
}

/* A ball on an arm that turns about z begins in the middle of a ball, leaves it, and passes it again after a turn: by
 * depths and without them, and whatever the stack held before, the intervals are those of the closed form. */
CASE(a_robot_that_begins_in_contact_has_the_same_violations_with_depths) {
  enum { MOST = 100 };
  static const size_t WAYPOINTS[4] = {2, 3, 40, MOST};
  cprox_body *ball = NULL;
  cprox_robot *robot = NULL;
  assert_int_equal(cprox_body_create_sphere(0.3, ws, &ball), CPROX_OK);
  const cprox_link link = {
      .parent = -1, .type = CPROX_JOINT_REVOLUTE, .origin = HERE, .axis = vec(0, 0, 1), .multiplier = 1};
  cprox_link_geometry geometry = {.body = ball, .pose = HERE};
  geometry.pose.position.x = 1.0;
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
  cprox_obstacle at = cprox_obstacle_at(ball, HERE);
  at.pose.position.x = 1.0;
  const double delta = 0.05, resolution = 1e-4;
  const double leaves = 2.0 * asin(0.5 * (0.6 + delta)); /* [rad], and at 1 rad/s [s] */
  for (size_t k = 0; k < 4; k++) {
    const size_t n = WAYPOINTS[k];
    double positions[MOST];
    cprox_waypoint waypoints[MOST];
    memset(waypoints, 0, sizeof waypoints);
    for (size_t i = 0; i < n; i++) {
      positions[i] = 7.0 * (double)i / (double)(n - 1);
      waypoints[i].time = positions[i];
      waypoints[i].positions = positions + i;
    }
    const int32_t variable = 0;
    const cprox_motion_description d = {
        .variables = &variable, .n_variables = 1, .waypoints = waypoints, .n_waypoints = n};
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
    for (int way = 0; way < 8; way++) {
      static const double STACK[4] = {0.0, -3.0, 1e9, NAN};
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.signed_distance = way < 4;
      fill_stack(STACK[way % 4]);
      cprox_violation list[ROOM];
      cprox_violations v = {.list = list, .room = ROOM};
      assert_int_equal(
          violations_of_list(cprox_robot_along(motion, NULL, 0), &at, 1, delta, resolution, &options, ws, &v),
          CPROX_OK);
      assert_int_equal(v.count, 2);
      const double ends[2][2] = {{0.0, leaves}, {2.0 * acos(-1.0) - leaves, 2.0 * acos(-1.0) + leaves}};
      for (size_t i = 0; i < 2; i++) {
        assert_int_equal(list[i].verdict, CPROX_VERDICT_VIOLATED);
        assert_true(list[i].enter_lower <= ends[i][0] && list[i].enter_upper >= ends[i][0]);
        assert_true(list[i].leave_lower <= ends[i][1] && list[i].leave_upper >= ends[i][1]);
        assert_true(list[i].enter_upper - list[i].enter_lower < 10.0 * resolution);
        assert_true(list[i].leave_upper - list[i].leave_lower < 10.0 * resolution);
      }
    }
    cprox_motion_free(motion);
  }
  cprox_robot_free(robot);
  cprox_body_free(ball);
}

/* ---- limits ---- */

CASE(what_has_no_room_or_no_budget_is_left_within) {
  /* up and down through a plate, five times */
  vec3 control[6];
  for (size_t i = 0; i < 6; i++) control[i] = vec(0.1 * (double)i, 0, i % 2 ? 1.0 : -1.0);
  static const double KNOTS[8] = {0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1};
  const cprox_curve_description d = {
      .kind = CPROX_CURVE_BSPLINE, .points = control, .n = 6, .degree = 1, .knots = KNOTS, .n_knots = 8, .t1 = 1.0};
  cprox_curve *curve = NULL;
  if (cprox_curve_create(&d, ws, &curve) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  cprox_body *plate = NULL;
  assert_int_equal(cprox_body_create_box(vec(10, 10, 0.01), NULL, &plate), CPROX_OK);
  const cprox_obstacle target = cprox_obstacle_at(plate, HERE);
  const cprox_mover mover = cprox_point_along(curve);
  cprox_violation list[ROOM];
  cprox_violations all = {.list = list, .room = ROOM};
  assert_int_equal(violations_of_list(mover, &target, 1, 0.05, 1e-6, NULL, ws, &all), CPROX_OK);
  assert_int_equal(all.count, 5);

  cprox_violation few[2];
  cprox_violations v = {.list = few, .room = 2};
  assert_int_equal(violations_of_list(mover, &target, 1, 0.05, 1e-6, NULL, ws, &v), CPROX_BUDGET);
  assert_int_equal(v.count, 2);
  assert_true(few[0].enter_lower == list[0].enter_lower && few[0].leave_upper == list[0].leave_upper);
  assert_true(few[1].enter_lower == list[1].enter_lower && few[1].leave_upper == 1.0);

  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.max_nodes = 20;
  v = (cprox_violations){.list = list, .room = ROOM};
  assert_int_equal(violations_of_list(mover, &target, 1, 0.05, 1e-6, &o, ws, &v), CPROX_BUDGET);
  assert_true(v.count > 0 && list[v.count - 1].leave_upper == 1.0);

  assert_int_equal(violations_of_list(mover, &target, 1, 0.05, 0.0, NULL, ws, &v), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "the resolution is 0"));
  assert_int_equal(violations_of_list(mover, &target, 1, -1.0, 1e-6, NULL, ws, &v), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "delta is -1"));
  v.room = 0;
  assert_int_equal(violations_of_list(mover, &target, 1, 0.05, 1e-6, NULL, ws, &v), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "no room"));
  cprox_curve_free(curve);
  cprox_body_free(plate);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
