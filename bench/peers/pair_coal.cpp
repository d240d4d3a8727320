// SPDX-License-Identifier: BSD-3-Clause
// By coal's defaults: GJK to 1e-6, distances with both points, of meshes by trees of OBBRSS.
#include "pair_coal.h"

#include <cmath>
#include <exception>
#include <memory>
#include <vector>

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

using Geometry = std::shared_ptr<coal::CollisionGeometry>;

namespace {

coal::Transform3s placed(const cprox_pose &pose) {
  const cprox_quat q = pose.orientation;
  return coal::Transform3s(coal::Quatf(q.w, q.x, q.y, q.z),
                           coal::Vec3s(pose.position.x, pose.position.y, pose.position.z));
}

coal::CollisionGeometry *geometry(const void *body) {
  return static_cast<const Geometry *>(body)->get();
}

/* What its users call once a body is made. */
void *kept(Geometry made) {
  made->computeLocalAABB();
  return new Geometry(std::move(made));
}

std::vector<coal::Vec3s> points(const cprox_vec3 *vertices, size_t n) {
  std::vector<coal::Vec3s> out;
  for (size_t i = 0; i < n; i++) out.emplace_back(vertices[i].x, vertices[i].y, vertices[i].z);
  return out;
}

} // namespace

void *pair_coal_make(cprox_body_kind kind, const double size[3]) {
  switch (kind) {
    case CPROX_BODY_SPHERE: return kept(std::make_shared<coal::Sphere>(size[0]));
    case CPROX_BODY_BOX: return kept(std::make_shared<coal::Box>(size[0], size[1], size[2]));
    case CPROX_BODY_CYLINDER: return kept(std::make_shared<coal::Cylinder>(size[1], size[0]));
    case CPROX_BODY_CAPSULE: return kept(std::make_shared<coal::Capsule>(size[1], size[0]));
    default: return kept(std::make_shared<coal::Ellipsoid>(size[0], size[1], size[2]));
  }
}

void *pair_coal_make_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m) {
  const auto faces = std::make_shared<std::vector<coal::Triangle>>();
  for (size_t i = 0; i < m; i++) {
    const int *t = triangles[i];
    faces->emplace_back(static_cast<size_t>(t[0]), static_cast<size_t>(t[1]), static_cast<size_t>(t[2]));
  }
  return kept(
      std::make_shared<coal::Convex<coal::Triangle>>(std::make_shared<std::vector<coal::Vec3s>>(points(vertices, n)),
                                                     static_cast<unsigned>(n), faces, static_cast<unsigned>(m)));
}

void *pair_coal_make_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m) {
  std::vector<coal::Triangle> faces;
  for (size_t i = 0; i < m; i++) faces.emplace_back(triangles[i][0], triangles[i][1], triangles[i][2]);
  const auto model = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
  model->beginModel();
  model->addSubModel(points(vertices, n), faces);
  model->endModel();
  return kept(model);
}

void pair_coal_free(void *body) {
  delete static_cast<Geometry *>(body);
}

double pair_coal_distance(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  const coal::DistanceRequest request;
  coal::DistanceResult found;
  return coal::distance(geometry(a), placed(*pa), geometry(b), placed(*pb), request, found);
} catch (const std::exception &) {
  return NAN;
}

int pair_coal_collides(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb) try {
  const coal::CollisionRequest request;
  coal::CollisionResult found;
  coal::collide(geometry(a), placed(*pa), geometry(b), placed(*pb), request, found);
  return found.isCollision();
} catch (const std::exception &) {
  return -1;
}

void pair_coal_follow(const void *a, const cprox_pose *pa, const void *b, const cprox_pose *pb, size_t n,
                      double *found) try {
  coal::DistanceRequest request;
  request.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
  for (size_t i = 0; i < n; i++) {
    coal::DistanceResult result;
    found[i] = coal::distance(geometry(a), placed(*pa), geometry(b), placed(pb[i]), request, result);
    request.updateGuess(result);
  }
} catch (const std::exception &) {
  for (size_t i = 0; i < n; i++) found[i] = NAN;
}
