/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls that cover a part of a robot, and balls that lie in it. doc/robot-edges.md, Levels */
#ifndef CPROX_EDGES_COVER_H
#define CPROX_EDGES_COVER_H

#include "kinematics/link_model.h"

typedef struct cover_ball {
  vec3 centre;  /* in the shape's frame */
  double outer; /* its radius */
  double inner; /* a ball about the same centre with this radius lies in the part; negative: none is known */
} cover_ball;

enum { COVER_MOST = 64 };

/* Writes up to COVER_MOST balls whose union contains the part; returns their number, at least 1. Of a sphere or a
 * capsule outer and inner differ by rounding, or little. */
size_t cover_of_part(const part_model *model, cover_ball balls[COVER_MOST]);

#endif
