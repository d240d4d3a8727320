/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward kinematics. */
#include "motion/tree.h"

#include <math.h>

vec3 placement_turn(const placement *at, vec3 v) {
  const double *r = at->r;
  return vec(r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
             r[6] * v.x + r[7] * v.y + r[8] * v.z);
}

vec3 placement_turn_back(const placement *at, vec3 v) {
  const double *r = at->r;
  return vec(r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
             r[2] * v.x + r[5] * v.y + r[8] * v.z);
}

vec3 placement_apply(const placement *at, vec3 v) {
  return vec_add(placement_turn(at, v), at->p);
}

static void multiply(const double *a, const double *b, double *c) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

placement placement_compose(const placement *outer, const placement *inner) {
  placement both = {.p = placement_apply(outer, inner->p)};
  multiply(outer->r, inner->r, both.r);
  return both;
}

/* Rodrigues: cos q + sin q [z] + (1 - cos q) z z^T, 1 - cos q as 2 sin²(q/2), which is small where q is. */
static void turn_about(vec3 z, double q, double *r) {
  const double half = sin(0.5 * q), s = sin(q), c = cos(q), d = 2.0 * half * half;
  const double xy = d * z.x * z.y, xz = d * z.x * z.z, yz = d * z.y * z.z;
  r[0] = c + d * z.x * z.x, r[1] = xy - s * z.z, r[2] = xz + s * z.y;
  r[3] = xy + s * z.z, r[4] = c + d * z.y * z.y, r[5] = yz - s * z.x;
  r[6] = xz - s * z.y, r[7] = yz + s * z.x, r[8] = c + d * z.z * z.z;
}

placement axis_move(const robot_axis *axis, const placement *parent, double value, const double *quaternion) {
  placement moved = axis->at, turn = {0};
  switch (axis->kind) {
    case AXIS_PRISMATIC: moved.p = vec_axpy(moved.p, value, placement_turn(&axis->at, axis->z)); break;
    case AXIS_REVOLUTE:
      turn_about(axis->z, value, turn.r);
      multiply(axis->at.r, turn.r, moved.r);
      break;
    case AXIS_BALL: {
      const cprox_pose pose = {.orientation = {quaternion[3], quaternion[0], quaternion[1], quaternion[2]}};
      const frame f = frame_create(&pose, vec(0, 0, 0));
      multiply(axis->at.r, f.r, moved.r);
      break;
    }
  }
  return parent ? placement_compose(parent, &moved) : moved;
}

void robot_place_axes(const cprox_robot *robot, const double *variables, placement *frames) {
  for (size_t i = 0; i < robot->n_axes; i++) {
    const robot_axis *axis = &robot->axes[i];
    const double *q = variables + axis->variable;
    frames[i] =
        axis_move(axis, axis->parent < 0 ? NULL : &frames[axis->parent], axis->multiplier * q[0] + axis->offset, q);
  }
}

int32_t robot_common_axis(const cprox_robot *robot, int32_t a, int32_t b) {
  /* parents come first: the larger number is never above the smaller one */
  while (a != b) {
    if (a > b)
      a = robot->axes[a].parent;
    else
      b = robot->axes[b].parent;
  }
  return a;
}

void cprox_robot_link_frame(const cprox_robot *robot, const double *variables, size_t link, cprox_vec3 *position,
                            double rotation[9]) {
  /* up from the link: only the axes that carry it */
  const robot_link *l = &robot->links[link];
  placement at = l->at;
  for (int32_t i = l->axis; i >= 0; i = robot->axes[i].parent) {
    const robot_axis *axis = &robot->axes[i];
    const double *q = variables + axis->variable;
    const placement moved = axis_move(axis, NULL, axis->multiplier * q[0] + axis->offset, q);
    at = placement_compose(&moved, &at);
  }
  *position = at.p;
  for (int i = 0; i < 9; i++) rotation[i] = at.r[i];
}
