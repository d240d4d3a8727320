/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the parts of a joined motion are, whenever or over a while: what is far apart need not be searched.
 * doc/robot-clocks.md, Several robots on one clock */
#ifndef CPROX_KINEMATICS_SWEEPS_H
#define CPROX_KINEMATICS_SWEEPS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"

struct cprox_motion;

/* A box, and in it the origin of a part. */
typedef struct sweep_box {
  vec3 low, high;
} sweep_box;

enum { SWEEP_SHIFTS = 3 };

/* No point of the part is ever farther than the radius from the box. So many axes of one track shift it along lines of
 * the world, from where it is with all of them at 0. */
typedef struct part_sweep {
  sweep_box box;
  double radius;
  vec3 origin;
  vec3 along[SWEEP_SHIFTS];
  size_t axes[SWEEP_SHIFTS], n_shifts; /* 0 also where there are more of them, or several tracks */
} part_sweep;

/* All parts of a finished motion; false where memory is out. */
bool motion_sweeps_make(struct cprox_motion *motion);

/* The box over segments first … last - 1 of the track that shifts it: that of the whole where none does. */
sweep_box motion_sweep_over(const struct cprox_motion *motion, const part_sweep *sweep, size_t first, size_t last);

/* Two parts are never nearer than this. */
double part_sweeps_apart(const part_sweep *a, const part_sweep *b);

/* Nor than this while they are in these boxes. */
double sweep_boxes_apart(const sweep_box *a, const sweep_box *b, double radii);

#endif
