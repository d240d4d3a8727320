/* SPDX-License-Identifier: BSD-3-Clause */
#include "sampling.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <memory>
#include <vector>

using Object = fcl::CollisionObjectd;

struct sampling {
  std::vector<std::unique_ptr<Object>> objects;
  mutable fcl::DynamicAABBTreeCollisionManagerd tree;
};

const char *sampling_name(void) {
  return "FCL at 100 points";
}

sampling *sampling_create(void) {
  return new sampling;
}

void sampling_free(sampling *s) {
  delete s;
}

void sampling_add_box(sampling *s, cprox_vec3 edges, cprox_pose pose) {
  fcl::Transform3d placed = fcl::Transform3d::Identity();
  const cprox_quat q = pose.orientation;
  placed.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  placed.translation() = fcl::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  s->objects.emplace_back(new Object(std::make_shared<fcl::Boxd>(edges.x, edges.y, edges.z), placed));
  s->objects.back()->computeAABB();
}

void sampling_ready(sampling *s) {
  for (const auto &object : s->objects) s->tree.registerObject(object.get());
  s->tree.setup();
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

/* Calls `ask` with the ball at each parameter until it says that this is enough. */
template <typename Ask>
void ride(const cprox_vec3 *points, size_t n, double radius, size_t samples, Ask ask) {
  Object ball(std::make_shared<fcl::Sphered>(radius));
  for (size_t k = 0; k < samples; k++) {
    ball.setTranslation(point_at(points, n, double(k) / double(samples - 1)));
    ball.computeAABB();
    if (ask(&ball)) return;
  }
}

} // namespace

double sampling_collides(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples) {
  bool hit = false;
  ride(points, n_points, radius, samples, [&](Object *ball) {
    fcl::DefaultCollisionData<double> data;
    s->tree.collide(ball, &data, fcl::DefaultCollisionFunction<double>);
    return hit = data.result.isCollision();
  });
  return hit ? 1.0 : 0.0;
}

double sampling_distance(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples) {
  double least = INFINITY;
  ride(points, n_points, radius, samples, [&](Object *ball) {
    fcl::DefaultDistanceData<double> data;
    s->tree.distance(ball, &data, fcl::DefaultDistanceFunction<double>);
    least = std::min(least, std::max(data.result.min_distance, 0.0));
    return least <= 0.0;
  });
  return least;
}
