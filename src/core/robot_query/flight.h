/* SPDX-License-Identifier: BSD-3-Clause */
/* A pair of convex bodies that ride pose splines, or one that does and what stands, over an interval of one segment:
 * bounds by control poses. doc/robot-poses.md, Control poses. */
#ifndef CPROX_ROBOT_QUERY_FLIGHT_H
#define CPROX_ROBOT_QUERY_FLIGHT_H

#include "kinematics/pose_fit.h"
#include "robot_query/pair_distance.h"

/* The interval's own parameter x goes from 0 at u = a of the segment to 1 at u = b. */
typedef struct flight {
  const cprox_motion *motion;
  size_t segment;
  double a, b;
  const pose_basis *basis;
  pose_chain chain[2]; /* of the moving side, and of the standing one if it rides, too */
  pose_fit fit[2];
  bool rides; /* the standing side does */
  robot_body body[2];
  vec3 origin;   /* heights are above it */
  double sizes;  /* of both cores */
  double margin; /* of both sides */
  double error;  /* of every bound, by remainders and places */
} flight;

/* Of the moving body and the standing one, over an interval of one segment. rides: both are parts of the robot.
 * False where a part does not ride so, where bounds would be off by more than `tolerance`, or memory is out: *f is
 * then not to be used. */
bool flight_begin(flight *f, const cprox_motion *motion, const robot_body *const body[2], bool rides,
                  const motion_interval *over, double tolerance, cprox_workspace *workspace);

/* Places both bodies as they are at x. */
void flight_place(flight *f, double x);

/* A direction from the standing side to the moving one that turns: at x it is n + (x - at) rate; n is unit within 4 u,
 * the rate orthogonal to it within 8 u. What follows from it is kept from interval to interval. */
typedef struct flight_plane {
  vec3 n, rate;
  double at;
  pose_rows rows[2], rates[2];
} flight_plane;

/* One that stands, and lets it turn. */
void flight_plane_make(const flight *f, vec3 n, double at, flight_plane *plane);
void flight_plane_turn(const flight *f, vec3 rate, flight_plane *plane);

/* What a plane says of an interval of x. */
typedef struct flight_bound {
  double lower;  /* of the distance; rounding included */
  double slack;  /* that rounding */
  double lowest; /* about where the bound is least, in [0, 1] of the interval */
  double clear;  /* from the interval's beginning to here, in [0, 1] of it, the distance is at least `level` */
} flight_bound;

/* turning: by the turning plane, else by the one that stands. Where the bound exceeds `goal`, it need not be the best.
 */
void flight_bound_over(const flight *f, const flight_plane *plane, bool turning, double from, double to, double goal,
                       double level, flight_bound *bound);

#endif
