/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers of a curve by parts, each with a normal that separates it from a set by more than delta: the substance of a
 * certificate. A cover is laid after the answer, at the answer's limit, and not collected from the search: the search
 * settles nodes by tangent balls, bounding spheres and other obstacles' distances, which no checker should have to
 * know, and in an order of its own. */
#ifndef CPROX_CERTIFICATE_PARTITION_H
#define CPROX_CERTIFICATE_PARTITION_H

#include "base/frame.h"
#include "base/workspace.h"
#include "certificate/certificate.h"
#include "certificate/multipliers.h"
#include "problem/carried_shape.h"

/* What is to be proven, and what may help. It refers to itself. */
typedef struct cover {
  const cprox_curve *curve;  /* of the mover; seen from what rides the same parameter */
  const cprox_curve *radius; /* NULL, or with the same pieces what both radii add there */
  reach_set set;             /* the radius of the mover belongs to its offset, and that of elements */
  cprox_pose pose;           /* of the set, composed */
  reach_set carried;         /* body NULL: nothing */
  carried_shape joined;      /* then the set and what is carried as one shape */
  cprox_pose outer;          /* of what rides, turned alone */
  cprox_curve made[2];       /* the two curves, where they were made for this cover */
  double delta;
  double from, until;             /* the part of the curve that is covered: counting parameters */
  double witness, witness_on_set; /* counting parameters where mover and curve obstacles are nearest, -1: not known */
  vec3 normal;                    /* unit, from the set to the mover there; (0,0,0): not known */
  uint32_t budget;                /* parts that may be tried */
  double shortest;                /* parts shorter than this are given up, relative to one piece */
  cprox_workspace *workspace;
  cprox_certificate *certificate;
} cover;

/* The world point of a curve at its counting parameter. */
vec3 partition_point(const cprox_curve *curve, double sigma);

/* Where to cut a part: at the witness where it lies inside, at a joint of pieces, or in the middle. NaN where it is too
 * short. */
double partition_cut(const cover *c, reach_part part, double witness);

/* The shape that the curve keeps away from, and where it stands. */
const convex *partition_shape(const cover *c, frame *placed);

/* Writes the section: CPROX_OK; CPROX_BUDGET or CPROX_PRECISION, where no cover was found; CPROX_MEMORY. */
cprox_status partition_convex(cover *c);
cprox_status partition_curves(cover *c);
cprox_status partition_elements(cover *c);

/* The surface point of the convex body next to a point, drawn in so that rounding does not leave it outside; false
 * where it cannot be. */
bool partition_draw_in(const cprox_body *body, const convex_near *near, double by, vec3 *drawn);

/* Writes how a body's point is found that is near y, a point of the frame about its centre that is within error of the
 * exact one; returns how far y is from it: 0 inside, infinity for none. */
double partition_near_point(const cprox_body *body, cprox_certificate *certificate, vec3 y, double error);

/* The same of the element that is nearest to y, which is seen about the origin of the body's tree; of the inside of a
 * closed mesh that y is in it. first: of the order. */
double partition_near_element(const cprox_body *body, const uint32_t *first, cprox_certificate *certificate, vec3 y,
                              double error);

/* Writes the point of a body that is nearest to y, drawn in; both are seen from the body's centre. NaN where there is
 * none. */
vec3 partition_point_of(const cprox_body *body, cprox_certificate *certificate, vec3 y);

/* Writes that at the witness of the answer the distance is at most delta; carrier: where the mover's own curve is, and
 * radius: of the mover alone. */
cprox_status cover_near(const cover *c, uint32_t section, const cprox_result *answer, vec3 carrier, double radius);

#endif
