/* SPDX-License-Identifier: BSD-3-Clause */
/* Time of contact: "violated" is a common point at t, and otherwise upper is the distance of the two points that are
 * reported. The points are held against the bodies where they are then, in long double; contact face on face is known
 * in closed form. */
#include <math.h>

#include "attack.h"
#include "curve_proximity/cprox/robot.h"
#include "curve_proximity/cprox/translation.h"
#include "support/make_curve.h"
#include "support/reference.h"

/* A point or a box or a hull, its distance from a point known to 1e-18 of the sizes. */
typedef struct solid {
  int kind; /* 0 point, 1 ball, 2 box, 3 hull */
  double radius;
  vec3 half, corner[6];
  cprox_body *body;
} solid;

static void make_solid(attack *a, rng *r, int kind, solid *s) {
  cprox_status status = CPROX_INVALID;
  *s = (solid){.kind = kind, .radius = rng_uniform(r, 0.05, 0.5)};
  s->half = vec(rng_uniform(r, 0.05, 0.5), rng_uniform(r, 0.05, 0.5), rng_uniform(r, 0.05, 0.5));
  for (int i = 0; i < 6; i++) s->corner[i] = rng_in_cube(r, 0.5);
  if (kind == 0) status = cprox_body_create_polytope(&(vec3){0, 0, 0}, 1, a->ws, &s->body);
  if (kind == 1) status = cprox_body_create_sphere(s->radius, a->ws, &s->body);
  if (kind == 2) status = cprox_body_create_box(vec_scale(2.0, s->half), a->ws, &s->body);
  if (kind == 3) status = cprox_body_create_polytope(s->corner, 6, a->ws, &s->body);
  if (status != CPROX_OK) attack_fail(a, "%s", cprox_workspace_error(a->ws));
}

static long double off(const solid *s, const cprox_pose *pose, vec3 world) {
  const vec3l p = ref_to_local(pose, ref_vec(world));
  if (s->kind == 0) return ref_norm(p);
  if (s->kind == 1) return fmaxl(ref_norm(p) - (long double)s->radius, 0.0L);
  return s->kind == 2 ? ref_point_box(p, s->half) : ref_point_hull(p, s->corner, 6);
}

/* Both points on their bodies, and what is said of them. `signed_too`: where the bodies overlap upper is minus a depth.
 */
static void check_words(attack *a, const cprox_result *x, double epsilon, const solid *s[2], const cprox_pose pose[2],
                        bool signed_too) {
  static const double ROOM = 1e-10; /* sizes are about 1, and points come from weighted sums and poses */
  attack_count(a, cprox_verdict_name(x->verdict));
  attack_check(a, x->t_contact_lower <= x->t || x->verdict == CPROX_VERDICT_CLEAR, "t_contact_lower %.17g, t %.17g",
               x->t_contact_lower, x->t);
  if (x->obstacle_index < 0 || !isfinite(x->upper)) return;
  const double apart = vec_norm(vec_sub(x->witness_mover, x->witness_obstacle));
  const long double first = off(s[0], &pose[0], x->witness_mover), second = off(s[1], &pose[1], x->witness_obstacle);
  attack_check(a, first <= (long double)ROOM && second <= (long double)ROOM, "points off their bodies by %.3Lg, %.3Lg",
               first, second);
  if (x->verdict == CPROX_VERDICT_VIOLATED)
    attack_check(a, signed_too ? x->upper <= 0.0 : x->upper == 0.0 && apart <= ROOM,
                 "contact, but upper is %.17g and the points are %.17g apart", x->upper, apart);
  else
    attack_check(a, fabs(apart - x->upper) <= ROOM, "%s: upper is %.17g, but the points are %.17g apart",
                 cprox_verdict_name(x->verdict), x->upper, apart);
  if (x->verdict == CPROX_VERDICT_UNDECIDED && x->status == CPROX_OK)
    attack_check(a, x->upper <= epsilon * 1.000001 + ROOM, "undecided, but upper is %.17g", x->upper);
}

/* ---- along a curve, and at constant velocities ---- */

static void along_curve(attack *a, rng *r, double epsilon) {
  attack_kind(a, "along a curve");
  solid s[2];
  make_solid(a, r, (int)rng_index(r, 4), &s[0]);
  make_solid(a, r, 1 + (int)rng_index(r, 3), &s[1]);
  vec3 points[5];
  const size_t n = 2 + rng_index(r, 4);
  for (size_t i = 0; i < n; i++) points[i] = rng_in_cube(r, 2.0);
  cprox_curve *curve = NULL;
  if (curve_from(describe_bezier(points, n, 0.0, 1.0), a->ws, &curve) != CPROX_OK)
    attack_fail(a, "%s", cprox_workspace_error(a->ws));
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_pose pose[2] = {CPROX_POSE_IDENTITY, rng_pose(r, 0.5)};
  cprox_result x;
  const cprox_status status = cprox_time_of_contact(cprox_body_along(s[0].body, curve),
                                                    cprox_obstacle_at(s[1].body, pose[1]), &options, a->ws, &x);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (!attack_failed(a) && isfinite(x.t)) {
    const vec3l at = ref_bezier(points, n - 1, (long double)x.t, 0);
    pose[0].position = vec((double)at.x, (double)at.y, (double)at.z);
    check_words(a, &x, epsilon, (const solid *[2]){&s[0], &s[1]}, pose, false);
  }
  cprox_curve_free(curve);
  for (int i = 0; i < 2; i++) cprox_body_free(s[i].body);
}

static void at_velocities(attack *a, rng *r, double epsilon) {
  attack_kind(a, "at constant velocities");
  solid s[2];
  cprox_translating from[2];
  for (int i = 0; i < 2; i++) {
    make_solid(a, r, 1 + (int)rng_index(r, 3), &s[i]);
    from[i] =
        (cprox_translating){.from = cprox_obstacle_at(s[i].body, rng_pose(r, 2.0)), .velocity = rng_in_cube(r, 1.0)};
  }
  if (rng_index(r, 2))
    from[0].velocity = vec_add(from[1].velocity, vec_sub(from[1].from.pose.position, from[0].from.pose.position));
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result x;
  const cprox_status status = cprox_translating_contact(from[0], from[1], 2.0, &options, a->ws, &x);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (!attack_failed(a) && x.verdict != CPROX_VERDICT_CLEAR) {
    cprox_pose pose[2];
    for (int i = 0; i < 2; i++) {
      pose[i] = from[i].from.pose;
      pose[i].position = vec_axpy(pose[i].position, x.t, from[i].velocity);
    }
    check_words(a, &x, epsilon, (const solid *[2]){&s[0], &s[1]}, pose, true);
  }
  for (int i = 0; i < 2; i++) cprox_body_free(s[i].body);
}

/* ---- a box that screws onto a box ---- */

/* It goes down a way of 1 s at constant speed while it turns about the vertical: contact at a time that is known. */
static void screw(attack *a, rng *r, double epsilon) {
  attack_kind(a, "face on face");
  solid s[2];
  for (int i = 0; i < 2; i++) make_solid(a, r, 2, &s[i]);
  const double contact = rng_uniform(r, 0.1, 0.9), speed = rng_log_uniform(r, 0.05, 2.0);
  const double turn = rng_uniform(r, -6, 6), start = s[0].half.z + s[1].half.z + speed * contact;
  const cprox_quat one = {1, 0, 0, 0};
  const cprox_link links[2] = {{.parent = -1,
                                .type = CPROX_JOINT_PRISMATIC,
                                .origin = {{0, 0, 0}, one},
                                .axis = {0, 0, 1},
                                .variable = 0,
                                .multiplier = 1},
                               {.parent = 0,
                                .type = CPROX_JOINT_REVOLUTE,
                                .origin = {{0, 0, 0}, one},
                                .axis = {0, 0, 1},
                                .variable = 1,
                                .multiplier = 1}};
  const cprox_link_geometry geometry = {
      .body = s[0].body, .pose = {{rng_uniform(r, -0.04, 0.04), rng_uniform(r, -0.04, 0.04), 0}, one}, .link = 1};
  const double first[2] = {start, 0}, last[2] = {start - speed, turn};
  const cprox_waypoint points[2] = {{.time = 0, .positions = first}, {.time = 1, .positions = last}};
  cprox_robot *robot = NULL;
  cprox_motion *motion = NULL;
  if (cprox_robot_create(links, 2, &geometry, 1, 2, a->ws, &robot) != CPROX_OK ||
      cprox_motion_create(robot,
                          &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                      .variables = (const int32_t[]){0, 1},
                                                      .n_variables = 2,
                                                      .waypoints = points,
                                                      .n_waypoints = 2,
                                                      .interpolation = CPROX_INTERPOLATION_LINEAR},
                          a->ws, &motion) != CPROX_OK)
    attack_fail(a, "%s", cprox_workspace_error(a->ws));
  const double angle = rng_index(r, 2) ? 0.0 : rng_uniform(r, -1.5, 1.5);
  cprox_pose pose[2] = {geometry.pose, {{0, 0, 0}, {cos(angle), 0, 0, sin(angle)}}};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result x;
  const cprox_status status = cprox_time_of_contact(cprox_robot_along(motion, NULL, 0),
                                                    cprox_obstacle_at(s[1].body, pose[1]), &options, a->ws, &x);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (!attack_failed(a)) {
    attack_check(a, x.verdict == CPROX_VERDICT_VIOLATED && x.t_contact_lower <= contact + 1e-12,
                 "%s, t_contact_lower %.17g, but they touch at %.17g", cprox_verdict_name(x.verdict), x.t_contact_lower,
                 contact);
    attack_check(a, x.t >= contact - 1e-12 && x.t <= contact + 1e-5, "contact at %.17g, proven at %.17g", contact, x.t);
    /* where the box is then */
    const double half = 0.5 * turn * x.t;
    const cprox_pose turned = {{0, 0, start - speed * x.t}, {cos(half), 0, 0, sin(half)}};
    const vec3l at = ref_to_world(&turned, ref_vec(geometry.pose.position));
    pose[0] = (cprox_pose){{(double)at.x, (double)at.y, (double)at.z}, turned.orientation};
    check_words(a, &x, epsilon, (const solid *[2]){&s[0], &s[1]}, pose, false);
  }
  cprox_motion_free(motion);
  cprox_robot_free(robot);
  for (int i = 0; i < 2; i++) cprox_body_free(s[i].body);
}

static void one_case(attack *a, rng *r) {
  const double epsilon = rng_log_uniform(r, 1e-9, 0.5);
  const size_t kind = rng_index(r, 8);
  if (kind == 0)
    screw(a, r, epsilon);
  else if (kind < 5)
    along_curve(a, r, epsilon);
  else
    at_velocities(a, r, epsilon);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "contact", one_case);
}
