/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>
#include <exception>

#include <fcl/config.h>
#if FCL_MAJOR_VERSION > 0 || FCL_MINOR_VERSION >= 6
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>
#endif

#include "peers.h"

namespace curve_proximity {

#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6

double fclDistance(const Piece &, const Piece &) {
  throw Error("this build has FCL 0.5: second opinions need FCL 0.6 or later");
}

#else

namespace {

using FclShape = std::shared_ptr<const fcl::CollisionGeometryd>;
using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

/* FCL knows no points: a ball of this radius stands for one [m]. */
constexpr double POINT_RADIUS = 1e-6;

FclShape meshOf(const PeerMesh &mesh) {
  std::call_once(mesh.once, [&] {
    const auto model = std::make_shared<FclMesh>();
    const Eigen::Matrix3Xd &vertices = mesh.data.vertices;
    const Triangles &triangles = mesh.data.triangles;
    model->beginModel(static_cast<int>(triangles.cols()), static_cast<int>(vertices.cols()));
    for (Eigen::Index i = 0; i < triangles.cols(); ++i)
      model->addTriangle(vertices.col(triangles(0, i)), vertices.col(triangles(1, i)), vertices.col(triangles(2, i)));
    model->endModel();
    mesh.made = model;
  });
  return std::static_pointer_cast<const FclMesh>(mesh.made);
}

/* Without faces FCL looks at all vertices. */
FclShape polytopeOf(const Eigen::Matrix3Xd &vertices) {
  const auto corners = std::make_shared<std::vector<fcl::Vector3d> >();
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) corners->push_back(vertices.col(i));
  return std::make_shared<fcl::Convexd>(corners, 0, std::make_shared<std::vector<int> >());
}

FclShape geometryOf(const Piece &piece) {
  const Eigen::Vector3d &size = piece.size;
  switch (piece.type) {
    case ShapeType::SPHERE: return std::make_shared<fcl::Sphered>(size.x());
    case ShapeType::BOX: return std::make_shared<fcl::Boxd>(size);
    case ShapeType::CAPSULE: return std::make_shared<fcl::Capsuled>(size.y(), size.x());
    case ShapeType::CYLINDER: return std::make_shared<fcl::Cylinderd>(size.y(), size.x());
    case ShapeType::CONE: return std::make_shared<fcl::Coned>(size.y(), size.x());
    case ShapeType::ELLIPSOID: return std::make_shared<fcl::Ellipsoidd>(size);
    case ShapeType::POLYTOPE: return polytopeOf(piece.vertices);
    case ShapeType::MESH: return meshOf(*piece.mesh);
    default: return std::make_shared<fcl::Sphered>(POINT_RADIUS);
  }
}

} // namespace

double fclDistance(const Piece &a, const Piece &b) {
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-9;
  request.gjk_solver_type =
      fcl::GST_INDEP; /* the default is wrong about boxes with parallel edges (doc/second-opinion.md) */
  fcl::DistanceResultd result;
  double found = 0.0;
  try {
    found = fcl::distance(geometryOf(a).get(), a.pose, geometryOf(b).get(), b.pose, request, result);
  } catch (const std::exception &) { /* its text is a page of internals */
    throw Error("FCL gives up on the pair with an exception");
  }
  for (const Piece *piece : {&a, &b}) found += piece->type == ShapeType::POINT && found > 0.0 ? POINT_RADIUS : 0.0;
  return std::max(0.0, found);
}

#endif

} // namespace curve_proximity
