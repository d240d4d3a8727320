/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/arcs.h"

#include <math.h>

#include "base/rounding.h"

/* Products of a dozen factors; the first of them may be off by this much of their size. */
#define ARC_UP (1.0 + 64.0 * ROUND_U)

motion_arc arc_between(const double q0[4], const double q1[4]) {
  motion_arc arc = {.to = 1.0, .q = {q0[0], q0[1], q0[2], q0[3]}, .z = {0, 0, 1}};
  /* q1 q0*: its vector part is sin(angle/2) z */
  const vec3 u = vec(q1[0], q1[1], q1[2]), v = vec(q0[0], q0[1], q0[2]);
  const vec3 part = vec_sub(vec_sub(vec_scale(q0[3], u), vec_scale(q1[3], v)), vec_cross(u, v));
  const double sine = vec_norm(part), cosine = q1[3] * q0[3] + vec_dot(u, v);
  if (!(sine > 0.0)) return arc;
  arc.z = vec_scale(1.0 / sine, part);
  arc.angle = 2.0 * atan2(sine, cosine);
  return arc;
}

motion_arc arc_screw(const double q0[4], const double q1[4], vec3 p0, vec3 p1) {
  motion_arc arc = arc_between(q0, q1);
  const vec3 way = vec_sub(p1, p0);
  arc.screw = true;
  arc.p = p0;
  arc.along = vec_scale(vec_dot(way, arc.z), arc.z);
  arc.across = vec_sub(way, arc.along);
  arc.up = vec_cross(arc.z, arc.across);
  return arc;
}

void arc_orientation(const motion_arc *arc, double s, double q[4]) {
  const double half = 0.5 * arc->angle * s, w = cos(half);
  const vec3 u = vec_scale(sin(half), arc->z), v = vec(arc->q[0], arc->q[1], arc->q[2]);
  const vec3 part = vec_add(vec_add(vec_scale(w, v), vec_scale(arc->q[3], u)), vec_cross(u, v));
  q[0] = part.x, q[1] = part.y, q[2] = part.z;
  q[3] = w * arc->q[3] - vec_dot(u, v);
}

/* (angle/2) / sin(angle/2): how much longer an arc of a circle is than its chord. */
static double arc_over_chord(const motion_arc *arc) {
  const double half = 0.5 * arc->angle;
  return half > 0.0 ? half / sin(half) : 1.0;
}

void arc_position(const motion_arc *arc, double s, vec3 p[3]) {
  const double half = 0.5 * arc->angle, longer = arc_over_chord(arc);
  const double part = half > 0.0 ? sin(half * s) / sin(half) : s, rest = half * (1.0 - s);
  p[0] = vec_axpy(arc->p, s, arc->along);
  p[0] = vec_axpy(p[0], part * cos(rest), arc->across);
  p[0] = vec_axpy(p[0], -part * sin(rest), arc->up);
  const double turned = arc->angle * (s - 0.5), c = longer * cos(turned), d = longer * sin(turned);
  p[1] = vec_axpy(vec_axpy(arc->along, c, arc->across), d, arc->up);
  p[2] = vec_axpy(vec_scale(-d * arc->angle, arc->across), c * arc->angle, arc->up);
}

double arc_speed(const motion_arc *arc, double *across) {
  const double round = ARC_UP * arc_over_chord(arc) * vec_norm(arc->across);
  *across = round;
  return ARC_UP * sqrt(vec_norm2(arc->along) + round * round);
}

/* A function whose second derivative is at most a is within a/8 of its chord. */
double arc_sagitta(const motion_arc *arc, double *position) {
  double across;
  arc_speed(arc, &across);
  *position = arc->screw ? ARC_UP * across * arc->angle / 8.0 : 0.0;
  return ARC_UP * arc->angle * arc->angle / 32.0;
}

bool arc_moves(const motion_arc *arc) {
  return arc->angle > 0.0 || vec_norm2(arc->along) > 0.0 || vec_norm2(arc->across) > 0.0;
}
