/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangles to look at: what a shape is drawn by, never what it is measured by. */
#ifndef CURVE_PROXIMITY_SCENE_SURFACE_H
#define CURVE_PROXIMITY_SCENE_SURFACE_H

#include <cstddef>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/* A surface in its shape's own frame. */
struct Surface {
  Eigen::Matrix3Xd vertices; /* [m] */
  Triangles triangles;
};

/* The surface of a shape, of at most about `most` triangles (>= 100): meshes and height fields by their triangles, the
 * vertices of a cell of a grid drawn together where there are too many; convex bodies by their support points; of
 * points and octree cells as many as that allows; of a halfspace a square of its plane, `plane_size` [m] wide. No
 * triangles where the shape has no body, or its file has gone since the body was made. */
Surface surfaceOf(const ShapeDescription &shape, const BodyHandle &body, const ResourceOptions &resources,
                  std::size_t most, double plane_size);

/* The same mesh of at most `most` triangles: the vertices of a grid's cell become their mean, the cells as small as
 * that allows. The result has no vertex that no triangle uses. */
Surface decimated(const Surface &mesh, std::size_t most);

} // namespace curve_proximity
#endif
