/* SPDX-License-Identifier: BSD-3-Clause */
#include "outline.h"

#include <algorithm>

#include "../scene/geometry/scaling.h"

namespace curve_proximity {
namespace {

using Loop = std::vector<int>; /* columns of vertices */

/* Twice the area of a triangle, positive counter-clockwise. long double: differences of doubles of like size are exact.
 */
long double turn(const Eigen::Matrix3Xd &v, int a, int b, int c) {
  const auto side = [&](int from, int to, int axis) {
    return static_cast<long double>(v(axis, to)) - static_cast<long double>(v(axis, from));
  };
  return side(a, b, 0) * side(a, c, 1) - side(a, b, 1) * side(a, c, 0);
}

bool isAt(const Eigen::Matrix3Xd &v, int a, int b) {
  return v.col(a) == v.col(b);
}

/* Whether a vertex of the loop is in the triangle, edges included, and at none of its corners. */
bool isCrossed(const Eigen::Matrix3Xd &v, const Loop &loop, int a, int b, int c) {
  return std::any_of(loop.begin(), loop.end(), [&](int p) {
    if (isAt(v, p, a) || isAt(v, p, b) || isAt(v, p, c)) return false;
    return turn(v, a, b, p) >= 0.0L && turn(v, b, c, p) >= 0.0L && turn(v, c, a, p) >= 0.0L;
  });
}

/* An ear to cut off, loop.size() where there is none: an empty triangle, or a vertex on the line of its neighbours. */
std::size_t earOf(const Eigen::Matrix3Xd &v, const Loop &loop) {
  const std::size_t n = loop.size();
  for (const bool flat : {false, true})
    for (std::size_t i = 0; i < n; ++i) {
      const int a = loop[(i + n - 1) % n], b = loop[i], c = loop[(i + 1) % n];
      const long double area = turn(v, a, b, c);
      if (flat ? area == 0.0L : area > 0.0L && !isCrossed(v, loop, a, b, c)) return i;
    }
  return n;
}

/* A part's triangles: of a mesh, scaled, or of an outline. */
ShapeDescription elementsOf(const ShapeDescription &shape) {
  if (shape.type == ShapeType::POLYGON) return filledOutline(shape);
  if (shape.type != ShapeType::MESH)
    throw Error(std::string(shapeTypeName(shape.type)) +
                ": it is not carried along a curve but by its hull: ask with meshes: hull");
  ShapeDescription mesh = loadedShape(shape, {});
  if (mesh.dimensions.size() != 3) return mesh;
  mesh.vertices = Eigen::Vector3d(mesh.dimensions.data()).asDiagonal() * mesh.vertices;
  mesh.dimensions.clear();
  return mesh;
}

} // namespace

bool turnsBothWays(const Eigen::Matrix3Xd &outline) {
  bool left = false, right = false;
  for (Eigen::Index i = 0, n = outline.cols(); i < n; ++i) {
    const Eigen::Vector3d a = outline.col((i + 1) % n) - outline.col(i);
    const double z = a.cross(outline.col((i + 2) % n) - outline.col((i + 1) % n)).z();
    left = left || z > 0.0;
    right = right || z < 0.0;
  }
  return left && right;
}

ShapeDescription filledOutline(const ShapeDescription &polygon) {
  const Eigen::Matrix3Xd &v = polygon.vertices;
  Loop loop;
  for (int i = 0; i < v.cols(); ++i) loop.push_back(i);
  long double area = 0.0L;
  for (int i = 1; i + 1 < v.cols(); ++i) area += turn(v, 0, i, i + 1);
  if (area < 0.0L) std::reverse(loop.begin(), loop.end());

  std::vector<Eigen::Vector3i> ears;
  while (loop.size() > 2) {
    const std::size_t n = loop.size(), i = earOf(v, loop);
    if (i == n) throw Error("the outline crosses itself");
    const Eigen::Vector3i ear(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]);
    if (turn(v, ear[0], ear[1], ear[2]) > 0.0L) ears.push_back(ear);
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
  }
  ShapeDescription mesh;
  mesh.type = ShapeType::MESH;
  mesh.pose = polygon.pose;
  mesh.vertices = v;
  mesh.triangles.resize(3, static_cast<Eigen::Index>(ears.size()));
  for (std::size_t i = 0; i < ears.size(); ++i) mesh.triangles.col(static_cast<Eigen::Index>(i)) = ears[i];
  return mesh;
}

BodyHandle convexElements(const ConstraintBody &side) {
  std::vector<BodyHandle> bodies;
  std::vector<Eigen::Isometry3d> poses;
  for (const ConstraintBody::Part &part : side.parts) {
    if (!isHull(part)) {
      bodies.push_back(part.body);
      poses.push_back(part.shape.pose);
      continue;
    }
    const ShapeDescription mesh = elementsOf(part.shape);
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
      Eigen::Matrix3d corners;
      for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, i));
      bodies.push_back(makePolytope(corners));
      poses.push_back(part.shape.pose);
    }
  }
  return makeCompound(bodies, poses);
}

bool isHull(const ConstraintBody::Part &part) {
  if (part.exact) return part.exact != part.body;
  return part.excess > 0.0 || part.shape.type == ShapeType::MESH || part.shape.type == ShapeType::HEIGHT_FIELD;
}

bool hasHulls(const ConstraintBody &side) {
  return std::any_of(side.parts.begin(), side.parts.end(), isHull);
}

} // namespace curve_proximity
