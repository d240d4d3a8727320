/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether two placed bodies are nearest in one pair of points only, and along
 * one normal only: else a distance has no gradient. */
#ifndef CPROX_SOLVE_GRADIENT_TIES_H
#define CPROX_SOLVE_GRADIENT_TIES_H

#include "curve_proximity/cprox/query.h"

typedef struct placed_bodies {
  cprox_obstacle a, b;
  size_t part_a, part_b;
  cprox_lod finest;
  bool depth;  /* overlaps are measured */
  double size; /* [m] of the smaller one */
  cprox_workspace *workspace;
} placed_bodies;

/* *alone: b's nearest point does not jump where b turns a little about it to
 * either side, round any axis across the normal. By doc/curve-bound.md.
 * CPROX_OK or a negative status. */
cprox_status ties_point_is_alone(const placed_bodies *bodies, bool *alone);

/* *alone: the normal does not jump where a moves a little, to any side. */
cprox_status ties_normal_is_alone(const placed_bodies *bodies, bool *alone);

/* What was measured a little to either side, and a hundred times farther: a
 * jump stays as it is, what is smooth shrinks with the step. Differences below
 * `noise` are rounding. */
bool ties_is_jump(double near, double far, double noise);

/* The steps of both: turns [rad], and shifts in sizes. */
extern const double TIES_NEAR, TIES_FAR;

#endif
