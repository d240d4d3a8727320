/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers of a robot's motion by intervals, on each of which planes part the pairs that coarser intervals have left
 * open: the substance of a robot's certificate. Laid after the answer, as those of curves (cover.h). */
#ifndef CPROX_CERTIFICATE_PARTITION_ROBOT_H
#define CPROX_CERTIFICATE_PARTITION_ROBOT_H

#include "certificate/certificate.h"
#include "certificate/element_order.h"
#include "robot_query/placed_robot_pair.h"

/* An obstacle of the scene that is made of elements; order.t NULL: it is not. */
typedef struct robot_cover_elements {
  element_order order;
  const cprox_body *body;
  robot_body standing; /* about the tree's origin, its shape apart */
} robot_cover_elements;

typedef struct robot_cover {
  robot_scene *scene;
  const robot_cover_elements *elements; /* of each obstacle */
  size_t n_items;
  double delta;
  uint32_t budget;    /* intervals that may be tried */
  size_t first, last; /* the segments that are covered first, from `begin` of it on, and last, up to `end` of it */
  double begin, end;
  bool reaches_beyond; /* the interval at hand goes on outside of these, where anything may touch */
  double shortest;     /* intervals shorter than this part of a segment are given up */
  cprox_certificate *certificate;
} robot_cover;

/* The obstacles of a scene as covers take them, in the workspace; NULL where memory is out. Links become their
 * hulls. */
const robot_cover_elements *partition_robot_begin(robot_scene *scene);

/* Writes the trees of all segments: CPROX_OK; CPROX_BUDGET or CPROX_PRECISION, where no cover was found; CPROX_MEMORY.
 */
cprox_status partition_robot(robot_cover *c);

/* Writes that at the witness of the answer the distance is at most delta. */
cprox_status partition_robot_near(const robot_cover *c, const cprox_result *answer);

#endif
