/* SPDX-License-Identifier: BSD-3-Clause */
/* How free a pose among obstacles is, with its gradient, by the measures that lead an optimiser in planning.c. */
#ifndef CPROX_BENCH_FOURIER_FREEDOM_H
#define CPROX_BENCH_FOURIER_FREEDOM_H

#include "curve_proximity/cprox.h"
#include "curve_proximity/cprox_fourier.h"
#include "peers/cone_growth.h"

enum { PARTS = 6 };

/* A solid of boxes, or one ball. */
typedef struct thing {
  int n;
  cprox_body *part[PARTS], *rounded[PARTS];
  cone_body cone[PARTS];
  cprox_pose at[PARTS];
  cprox_solid *solid;
} thing;

/* How free a pose is, and its gradient: by the position in the world, by the rotation in the body's axes. */
typedef struct freedom {
  double value;
  cprox_vec3 position, rotation;
} freedom;

/* COARSE to FINE are certified gaps: 17, 33, 65 samples in the plane, 9, 17, 33 in space; the signal has 9. */
typedef enum measure {
  NONE,
  DISTANCE,
  SUPERQUADRIC,
  GROWTH,
  CONES,    /* the growth distance by a cone program */
  TILTED,   /* the mean of growth distances of TILTS turned poses */
  JITTERED, /* the mean of signed distances of JITTERS random poses beside: randomised smoothing */
  COARSE,
  MIDDLE,
  FINE,
  SIGNAL,
  GUIDE
} measure;
enum { CERTIFIED = 3, GAPS = CERTIFIED + 1 };

typedef struct problem {
  int dimension;
  bool path;
  thing fixed, moving;
  double goal[6]; /* of a path: both ends */
  cprox_gap *gap[GAPS];
  cprox_gap_info info[GAPS];
  cprox_workspace *ws;
  measure by;
  double weight; /* of a penalty; 0: none */
} problem;

/* By the measure of the problem. */
freedom freedom_of(problem *p, const cprox_pose *pose);

/* The least of all pairs of parts, by one of NONE to CONES. */
freedom freedom_by_pairs(problem *p, measure by, const cprox_pose *pose);

/* The rotation of a rotation vector; and by that vector, of a gradient by a turn in the axes of the body that it has
 * turned. */
cprox_quat rotation_exponential(cprox_vec3 r);
cprox_vec3 rotation_by_vector(cprox_vec3 r, cprox_vec3 g);

#endif
