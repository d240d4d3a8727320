/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers of a robot's motion by intervals, on each of which planes part the pairs that coarser intervals have left
 * open: the substance of a robot's certificate. Laid after the answer, as those of curves (cover.h). */
#ifndef CPROX_CERTIFICATE_PARTITION_ROBOT_H
#define CPROX_CERTIFICATE_PARTITION_ROBOT_H

#include "certificate/certificate.h"
#include "robot_query/placed_robot_pair.h"

typedef struct robot_cover {
  robot_scene *scene;
  double delta;
  uint32_t budget; /* intervals that may be tried */
  double shortest; /* intervals shorter than this part of a segment are given up */
  cprox_certificate *certificate;
} robot_cover;

/* Writes the trees of all segments: CPROX_OK; CPROX_BUDGET or CPROX_PRECISION, where no cover was found; CPROX_MEMORY.
 */
cprox_status partition_robot(robot_cover *c);

/* Writes that at the witness of the answer the distance is at most delta. */
cprox_status partition_robot_near(const robot_cover *c, const cprox_result *answer);

#endif
