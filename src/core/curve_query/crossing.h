/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve that passes through a body without an inside: no point of it need be a double. Its two sides prove it.
 * doc/curve-bound.md. */
#ifndef CPROX_CURVE_QUERY_CROSSING_H
#define CPROX_CURVE_QUERY_CROSSING_H

#include "curve_query/curve_convex.h"

/* A curve, and the flat shape in its frame. */
typedef struct crossing {
  curve_side *side;
  const convex *shape;
  const flat_shape *flat;
} crossing;

/* Near s of a piece. When a crossing is proven: where they meet but for rounding, and by where they certainly have met.
 */
typedef struct crossing_place {
  size_t piece;
  double s;
  vec3 meeting;
  size_t until_piece;
  double until;
} crossing_place;

/* Whether the curve certainly passes through the shape near a place, which then moves; the piece is the loaded one.
 * Where it does not, s is where it meets the plane, as far as Newton's method finds that. */
bool crossing_prove(const crossing *of, crossing_place *place);

/* The same near a sample, which becomes that of the place. False also of shapes that have an inside. */
bool crossing_prove_convex(curve_convex *o, curve_sample *sample, crossing_place *place);

#endif
