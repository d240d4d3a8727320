/* SPDX-License-Identifier: BSD-3-Clause */
#include "worlds.h"

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#include <octomap/octomap.h>
#endif

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

struct world_peer {
  std::unique_ptr<fcl::CollisionObjectd> object;
};

world_peer *world_peer_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m) {
  std::vector<fcl::Vector3d> points;
  std::vector<fcl::Triangle> faces;
  for (size_t i = 0; i < n; i++) points.emplace_back(vertices[i].x, vertices[i].y, vertices[i].z);
  for (size_t i = 0; i < m; i++) faces.emplace_back(triangles[i][0], triangles[i][1], triangles[i][2]);
  const auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(m), static_cast<int>(n));
  model->addSubModel(points, faces);
  model->endModel();
  return new world_peer{std::make_unique<fcl::CollisionObjectd>(model)};
}

world_peer *world_peer_octree(const cprox_vec3 *centres, size_t n, double resolution) {
#if FCL_HAVE_OCTOMAP
  const auto cells = std::make_shared<octomap::OcTree>(resolution);
  for (size_t i = 0; i < n; i++)
    cells->updateNode(octomap::point3d(centres[i].x, centres[i].y, centres[i].z), true, true);
  cells->updateInnerOccupancy();
  return new world_peer{std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::OcTreed>(cells))};
#else
  (void)centres, (void)n, (void)resolution;
  return nullptr;
#endif
}

void world_peer_free(world_peer *w) {
  delete w;
}

namespace {

fcl::Vector3d point_at(const cprox_vec3 *points, size_t n, double s) {
  cprox_vec3 w[64];
  std::copy(points, points + n, w);
  for (size_t k = n - 1; k > 0; k--)
    for (size_t i = 0; i < k; i++)
      w[i] = {w[i].x + s * (w[i + 1].x - w[i].x), w[i].y + s * (w[i + 1].y - w[i].y),
              w[i].z + s * (w[i + 1].z - w[i].z)};
  return {w[0].x, w[0].y, w[0].z};
}

fcl::Transform3d at(const cprox_vec3 *points, size_t n_points, size_t i, size_t n) {
  fcl::Transform3d there = fcl::Transform3d::Identity();
  there.translation() = point_at(points, n_points, n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.5);
  return there;
}

} // namespace

double world_peer_distance(const world_peer *w, const cprox_vec3 *points, size_t n_points, size_t n) {
  const double radius = 1e-6;
  fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius));
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < n; i++) {
    ball.setTransform(at(points, n_points, i, n));
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    least = std::min(least, fcl::distance(w->object.get(), &ball, request, result) + radius);
  }
  return least;
}

double world_peer_ball(const world_peer *w, cprox_vec3 centre, double radius) {
  fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius));
  ball.setTransform(at(&centre, 1, 0, 1));
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(w->object.get(), &ball, request, result);
}

bool world_peer_collides(const world_peer *w, const cprox_vec3 *points, size_t n_points, double radius, size_t n) {
  fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius));
  for (size_t i = 0; i < n; i++) {
    ball.setTransform(at(points, n_points, i, n));
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(w->object.get(), &ball, request, result) > 0) return true;
  }
  return false;
}
