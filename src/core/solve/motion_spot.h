/* SPDX-License-Identifier: BSD-3-Clause */
/* One pair of a robot's parts and what it is held against, at single times of a motion: how far apart, how that changes
 * with every variable, where along the motion it is least, and whether the nearest points are the only ones. */
#ifndef CPROX_SOLVE_MOTION_SPOT_H
#define CPROX_SOLVE_MOTION_SPOT_H

#include "kinematics/jacobian.h"
#include "robot_query/placed_robot_pair.h"

typedef struct motion_spot {
  size_t segment; /* at u of this segment */
  double u;
  robot_gap gap;
  double slope; /* [m/s] of the distance along the motion, on that segment */
} motion_spot;

typedef struct spot_pair {
  robot_scene *scene;
  robot_pair pair;                      /* whole parts */
  int32_t index;                        /* that pair in the scene, */
  placed_robot_pair placed;             /* where it was measured last */
  int32_t element[2];                   /* the elements that were nearest last; -1: none */
  uint32_t gaps;                        /* distances measured */
  double *values, *rates, *by_variable; /* of all variables, at the spot measured last */
  double *sum;                          /* room for as many */
  placement *frames;
} spot_pair;

/* The pair of parts that this pair of the scene belongs to. False where memory is out. */
bool spot_begin(robot_scene *scene, int32_t index, spot_pair *p);

/* Measures at u of a segment. CPROX_OK, or a negative status. */
cprox_status spot_measure(spot_pair *p, size_t segment, double u, motion_spot *spot);

/* by_variable and rates again at a spot that was measured before others. */
void spot_differentiate(spot_pair *p, const motion_spot *spot);

static inline double spot_distance(const motion_spot *spot) {
  return 0.5 * (spot->gap.lower + spot->gap.upper);
}

double spot_time(const spot_pair *p, const motion_spot *spot);

/* Moves a spot to the local minimum near it within the interval. *found: there is one. */
cprox_status spot_refine(spot_pair *p, const motion_interval *within, motion_spot *spot, bool *found);

/* Two shortest ways out where the motion passes from one to the other. The derivative at the spot is a sum of those at
 * three places before it and three behind it, with these factors. *found: that is so, and either way is the only one
 * where it is clear of the other. */
enum { SPOT_SIDES = 6 };
cprox_status spot_find_crossing(spot_pair *p, const motion_interval *within, const motion_spot *spot, double apart,
                                motion_spot side[SPOT_SIDES], double part[SPOT_SIDES], bool *found);

/* *alone: at the spot the pair has one pair of nearest points only; elements that are nearest within `apart` count. */
cprox_status spot_is_alone(spot_pair *p, const motion_spot *spot, double apart, bool *alone);

#endif
