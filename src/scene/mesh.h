/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes: from a file to vertices and triangles, and from those to the convex hull that answers for them. */
#ifndef CURVE_PROXIMITY_SCENE_MESH_H
#define CURVE_PROXIMITY_SCENE_MESH_H

#include <string>
#include <vector>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

struct MeshData {
  Eigen::Matrix3Xd vertices; /* [m] */
  Triangles triangles;
};

/* Reads any format that assimp knows, in a process of its own: a malformed file costs seconds at most. Throws Error, naming the
 * file and what is wrong with it, where it is cut short or otherwise malformed, or holds no triangle. */
MeshData readMesh(const std::string &file);

/* The mesh, scaled along the axes, as a level-of-detail body of the convex hull of the vertices that triangles use, and
 * the triangles. Throws Error: no triangle, an index out of range, vertices or scale not finite, a scale of 0;
 * CPROX_MEMORY where the triangles would take more than memory_limit bytes. */
Geometry makeMeshGeometry(const MeshData &mesh, const Eigen::Vector3d &scale, bool solid, std::size_t memory_limit);

/* A convex hull, and how far what it is the hull of may stand out of it [m]. */
struct Hull {
  BodyHandle body;
  double excess = 0.0;
};

/* The hull of `kept`, some of the points of `all`, so that all of them are covered: by the body, by the excess where they
 * stand out by no more than rounding, or by taking them back. */
Hull hullCovering(const std::vector<Eigen::Vector3d> &all, std::vector<Eigen::Vector3d> kept);

} // namespace curve_proximity
#endif
