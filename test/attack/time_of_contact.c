/* SPDX-License-Identifier: BSD-3-Clause */
/* Certified times: no contact before t_contact_lower, whatever unit and origin the time has. A ball meets a wall at a
 * constant speed, so that the time of contact has a closed form; times lie far from 0 (seconds since 1970) or on both
 * sides of it. The reference's own error is 16 roundings of long double. */
#include <float.h>
#include <math.h>

#include "attack.h"
#include "support/builders.h"
#include "support/make_curve.h"
#include "support/reference.h"

typedef struct meeting {
  double t0, t1; /* when the motion begins and ends */
  double from, to, radius, wall;
  cprox_body *body;
  cprox_options options;
} meeting;

static meeting meeting_make(attack *a, rng *r) {
  static const double origins[] = {0.0, 1.7e9, -1.0, 1e3, -1e-3, 1e15};
  meeting m = {.radius = rng_uniform(r, 0.0, 0.2), .options = CPROX_OPTIONS_DEFAULT};
  m.t0 = origins[rng_index(r, 6)] * rng_uniform(r, 0.5, 1.0);
  m.t1 = m.t0 + rng_log_uniform(r, 0.1, 100.0) * fmax(1.0, 1e-12 * fabs(m.t0));
  m.from = rng_uniform(r, -2.0, -0.5), m.to = rng_uniform(r, 0.5, 2.0);
  m.wall = 0.1;
  m.options.epsilon = rng_index(r, 3) ? rng_log_uniform(r, 1e-9, 1e-3) : 0.0;
  m.options.max_nodes = 500;
  if (rng_index(r, 2))
    cprox_body_create_halfspace(vec(-1, 0, 0), 0.0, a->ws, &m.body); /* x >= 0 */
  else
    cprox_body_create_box(vec(0.2, 4, 4), a->ws, &m.body);
  return m;
}

static cprox_obstacle target_of(const meeting *m, bool box) {
  return cprox_obstacle_at(m->body, (cprox_pose){{box ? m->wall : 0.0, 0, 0}, {1, 0, 0, 0}});
}

/* The time of contact is where x + radius = 0: t0 + (t1 - t0)(-radius - from)/(to - from). */
static void check(attack *a, const meeting *m, const char *what, cprox_status status, const cprox_result *r) {
  if (!attack_check(a, status >= 0, "%s: %s", what, cprox_workspace_error(a->ws))) return;
  const long double way = (long double)m->to - m->from, part = (-(long double)m->radius - m->from) / way;
  const long double begin = m->t0, length = (long double)m->t1 - m->t0;
  const long double error = 16 * LDBL_EPSILON * (length + (m->t0 == 0.0 ? 0.0L : LDBL_EPSILON * fabsl(begin)));
  /* t_contact_lower - t0 is exact in long double, or rounded by 2^-64 of itself */
  attack_check(a, (long double)r->t_contact_lower - begin <= part * length + error,
               "%s: t_contact_lower = %.17g is late by %Lg; t from %.17g to %.17g, x from %.17g to %.17g, radius "
               "%.17g, epsilon %g",
               what, r->t_contact_lower, (long double)r->t_contact_lower - begin - part * length, m->t0, m->t1, m->from,
               m->to, m->radius, m->options.epsilon);
  attack_check(a, r->verdict != CPROX_VERDICT_VIOLATED || r->t_contact_lower <= r->t,
               "%s: t_contact_lower %.17g is after t %.17g, where contact is proven", what, r->t_contact_lower, r->t);
}

static void one_case(attack *a, rng *r) {
  const meeting m = meeting_make(a, r);
  const bool box = cprox_body_get_info(m.body).kind == CPROX_BODY_BOX;
  const cprox_obstacle target = target_of(&m, box);
  cprox_result result = {0};
  const size_t kind = rng_index(r, 3);
  static const char *const names[] = {"curve", "robot", "translation"};
  attack_kind(a, "%s", names[kind]);
  if (kind == 0) {
    const vec3 ends[2] = {{m.from, 0, 0}, {m.to, 0, 0}};
    cprox_curve *curve = NULL;
    curve_from(describe_bezier(ends, 2, m.t0, m.t1), a->ws, &curve);
    check(a, &m, "curve", cprox_time_of_contact(cprox_tube_along(curve, m.radius), target, &m.options, a->ws, &result),
          &result);
    cprox_curve_free(curve);
  } else if (kind == 1 && box) {
    const cprox_link link = {
        .parent = -1, .type = CPROX_JOINT_PRISMATIC, .origin = CPROX_POSE_IDENTITY, .axis = {1, 0, 0}, .multiplier = 1};
    cprox_body *point = NULL;
    cprox_body_create_point(vec(0, 0, 0), a->ws, &point);
    const cprox_link_geometry geometry = {.body = point, .pose = CPROX_POSE_IDENTITY, .margin = m.radius};
    const int32_t variable = 0;
    const cprox_waypoint points[2] = {{.time = m.t0, .positions = &m.from}, {.time = m.t1, .positions = &m.to}};
    cprox_robot *robot = NULL;
    cprox_motion *motion = NULL;
    cprox_robot_create(&link, 1, &geometry, 1, 1, a->ws, &robot);
    cprox_motion_create(robot,
                        &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                    .variables = &variable,
                                                    .n_variables = 1,
                                                    .waypoints = points,
                                                    .n_waypoints = 2,
                                                    .interpolation = CPROX_INTERPOLATION_LINEAR},
                        a->ws, &motion);
    check(a, &m, "robot", cprox_time_of_contact(cprox_robot_along(motion, NULL, 0), target, &m.options, a->ws, &result),
          &result);
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    cprox_body_free(point);
  } else if (kind == 2) {
    /* at the speed that takes x = from to 0 in part of the duration */
    meeting own = m;
    own.t0 = 0.0, own.t1 = 1.0, own.to = own.from + 3.0;
    cprox_body *ball = NULL;
    if (own.radius > 0.0) cprox_body_create_sphere(own.radius, a->ws, &ball);
    if (!ball) cprox_body_create_point(vec(0, 0, 0), a->ws, &ball);
    const cprox_translating one = {cprox_obstacle_at(ball, (cprox_pose){{own.from, 0, 0}, {1, 0, 0, 0}}), {3, 0, 0}};
    const cprox_translating two = {target, {0, 0, 0}};
    check(a, &own, "translation", cprox_translating_contact(one, two, 1.0, &m.options, a->ws, &result), &result);
    cprox_body_free(ball);
  }
  cprox_body_free(m.body);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "time_of_contact", one_case);
}
