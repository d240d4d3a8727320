/* SPDX-License-Identifier: BSD-3-Clause */
/* Does a direction separate a part of a curve from a set by more than delta? Decided in double-double arithmetic, far
 * more finely than the search's bounds, so that what holds here holds for the checker: the answer is yes only where the
 * margin is 2^-90 of the sizes that entered, and the rounding of all that follows is below 2^-95 of them
 * (doc/certificates.md). */
#ifndef CPROX_CERTIFICATE_REACH_H
#define CPROX_CERTIFICATE_REACH_H

#include "base/double_double.h"
#include "certificate/element_order.h"
#include "curve/curve.h"
#include "implicit/implicit.h"
#include "shape/body.h"

/* A direction that turns without rounding to a double. */
typedef struct reach_direction {
  dd k[3];
} reach_direction;

/* A body or a curve where it stands: the poses from the outermost to the innermost, and the ball added to it. */
typedef struct reach_set {
  const cprox_body *body;   /* convex or of elements, or NULL */
  const cprox_curve *curve; /* or NULL */
  const cprox_pose *pose[2];
  int poses;
  double offset;
  const struct reach_set *carried; /* by what moves, NULL: nothing; the set grows by its opposite */
} reach_set;

/* How far something reaches along a direction, and the size of what entered. */
typedef struct reach_value {
  dd value;
  double size;
} reach_value;

/* A part of a curve: from `from` to `to` in its counting parameter sigma, piece + s, 0 <= from < to <= number of
 * pieces. */
typedef struct reach_part {
  double from, to;
} reach_part;

/* The direction of a world vector. */
reach_direction reach_along(vec3 n);

/* The direction of the only normal that a halfspace has, in the world. */
reach_direction reach_of_halfspace(const reach_set *set);

/* Of a body by inequalities: the direction that multipliers make becomes *n, in the world, and what they prove of how
 * far the body reaches along it is returned. */
reach_value reach_of_multipliers(const reach_set *set, const implicit_dual *dual, reach_direction *n);

/* max n·x over the body, its offset included. */
reach_value reach_of_body(const reach_set *set, const reach_direction *n);

/* The same of a range of the body's elements, their own margin apart; rounded up. */
reach_value reach_of_elements(const reach_set *set, const reach_direction *n, const element_order *order,
                              const element_range *range);

/* max n·x over a part of the posed curve, its offset included. */
reach_value reach_of_curve(const reach_set *set, const reach_direction *n, reach_part part);

/* min n·psi over the part less `reach` is more than delta |n|; radius: NULL, or a curve with the same pieces and of the
 * same degree, whose x takes from the height. */
bool reach_separates(const cprox_curve *curve, const cprox_curve *radius, reach_part part, const reach_direction *n,
                     const reach_value *reach, double delta);

#endif
