/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls that cover a part of a robot, and balls that lie in it. doc/robot-edges.md, Levels */
#ifndef CPROX_KINEMATICS_PART_COVER_H
#define CPROX_KINEMATICS_PART_COVER_H

#include "kinematics/link_model.h"

struct cprox_robot;

typedef struct cover_ball {
  vec3 centre;  /* in the shape's frame */
  double outer; /* its radius */
  double inner; /* a ball about the same centre with this radius lies in the part; negative: none is known */
} cover_ball;

enum { COVER_MOST = 64 };

/* Writes up to COVER_MOST balls whose union contains the part; returns their number, at least 1. Of a sphere or a
 * capsule outer and inner differ by rounding, or little. */
size_t cover_of_part(const part_model *model, cover_ball balls[COVER_MOST]);

/* Whether a ball reaches far beyond what is known to lie in the part. */
static inline bool cover_is_coarse(double outer, double inner) {
  return outer > 1.125 * inner;
}

/* The covers of all parts of a robot. */
typedef struct robot_covers {
  size_t *first; /* n_parts + 1: of each part its first ball */
  cover_ball *balls;
  size_t n_coarse; /* parts with a cover that is coarse */
  char *signature; /* robots with the same bytes here have the same axes, links of geometries, parts and covers */
  size_t n_signature;
} robot_covers;

/* Those of the robot, made when they are first asked for; any number of threads may ask. NULL where memory is out. */
const robot_covers *robot_covers_of(const struct cprox_robot *robot);
void robot_covers_free(robot_covers *covers);

#endif
