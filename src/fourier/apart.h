/* SPDX-License-Identifier: BSD-3-Clause */
/* Bounds of a solid per direction: the support values of its parts' convex hulls on a lattice of directions. They tell
 * pairs apart that no sum need be computed for (doc/fourier.md, "Bounds per direction"). */
#ifndef CPROX_FOURIER_APART_H
#define CPROX_FOURIER_APART_H

#include "fourier/solid.h"

/* The directions are the integer points v with |v.x| + |v.y| + |v.z| = CELLS: 66 in space, 16 in the plane. A table has
 * room for all integer points of that cube. */
enum {
  ENCLOSURE_CELLS = 4,
  ENCLOSURE_SIDE = 2 * ENCLOSURE_CELLS + 1,
  ENCLOSURE_TABLE = ENCLOSURE_SIDE * ENCLOSURE_SIDE * ENCLOSURE_SIDE
};

/* Immutable once made. */
typedef struct enclosures {
  size_t n;       /* parts; 0: nothing is known */
  double *height; /* a table a part, about the solid's centre */
} enclosures;

/* merged: of the whole solid as one part, else of each piece. False where memory is out. */
bool enclosures_make(const cprox_solid *solid, bool merged, enclosures *out);
void enclosures_free(enclosures *e);

/* So many pairs of parts are looked at; solids with more are merged. */
enum { ENCLOSURES_MOST_PAIRS = 16 };

/* The distance of both solids is at least this; 0 where a pair of parts has no direction that separates them. turn: of
 * the second's axes to the first's, x: from centre to centre, in the first's frame. size: of both solids, for rounding.
 */
double enclosures_apart(const enclosures *first, const enclosures *second, int dimension, const double turn[9], vec3 x,
                        double size);

#endif
