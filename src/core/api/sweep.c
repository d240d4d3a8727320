/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion cut into intervals over each of which a geometry of the robot moves no farther than asked.
 * doc/swept-volume.md */
#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "curve_proximity/cprox/robot.h"
#include "kinematics/bound.h"
#include "problem/validate.h"

enum { NODES_BETWEEN_LOOKS = 64 };

typedef struct sweep {
  const cprox_motion *motion;
  int32_t geometry;
  double most; /* [m] */
  axis_state *axes;
  double *rows;
  cprox_swept_pose *poses;
  size_t room, n;
  cprox_workspace *workspace;
  size_t nodes;
} sweep;

/* How far a point of the geometry can be from where the middle of the node at hand has it. */
static double displacement_of(const sweep *s) {
  const cprox_robot *robot = s->motion->robot;
  double most = 0.0;
  for (size_t i = 0; i < robot->n_parts; i++) {
    const robot_part *part = &robot->parts[i];
    if (part->geometry != s->geometry) continue;
    double moved = 0.0;
    if (part->axis >= 0) {
      const vec3 centre = placement_apply(&s->axes[part->axis].frame, part->at.p);
      moved = motion_displacement(s->motion, s->axes, part->axis, -1, centre,
                                  part->model.radius + s->motion->part_error[i]);
    }
    most = greater(ROUND_UP * (moved + s->motion->part_error[i]), most);
  }
  return most;
}

static void keep(sweep *s, size_t segment, double a, double b, double displacement) {
  if (s->n < s->room) {
    const cprox_robot *robot = s->motion->robot;
    const placement own = robot_geometry_place(robot, s->geometry);
    const int32_t axis = robot->links[robot->given_geometries[s->geometry].link].axis;
    const placement at = axis < 0 ? own : placement_compose(&s->axes[axis].frame, &own);
    /* the quaternion of the pose is rounded, and the body turns with it */
    const cprox_body *body = robot->given_geometries[s->geometry].body;
    const double size = vec_norm(body->ball_centre) + body->ball_radius + vec_norm(at.p);
    s->poses[s->n] = (cprox_swept_pose){.geometry = s->geometry,
                                        .pose = placement_pose(&at),
                                        .displacement = ROUND_UP * (displacement + ROUND_U * ROUND_JOINT * size),
                                        .t0 = motion_time(s->motion, segment, a),
                                        .t1 = motion_time(s->motion, segment, b)};
  }
  s->n++;
}

/* False where no interval is short enough, or an end is wanted. */
static bool cut(sweep *s, size_t segment, double a, double b) {
  if (s->nodes++ % NODES_BETWEEN_LOOKS == 0 && workspace_stops(s->workspace)) return false;
  motion_node(s->motion, segment, a, b, s->rows, s->axes);
  const double displacement = displacement_of(s);
  if (displacement <= s->most) {
    keep(s, segment, a, b, displacement);
    return true;
  }
  const double middle = 0.5 * (a + b);
  return b - a > 1e-9 && cut(s, segment, a, middle) && cut(s, segment, middle, b);
}

cprox_status cprox_motion_sweep(const cprox_motion *motion, int32_t geometry, double displacement,
                                cprox_workspace *workspace, size_t room, cprox_swept_pose *poses, size_t *n) {
  WORKSPACE_USE(workspace);
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!motion || !n || (room > 0 && !poses))
    return workspace_fail(workspace, CPROX_INVALID, "motion, poses and n are needed");
  if (motion->n_tracks != 1)
    return workspace_fail(workspace, CPROX_INVALID, "the motion is a joined one: sweep each of its motions");
  if (geometry < 0 || (size_t)geometry >= motion->robot->n_geometries)
    return workspace_fail(workspace, CPROX_INVALID, "there is no geometry %d: the robot has %zu", (int)geometry,
                          motion->robot->n_geometries);
  if (!(displacement > 0.0 && displacement <= LENGTH_MOST))
    return workspace_fail(workspace, CPROX_INVALID, "displacement is %g, must be above 0 and at most %g", displacement,
                          LENGTH_MOST);
  sweep s = {.motion = motion,
             .geometry = geometry,
             .most = displacement,
             .poses = poses,
             .room = room,
             .workspace = workspace};
  const size_t rows = MOTION_ROWS * motion->row_size * sizeof *s.rows;
  char *memory = workspace_reserve(workspace, WORKSPACE_SWEEP, motion->robot->n_axes * sizeof *s.axes + rows + 64);
  if (!memory) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a motion's intervals");
  s.rows = (double *)(void *)memory;
  s.axes = (axis_state *)(void *)(memory + rows);
  for (size_t i = 0; i < motion->n_segments; i++) {
    if (cut(&s, i, 0.0, 1.0)) continue;
    if (workspace_has_stopped(workspace)) return workspace_fail(workspace, CPROX_INVALID, "stopped");
    return workspace_fail(workspace, CPROX_PRECISION, "no interval moves geometry %d by less than %g m", (int)geometry,
                          displacement);
  }
  *n = s.n;
  return CPROX_OK;
}
