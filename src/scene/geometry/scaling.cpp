/* SPDX-License-Identifier: BSD-3-Clause */
#include "scaling.h"

#include "mesh.h"

namespace curve_proximity {
namespace {

/* The factors of a mesh, its own and the new one; its mean stays where it is. */
void scaleMesh(ShapeDescription &shape, double scale, const ResourceOptions &resources) {
  shape = loadedShape(shape, resources);
  if (shape.dimensions.empty()) shape.dimensions = {1.0, 1.0, 1.0};
  if (shape.dimensions.size() != 3 || shape.vertices.cols() == 0) return; /* refused where the body is made */
  const Eigen::Vector3d factors(shape.dimensions.data());
  const Eigen::Vector3d mean = factors.cwiseProduct(shape.vertices.rowwise().mean());
  for (double &factor : shape.dimensions) factor *= scale;
  shape.pose.translate((1.0 - scale) * mean);
}

/* What is <= 0 at x, at x / scale. */
void scaleConstraints(ShapeDescription &shape, double scale) {
  for (HyperquadricTerms &terms : shape.hyperquadrics)
    for (std::array<double, 5> &term : terms)
      for (std::size_t i = 0; i < 3; ++i) term[i] /= scale;
  for (std::array<double, 4> &plane : shape.planes)
    for (std::size_t i = 0; i < 3; ++i) plane[i] /= scale;
  for (std::array<double, 10> &quadric : shape.quadrics)
    for (std::size_t i = 0; i < 9; ++i) quadric[i] /= i < 6 ? scale * scale : scale;
}

} // namespace

ShapeDescription loadedShape(const ShapeDescription &shape, const ResourceOptions &resources) {
  if (shape.type != ShapeType::MESH || shape.resource.empty()) return shape;
  const MeshData data = readMesh(resolveResource(shape.resource, resources));
  ShapeDescription out = shape;
  out.vertices = data.vertices;
  out.triangles = data.triangles;
  out.resource.clear();
  return out;
}

ShapeDescription scaledShape(const ShapeDescription &shape, double scale, const ResourceOptions &resources) {
  ShapeDescription out = shape;
  out.made.reset();
  if (out.deformed) out.deformed->translation *= scale;
  switch (shape.type) {
    case ShapeType::MESH: scaleMesh(out, scale, resources); break;
    case ShapeType::POINT:
    case ShapeType::POLYGON:
    case ShapeType::POLYTOPE: out.vertices *= scale; break;
    case ShapeType::POINTS: /* [radius] */
      out.vertices *= scale;
      for (double &radius : out.dimensions) radius *= scale;
      break;
    case ShapeType::OCTREE: throw Error("an octree has no other size than its own");
    case ShapeType::HEIGHT_FIELD:
    case ShapeType::CURVE:
    case ShapeType::DISTANCE_GRID:
      throw Error(std::string("a ") + shapeTypeName(shape.type) + " has no other size than its own");
    case ShapeType::IMPLICIT: scaleConstraints(out, scale); break;
    case ShapeType::HALFSPACE: /* [a, b, c, d] */
      if (out.dimensions.size() == 4) out.dimensions[3] *= scale;
      break;
    case ShapeType::SUPERQUADRIC:   /* [a1, a2, a3, n1, n2, n3] */
    case ShapeType::SUPERELLIPSOID: /* [a1, a2, a3, e1, e2] */
      for (std::size_t i = 0; i < 3 && i < out.dimensions.size(); ++i) out.dimensions[i] *= scale;
      break;
    default:
      for (double &length : out.dimensions) length *= scale;
      break;
  }
  return out;
}

} // namespace curve_proximity
