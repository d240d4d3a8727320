/* SPDX-License-Identifier: BSD-3-Clause */
/* What a batch knows of its targets. */
#ifndef CPROX_QUERY_BATCH_TARGETS_H
#define CPROX_QUERY_BATCH_TARGETS_H

#include "curve_proximity/cprox/batch.h"
#include "query/batch_lanes.h"
#include "query/candidates.h"

/* A ball inside a target, in the world, padding left out. */
typedef struct batch_core {
  vec3 centre;   /* where there is no such ball, the centre of the bounding ball */
  double radius; /* rounding of the radius included; 0: the centre is a point of the target; < 0: there is no ball */
  bool flat;     /* a disc in the plane of constant z: it tells of curves in that plane only */
  double extent; /* of the bounding ball, without padding */
} batch_core;

struct cprox_batch {
  cprox_target *targets;
  size_t n;
  bool on_clock; /* some of them are: where they are depends on the mover */
  /* one for each target that is a curve, one for each convex part of a body */
  candidate *parts;
  batch_core *cores;
  lanes_balls balls;
};

#endif
