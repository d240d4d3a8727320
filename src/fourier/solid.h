/* SPDX-License-Identifier: BSD-3-Clause */
/* A solid: pieces, and what its constructors share. */
#ifndef CPROX_FOURIER_SOLID_H
#define CPROX_FOURIER_SOLID_H

#include "curve_proximity/cprox_fourier.h"
#include "fourier/error.h"
#include "fourier/piece.h"

struct cprox_solid {
  cprox_solid_kind kind;
  int dimension;
  size_t n;
  piece *pieces;
  vec3 centre; /* of a ball that contains the solid */
  double radius;
};

/* Lengths a solid may have. */
#define SOLID_LEAST 1e-100
#define SOLID_LARGEST 1e100

/* Makes one kind of solid from its description; checked: the dimension, where the kind reads it,
 * and the pointers. */
typedef cprox_status solid_constructor(const cprox_solid_description *d, cprox_workspace *workspace,
                                       cprox_solid **solid);
solid_constructor solid_create_ball, solid_create_box, solid_create_ellipsoid, solid_create_cylinder,
    solid_create_capsule, solid_create_polygon, solid_create_mesh, solid_create_polyline, solid_create_sweep,
    solid_create_grid, solid_create_union, solid_create_clipped, solid_create_sublevel;

/* The checks that constructors share; CPROX_OK or the failure with its error message. */
cprox_status solid_check_length(const char *name, double value, cprox_workspace *workspace);
cprox_status solid_check_points(const char *name, const vec3 *points, size_t n, int dimension,
                                cprox_workspace *workspace);
cprox_status solid_out_of_memory(cprox_workspace *workspace);

/* The grid of a description, without its cells. */
cprox_status solid_check_grid(const cprox_solid_description *d, cprox_workspace *workspace);

/* A solid with room for n empty pieces, or NULL. */
cprox_solid *solid_allocate(int dimension, size_t n);

/* Sets the bounding sphere once the pieces are there. */
void solid_bound(cprox_solid *solid);

/* One piece as a solid: takes the piece over, also on failure (memory out). */
cprox_status solid_of_piece(int dimension, piece *p, cprox_workspace *workspace, cprox_solid **solid);

/* A copy whose function is at least 1 within rho of the solid, shifted by minus its centre; no clipping left. *reach:
 * how far it goes beyond the solid at most. NULL where memory is out. */
cprox_solid *solid_offset(const cprox_solid *solid, double rho, double *reach);

/* Sum of the pieces' spectra. */
void solid_spectrum(const cprox_solid *solid, vec3 q, bool gradient, wave_jet *jet);

/* Sum of the pieces' error scales at |q|. */
double solid_error_scale(const cprox_solid *solid, double q);

/* Upper bounds of a solid's function: the integral of its square, and its largest value; infinite where unknown. */
typedef struct solid_bounds {
  double energy, peak;
} solid_bounds;

/* false where memory is out. */
bool solid_find_bounds(const cprox_solid *solid, solid_bounds *bounds);

#endif
