/* SPDX-License-Identifier: BSD-3-Clause */
/** Shape descriptions from shapes in memory of the package geometric_shapes, which MoveIt uses.
 *
 *  Header-only over geometric_shapes and octomap. */
#ifndef CURVE_PROXIMITY_GEOMETRIC_SHAPES_HPP
#define CURVE_PROXIMITY_GEOMETRIC_SHAPES_HPP

#include <sstream>

#include <geometric_shapes/shapes.h>
#include <octomap/octomap.h>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

namespace curve_proximity {

/** The same shape, its pose the identity. A mesh is a surface. A plane is the halfspace below it, as in scenes of
 *  moveit_msgs. An octree counts its occupied cells, by its own threshold. Throws Error for a shape of another type,
 *  and for an octree without its tree. */
inline ShapeDescription fromShape(const shapes::Shape &shape) {
  ShapeDescription out;
  switch (shape.type) {
    case shapes::SPHERE:
      out.type = ShapeType::SPHERE;
      out.dimensions = {static_cast<const shapes::Sphere &>(shape).radius};
      return out;
    case shapes::CYLINDER: {
      const auto &cylinder = static_cast<const shapes::Cylinder &>(shape);
      out.type = ShapeType::CYLINDER;
      out.dimensions = {cylinder.length, cylinder.radius};
      return out;
    }
    case shapes::CONE: {
      const auto &cone = static_cast<const shapes::Cone &>(shape);
      out.type = ShapeType::CONE;
      out.dimensions = {cone.length, cone.radius};
      return out;
    }
    case shapes::BOX: {
      const double *size = static_cast<const shapes::Box &>(shape).size;
      out.type = ShapeType::BOX;
      out.dimensions = {size[0], size[1], size[2]};
      return out;
    }
    case shapes::PLANE: {
      const auto &plane = static_cast<const shapes::Plane &>(shape);
      out.type = ShapeType::HALFSPACE;
      out.dimensions = {plane.a, plane.b, plane.c, plane.d};
      return out;
    }
    case shapes::MESH: {
      const auto &mesh = static_cast<const shapes::Mesh &>(shape);
      out.type = ShapeType::MESH;
      out.vertices = Eigen::Map<const Eigen::Matrix3Xd>(mesh.vertices, 3, mesh.vertex_count);
      using Indices = Eigen::Matrix<unsigned int, 3, Eigen::Dynamic>;
      out.triangles = Eigen::Map<const Indices>(mesh.triangles, 3, mesh.triangle_count).cast<int>();
      return out;
    }
    case shapes::OCTREE: {
      const auto &held = static_cast<const shapes::OcTree &>(shape).octree;
      if (!held) throw Error("an octree without its tree");
      const octomap::OcTree &tree = *held;
      std::ostringstream bytes;
      tree.writeData(bytes);
      out.type = ShapeType::OCTREE;
      out.octree.id = tree.getTreeType();
      out.octree.resolution = tree.getResolution();
      out.octree.binary = false;
      out.octree.data = tree.size() > 0 ? bytes.str() : std::string();
      return out;
    }
    default: throw Error("a shape of geometric_shapes' type " + std::to_string(shape.type) + " is not known here");
  }
}

} // namespace curve_proximity
#endif
