/* SPDX-License-Identifier: BSD-3-Clause */
/* A piece of a solid: one closed-form spectrum. A solid's function is the sum of its pieces' functions. */
#ifndef CPROX_FOURIER_PIECE_H
#define CPROX_FOURIER_PIECE_H

#include <stdbool.h>

#include "base/frame.h"
#include "base/rotation.h"
#include "fourier/wave.h"

/* In the order of what turning one costs. */
typedef enum piece_kind {
  PIECE_ELLIPSOID, /* size: semi-axes */
  PIECE_BOX,       /* size: half edges */
  PIECE_POLYGON,   /* corners: a closed loop; the function is its winding number */
  PIECE_CYLINDER,  /* size: radius, half height; along its own z */
  PIECE_CAPSULE,   /* size: radius, half height; along its own x in the plane, z in space */
  PIECE_SWEEP,     /* size: radius; corners: two a segment */
  PIECE_SOUP,      /* corners: three a triangle, a closed surface; the function is its winding number */
  PIECE_GRID       /* size: edge of a cell; counts, cells; the lowest corner at `centre` */
} piece_kind;

typedef struct piece {
  piece_kind kind;
  double size[3];
  double turn[9]; /* its own axes to the solid's, row-major (not for corners, which are in the solid's frame) */
  vec3 centre;
  vec3 *corner;
  size_t n_corners;

  /* What an offset is made from: the polygon's loop or the mesh before clipping, and the clipping half-spaces. A soup
   * without triangles is a convex polytope: the half-spaces alone, within the box of `size` at `centre`. */
  vec3 *vertex;
  size_t n_vertices;
  uint32_t (*triangle)[3];
  size_t n_triangles;
  double (*plane)[4]; /* a·x <= d, |a| = 1 */
  size_t n_planes;

  uint32_t counts[3];
  unsigned char *cells;

  bool folded; /* a soup whose winding number may exceed 1 */
} piece;

/* A piece of the kind with its own frame at the origin and no memory. */
piece piece_create(piece_kind kind);
void piece_free(piece *p);

/* A copy moved by a rotation matrix and a shift; false where memory is out. */
bool piece_copy(const piece *p, const double turn[9], vec3 shift, piece *copy);

/* Integral of the function. */
double piece_measure(const piece *p, int dimension);

/* How much of it a shift by a unit length uncovers at most: the largest projection of a convex piece, half the boundary
 * of another. */
double piece_slope(const piece *p, int dimension);

/* Every point of the piece is within the answer of the point. */
double piece_radius_about(const piece *p, int dimension, vec3 point);

/* At least the largest v·x over the piece; of a grid that of its box, of what is not convex that of its hull. */
double piece_height(const piece *p, int dimension, vec3 v);

/* An axis-aligned box that holds it. */
void piece_box(const piece *p, int dimension, vec3 *low, vec3 *high);

/* The spectrum at q; gradient too where asked. */
void piece_spectrum(const piece *p, int dimension, vec3 q, bool gradient, wave_jet *jet);

/* For each q the computed value is within a few (N + 10) u times this of the exact one: the measure, or the boundary's
 * measure over |q| where the formula sums over the boundary. */
double piece_error_scale(const piece *p, int dimension, double q);

/* A piece without clipping whose function is at least 1 on every point within rho of p: corners and sizes only. *reach
 * grows to how far beyond p it goes at most. False where memory is out. */
bool piece_offset(const piece *p, int dimension, double rho, piece *out, double *reach);

static inline bool piece_is_polytope(const piece *p) {
  return p->kind == PIECE_SOUP && !p->triangle;
}

/* The faces of a polytope whose half-spaces have moved out by `grow`; false where memory is out. */
struct points;
bool piece_polytope_faces(const piece *p, double grow, struct points *out);

static inline double ball_measure(int dimension, double r) {
  return dimension == 2 ? 3.14159265358979323846 * r * r : 4.18879020478639098462 * r * r * r;
}

#endif
