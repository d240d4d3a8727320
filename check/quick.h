/* SPDX-License-Identifier: BSD-3-Clause */
/* Directions in doubles with radii: most of them need no more. */
#ifndef CHECK_QUICK_H
#define CHECK_QUICK_H

#include "pieces.h"

struct vec;

/* A part of the mover's pieces; a set, or the part [theirs] of the pieces of a set that is a curve. */
typedef struct quick_query {
  const set *set;
  pieces *mover, *obstacle; /* obstacle: NULL for a set that is no curve */
  double from, to, theirs[2];
  double normal[3];
  double balls[3]; /* delta, radius, margin */
} quick_query;

/* True: the direction separates, as separates() of check.c means it. False: nothing is known. */
bool quick_separates(const quick_query *q);

/* The point of the curve at s of piece i, 0 <= s < 1; false where memory is out. */
bool quick_point(pieces *p, size_t i, double s, struct vec *point);

/* A world point in the set's own frame; of ball.h. */
struct vec quick_to_frame(const set *s, const struct vec *p);

/* For tests, which compare both ways: false, and from now on nothing is known in doubles. */
void quick_use(bool on);

#endif
