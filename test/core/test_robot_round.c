/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that look the same all round the axis that turns them, exactly or nearly, and what stands round such an axis:
 * against samples of the motion, and by what they cost. */
#include <math.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/implicits.h"
#include "support/random.h"
#include "support/reference.h"

/* Kinds of bodies; those before BY_INEQUALITIES have forms of their own. */
enum { MOST_JOINTS = 3, BY_INEQUALITIES = 7, KINDS = 9 };

static cprox_quat times(cprox_quat a, cprox_quat b) {
  return (cprox_quat){.w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
                      .x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      .y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      .z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static vec3 turned(cprox_quat q, vec3 x) {
  const vec3 v = vec(q.x, q.y, q.z), twice = vec_scale(2.0, vec_cross(v, x));
  return vec_add(vec_axpy(x, q.w, twice), vec_cross(v, twice));
}

static cprox_pose under(cprox_pose outer, cprox_pose inner) {
  return (cprox_pose){vec_add(outer.position, turned(outer.orientation, inner.position)),
                      times(outer.orientation, inner.orientation)};
}

static cprox_quat about(vec3 axis, double angle) {
  const double s = sin(0.5 * angle);
  return (cprox_quat){.w = cos(0.5 * angle), .x = s * axis.x, .y = s * axis.y, .z = s * axis.z};
}

/* Turns z to the unit axis. */
static cprox_quat from_z(vec3 axis) {
  const vec3 z = vec(0, 0, 1), across = vec_cross(z, axis);
  const double length = vec_norm(across);
  return length > 0.0 ? about(vec_scale(1.0 / length, across), atan2(length, axis.z))
                      : about(vec(1, 0, 0), axis.z > 0.0 ? 0.0 : 3.141592653589793);
}

static cprox_body *round_body(rng *r, size_t kind) {
  cprox_body *body = NULL;
  const double a = rng_uniform(r, 0.02, 0.3), b = rng_uniform(r, 0.05, 0.6), c = rng_uniform(r, 0.02, 0.3);
  switch (kind) {
    case 0: cprox_body_create_sphere(a, ws, &body); break;
    case 1: cprox_body_create_cylinder(b, a, ws, &body); break;
    case 2: cprox_body_create_capsule(b, a, ws, &body); break;
    case 3: cprox_body_create_cone(b, a, ws, &body); break;
    case 4: cprox_body_create_ellipsoid(vec(a, a, c), ws, &body); break;
    case 5: cprox_body_create_ellipsoid(vec(a, b, c), ws, &body); break;
    case 6: cprox_body_create_box(vec(a, b, c), ws, &body); break;
    case BY_INEQUALITIES: {
      const double power = rng_log_uniform(r, 1.2, 50.0);
      cprox_body_create_superquadric(vec(a, a, c), vec(power, power, rng_log_uniform(r, 1.2, 50.0)), ws, &body);
      break;
    }
    default: {
      const cprox_affine map = {.linear = {a, 0, 0, 0, a, 0, 0, 0, c}};
      implicit_case paper;
      implicit_case_paper(1 + (int)rng_index(r, 6), &paper);
      body = implicit_case_body(&paper, &map);
    }
  }
  assert_non_null(body);
  return body;
}

/* On the axis through `at`, or off it by as much as `off`. */
static cprox_pose on_axis(rng *r, vec3 axis, double off) {
  const cprox_pose along = {vec_scale(rng_uniform(r, -0.4, 0.4), axis),
                            times(from_z(axis), about(vec(0, 0, 1), rng_uniform(r, -3, 3)))};
  const cprox_pose shifted = {vec_scale(off, rng_in_cube(r, 1.0)), about(rng_unit(r), off * rng_uniform(r, -1, 1))};
  return under(along, shifted);
}

typedef struct round_robot {
  size_t n;
  cprox_link links[MOST_JOINTS];
  cprox_link_geometry geometries[MOST_JOINTS];
  cprox_body *body[MOST_JOINTS + 1];
  double values[2][MOST_JOINTS];
  cprox_obstacle obstacle;
  cprox_robot *robot;
  cprox_motion *motion;
} round_robot;

/* Its links of the kinds from `first` to before `end`; what stands, of any before `end`. */
static void round_robot_make(rng *r, size_t first, size_t end, round_robot *t) {
  static const double OFF[5] = {0.0, 1e-9, 1e-4, 1e-2, 0.3};
  t->n = 1 + rng_index(r, MOST_JOINTS);
  const double speed = rng_log_uniform(r, 0.01, 300.0);
  int32_t variables[MOST_JOINTS];
  cprox_waypoint points[2];
  for (size_t i = 0; i < t->n; i++) {
    const vec3 axis = rng_index(r, 2) ? vec(0, 0, 1) : rng_unit(r);
    const cprox_pose origin = {rng_in_cube(r, 0.8), rng_index(r, 2) ? (cprox_quat){.w = 1.0} : rng_quat(r)};
    t->links[i] = (cprox_link){.parent = (int32_t)i - 1,
                               .type = rng_index(r, 5) ? CPROX_JOINT_REVOLUTE : CPROX_JOINT_PRISMATIC,
                               .origin = origin,
                               .axis = axis,
                               .variable = (int32_t)i,
                               .multiplier = 1.0};
    t->body[i] = round_body(r, first + rng_index(r, end - first));
    const cprox_pose at = rng_index(r, 4) ? on_axis(r, axis, OFF[rng_index(r, 5)]) : rng_pose(r, 0.8);
    t->geometries[i] = (cprox_link_geometry){.body = t->body[i], .pose = at, .link = (int32_t)i};
    variables[i] = (int32_t)i;
    const double most = t->links[i].type == CPROX_JOINT_REVOLUTE ? speed : lesser(speed, 1.0);
    t->values[0][i] = rng_uniform(r, -most, most);
    t->values[1][i] = rng_index(r, 4) ? rng_uniform(r, -most, most) : t->values[0][i];
  }
  for (size_t k = 0; k < 2; k++) points[k] = (cprox_waypoint){.time = (double)k, .positions = t->values[k]};
  t->body[t->n] = NULL;
  if (rng_index(r, 8))
    t->body[t->n] = round_body(r, rng_index(r, end));
  else
    assert_int_equal(cprox_body_create_halfspace(rng_unit(r), -rng_uniform(r, 0.2, 1.5), ws, &t->body[t->n]), CPROX_OK);
  const cprox_pose beside = on_axis(r, t->links[0].axis, OFF[rng_index(r, 5)]);
  t->obstacle =
      cprox_obstacle_at(t->body[t->n], rng_index(r, 3) ? under(t->links[0].origin, beside) : rng_pose(r, 1.0));
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR,
                                      .variables = variables,
                                      .n_variables = t->n,
                                      .waypoints = points,
                                      .n_waypoints = 2};
  assert_int_equal(cprox_robot_create(t->links, t->n, t->geometries, t->n, t->n, ws, &t->robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(t->robot, &d, ws, &t->motion), CPROX_OK);
}

static void round_robot_free(round_robot *t) {
  cprox_motion_free(t->motion);
  cprox_robot_free(t->robot);
  for (size_t i = 0; i <= t->n; i++) cprox_body_free(t->body[i]);
}

static cprox_obstacle placed_at(const round_robot *t, size_t geometry, double time) {
  cprox_pose at = CPROX_POSE_IDENTITY;
  for (size_t i = 0; i <= geometry; i++) {
    const double value = (1.0 - time) * t->values[0][i] + time * t->values[1][i];
    const vec3 axis = vec_scale(1.0 / vec_norm(t->links[i].axis), t->links[i].axis);
    const bool turns = t->links[i].type == CPROX_JOINT_REVOLUTE;
    const cprox_pose moved = {turns ? vec(0, 0, 0) : vec_scale(value, axis),
                              turns ? about(axis, value) : (cprox_quat){.w = 1.0}};
    at = under(under(at, t->links[i].origin), moved);
  }
  return cprox_obstacle_at(t->body[geometry], under(at, t->geometries[geometry].pose));
}

/* Of one pair at a time, by the search for static pairs, to 1e-10. `other`: a geometry, or -1 for the obstacle. */
static double distance_at(const round_robot *t, size_t geometry, int32_t other, double time) {
  const cprox_options fine = accurate(1e-10);
  cprox_result found;
  const cprox_obstacle standing = other < 0 ? t->obstacle : placed_at(t, (size_t)other, time);
  assert_true(cprox_pair(placed_at(t, geometry, time), standing, &fine, ws, &found) >= 0);
  return greater(found.upper, 0.0);
}

/* What distances are measured to, and computed poses may be off at lengths below 4 and angles below 600. */
static const double ROUNDING = 1e-10 + 1e-11;

/* A random robot: at 60 times none of one pair's distances is below `lower`, and at the time of the best they are as near
 * as `upper`. Whether the search ended. */
static bool agrees_with_samples(rng *r, size_t first, size_t end, size_t number) {
  enum { SAMPLES = 60 };
  round_robot t;
  round_robot_make(r, first, end, &t);
  const size_t geometry = rng_index(r, t.n);
  const int32_t other = geometry > 0 && rng_index(r, 2) ? (int32_t)rng_index(r, geometry) : -1;
  const cprox_robot_pair pair = {.geometry = (int32_t)geometry, .other = other};
  const cprox_robot_pair with = {.geometry = (int32_t)geometry, .other = 0};
  cprox_options options = accurate(rng_log_uniform(r, 1e-9, 1e-2));
  options.max_nodes = 300;
  cprox_result found;
  const cprox_status status =
      other < 0 ? cprox_distance(cprox_robot_along(t.motion, &with, 1), t.obstacle, &options, ws, &found)
                : cprox_obstacles_distance(NULL, cprox_robot_self(t.motion, &pair, 1), &options, ws, &found, NULL);
  assert_true(status == CPROX_OK || status == CPROX_BUDGET || status == CPROX_OVERLAP || status == CPROX_PRECISION);
  double least = distance_at(&t, geometry, other, found.t);
  if (least > found.upper + ROUNDING) fail_msg("case %zu: %.17g at %g, not %.17g", number, least, found.t, found.upper);
  for (int k = 0; k <= SAMPLES; k++) {
    const double time = (k + (k > 0 && k < SAMPLES ? rng_uniform(r, -0.5, 0.5) : 0.0)) / SAMPLES;
    least = lesser(distance_at(&t, geometry, other, time), least);
  }
  if (found.lower > least + ROUNDING) fail_msg("case %zu: lower %.17g, but %.17g", number, found.lower, least);
  if (status == CPROX_OK) assert_true(found.upper <= least + options.epsilon + ROUNDING);
  round_robot_free(&t);
  return status == CPROX_OK;
}

/* 3,000 robots of up to three joints (seed 411) that turn by up to 600 rad, their bodies on the axes of their joints or
 * off by 1e-9 … 0.3, what stands on the axis of the first. */
CASE(what_turns_about_its_own_axis_is_never_nearer_than_lower) {
  rng r = rng_seed(411);
  const size_t cases = test_cases(3000);
  size_t answered = 0;
  for (size_t i = 0; i < cases; i++) answered += agrees_with_samples(&r, 0, BY_INEQUALITIES, i);
  assert_true(2 * answered > cases);
}

/* 500 of the same (seed 413) whose links are superquadrics of exponents 1.2 … 50, and the implicit paper's objects. */
CASE(links_by_inequalities_are_never_nearer_than_lower) {
  rng r = rng_seed(413);
  const size_t cases = test_cases(500);
  size_t answered = 0;
  for (size_t i = 0; i < cases; i++) answered += agrees_with_samples(&r, BY_INEQUALITIES, KINDS, i);
  assert_true(3 * answered > cases);
}

/* ---- cost ---- */

static cprox_result ask_turning(cprox_body *link, cprox_pose on_link, double angle, cprox_body *standing, cprox_pose at,
                                cprox_status *status) {
  const cprox_link joint = {
      .parent = -1, .type = CPROX_JOINT_REVOLUTE, .origin = CPROX_POSE_IDENTITY, .axis = {0, 0, 1}, .multiplier = 1.0};
  const cprox_link_geometry geometry = {.body = link, .pose = on_link};
  const double from = 0.0;
  const int32_t variable = 0;
  const cprox_waypoint points[2] = {{.time = 0.0, .positions = &from}, {.time = 1.0, .positions = &angle}};
  const cprox_motion_description d = {
      .kind = CPROX_MOTION_WAYPOINTS, .variables = &variable, .n_variables = 1, .waypoints = points, .n_waypoints = 2};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  cprox_result found;
  assert_int_equal(cprox_robot_create(&joint, 1, &geometry, 1, 1, ws, &robot), CPROX_OK);
  assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
  *status = cprox_distance(cprox_robot_along(motion, NULL, 0), cprox_obstacle_at(standing, at), NULL, ws, &found);
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  return found;
}

/* A crank round a coaxial body of revolution, and such a body that turns by itself beside anything, by 0.5, 6.3 and
 * 10,000 rad: the distance is the same all the way. */
CASE(a_turn_that_changes_no_distance_takes_one_interval) {
  static const double ANGLE[3] = {0.5, 6.3, 1e4};
  enum { BODIES = 7 };
  rng r = rng_seed(412);
  for (int i = 0; i < 3; i++)
    for (size_t round = 0; round < 5; round++)
      for (size_t other = 0; other < BODIES; other++) {
        cprox_body *turning = round_body(&r, round), *any = round_body(&r, other);
        const cprox_pose own = on_axis(&r, vec(0, 0, 1), 0.0), beside = {vec(1.2, 0.1, 0.2), rng_quat(&r)};
        for (int crank = 0; crank < 2; crank++) {
          cprox_status status;
          const cprox_result found = crank ? ask_turning(any, beside, ANGLE[i], turning, own, &status)
                                           : ask_turning(turning, own, ANGLE[i], any, beside, &status);
          assert_int_equal(status, CPROX_OK);
          if (found.nodes > 1) fail_msg("%g rad, %zu beside %zu: %u nodes", ANGLE[i], round, other, found.nodes);
          assert_true(found.lower > 0.0 && found.upper - found.lower <= 1e-6);
        }
        cprox_body_free(turning);
        cprox_body_free(any);
      }
}

/* What the crank goes round stands beside its axis: the nearest face turns with the crank, and the plane with it. */
CASE(a_face_that_turns_past_a_cylinder_takes_few_intervals) {
  cprox_body *box = NULL, *cylinder = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_cylinder(1.0, 0.3, ws, &cylinder), CPROX_OK);
  for (int i = 1; i <= 8; i++) {
    const cprox_pose crank = {vec(1, 0, 0), {.w = 1.0}}, beside = {vec(0.05 * i, 0, 0), {.w = 1.0}};
    cprox_status status;
    const cprox_result found = ask_turning(box, crank, 6.3, cylinder, beside, &status);
    assert_int_equal(status, CPROX_OK);
    if (found.nodes > 100) fail_msg("%g beside the axis: %u nodes", 0.05 * i, found.nodes);
    assert_true(found.lower <= 0.55 - 0.05 * i + 1e-12 && found.upper >= 0.55 - 0.05 * i - 1e-12);
  }
  cprox_body_free(box);
  cprox_body_free(cylinder);
}

/* Beside the axis and 10,000 rad round it: the budget is far from enough, but the distance from the axis bounds it. */
CASE(a_budget_that_ends_a_long_turn_leaves_a_bound_above_zero) {
  cprox_body *box = NULL, *cylinder = NULL;
  assert_int_equal(cprox_body_create_box(vec(0.3, 0.2, 0.1), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_cylinder(1.0, 0.3, ws, &cylinder), CPROX_OK);
  const cprox_pose crank = {vec(1, 0, 0), {.w = 1.0}}, beside = {vec(0.1, 0, 0), {.w = 1.0}};
  cprox_status status;
  const cprox_result found = ask_turning(box, crank, 1e4, cylinder, beside, &status);
  assert_true(status == CPROX_OK || status == CPROX_BUDGET);
  assert_true(found.lower > 0.1 && found.lower <= 0.45 && found.upper < 0.450001);
  cprox_body_free(box);
  cprox_body_free(cylinder);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
