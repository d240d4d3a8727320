/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot as the searches see it: single axes, each a rotation about a line, a shift along a line or a rotation about a
 * point, and convex parts that hang on them. Planar and floating joints are several axes, fixed ones none: their
 * transforms are folded into what follows. doc/robot-motion-bounds.md derives what is computed with them. */
#ifndef CPROX_KINEMATICS_JOINT_TREE_H
#define CPROX_KINEMATICS_JOINT_TREE_H

#include <stdatomic.h>

#include "base/rotation.h"
#include "curve_proximity/cprox/robot.h"
#include "kinematics/link_model.h"
#include "kinematics/part_cover.h"
#include "kinematics/part_groups.h"
#include "shape/body.h"

typedef enum axis_kind {
  AXIS_REVOLUTE,
  AXIS_PRISMATIC,
  AXIS_BALL,  /* by a quaternion */
  AXIS_VECTOR /* a ball by a rotation vector */
} axis_kind;

static inline int32_t axis_variables(axis_kind kind) {
  return kind == AXIS_BALL ? 4 : kind == AXIS_VECTOR ? 3 : 1;
}

typedef struct robot_axis {
  axis_kind kind;
  int32_t parent;            /* axis, or -1 */
  int32_t variable;          /* balls: the first of the quaternion's four or of the vector's three */
  uint32_t depth;            /* so many axes from this one up to the base, both ends counted */
  int32_t order, branch;     /* its place where all under an axis follow it; so many axes its branch has, with it */
  double multiplier, offset; /* the angle or shift is multiplier * variable + offset */
  placement at;              /* in the parent axis's moved frame */
  vec3 z;                    /* unit, in the axis's own frame */
  int8_t along;              /* z is this one of the frame's axes, 0 … 2, or the opposite; -1: none of them */
  bool first_of_joint;       /* of the axes that one joint became */
  uint32_t steps;            /* transforms between here and the world */
  double reach;              /* the sum of their lengths, shifts along prismatic axes not counted */
} robot_axis;

typedef struct robot_link {
  int32_t parent; /* link, or -1 */
  int32_t axis;   /* the last one above, or -1 */
  placement at;   /* in that axis's moved frame */
  uint32_t steps;
  double reach;
} robot_link;

/* A part of a geometry. */
typedef struct robot_part {
  part_model model; /* with the margin in its margins and its radius */
  int32_t geometry, link, axis;
  placement at;   /* of the model's frame, in the axis's moved frame */
  uint32_t steps; /* transforms between the shape and the world */
  double reach;   /* the sum of their lengths and the radius, shifts along prismatic axes not counted */
} robot_part;

struct cprox_robot {
  size_t n_links, n_axes, n_parts, n_geometries, n_variables;
  robot_link *links;
  robot_axis *axes;   /* parents first */
  robot_part *parts;  /* by geometry; the first one of each, and after the last of all their number: */
  size_t *first_part; /* n_geometries + 1 */
  part_groups groups;
  _Atomic(robot_covers *) covers; /* robot_covers_of() */
  cprox_link *given_links;        /* as they were given: what certificates are about */
  cprox_link_geometry *given_geometries;
};

/* The error of one transform of a chain: the rotation's, per unit of length behind it (doc/robot-motion-bounds.md). */
#define ROUND_JOINT 104.0
/* That of a place along the chain, per unit of the whole length. */
#define ROUND_PLACE 7.0

/* outer then inner: x -> outer.r (inner.r x + inner.p) + outer.p. */
placement placement_compose(const placement *outer, const placement *inner);

/* The quaternion x, y, z, w of a rotation vector. */
void rotation_vector_quaternion(const double vector[3], double quaternion[4]);

/* The axis moved to the value, from where it stands at 0: in the same frame as `before`. Not of a ball. */
void robot_axis_advance(const robot_axis *axis, const placement *before, double value, placement *moved);

/* The moved frame of an axis at the value, its parent's being given (NULL: the world). `ball` are the
 * values of a ball. */
placement robot_axis_move(const robot_axis *axis, const placement *parent, double value, const double *ball);

/* The moved frames of all axes, for values of all variables. */
void robot_place_axes(const cprox_robot *robot, const double *variables, placement *frames);

static inline placement placement_under(const placement *frames, int32_t axis, const placement *at) {
  return axis < 0 ? *at : placement_compose(&frames[axis], at);
}

/* Where a geometry stands in the moved frame of the axis that carries it. */
placement robot_geometry_place(const cprox_robot *robot, int32_t geometry);

/* As a pose: its quaternion is rounded once more. */
cprox_pose placement_pose(const placement *at);

/* Is the axis (-1: the world) above the other one, or the same? */
static inline bool robot_axis_carries(const cprox_robot *robot, int32_t axis, int32_t other) {
  if (axis < 0) return true;
  if (other < 0) return false;
  const int32_t behind = robot->axes[other].order - robot->axes[axis].order;
  return behind >= 0 && behind < robot->axes[axis].branch;
}

/* The first link whose joint has one of `count` variables from `first` on; floating joints that begin at the variable
 * `floating` are not asked. n_links: there is none. */
size_t robot_sharing_link(const cprox_link *links, size_t n_links, int32_t floating, int32_t first, int32_t count);

/* The nearest axis that is above both, or -1. */
static inline int32_t robot_common_axis(const cprox_robot *robot, int32_t a, int32_t b) {
  /* parents come first: the larger number is never above the smaller one */
  int32_t axis = a < b ? a : b;
  const int32_t other = a < b ? b : a;
  while (!robot_axis_carries(robot, axis, other)) axis = robot->axes[axis].parent;
  return axis;
}

/* How many joints are between two links, -1 being the world. */
static inline size_t robot_joints_between(const cprox_robot *robot, int32_t link_a, int32_t link_b) {
  const int32_t a = link_a < 0 ? -1 : robot->links[link_a].axis, b = link_b < 0 ? -1 : robot->links[link_b].axis;
  const int32_t common = robot_common_axis(robot, a, b);
  size_t n = 0;
  for (int32_t i = a; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  for (int32_t i = b; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  return n;
}

/* Whether two geometries are asked about each other where no list says so: two joints or more are between them. */
static inline bool robot_is_worth_asking(const cprox_robot *robot, size_t geometry, size_t other) {
  return robot_joints_between(robot, robot->given_geometries[geometry].link, robot->given_geometries[other].link) >= 2;
}

/* The axes from one up to the base; none for -1. */
static inline uint32_t robot_axis_depth(const cprox_robot *robot, int32_t axis) {
  return axis < 0 ? 0 : robot->axes[axis].depth;
}

#endif
