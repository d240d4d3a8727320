/* SPDX-License-Identifier: BSD-3-Clause */
/* What the makers of motions share: memory, and what follows from the coefficients. */
#ifndef CPROX_KINEMATICS_MOTION_BUILD_H
#define CPROX_KINEMATICS_MOTION_BUILD_H

#include "kinematics/motion.h"

/* What a motion is made of. */
typedef struct motion_source {
  const cprox_robot *robot;
  const int32_t *variables;
  size_t n;
  const double *rest;
  const cprox_motion_description *description;
  cprox_workspace *workspace;
} motion_source;

/* A motion of so many tracks, all empty, and no times; NULL where memory is out. */
cprox_motion *motion_allocate(const motion_source *source, size_t n_tracks);

/* Room for a track of so many segments and variables, all 0, and for the arcs of so many joints. */
bool motion_allocate_track(motion_track *track, size_t n_segments, size_t n_variables, size_t degree);
bool motion_allocate_track_arcs(motion_track *track, size_t n_arcs);

/* All that follows from times, degrees, coefficients and their errors. Frees the motion on failure. Of one track the
 * variables that move are found; of several they are known. */
cprox_status motion_finish(cprox_motion *m, const motion_source *source, cprox_motion **motion);

/* What cutting and evaluating adds to the error of coefficients of this size; doc/robot-motion-bounds.md. */
double motion_cutting_error(size_t degree, double largest);

/* Room for which joints turn by arcs; false where memory is out. */
bool motion_allocate_arcs(cprox_motion *m);

/* Floating joints between waypoints that turn by slerp or by screws: arcs, straight lines in the place of their
 * polynomials, and the errors of both. */
cprox_status motion_turn_by_arcs(const motion_source *source, cprox_motion *m);

/* Whether a variable belongs to a joint that turns by arcs and moves. */
bool motion_moves_by_arc(const cprox_motion *m, int32_t variable);

/* The kind CPROX_MOTION_JOINED. */
cprox_status motion_create_joined(const motion_source *source, cprox_motion **motion);

#endif
