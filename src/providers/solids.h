/* SPDX-License-Identifier: BSD-3-Clause */
/** From shapes to the solids of cprox_fourier.h. */
#ifndef CURVE_PROXIMITY_PROVIDERS_SOLIDS_H
#define CURVE_PROXIMITY_PROVIDERS_SOLIDS_H

#include <curve_proximity/constraint_provider.hpp>
#include <curve_proximity/fourier.hpp>

namespace curve_proximity {

/** The union of a side's parts, each as a solid that contains the shape and all within the side's padding of it.
 *
 *  In space: spheres, boxes, ellipsoids, cylinders, capsules; cones, polytopes, superquadrics and implicit bodies by
 *  polytopes; closed meshes, with padding by their hulls; points, octrees and height fields by the cells of a grid that
 *  they meet. In the plane: spheres, boxes, ellipsoids, superquadrics, cylinders, capsules and cones by their sections
 *  at z = 0, outlines convex or not, polytopes and points at z = 0. Throws Error that names the type of any other
 *  shape. Files are named by absolute paths. dimension: 2 or 3. stop: asked while the hull of many points is made; true
 *  ends it with an Error. */
SolidHandle makeSolid(const ConstraintBody &side, int dimension, const Stop &stop = {});

} // namespace curve_proximity
#endif
