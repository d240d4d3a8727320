/* SPDX-License-Identifier: BSD-3-Clause */
/* A hierarchy over the parts of a robot, made once: groups of parts that are neighbours in the tree of its joints, and
 * of one link neighbours in space. */
#ifndef CPROX_KINEMATICS_PART_GROUPS_H
#define CPROX_KINEMATICS_PART_GROUPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox/robot.h"

typedef struct part_group {
  int32_t first, last; /* its parts stand at these places of the order, at `last` no more */
  int32_t half;        /* it consists of the groups `half` and `half + 1`; -1: it is one part */
  int32_t axis;        /* the last one that carries all of its parts; -1: none does */
} part_group;

/* No group is inside more than so many others. */
enum { PART_GROUPS_DEEPEST = 96 };

typedef struct part_groups {
  size_t n;       /* 0: the robot has no parts */
  part_group *at; /* that of all parts first; halves come later than what they are halves of */
  int32_t *part;  /* at each place of the order */
  int32_t *alone; /* of each part the group that it is alone */
} part_groups;

/* The robot has its axes and parts. False where memory is out. */
bool part_groups_create(const cprox_robot *robot, part_groups *groups);
void part_groups_free(part_groups *groups);

#endif
