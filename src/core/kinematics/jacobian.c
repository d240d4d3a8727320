/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/jacobian.h"

#include <math.h>
#include <string.h>

#include "base/bernstein.h"

/* ---- points by variables ---- */

/* A quaternion p of any norm turns by 2 vec(dp p*) / |p|² in the frame that its axis stands in; doc/robot-depth.md. */
static void add_quaternion(const double *p, vec3 moment, double *by) {
  const vec3 v = vec(p[0], p[1], p[2]);
  const vec3 across = vec_sub(vec_scale(p[3], moment), vec_cross(v, moment));
  const double scale = 2.0 / (vec_norm2(v) + p[3] * p[3]);
  by[0] += scale * across.x, by[1] += scale * across.y, by[2] += scale * across.z;
  by[3] -= scale * vec_dot(v, moment);
}

/* A rotation vector p turns by J dp, J the left Jacobian of the exponential; by J^T what is before it. */
static void add_vector(const double *p, vec3 moment, double *by) {
  const vec3 v = vec(p[0], p[1], p[2]);
  const double angle2 = vec_norm2(v), angle = sqrt(angle2), sine = sin(0.5 * angle);
  const bool is_small = angle < 1e-4;
  const double s = is_small ? 1.0 - angle2 / 6.0 : sin(angle) / angle;
  const double c = is_small ? 0.5 - angle2 / 24.0 : 2.0 * sine * sine / angle2;
  const double a = is_small ? 1.0 / 6.0 - angle2 / 120.0 : (1.0 - s) / angle2;
  const vec3 turned = vec_axpy(vec_axpy(vec_scale(s, moment), a * vec_dot(v, moment), v), -c, vec_cross(v, moment));
  by[0] += turned.x, by[1] += turned.y, by[2] += turned.z;
}

void motion_add_gradient(const cprox_robot *robot, const double *values, const placement *frames, int32_t axis,
                         int32_t above, vec3 n, vec3 x, double *by_variable) {
  for (int32_t i = axis; i != above; i = robot->axes[i].parent) {
    const robot_axis *a = &robot->axes[i];
    const placement *moved = &frames[i];
    const vec3 torque = vec_cross(vec_sub(x, moved->p), n);
    double *by = by_variable + a->variable;
    if (a->kind == AXIS_BALL || a->kind == AXIS_VECTOR) {
      const vec3 seen = a->parent < 0 ? torque : placement_turn_back(&frames[a->parent], torque);
      const vec3 moment = placement_turn_back(&a->at, seen); /* in the frame that the ball stands in */
      if (a->kind == AXIS_BALL)
        add_quaternion(values + a->variable, moment, by);
      else
        add_vector(values + a->variable, moment, by);
      continue;
    }
    const vec3 z = placement_turn(moved, a->z);
    *by += a->multiplier * vec_dot(a->kind == AXIS_PRISMATIC ? n : torque, z);
  }
}

/* ---- variables by time ---- */

/* Of slerp and screws, which turn at a constant rate: q' = omega q / 2. */
static void add_arc_rates(const cprox_motion *m, size_t axis, size_t segment, double u, double *rates) {
  const motion_track *t = motion_track_of(m, axis);
  const motion_arc *arc = motion_arc_at(m, axis, segment);
  const double s = arc->from + (arc->to - arc->from) * u,
               speed = (arc->to - arc->from) / (t->times[segment + 1] - t->times[segment]);
  double q[4];
  arc_orientation(arc, s, q);
  const vec3 half = vec_scale(0.5 * speed * arc->angle, arc->z), v = vec(q[0], q[1], q[2]);
  const vec3 part = vec_add(vec_scale(q[3], half), vec_cross(half, v));
  rates[0] = part.x, rates[1] = part.y, rates[2] = part.z, rates[3] = -vec_dot(half, v);
  if (!arc->screw) return;
  vec3 p[3];
  arc_position(arc, s, p);
  rates[-3] = speed * p[1].x, rates[-2] = speed * p[1].y, rates[-1] = speed * p[1].z;
}

static void add_polynomial_rates(const motion_track *t, size_t segment, double u, double *rates) {
  const size_t degree = t->degree[segment];
  const double scale = (double)degree / (t->times[segment + 1] - t->times[segment]);
  for (size_t k = 0; k < t->n_moving; k++) {
    const double *root = t->coefficients + (segment * t->n_moving + k) * t->stride;
    double c[MOTION_MAX_DEGREE + 1] = {0};
    for (size_t i = 0; i < degree; i++) c[i] = root[i + 1] - root[i];
    rates[t->moving[k]] = scale * bernstein_at(c, degree - 1, u);
  }
}

void motion_rates(const cprox_motion *m, size_t segment, double at, double *rates) {
  memset(rates, 0, m->robot->n_variables * sizeof *rates);
  for (size_t j = 0; j < m->n_tracks; j++) {
    const motion_track *t = &m->tracks[j];
    double u = at;
    const size_t own = motion_track_place(m, t, segment, &u);
    add_polynomial_rates(t, own, u, rates);
    for (size_t k = 0; k < t->n_arcs; k++) {
      const size_t i = (size_t)t->arc_axes[k];
      if (m->axis_moves[i]) add_arc_rates(m, i, own, u, rates + m->robot->axes[i].variable);
    }
  }
}
