/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward kinematics. */
#include "kinematics/joint_tree.h"

#include <math.h>

static void multiply(const double *a, const double *b, double *c) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

placement placement_compose(const placement *outer, const placement *inner) {
  placement both = {.p = placement_apply(outer, inner->p)};
  multiply(outer->r, inner->r, both.r);
  return both;
}

/* About one of the frame's own axes only the other two columns change: m' = c m + s n, n' = c n - s m, turned from m to
 * n. */
static void turn_columns(const double *from, int m, int n, double s, double c, double *to) {
  for (int i = 0; i < 9; i += 3) {
    to[i + m] = c * from[i + m] + s * from[i + n];
    to[i + n] = c * from[i + n] - s * from[i + m];
    to[i + 3 - m - n] = from[i + 3 - m - n];
  }
}

/* Rodrigues: cos q + sin q [z] + (1 - cos q) z z^T, all by half the angle; 1 - cos q = 2 sin²(q/2) is small where q is.
 */
static void turn_about(const robot_axis *axis, const double *from, double q, double *to) {
  const vec3 z = axis->z;
  const double sine = sin(0.5 * q), s = 2.0 * sine * cos(0.5 * q), d = 2.0 * sine * sine, c = 1.0 - d;
  switch (axis->along) {
    case 0: turn_columns(from, 1, 2, z.x * s, c, to); return;
    case 1: turn_columns(from, 2, 0, z.y * s, c, to); return;
    case 2: turn_columns(from, 0, 1, z.z * s, c, to); return;
    default: break;
  }
  const double xy = d * z.x * z.y, xz = d * z.x * z.z, yz = d * z.y * z.z;
  const double r[9] = {c + d * z.x * z.x, xy - s * z.z, xz + s * z.y, xy + s * z.z,     c + d * z.y * z.y,
                       yz - s * z.x,      xz - s * z.y, yz + s * z.x, c + d * z.z * z.z};
  multiply(from, r, to);
}

void robot_axis_advance(const robot_axis *axis, const placement *before, double value, placement *moved) {
  *moved = *before;
  if (axis->kind == AXIS_PRISMATIC)
    moved->p = vec_axpy(before->p, value, placement_turn(before, axis->z));
  else
    turn_about(axis, before->r, value, moved->r);
}

void rotation_vector_quaternion(const double vector[3], double quaternion[4]) {
  const double angle = sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
  /* sin(x/2)/x by its series is 1/2 within x²/48: less than 1e-17 */
  const double part = angle > 1e-8 ? sin(0.5 * angle) / angle : 0.5;
  for (int k = 0; k < 3; k++) quaternion[k] = part * vector[k];
  quaternion[3] = cos(0.5 * angle);
}

placement robot_axis_move(const robot_axis *axis, const placement *parent, double value, const double *ball) {
  placement moved = axis->at;
  if (axis->kind == AXIS_BALL || axis->kind == AXIS_VECTOR) {
    double of_vector[4];
    if (axis->kind == AXIS_VECTOR) rotation_vector_quaternion(ball, of_vector);
    const double *quaternion = axis->kind == AXIS_VECTOR ? of_vector : ball;
    const cprox_pose pose = {.orientation = {quaternion[3], quaternion[0], quaternion[1], quaternion[2]}};
    const frame f = frame_create(&pose, vec(0, 0, 0));
    multiply(axis->at.r, f.r, moved.r);
  } else {
    robot_axis_advance(axis, &axis->at, value, &moved);
  }
  return parent ? placement_compose(parent, &moved) : moved;
}

void robot_place_axes(const cprox_robot *robot, const double *variables, placement *frames) {
  for (size_t i = 0; i < robot->n_axes; i++) {
    const robot_axis *axis = &robot->axes[i];
    const double *q = variables + axis->variable;
    frames[i] = robot_axis_move(axis, axis->parent < 0 ? NULL : &frames[axis->parent],
                                axis->multiplier * q[0] + axis->offset, q);
  }
}

placement robot_geometry_place(const cprox_robot *robot, int32_t geometry) {
  const cprox_link_geometry *g = &robot->given_geometries[geometry];
  const frame f = frame_create(&g->pose, vec(0, 0, 0));
  placement inner = {.p = g->pose.position};
  for (int i = 0; i < 9; i++) inner.r[i] = f.r[i];
  return placement_compose(&robot->links[g->link].at, &inner);
}

/* By the largest of the four numbers. */
static cprox_quat quaternion_of(const double r[9]) {
  const double w = 1.0 + r[0] + r[4] + r[8], x = 1.0 + r[0] - r[4] - r[8], y = 1.0 - r[0] + r[4] - r[8],
               z = 1.0 - r[0] - r[4] + r[8];
  if (w >= x && w >= y && w >= z) return (cprox_quat){w, r[7] - r[5], r[2] - r[6], r[3] - r[1]};
  if (x >= y && x >= z) return (cprox_quat){r[7] - r[5], x, r[1] + r[3], r[2] + r[6]};
  if (y >= z) return (cprox_quat){r[2] - r[6], r[1] + r[3], y, r[5] + r[7]};
  return (cprox_quat){r[3] - r[1], r[2] + r[6], r[5] + r[7], z};
}

cprox_pose placement_pose(const placement *at) {
  return (cprox_pose){.position = at->p, .orientation = quaternion_of(at->r)};
}

void cprox_robot_link_frame(const cprox_robot *robot, const double *variables, size_t link, cprox_vec3 *position,
                            double rotation[9]) {
  /* up from the link: only the axes that carry it */
  const robot_link *l = &robot->links[link];
  placement at = l->at;
  for (int32_t i = l->axis; i >= 0; i = robot->axes[i].parent) {
    const robot_axis *axis = &robot->axes[i];
    const double *q = variables + axis->variable;
    const placement moved = robot_axis_move(axis, NULL, axis->multiplier * q[0] + axis->offset, q);
    at = placement_compose(&moved, &at);
  }
  *position = at.p;
  for (int i = 0; i < 9; i++) rotation[i] = at.r[i];
}
