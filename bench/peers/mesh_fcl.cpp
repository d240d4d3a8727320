// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_fcl.h"

#include <cmath>
#include <exception>
#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

using Model = fcl::BVHModel<fcl::OBBRSSd>;
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

void *mesh_fcl_make(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m) {
  std::vector<fcl::Vector3d> corners;
  std::vector<fcl::Triangle> faces;
  for (size_t i = 0; i < n; i++) corners.emplace_back(vertices[i].x, vertices[i].y, vertices[i].z);
  for (size_t i = 0; i < m; i++) faces.emplace_back(triangles[i][0], triangles[i][1], triangles[i][2]);
  const auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(corners, faces);
  model->endModel();
  return new Geometry(model);
}

void mesh_fcl_free(void *mesh) {
  delete static_cast<Geometry *>(mesh);
}

double mesh_fcl_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  fcl::DistanceRequestd request;
  fcl::DistanceResultd found;
  fcl::distance(static_cast<const Geometry *>(a)->get(), placed(*pa), static_cast<const Geometry *>(b)->get(),
                placed(*pb), request, found);
  return found.min_distance;
} catch (const std::exception &) {
  return NAN;
}

int mesh_fcl_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd found;
  fcl::collide(static_cast<const Geometry *>(a)->get(), placed(*pa), static_cast<const Geometry *>(b)->get(),
               placed(*pb), request, found);
  return found.isCollision();
} catch (const std::exception &) {
  return -1;
}
