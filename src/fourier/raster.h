/* SPDX-License-Identifier: BSD-3-Clause */
/* A solid as cells that cover it: what a gap takes in the place of a solid whose closed form costs too much. */
#ifndef CPROX_FOURIER_RASTER_H
#define CPROX_FOURIER_RASTER_H

#include "fourier/solid.h"

/* Whether the solid can be covered: in space, and no sweep, whose function is no indicator. */
bool raster_is_possible(const cprox_solid *solid);

/* The cover is within the solid's closed form enlarged by this (solid_offset()). */
double raster_growth(const cprox_solid *solid, double cell);

/* One grid of cells of that edge, aligned with the solid's frame, which holds each point of the solid; about the
 * solid's own centre. NULL where memory is out, where there would be too many cells, or where the stop function wants
 * an end. Cost: a test of a cell for each piece (half a space each of a polytope; of a mesh each triangle's own
 * cells). */
cprox_solid *raster_cover(const cprox_solid *solid, double cell, cprox_workspace *workspace);

#endif
