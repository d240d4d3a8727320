/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls and hulls that cover a part of a robot, and what of them lies in it. doc/robot-edges.md, Levels */
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

/* A part, or a piece of one, lies within `margin` of the hull of these points of the shape's frame. */
typedef struct cover_hull {
  uint32_t first, n; /* points */
  double margin;
  double inner;               /* so far about each of its points the part reaches; negative: that is not known */
  uint32_t child, n_children; /* hulls that together contain what of the part is in this one; 0: there are none */
} cover_hull;

/* Hulls of a part, at most. */
enum { COVER_MOST_HULLS = 73 };

/* Writes up to COVER_MOST balls whose union contains the part; returns their number, at least 1. Of a sphere or a
 * capsule outer and inner differ by rounding, or little. */
size_t cover_of_part(const part_model *model, cover_ball balls[COVER_MOST]);

/* Whether a ball reaches far beyond what is known to lie in the part. */
static inline bool cover_is_coarse(double outer, double inner) {
  return outer > 1.125 * inner;
}

/* Hulls, and the points that they are of. Both grow. */
typedef struct cover_hulls {
  cover_hull *hull;
  vec3 *point;
  size_t n, n_points, room, room_of_points;
} cover_hulls;

/* Whether hulls tell more about a part than balls do: polyhedra, cylinders and cones, and what lies in a polyhedron. */
bool cover_is_by_hulls(const part_model *model);

/* Adds the hull of a part, then those of its pieces, each set of children side by side. False where memory is out. */
bool cover_by_hulls(const part_model *model, cover_hulls *to);

/* The covers of all parts of a robot: by balls or by hulls. */
typedef struct robot_covers {
  size_t *first; /* n_parts + 1: of each part its first ball */
  cover_ball *balls;
  size_t n_coarse;    /* parts with a cover by balls that is coarse */
  size_t *first_hull; /* n_parts + 1: of each part its first hull, which is of all of it */
  cover_hulls hulls;
  /* robots with the same bytes here have the same axes, links of geometries, parts and covers; hulls stand for
   * themselves by a number that is never used again */
  char *signature;
  size_t n_signature;
} robot_covers;

/* Those of the robot, made when they are first asked for; any number of threads may ask. NULL where memory is out. */
const robot_covers *robot_covers_of(const struct cprox_robot *robot);
void robot_covers_free(robot_covers *covers);

#endif
