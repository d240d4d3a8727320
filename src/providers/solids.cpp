/* SPDX-License-Identifier: BSD-3-Clause */
#include "solids.h"

#include <geometric_shapes/bodies.h>
#include <geometric_shapes/shapes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace curve_proximity {
namespace {

using Points = std::vector<cprox_vec3>;
using Corners = std::vector<std::array<std::uint32_t, 3>>;

/* Of the pyramid round a cone. */
constexpr int SIDES = 32;

SolidHandle own(const cprox_solid_description &description) {
  Workspace workspace;
  cprox_solid *solid = nullptr;
  require(cprox_solid_create(&description, workspace.get(), &solid), workspace);
  return SolidHandle(solid, [](const cprox_solid *s) { cprox_solid_free(const_cast<cprox_solid *>(s)); });
}

SolidHandle meshSolid(const Points &vertices, const Corners &triangles) {
  cprox_solid_description solid{};
  solid.kind = CPROX_SOLID_MESH;
  solid.points = vertices.data();
  solid.n = vertices.size();
  solid.triangles = reinterpret_cast<const std::uint32_t(*)[3]>(triangles.data());
  solid.n_triangles = triangles.size();
  return own(solid);
}

/* Turns each triangle so that it looks away from a point inside a convex hull. */
void lookOutward(const Points &vertices, const Eigen::Vector3d &inside, Corners &triangles) {
  for (auto &t : triangles) {
    const Eigen::Vector3d a = toEigen(vertices[t[0]]), b = toEigen(vertices[t[1]]), c = toEigen(vertices[t[2]]);
    if ((b - a).cross(c - a).dot(a - inside) < 0.0) std::swap(t[1], t[2]);
  }
}

/* The hull of points with an interior. What the hull's computation dropped is taken in again: all is scaled about the
 * middle until every point is behind every face. */
SolidHandle hullSolid(const Eigen::Matrix3Xd &points) {
  shapes::Mesh mesh(static_cast<unsigned>(points.cols()), 0);
  Eigen::Map<Eigen::Matrix3Xd>(mesh.vertices, 3, points.cols()) = points;
  const bodies::ConvexMesh hull(&mesh);
  const std::vector<unsigned> &corners = hull.getTriangles();
  if (corners.size() < 12) throw Error("the hull of its vertices has no interior");
  Points vertices;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d &v : hull.getVertices()) {
    vertices.push_back(toVec3(v));
    middle += v / static_cast<double>(hull.getVertices().size());
  }
  Corners triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  lookOutward(vertices, middle, triangles);

  double scale = 1.0;
  for (const auto &t : triangles) {
    const Eigen::Vector3d a = toEigen(vertices[t[0]]);
    const Eigen::Vector3d n = (toEigen(vertices[t[1]]) - a).cross(toEigen(vertices[t[2]]) - a).normalized();
    const double depth = n.dot(a - middle);
    if (!(depth > 0.0)) continue; // a sliver: its neighbours hold its place
    scale = std::max(
        scale,
        (points.colwise() - middle).cwiseProduct(n.replicate(1, points.cols())).colwise().sum().maxCoeff() / depth);
  }
  scale *= 1.0 + 1e-12;
  for (cprox_vec3 &v : vertices) v = toVec3(middle + scale * (toEigen(v) - middle));
  return meshSolid(vertices, triangles);
}

SolidHandle coneSolid(double height, double radius) {
  const double r = radius / std::cos(M_PI / SIDES);
  Eigen::Matrix3Xd points(3, SIDES + 1);
  for (int i = 0; i < SIDES; ++i)
    points.col(i) << r * std::cos(2.0 * M_PI * i / SIDES), r * std::sin(2.0 * M_PI * i / SIDES), -0.5 * height;
  points.col(SIDES) << 0.0, 0.0, 0.5 * height;
  return hullSolid(points);
}

SolidHandle meshOf(const ShapeDescription &shape) {
  if (!shape.resource.empty()) throw Error("FourierGap takes meshes by vertices and triangles, not from a file");
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (shape.dimensions.size() == 3) scale = Eigen::Vector3d(shape.dimensions.data());
  Points vertices;
  for (Eigen::Index i = 0; i < shape.vertices.cols(); ++i)
    vertices.push_back(toVec3(scale.cwiseProduct(shape.vertices.col(i))));
  Corners triangles;
  const bool mirrored = scale.prod() < 0.0;
  for (Eigen::Index i = 0; i < shape.triangles.cols(); ++i) {
    const Eigen::Vector3i t = shape.triangles.col(i);
    triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[mirrored ? 2 : 1]),
                         static_cast<std::uint32_t>(t[mirrored ? 1 : 2])});
  }
  return meshSolid(vertices, triangles);
}

/* The hull of planar points, counter-clockwise (Andrew's chains). */
SolidHandle polygonSolid(const Eigen::Matrix3Xd &points) {
  using Point = std::array<double, 2>;
  std::vector<Point> sorted, hull;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points(2, i) != 0.0) throw Error("in the plane vertices have z = 0");
    sorted.push_back({points(0, i), points(1, i)});
  }
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto turns_right = [](const Point &a, const Point &b, const Point &c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0;
  };
  for (int chain = 0; chain < 2; ++chain, std::reverse(sorted.begin(), sorted.end())) {
    const std::size_t begin = hull.size();
    for (const Point &p : sorted) {
      while (hull.size() >= begin + 2 && turns_right(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  }
  if (hull.size() < 3) throw Error("the hull of its vertices has no interior");
  cprox_solid_description solid{};
  solid.kind = CPROX_SOLID_POLYGON;
  solid.corners = reinterpret_cast<const double(*)[2]>(hull.data());
  solid.n = hull.size();
  return own(solid);
}

SolidHandle solidOf(const ShapeDescription &shape, int dimension) {
  const std::vector<double> &d = shape.dimensions;
  cprox_solid_description solid{};
  solid.dimension = dimension;
  switch (shape.type) {
    case ShapeType::SPHERE:
      solid.kind = CPROX_SOLID_BALL;
      solid.radius = d.at(0);
      return own(solid);
    case ShapeType::BOX:
      solid.kind = CPROX_SOLID_BOX;
      solid.size = {d.at(0), d.at(1), d.at(2)};
      return own(solid);
    case ShapeType::ELLIPSOID:
      solid.kind = CPROX_SOLID_ELLIPSOID;
      solid.semi_axes = {d.at(0), d.at(1), d.at(2)};
      return own(solid);
    case ShapeType::POLYTOPE: return dimension == 2 ? polygonSolid(shape.vertices) : hullSolid(shape.vertices);
    case ShapeType::POLYGON:
      if (dimension == 3) break;
      return polygonSolid(shape.vertices);
    case ShapeType::CYLINDER:
    case ShapeType::CAPSULE:
      if (dimension == 2) break;
      solid.kind = shape.type == ShapeType::CYLINDER ? CPROX_SOLID_CYLINDER : CPROX_SOLID_CAPSULE;
      solid.height = d.at(0);
      solid.radius = d.at(1);
      return own(solid);
    case ShapeType::CONE:
      if (dimension == 2) break;
      return coneSolid(d.at(0), d.at(1));
    case ShapeType::MESH:
      if (dimension == 2) break;
      return meshOf(shape);
    default: break;
  }
  throw Error(std::string("FourierGap has no solid for it in ") + (dimension == 2 ? "the plane" : "space"));
}

} // namespace

SolidHandle makeSolid(const ConstraintBody &side, int dimension) {
  if (side.parts.empty()) throw Error("the side has no shape");
  if (side.padding != 0.0) throw Error("FourierGap takes no padding: enlarge the shapes");
  std::vector<SolidHandle> parts;
  std::vector<cprox_pose> poses;
  bool moved = false;
  for (const ConstraintBody::Part &part : side.parts) {
    try {
      parts.push_back(solidOf(part.shape, dimension));
    } catch (const Error &error) {
      throw Error(std::string(shapeTypeName(part.shape.type)) + ": " + error.what(), error.status());
    }
    poses.push_back(toPose(part.shape.pose));
    moved = moved || !part.shape.pose.matrix().isIdentity(0.0);
  }
  if (parts.size() == 1 && !moved) return parts.front();
  std::vector<const cprox_solid *> handles;
  for (const SolidHandle &part : parts) handles.push_back(part.get());
  cprox_solid_description all{};
  all.kind = CPROX_SOLID_UNION;
  all.parts = handles.data();
  all.poses = poses.data();
  all.n = handles.size();
  return own(all);
}

} // namespace curve_proximity
