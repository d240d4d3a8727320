/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes at another size (the link_scale of a planning scene), and with what is in their files. */
#ifndef CURVE_PROXIMITY_SCENE_SCALING_H
#define CURVE_PROXIMITY_SCENE_SCALING_H

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/* A mesh with the vertices and triangles of its file in place of `resource`; any other shape as it is. Throws Error
 * where the file cannot be read. */
ShapeDescription loadedShape(const ShapeDescription &shape, const ResourceOptions &resources);

/* The shape enlarged about its own origin, of a mesh about the mean of its vertices; the pose says where that puts it.
 * scale > 0. Throws Error where a mesh file cannot be read, and for octrees. */
ShapeDescription scaledShape(const ShapeDescription &shape, double scale, const ResourceOptions &resources);

} // namespace curve_proximity
#endif
