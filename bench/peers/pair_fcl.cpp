// SPDX-License-Identifier: BSD-3-Clause
#include "pair_fcl.h"

#include <cmath>
#include <exception>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

namespace {

fcl::Transform3d placed(const cprox_pose &pose) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  const cprox_quat q = pose.orientation;
  out.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  out.translation() = fcl::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return out;
}

} // namespace

void *pair_fcl_make(cprox_body_kind kind, const double size[3]) {
  switch (kind) {
    case CPROX_BODY_SPHERE: return new Geometry(std::make_shared<fcl::Sphered>(size[0]));
    case CPROX_BODY_BOX: return new Geometry(std::make_shared<fcl::Boxd>(size[0], size[1], size[2]));
    case CPROX_BODY_CYLINDER: return new Geometry(std::make_shared<fcl::Cylinderd>(size[1], size[0]));
    case CPROX_BODY_CAPSULE: return new Geometry(std::make_shared<fcl::Capsuled>(size[1], size[0]));
    default: return new Geometry(std::make_shared<fcl::Ellipsoidd>(size[0], size[1], size[2]));
  }
}

void *pair_fcl_make_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m) {
  const auto corners = std::make_shared<std::vector<fcl::Vector3d>>();
  const auto faces = std::make_shared<std::vector<int>>();
  for (size_t i = 0; i < n; i++) corners->emplace_back(vertices[i].x, vertices[i].y, vertices[i].z);
  for (size_t i = 0; i < m; i++) faces->insert(faces->end(), {3, triangles[i][0], triangles[i][1], triangles[i][2]});
  return new Geometry(std::make_shared<fcl::Convexd>(corners, static_cast<int>(m), faces));
}

void pair_fcl_free(void *geometry) {
  delete static_cast<Geometry *>(geometry);
}

double pair_fcl_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-10;
  fcl::DistanceResultd found;
  fcl::distance(static_cast<const Geometry *>(a)->get(), placed(*pa), static_cast<const Geometry *>(b)->get(),
                placed(*pb), request, found);
  return found.min_distance;
} catch (const std::exception &) {
  return NAN;
}

int pair_fcl_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd found;
  fcl::collide(static_cast<const Geometry *>(a)->get(), placed(*pa), static_cast<const Geometry *>(b)->get(),
               placed(*pb), request, found);
  return found.isCollision();
} catch (const std::exception &) {
  return -1;
}
