/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_fcl.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

using Object = fcl::CollisionObjectd;

struct robot_fcl {
  std::vector<std::unique_ptr<Object>> parts, world;
  std::vector<std::pair<size_t, size_t>> pairs;
  fcl::DynamicAABBTreeCollisionManagerd tree;
};

const char *robot_fcl_name(void) {
  return "FCL boolean at .01";
}

robot_fcl *robot_fcl_create(void) {
  return new robot_fcl;
}

void robot_fcl_free(robot_fcl *r) {
  delete r;
}

void robot_fcl_add_mesh(robot_fcl *r, const double *corners, size_t m) {
  const auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(m), static_cast<int>(3 * m));
  for (size_t i = 0; i < m; i++) {
    const double *c = corners + 9 * i;
    model->addTriangle({c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]});
  }
  model->endModel();
  r->parts.emplace_back(new Object(model));
}

void robot_fcl_add_box(robot_fcl *r, cprox_vec3 edges) {
  r->parts.emplace_back(new Object(std::make_shared<fcl::Boxd>(edges.x, edges.y, edges.z)));
}

void robot_fcl_add_cylinder(robot_fcl *r, double radius, double height) {
  r->parts.emplace_back(new Object(std::make_shared<fcl::Cylinderd>(radius, height)));
}

void robot_fcl_add_capsule(robot_fcl *r, double radius, double height) {
  r->parts.emplace_back(new Object(std::make_shared<fcl::Capsuled>(radius, height)));
}

void robot_fcl_add_sphere(robot_fcl *r, double radius) {
  r->parts.emplace_back(new Object(std::make_shared<fcl::Sphered>(radius)));
}

void robot_fcl_stand(robot_fcl *r, cprox_pose pose) {
  r->world.push_back(std::move(r->parts.back()));
  r->parts.pop_back();
  const cprox_quat q = pose.orientation;
  Object &object = *r->world.back();
  object.setRotation(fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix());
  object.setTranslation(fcl::Vector3d(pose.position.x, pose.position.y, pose.position.z));
  object.computeAABB();
}

void robot_fcl_add_pair(robot_fcl *r, size_t a, size_t b) {
  r->pairs.emplace_back(a, b);
}

void robot_fcl_ready(robot_fcl *r) {
  for (const auto &object : r->world) r->tree.registerObject(object.get());
  r->tree.setup();
}

void robot_fcl_place(robot_fcl *r, size_t part, cprox_vec3 position, const double rotation[9]) {
  Object &object = *r->parts[part];
  fcl::Matrix3d m;
  for (int i = 0; i < 9; i++) m(i / 3, i % 3) = rotation[i];
  object.setRotation(m);
  object.setTranslation(fcl::Vector3d(position.x, position.y, position.z));
  object.computeAABB();
}

bool robot_fcl_hits_world(robot_fcl *r) {
  for (const auto &part : r->parts) {
    fcl::DefaultCollisionData<double> data;
    r->tree.collide(part.get(), &data, fcl::DefaultCollisionFunction<double>);
    if (data.result.isCollision()) return true;
  }
  return false;
}

bool robot_fcl_collides(robot_fcl *r) {
  if (robot_fcl_hits_world(r)) return true;
  for (const auto &[a, b] : r->pairs) {
    if (!r->parts[a]->getAABB().overlap(r->parts[b]->getAABB())) continue;
    fcl::CollisionResultd result;
    if (fcl::collide(r->parts[a].get(), r->parts[b].get(), fcl::CollisionRequestd(), result) > 0) return true;
  }
  return false;
}

double robot_fcl_distance(robot_fcl *r, bool of_pairs) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto &part : r->parts) {
    if (of_pairs) break;
    fcl::DefaultDistanceData<double> data;
    r->tree.distance(part.get(), &data, fcl::DefaultDistanceFunction<double>);
    least = std::min(least, data.result.min_distance);
  }
  for (const auto &[a, b] : r->pairs) {
    if (!of_pairs) break;
    fcl::DistanceResultd result;
    fcl::distance(r->parts[a].get(), r->parts[b].get(), fcl::DistanceRequestd(), result);
    least = std::min(least, result.min_distance);
  }
  return std::max(least, 0.0);
}
