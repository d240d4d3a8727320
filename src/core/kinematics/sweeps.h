/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the parts of a joined motion are, whenever: what is far apart all the time need not be searched.
 * doc/robot-bounds.md, Several robots on one clock */
#ifndef CPROX_KINEMATICS_SWEEPS_H
#define CPROX_KINEMATICS_SWEEPS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"

struct cprox_motion;

/* No point of the part is ever farther than the radius from the box. */
typedef struct part_sweep {
  vec3 low, high;
  double radius;
} part_sweep;

/* All parts of a finished motion; false where memory is out. */
bool motion_sweeps_make(struct cprox_motion *motion);

/* Two parts are never nearer than this. */
double part_sweeps_apart(const part_sweep *a, const part_sweep *b);

#endif
