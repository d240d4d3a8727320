/* SPDX-License-Identifier: BSD-3-Clause */
/* The inside of closed meshes. */
#ifndef CHECK_WINDING_H
#define CHECK_WINDING_H

#include "ball.h"
#include "pieces.h"
#include "problem.h"

typedef enum side { OUTSIDE, INSIDE, UNKNOWN_SIDE } side;

/* An edge from its lesser vertex to the greater one; the sign says which way it is run through. */
typedef struct winding_edge {
  const double *end[2];
  int sign;
} winding_edge;

/* Every edge is run through as often one way as the other; vertices with equal coordinates are one. edges: room for as
 * many as there are vertices. */
bool winding_is_closed(const set *s, winding_edge *edges);

/* Where a point is that is seen from the centre of a closed mesh: INSIDE, if the mesh winds round it. What is said
 * holds of every point within the radius. */
side winding_side(const set *s, const vec *y);

/* Whether the part of a curve, and each of the pieces in it, begins outside. */
bool winding_pieces_begin_outside(const set *s, pieces *p, double from, double until);

/* A ball about a point in intervals. */
vec winding_ball_of(const iv x[3]);

#endif
