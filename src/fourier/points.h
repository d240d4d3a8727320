/* SPDX-License-Identifier: BSD-3-Clause */
/* A growing list of points: corners of loops and soups under construction. */
#ifndef CPROX_FOURIER_POINTS_H
#define CPROX_FOURIER_POINTS_H

#include <stdlib.h>

#include "base/vec.h"

typedef struct points {
  vec3 *at;
  size_t n, room;
  bool failed; /* memory is out: later additions are dropped */
} points;

static inline void points_add(points *list, vec3 p) {
  if (list->n == list->room && !list->failed) {
    const size_t room = list->room ? 2 * list->room : 64;
    vec3 *at = realloc(list->at, room * sizeof *at);
    if (at)
      list->at = at, list->room = room;
    else
      list->failed = true;
  }
  if (!list->failed) list->at[list->n++] = p;
}

static inline void points_add_triangle(points *list, vec3 a, vec3 b, vec3 c) {
  points_add(list, a);
  points_add(list, b);
  points_add(list, c);
}

/* Keeps the part of a closed loop, or of a closed triangle soup, where plane·(x, -1) <= 0. Winding numbers inside the
 * half-space stay, those outside become 0: edges and faces along the plane close what was cut. */
void clip_loop(points *loop, const double plane[4]);
void clip_soup(points *soup, const double plane[4]);

/* Adds the faces of the polytope of all x with plane·(x, -1) <= grow, which lies within `size` of `middle`; normals of
 * unit length. Returns false where memory is out or the polytope is larger. */
bool polytope_soup(const double (*plane)[4], size_t n, double grow, vec3 middle, double size, points *soup);

/* Adds the boundary of a function that is at least 1 within rho of a closed mesh and is its indicator on it. *reach
 * grows to how far it goes beyond the mesh. Returns whether the function may exceed 1. */
struct piece;
bool offset_mesh(const struct piece *mesh, double rho, points *soup, double *reach);

#endif
