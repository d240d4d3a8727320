/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes: from a file to vertices and triangles, and from those to the convex hull that answers for them. */
#ifndef CURVE_PROXIMITY_SCENE_MESH_H
#define CURVE_PROXIMITY_SCENE_MESH_H

#include <functional>
#include <string>
#include <vector>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

struct MeshData {
  Eigen::Matrix3Xd vertices; /* [m] */
  Triangles triangles;
  std::string remark = ""; /* what was done to read the file that its user may not expect; "" for nothing */
};

/* Reads STL, PLY, OBJ, Collada and glTF files in double precision, in a process of its own: a malformed file costs
 * seconds at most. Throws Error, naming the file and what is wrong with it, where it is cut short or otherwise
 * malformed, or holds no triangle. */
MeshData readMesh(const std::string &file);

/* The mesh, scaled along the axes, as a level-of-detail body of the convex hull of the vertices that triangles use, and
 * the triangles. The hull is kept in memory and found again by the mesh's content. Throws Error: no triangle, an index
 * out of range, vertices or scale not finite, a scale of 0; CPROX_MEMORY where the triangles would take more than
 * options.memory_limit bytes, or options.stop ends it. */
Geometry makeMeshGeometry(const MeshData &mesh, const Eigen::Vector3d &scale, bool solid,
                          const ResourceOptions &options);

/* A mesh file that a description names. */
struct MeshRequest {
  std::string uri, file; /* as the description has it, and where that is */
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  bool solid = false;

  bool operator<(const MeshRequest &other) const;
};

/* Reads the file and makes the geometry as makeMeshGeometry() does; what is kept of the file's content and scale, in
 * memory or in the cache directory, is not made again. `remark`: that of MeshData. Throws Error, naming the file. */
Geometry loadMeshGeometry(const MeshRequest &request, const ResourceOptions &options, MeshTiming *timing = nullptr,
                          std::string *remark = nullptr);

/* How makeGeometry() gets the geometry of a mesh file. */
using MeshLoader = std::function<Geometry(const MeshRequest &request)>;
Geometry makeGeometry(const ShapeDescription &shape, const ResourceOptions &options, const MeshLoader &loader);

/* The scale of a MESH. */
Eigen::Vector3d meshScale(const ShapeDescription &shape);

} // namespace curve_proximity
#endif
