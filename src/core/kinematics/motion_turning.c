/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions whose floating joints turn by slerp or by screws: made from the waypoints. */
#include <math.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "kinematics/motion_build.h"

/* Orientations nearer than this to half a turn apart [half of it in rad] turn either way. */
static const double NEAREST_HALF_TURN = 1e-9;

/* Of what is computed of a quaternion, and of a position per unit of length (doc/robot-poses.md, Poses). */
#define ARC_ERROR (64.0 * ROUND_U)

bool motion_allocate_arcs(cprox_motion *m) {
  const size_t n_axes = m->robot->n_axes;
  m->arc_of = calloc(n_axes + 1, sizeof *m->arc_of);
  m->sagitta = calloc(n_axes + 1, sizeof *m->sagitta);
  if (!m->arc_of || !m->sagitta) return false;
  for (size_t i = 0; i < n_axes; i++) m->arc_of[i] = -1;
  return true;
}

bool motion_allocate_track_arcs(motion_track *t, size_t n) {
  t->n_arcs = n;
  t->arc_axes = calloc(n + 1, sizeof *t->arc_axes);
  t->arcs = calloc(n * t->n_segments + 1, sizeof *t->arcs);
  return t->arc_axes && t->arcs;
}

/* ---- which joints ---- */

/* Where the source gives the seven variables of a floating joint; -1: nowhere. */
static void find_columns(const motion_source *s, int32_t first, int32_t columns[7]) {
  for (int32_t k = 0; k < 7; k++) {
    columns[k] = -1;
    for (size_t i = 0; i < s->n; i++)
      if (s->variables[i] == first + k) columns[k] = (int32_t)i;
  }
}

/* How many of the variables that the joint needs are given; all or none will do. */
static cprox_status check_columns(const motion_source *s, int32_t first, const int32_t columns[7], bool *turns) {
  const int begin = s->description->turning == CPROX_TURNING_SCREW ? 0 : 3;
  int given = 0;
  for (int k = begin; k < 7; k++) given += columns[k] >= 0;
  *turns = given > 0;
  if (given == 0) return CPROX_OK;
  /* on a screw the position does not go as its variables would */
  const cprox_robot *robot = s->robot;
  const size_t other = robot_sharing_link(robot->given_links, robot->n_links, first, first, begin == 0 ? 3 : 0);
  if (other < robot->n_links)
    return workspace_fail(s->workspace, CPROX_INVALID,
                          "link %zu: its joint shares a variable with a floating joint that moves by screws, of "
                          "variables %d to %d",
                          other, (int)first, (int)first + 6);
  if (given == 7 - begin) return CPROX_OK;
  return workspace_fail(s->workspace, CPROX_INVALID,
                        "the motion gives %d of the variables %d to %d: %s needs all of them", given,
                        (int)first + begin, (int)first + 6, begin ? "slerp" : "a screw");
}

/* ---- waypoints ---- */

static cprox_status unit_quaternion(const motion_source *s, size_t point, const int32_t columns[7],
                                    const double before[4], double q[4]) {
  const double *values = s->description->waypoints[point].positions;
  double square = 0.0, along = 0.0;
  for (int k = 0; k < 4; k++) square += values[columns[3 + k]] * values[columns[3 + k]];
  if (!(square > 1e-18))
    return workspace_fail(s->workspace, CPROX_INVALID, "waypoint %zu: the quaternion of variables %d to %d is 0", point,
                          (int)s->variables[columns[3]], (int)s->variables[columns[6]]);
  for (int k = 0; k < 4; k++) {
    q[k] = values[columns[3 + k]] / sqrt(square);
    along += q[k] * (before ? before[k] : q[k]);
  }
  for (int k = 0; k < 4 && along < 0.0; k++) q[k] = -q[k];
  if (fabs(along) >= NEAREST_HALF_TURN) return CPROX_OK;
  return workspace_fail(s->workspace, CPROX_INVALID,
                        "waypoints %zu and %zu: the orientations of variables %d to %d are half a turn apart; put a "
                        "waypoint between them",
                        point - 1, point, (int)s->variables[columns[3]], (int)s->variables[columns[6]]);
}

/* A straight line in the place of the polynomial. */
static void straighten(motion_track *t, size_t segment, size_t column, double from, double to, double error) {
  const size_t at = segment * t->n_moving + column, degree = t->degree[segment];
  double *c = t->coefficients + at * t->stride;
  for (size_t i = 0; i <= degree; i++) c[i] = from + (double)i / (double)degree * (to - from);
  c[degree] = to;
  t->error[at] = error;
}

static cprox_status turn_joint(const motion_source *s, motion_track *t, const int32_t columns[7], motion_arc *arcs) {
  const bool screw = s->description->turning == CPROX_TURNING_SCREW;
  const cprox_waypoint *points = s->description->waypoints;
  double q[2][4];
  cprox_status status = unit_quaternion(s, 0, columns, NULL, q[0]);
  for (size_t i = 0; i < t->n_segments && status == CPROX_OK; i++) {
    status = unit_quaternion(s, i + 1, columns, q[0], q[1]);
    if (status != CPROX_OK) break;
    const double *a = points[i].positions, *b = points[i + 1].positions;
    double size = 0.0;
    for (int k = 0; k < 3 && screw; k++) size += fabs(a[columns[k]]) + 2.0 * fabs(b[columns[k]] - a[columns[k]]);
    for (int k = 0; k < 3 && screw; k++)
      straighten(t, i, (size_t)columns[k], a[columns[k]], b[columns[k]], ARC_ERROR * size);
    for (int k = 0; k < 4; k++) straighten(t, i, (size_t)columns[3 + k], q[0][k], q[1][k], ARC_ERROR);
    arcs[i] = screw ? arc_screw(q[0], q[1], vec(a[columns[0]], a[columns[1]], a[columns[2]]),
                                vec(b[columns[0]], b[columns[1]], b[columns[2]]))
                    : arc_between(q[0], q[1]);
    for (int k = 0; k < 4; k++) q[0][k] = q[1][k];
  }
  return status;
}

cprox_status motion_turn_by_arcs(const motion_source *s, cprox_motion *m) {
  const robot_axis *axes = s->robot->axes;
  motion_track *t = m->tracks;
  size_t n = 0;
  for (size_t i = 0; i < s->robot->n_axes; i++) n += axes[i].kind == AXIS_BALL;
  if (!motion_allocate_arcs(m) || !motion_allocate_track_arcs(t, n))
    return workspace_fail(s->workspace, CPROX_MEMORY, "no memory for the arcs of %zu joints", n);
  t->n_arcs = 0;
  for (size_t i = 0; i < s->robot->n_axes; i++) {
    if (axes[i].kind != AXIS_BALL) continue;
    int32_t columns[7];
    bool turns;
    const int32_t first = axes[i].variable - 3;
    find_columns(s, first, columns);
    cprox_status status = check_columns(s, first, columns, &turns);
    if (status == CPROX_OK && turns) {
      t->arc_axes[t->n_arcs] = (int32_t)i;
      m->arc_of[i] = (int32_t)t->n_arcs++;
      status = turn_joint(s, t, columns, t->arcs + (size_t)m->arc_of[i] * t->n_segments);
    }
    if (status != CPROX_OK) return status;
  }
  return CPROX_OK;
}

/* ---- what follows from the arcs ---- */

bool motion_moves_by_arc(const cprox_motion *m, int32_t variable) {
  for (size_t i = 0; i < m->robot->n_axes && m->arc_of; i++) {
    if (m->arc_of[i] < 0 || m->robot->axes[i].kind != AXIS_BALL) continue;
    const motion_arc *arcs = motion_arc_at(m, i, 0);
    const int32_t last = m->robot->axes[i].variable + 3, first = last - (arcs[0].screw ? 6 : 3);
    if (variable < first || variable > last) continue;
    for (size_t k = 0; k < motion_track_of(m, i)->n_segments; k++)
      if (arc_moves(&arcs[k])) return true;
  }
  return false;
}

void motion_arc_values(const cprox_motion *m, size_t axis, size_t segment, double u, double values[7]) {
  const motion_arc *arc = motion_arc_at(m, axis, segment);
  const double s = arc->from + (arc->to - arc->from) * u;
  arc_orientation(arc, s, values + 3);
  if (!arc->screw) return;
  vec3 p[3];
  arc_position(arc, s, p);
  values[0] = p[0].x, values[1] = p[0].y, values[2] = p[0].z;
}
