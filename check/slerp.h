/* SPDX-License-Identifier: BSD-3-Clause */
/* Rotations by slerp between two quaternions. */
#ifndef CHECK_SLERP_H
#define CHECK_SLERP_H

#include "robot.h"

/* From p to q (x, y, z, w, of any norm) the shorter way round; false where that may be either way. */
bool slerp_between(const num p[4], const num q[4], slerp_arc *a);

#endif
