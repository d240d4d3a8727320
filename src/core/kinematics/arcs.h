/* SPDX-License-Identifier: BSD-3-Clause */
/* Poses of a floating joint between two waypoints that no polynomial gives: slerp, and screws (turns about a line at a
 * constant rate, with a shift along it). doc/robot-poses.md, Poses */
#ifndef CPROX_KINEMATICS_ARCS_H
#define CPROX_KINEMATICS_ARCS_H

#include <stdbool.h>

#include "base/vec.h"

/* Over a segment of a motion; s goes from 0 at the first waypoint to 1 at the second one. Directions and places are
 * those of the joint's frame. */
typedef struct motion_arc {
  double from, to; /* the s at the segment's ends */
  double q[4];     /* x, y, z, w of a unit quaternion: the orientation at s = 0 */
  vec3 z;          /* unit; it turns about it, */
  double angle;    /* by this much, 0 … pi, from s = 0 to 1 */
  bool screw;      /* the position is given, too: */
  vec3 p;          /* at s = 0; */
  vec3 along;      /* the way from s = 0 to 1 along z, */
  vec3 across, up; /* that across it, and z cross that */
} motion_arc;

/* Quaternions of norm 1 with q0·q1 >= 0 (a turn of pi at most). */
motion_arc arc_between(const double q0[4], const double q1[4]);

/* The same with positions. */
motion_arc arc_screw(const double q0[4], const double q1[4], vec3 p0, vec3 p1);

/* The orientation, and of a screw the position and two derivatives by s. */
void arc_orientation(const motion_arc *arc, double s, double q[4]);
void arc_position(const motion_arc *arc, double s, vec3 p[3]);

/* Bounds on the first derivative of a screw's position by s; the n-th is at most angle^(n-1) times that of the part
 * across, which is the second number. */
double arc_speed(const motion_arc *arc, double *across);

/* How far quaternion and position are from the straight line between both waypoints, at the same s. */
double arc_sagitta(const motion_arc *arc, double *position);

/* Does anything move? */
bool arc_moves(const motion_arc *arc);

#endif
