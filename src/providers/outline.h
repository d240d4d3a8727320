/* SPDX-License-Identifier: BSD-3-Clause */
/** Outlines that are not convex as triangles, and meshes as triangles one by one. */
#ifndef CURVE_PROXIMITY_PROVIDERS_OUTLINE_H
#define CURVE_PROXIMITY_PROVIDERS_OUTLINE_H

#include <curve_proximity/constraint_provider.hpp>

namespace curve_proximity {

/** Whether an outline in the plane z = 0 is not convex. */
bool turnsBothWays(const Eigen::Matrix3Xd &outline);

/** A MESH that fills the outline of a POLYGON in either orientation, with its pose. Ears are cut off; all are
 *  counter-clockwise, and their edges sum up to the outline, so that they cover what it winds round and nothing else.
 *  Cost: O(n²) for most outlines. Throws Error where the outline crosses itself. */
ShapeDescription filledOutline(const ShapeDescription &polygon);

/** The side as one body of convex parts alone: meshes and outlines triangle by triangle, without their inside. Throws
 *  Error for shapes that are made of other elements. */
BodyHandle convexElements(const ConstraintBody &side);

/** Whether part.body is a hull that stands for the part: of a mesh, an outline that is not convex, a height field. */
bool isHull(const ConstraintBody::Part &part);

/** Whether that is so of any part. */
bool hasHulls(const ConstraintBody &side);

} // namespace curve_proximity
#endif
