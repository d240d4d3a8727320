/* SPDX-License-Identifier: BSD-3-Clause */
/** From shapes to the solids of cprox_fourier.h. */
#ifndef CURVE_PROXIMITY_PROVIDERS_SOLIDS_H
#define CURVE_PROXIMITY_PROVIDERS_SOLIDS_H

#include <curve_proximity/cprox_fourier.h>
#include <curve_proximity/constraint_provider.hpp>
#include <memory>

namespace curve_proximity {

using SolidHandle = std::shared_ptr<const cprox_solid>;

/** The union of a side's parts, each as a solid that contains the shape.
 *
 *  In space: spheres, boxes, ellipsoids, cylinders, capsules, cones (as an enclosing pyramid), polytopes, closed meshes
 *  given by vertices and triangles. In the plane: spheres, boxes, ellipsoids, and polygons and polytopes at z = 0.
 *  Throws Error that names the type of any other shape, and for padding. dimension: 2 or 3. */
SolidHandle makeSolid(const ConstraintBody &side, int dimension);

} // namespace curve_proximity
#endif
